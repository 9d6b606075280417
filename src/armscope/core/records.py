"""What armscope remembers of what it wrote in a folder, and how the files of a result take their places."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from pathlib import Path

from armscope.core.locks import Lock

HIDDEN = ".armscope"


def tidy(home: Path, locked: str | None = None) -> None:
    """Finish or remove what killed runs left in a folder. ``locked``: the key of the result whose lock the caller
    holds."""
    for left in sorted((home / HIDDEN).glob("*")):
        key = left.name.removesuffix(".part").removesuffix(".plan").removesuffix(".new").removesuffix(".lock")
        if key == left.name:
            continue
        lock = Lock(home / HIDDEN / f"{key}.lock", key)
        if key == locked or lock.free():
            carry_out(home, key)
            lock.give_back()


def carry_out(home: Path, key: str) -> None:
    """What a plan says, from wherever it was left; without one, only what was made ready is removed."""
    hidden = home / HIDDEN
    plan, stage, record = hidden / f"{key}.plan", hidden / f"{key}.new", hidden / f"{key}.json"
    if plan.is_file():
        files, drop = read_record(plan), read_record(plan, "drop")
        for name in files:
            if (stage / name).exists():
                _move(stage / name, Path(os.path.realpath(home / name)))
        for name, digest in drop.items():
            path = home / name
            if path.is_file() and not path.is_symlink() and digest_of(path) == digest:  # changed: it is the user's now
                path.unlink()
                with contextlib.suppress(OSError):
                    path.parent.rmdir()
        plan.replace(record)  # and no file is written any more, for which a full disk might have no room
    drop_drafts(home, key)


def drop_drafts(home: Path, key: str) -> None:
    """Remove what was made ready and not put in place."""
    hidden = home / HIDDEN
    for left in (hidden / f"{key}.plan", hidden / f"{key}.json"):
        _draft(left).unlink(missing_ok=True)
    shutil.rmtree(hidden / f"{key}.new", ignore_errors=True)


def _move(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        source.replace(target)
    except OSError:  # a link to another file system
        beside = target.with_name(f".{target.name}.part")
        shutil.copyfile(source, beside)
        beside.replace(target)


def digest_of(path: Path) -> str:
    """The sha256 of a file's content."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def read_record(path: Path, key: str = "files") -> dict[str, str]:
    """Names below the folder that a record is of, with digests; nothing from what is no record."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        files = json.loads(path.read_text(encoding="utf-8")).get(key)
        return {
            name: digest
            for name, digest in files.items()
            if isinstance(digest, str) and not Path(name).is_absolute() and ".." not in Path(name).parts
        }
    return {}


def write_record(path: Path, content: dict[str, dict[str, str]]) -> None:
    """Write a record or a plan, whole or not at all."""
    text = json.dumps({"written by": "armscope", **content}, indent=1) + "\n"
    _draft(path).write_text(text, encoding="utf-8")
    _draft(path).replace(path)


def _draft(path: Path) -> Path:
    return path.with_name(path.name + ".part")
