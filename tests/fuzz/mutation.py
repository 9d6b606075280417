"""Good files made bad: bytes flipped, cut, doubled, swapped for odd ones; values of a tree swapped for odd ones."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import yaml

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

ODD_BYTES = [
    *(b"", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\x80", b"\x1b[31m", b"\r", b"\n\n", b"\t", b'"', b"'", b"\\"),
    *(b",", b";", b":", b"- ", b"#", b"&a ", b"*a", b"<<: *a", b"!!int ", b"!!python/none ", b"[", b"]", b"{", b"}"),
    *(b"<", b">", b"nan", b"inf", b"-inf", b".nan", b".inf", b"1e308", b"-1e308", b"1e999", b"1e-320", b"0", b"-1"),
    *(b"1.5", b"1,5", b"9" * 30, b"9" * 400, b"9" * 5000, b"true", b"null", b"~", b"2020-13-45", b"1:30", b"0x10"),
    *(b"NaN", b"Infinity", "µ".encode(), "°".encode(), "\u2028".encode(), b"<script>alert(1)</script>", b"../"),
    *(b"joint 7", b"link 0", b"motor 99", b"base", b"tool", b"instrument"),
    *(b"/etc/passwd", b"a" * 3000, b"[" * 3000, b'{"a":' * 3000),
]
ODD_VALUES: list[Any] = [
    *(None, True, False, 0, 1, -1, 2, 7, 99, -5, 0.5, -0.5, 1e-320, 1e12, -1e30, 1e308, float("nan"), float("inf")),
    *(10**30, "", "0", "a", "joint 7", "link 1", "motor 1", "base", "tx", "scale", "turn", "one", "spline", "angle"),
    *("nan", "é" * 200, [], {}, [None], [[]], [1, 2, 3], ["a"], {"a": 1}, [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    *([0.0] * 100, ["sine", 1, 2.0], ["moment", "joint 1", 5], ["regressor", 1, 2.0], ["heavier", ["one"]]),
]


def mutated(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    """A file with one to a few things wrong in it."""
    for _ in range(int(rng.geometric(0.5))):
        content = _MUTATIONS[rng.integers(len(_MUTATIONS))](content, others, rng)
    return content[:900_000]


def _span(content: bytes, rng: np.random.Generator, longest: int = 60) -> tuple[int, int]:
    at = int(rng.integers(len(content) + 1))
    return at, min(len(content), at + int(rng.integers(1, longest)))


def _flip(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    if not content:
        return b"\x00"
    changed = bytearray(content)
    changed[rng.integers(len(changed))] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def _drop(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    low, high = _span(content, rng)
    return content[:low] + content[high:]


def _double(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    low, high = _span(content, rng)
    return content[:high] + content[low:high] * int(rng.integers(1, 4)) + content[high:]


def _insert(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    at, _ = _span(content, rng)
    return content[:at] + ODD_BYTES[rng.integers(len(ODD_BYTES))] + content[at:]


def _swap_word(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    """One value between separators becomes an odd one."""
    low, _ = _span(content, rng)
    ends = b",:;[]{}<>\"'\n \t"
    while low > 0 and content[low - 1] not in ends:
        low -= 1
    high = low
    while high < len(content) and content[high] not in ends:
        high += 1
    return content[:low] + ODD_BYTES[rng.integers(len(ODD_BYTES))] + content[high:]


def _cut_off(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    return content[: int(rng.integers(len(content) + 1))]


def _splice(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    other = others[rng.integers(len(others))]
    return content[: int(rng.integers(len(content) + 1))] + other[int(rng.integers(len(other) + 1)) :]


def _lines(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    lines = content.split(b"\n")
    first, second = rng.integers(len(lines), size=2)
    lines[first], lines[second] = lines[second], lines[first]
    return b"\n".join(lines)


def _recoded(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    return content.decode("utf-8", "replace").encode(
        ("utf-16", "utf-16-le", "latin-1", "utf-8-sig")[rng.integers(4)], "replace"
    )


_MUTATIONS = (_flip, _drop, _double, _insert, _swap_word, _swap_word, _swap_word, _cut_off, _splice, _lines, _recoded)


def tree_of(path: Path) -> Any:
    """The content of a YAML or JSON file."""
    text = path.read_text(encoding="utf-8")
    return json.loads(text) if path.suffix == ".json" else yaml.load(text, Loader=_LOADER)


def text_of(tree: Any, suffix: str) -> bytes:
    """A tree as a file; JSON with what Python writes for numbers that are none."""
    if suffix == ".json":
        return json.dumps(tree).encode()
    return yaml.dump(tree, Dumper=_DUMPER, sort_keys=False, allow_unicode=True).encode()


def places(tree: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where something stands in a tree."""
    inner = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [at, *(place for key, value in inner for place in places(value, (*at, key)))]


def changed(tree: Any, place: tuple[Any, ...], what: str, value: Any) -> Any:
    """A tree with something else at a place: ``what`` is "swap", "drop", "rename" or "double"."""
    if not place:
        return value
    tree = copy.deepcopy(tree)
    inside = tree
    for key in place[:-1]:
        inside = inside[key]
    key = place[-1]
    if what == "drop":
        del inside[key]
    elif what == "rename" and isinstance(inside, dict):
        inside[str(value)] = inside.pop(key)
    elif what == "double" and isinstance(inside, list):
        inside.append(inside[key])
    else:
        inside[key] = value
    return tree
