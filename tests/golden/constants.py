"""Which thresholds matter: each one doubled and halved, and what the golden verdicts then say otherwise.

    python -m tests.golden.constants OUT.jsonl              # a line per threshold and factor, as it is found
    python -m tests.golden.constants OUT.jsonl --only beam  # one of them
    python -m tests.golden.constants --table OUT.jsonl      # the lines as a table

Every trial is a process of its own, in which numbers are changed before anything else is imported. It ends with the
first golden case that changes. Several that change nothing together are not tried one by one, and what matters doubled
is not tried halved. Shares near one are scaled by what they lack of one, ratios just above one by their excess: 0.95 is
tried as 0.90 and 0.975, 1.15 as 1.3 and 1.075. Counts stay at least one. What OUT.jsonl holds is not tried again.
"""

from __future__ import annotations

import argparse
import importlib
import json
import multiprocessing
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

ROOT = Path(__file__).parents[2]
FACTORS = (2.0, 0.5)
TOGETHER = 8
"""So many are tried at once, and one half after the other where that changes something."""
NOT_CALLED = ("motion", "compensation", "comparison", "fleet", "real")
"""Rooms that diagnose no arm at rest."""
SAME = 1e-6
"""Relative: what tests/golden/test_golden.py forgives."""


class Threshold(NamedTuple):
    """A field of one of a room's modules of constants."""

    module: str
    group: str
    name: str


def scaled(value: Any, factor: float) -> Any:
    """The threshold by the factor, in the sense that suits its kind."""
    if isinstance(value, tuple):
        return tuple(scaled(each, factor) for each in value)
    if isinstance(value, int):
        return max(round(value * factor), min(value, 1))
    if isinstance(value, float) and 0.5 < value < 1.0:
        return 1.0 - (1.0 - value) / factor
    if isinstance(value, float) and 1.0 < value < 1.5:
        return 1.0 + (value - 1.0) * factor
    return value * factor


def thresholds() -> list[Threshold]:
    """Every number of the rooms that golden cases call."""
    from tools.constants import groups

    from armscope.core.constants import entries

    return [
        Threshold(group.__module__.removeprefix("armscope."), group.__name__, each.name)
        for group in groups()
        for each in entries(group)
        if group.__module__.split(".")[1] not in NOT_CALLED
    ]


def _trial(
    together: Sequence[Threshold], factor: float, folders: list[Path], base: dict[str, Any], report: Any
) -> None:
    """In a process of its own: diagnose case by case until something changes."""
    _install(together, factor)
    from tests.golden.cases import QUICK, diagnosed

    found: dict[str, Any] = {"changed": {}, "verdicts": {}}
    for folder in folders:
        try:
            verdict = _content(diagnosed(folder, QUICK))
        except Exception as trouble:
            found["changed"][folder.name] = {"words": {"": f"{type(trouble).__name__}: {trouble}"}, "numbers": {}}
            break
        if not together:
            found["verdicts"][str(folder)] = verdict
            continue
        change = compare(base[str(folder)], verdict)
        if change["words"] or change["numbers"]:
            found["changed"][folder.parent.name if folder.name == "visible" else folder.name] = change
            break
    report.send(found)


def _content(verdict: Any) -> Any:
    from armscope.verdict.files import curves_table, next_poses_table

    content = {"verdict": verdict.to_json(), "weights": verdict.residuals.weight}
    if verdict.next_poses is not None:
        content["next_poses"] = next_poses_table(verdict).to_dict("list")
    if (curves := curves_table(verdict)) is not None:
        content["curves"] = curves.to_dict("list")
    if verdict.atlas is not None:
        content["atlas"] = verdict.atlas.share
    return json.loads(json.dumps(content, default=lambda value: np.asarray(value).tolist()))


def _install(together: Sequence[Threshold], factor: float) -> None:
    """Before anything else is imported, so that defaults follow."""
    for each in together:
        module = importlib.import_module(f"armscope.{each.module}")
        for held in vars(module).values():
            if type(held).__name__ == each.group:
                object.__setattr__(held, each.name, scaled(getattr(held, each.name), factor))


def compare(before: Any, after: Any, where: str = "") -> dict[str, dict[str, Any]]:
    """What differs between two verdicts: words and lengths by place, and numbers' relative changes by place."""
    words: dict[str, Any] = {}
    numbers: dict[str, float] = {}
    if isinstance(before, dict) and isinstance(after, dict) and before.keys() == after.keys():
        inside = [compare(before[key], after[key], f"{where}.{key}") for key in before]
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        inside = [compare(one, other, where) for one, other in zip(before, after, strict=True)]
    elif isinstance(before, int | float) and isinstance(after, int | float) and not isinstance(before, bool):
        if not np.isclose(before, after, rtol=SAME, atol=1e-9, equal_nan=True):
            numbers[where] = abs(after - before) / max(abs(before), 1e-9)
        inside = []
    else:
        if before != after:
            words[where] = f"{str(before)[:120]} -> {str(after)[:120]}"
        inside = []
    for each in inside:
        words = {**each["words"], **words}
        numbers = {key: max(numbers.get(key, 0.0), each["numbers"].get(key, 0.0)) for key in numbers | each["numbers"]}
    return {"words": words, "numbers": numbers}


def _run(together: Sequence[Threshold], factor: float, folders: list[Path], base: dict[str, Any]) -> dict[str, Any]:
    context = multiprocessing.get_context("fork")
    receiving, sending = context.Pipe(duplex=False)
    child = context.Process(target=_trial, args=(together, factor, folders, base, sending))
    child.start()
    sending.close()
    try:
        found: dict[str, Any] = receiving.recv()
    except EOFError:
        found = {"changed": {"": {"words": {"": "the process ended"}, "numbers": {}}}, "verdicts": {}}
    child.join()
    return found


def _tried(
    together: Sequence[Threshold], factor: float, folders: list[Path], base: dict[str, Any]
) -> Iterator[dict[str, Any]]:
    """A line per threshold. What changes nothing together changes nothing; otherwise, one half after the other."""
    if not together:
        return
    began = time.perf_counter()
    changed = _run(together, factor, folders, base)["changed"]
    names = " ".join(each.name for each in together)
    print(f"x{factor:g} {len(changed)} changed in {time.perf_counter() - began:.0f} s: {names}", file=sys.stderr)
    if len(together) > 1 and changed:
        half = len(together) // 2
        yield from _tried(together[:half], factor, folders, base)
        yield from _tried(together[half:], factor, folders, base)
        return
    for each in together:
        yield {**each._asdict(), "factor": factor, "changed": changed}


def _make_folders(made: Path) -> None:
    from armscope.world.folder import build
    from tests.golden.cases import chosen_worlds

    for spec in chosen_worlds():
        if spec.id != "world-long":
            build(spec, made, ROOT / "config" / "robots")


def _folders(made: Path) -> list[Path]:
    child = multiprocessing.get_context("fork").Process(target=_make_folders, args=(made,))
    child.start()
    child.join()
    examples = [path.parent for path in sorted((ROOT / "examples").glob("*/recordings.csv"))]
    worlds = sorted(made.glob("*/visible"))
    return sorted([*examples, *worlds], key=lambda folder: (folder / "recordings.csv").stat().st_size)


def _table(lines: Path) -> None:
    for line in lines.read_text(encoding="utf-8").splitlines():
        trial = json.loads(line)
        says = []
        for case, change in trial["changed"].items():
            words = "; ".join(sorted(change["words"]))
            largest = max(change["numbers"].values(), default=0.0)
            says.append(f"{case}: {words}{' ' if words else ''}numbers by {largest:.1e}")
        print(f"| {trial['module']} | {trial['name']} | x{trial['factor']:g} | {' / '.join(says) or 'nothing'} |")


def main() -> None:
    """Try them all, or print what was found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lines", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--table", action="store_true")
    asked = parser.parse_args()
    if asked.table:
        _table(asked.lines)
        return
    for library in ("pandas", "pinocchio", "pydantic", "scipy.optimize", "scipy.spatial", "scipy.stats"):
        importlib.import_module(library)  # once, before the trials part
    with tempfile.TemporaryDirectory() as made, asked.lines.open("a", encoding="utf-8") as out:
        folders = _folders(Path(made))
        base = _run((), 1.0, folders, {})["verdicts"]
        with multiprocessing.get_context("fork").Pool(1) as elsewhere:
            chosen = [each for each in elsewhere.apply(thresholds) if asked.only in ("", each.name)]
        tried = map(json.loads, asked.lines.read_text(encoding="utf-8").splitlines())
        done = {(trial["module"], trial["group"], trial["name"]) for trial in tried}
        left = [each for each in chosen if each not in done]
        for first in range(0, len(left), TOGETHER):
            without: set[Threshold] = set(left[first : first + TOGETHER])
            for factor in FACTORS:
                for trial in _tried(sorted(without), factor, folders, base):
                    out.write(json.dumps(trial) + "\n")
                    out.flush()
                    if trial["changed"]:
                        without.discard(Threshold(trial["module"], trial["group"], trial["name"]))


if __name__ == "__main__":
    main()
