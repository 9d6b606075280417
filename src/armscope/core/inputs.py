"""What a user gives us: one clear error when it can't be used, and YAML files read against a typed model."""

from __future__ import annotations

import difflib
import os
import re
import stat
from collections.abc import Iterable
from contextvars import ContextVar
from pathlib import Path
from typing import Any, TypeVar

import pydantic
import yaml

from armscope.core.plainyaml import CONTROL, NotPlain, plain_yaml
from armscope.core.streams import at_hand

_STEERING = re.compile(f"{CONTROL.pattern}|[\u202a-\u202e\u2066-\u2069]")
"""Control characters, and those that turn the order of what stands beside them."""

Model = TypeVar("Model", bound=pydantic.BaseModel)

FILES_READ: ContextVar[set[tuple[int, int]] | None] = ContextVar("files read", default=None)
"""Identities of the files that the command that runs has read: what it must not overwrite."""


def note_read(path: Path | str) -> None:
    """Note that a file is read."""
    read, found = FILES_READ.get(), identity(path)
    if read is not None and found is not None:
        read.add(found)


def identity(path: Path | str) -> tuple[int, int] | None:
    """Device and number of a regular file, the same by whatever name; None where there is none."""
    try:
        about = os.stat(path)
    except (OSError, ValueError):
        return None
    return (about.st_dev, about.st_ino) if stat.S_ISREG(about.st_mode) else None


def spelt_out(text: str) -> str:
    """Words for a terminal: characters that would steer it are shown as escapes."""
    return _STEERING.sub(lambda found: ascii(found.group())[1:-1], text)


class InputError(ValueError):
    """Something that a user gave can't be used: where it stands, what was found, what is allowed, how to mend it.

    Args:
        file: the file it stands in (or the option it was given by).
        place: where in it: "row 12, column q3_rad", "dh.joints[2].a_mm".
        found: the value found, as the user wrote it.
        rule: what is allowed.
        cure: how to mend it; empty where the rule says it all.
    """

    def __init__(self, file: object, place: str, found: object, rule: str, cure: str = "") -> None:
        if file == DATA_FRAME:
            place, rule, cure = map(_of_a_frame, (place, rule, cure))
        self.file, self.place, self.found, self.rule, self.cure = str(file), place, found, rule, cure
        where = f"{file}: {place}" if place else str(file)
        text = f"{where}: found {_quote(found)}; {rule}." + (f" {cure}" if cure else "")
        super().__init__(spelt_out(text))  # goes to a terminal


DATA_FRAME = "data frame"
"""What a table is called that a program gives: its rows count from 0, and no line of a file holds its header."""


def _of_a_frame(text: str) -> str:
    """Lines of a CSV file as rows of a data frame."""
    own = re.sub(r"\bline 1\b", "columns", text)
    return re.sub(r"\bline (\d+)", lambda found: f"row {int(found.group(1)) - 2}", own)


def _quote(value: object) -> str:
    if type(value).__module__ == "numpy" and hasattr(value, "item"):  # a number, not "np.float64(...)"
        value = value.item()
    text = value if isinstance(value, str) and value.startswith(("no ", "nothing")) else repr(value)
    return text if len(text) <= 120 else text[:117] + "..."


def why_unreadable(error: Exception) -> str:
    """What ails a file that could not be read, unpacked or understood, and what to do about it."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    if isinstance(error, ValueError | OverflowError):
        return str(error)
    if isinstance(error, EOFError):
        return "Its gzipped content was cut off: copy or download it again."
    return f"Its gzipped content is damaged ({error}): copy or download it again."


def unreadable(path: Path, error: OSError, endings: tuple[str, ...]) -> tuple[str, str]:
    """What stands at a path that can't be read as a file, and what to do about it.

    Args:
        path: the path.
        error: why it can't be read.
        endings: of the files that may be meant where it is a folder.

    Returns:
        What was found, and the cure.
    """
    if not path.is_dir():
        return "no readable file", error.strerror or ""
    inside = sorted(each.name for each in path.iterdir() if each.name.endswith(endings))[:MOST_OFFERED]
    listed = ", ".join(str(path / name) for name in inside)
    return (
        "no readable file, but a folder",
        f"Name the file in it: {listed}." if inside else "Name a file: it has none that could be meant.",
    )


MOST_OFFERED = 3  # Files of a folder that an error offers

LONGEST_NAME, MOST_NAMES, MOST_TOLD = 100, 1000, 100
"""Beyond these a name is no slip of the pen, and likeness takes too long to measure."""


def nearest(name: str, known: Iterable[str]) -> str:
    """A sentence that names the known spelling closest to ``name``, or lists what is known."""
    known = sorted(each for each in known if 0 < len(each) <= LONGEST_NAME)[:MOST_NAMES]
    if len(name) > LONGEST_NAME or not known:
        return ""
    in_small = [each for each in known if each.strip().lower() == name.strip().lower()]
    close = in_small or difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    return f"Did you mean {close[0]!r}?" if close else "Known: " + ", ".join(known[:MOST_TOLD]) + "."


class Strict(pydantic.BaseModel):
    """A configuration object: unknown keys are errors, values are not coerced from text, and it can't change."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, strict=False, allow_inf_nan=False)


def read_yaml(path: Path | str) -> Any:
    """The content of a YAML file: plain values, see `armscope.core.plainyaml`. Raises InputError: it can't be read;
    line and column are named."""
    path = Path(path)
    note_read(path)
    try:
        content = at_hand(path).read_bytes()
        if b"\0" in content:  # UTF-16 and binary files, which PyYAML would try to guess
            raise InputError(path, f"byte {content.index(0)}", "no UTF-8 text", "YAML files are UTF-8")
        return plain_yaml(content.decode("utf-8-sig"))
    except OSError as error:
        found, cure = unreadable(path, error, (".yaml", ".yml"))
        raise InputError(path, "", found, "a YAML file is needed here", cure) from error
    except NotPlain as error:
        place = f"line {error.mark.line + 1}, column {error.mark.column + 1}"
        rule = "a configuration is one document of plain values"
        raise InputError(path, place, error.problem, rule, error.cure) from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        problem = getattr(error, "problem", None) or "it can't be parsed"
        raise InputError(path, place, problem, "this must be valid YAML", "Check indentation and colons.") from error
    except UnicodeDecodeError as error:
        raise InputError(path, f"byte {error.start}", "no UTF-8 text", "YAML files are UTF-8") from error


def format_of(content: Any) -> str:
    """What a file says under ``format``, for those who want one version only."""
    return str(content.get("format", "no key format")) if isinstance(content, dict) else "no mapping"


def validate(model: type[Model], content: Any, file: object) -> Model:
    """``content`` as a ``model``; the first thing wrong becomes an `InputError` that names its place in ``file``.

    Args:
        model: the pydantic model that the content must fit.
        content: what was read.
        file: where it was read, for the error.

    Returns:
        The content as the model.

    Raises:
        InputError: the first thing that doesn't fit, with the nearest known key where a key is unknown.
    """
    try:
        return model.model_validate(content)
    except pydantic.ValidationError as error:
        # a key that is misspelt comes before what is then missing
        problem = min(error.errors(), key=lambda each: each["type"] != "extra_forbidden")
        place = _dotted(_as_written(content, problem["loc"]))
        if problem["type"] == "extra_forbidden":
            known = _keys_at(model, problem["loc"][:-1])
            key = str(problem["loc"][-1])
            raise InputError(file, place, key, "this key is not known here", nearest(key, known)) from error
        found = "nothing" if problem["type"] == "missing" else problem["input"] if place else "no consistent content"
        rule = problem["msg"].removeprefix("Value error, ").replace("valid tuple", "list")
        raise InputError(file, place, found, rule[0].lower() + rule[1:]) from error


def load(model: type[Model], path: Path | str) -> Model:
    """Read a YAML file and validate it against ``model``."""
    return validate(model, read_keys(path), path)


def read_keys(path: Path | str) -> dict[Any, Any]:
    """The content of a YAML file that has keys. Raises InputError: it can't be read, or has none."""
    content = read_yaml(path)
    if not isinstance(content, dict):
        raise InputError(path, "", content or "nothing", "this file has lines of the form `key: value`")
    return content


def mapping(content: Any, file: object, what: str) -> dict[str, Any]:
    """What was read, which must be a mapping.

    Args:
        content: what was read.
        file: where from, and
        what: what that is, for the error.

    Returns:
        the same.

    Raises:
        InputError: it is something else.
    """
    if not isinstance(content, dict):
        raise InputError(file, "", content, f"this is not {what}")
    return content


def folder_of(path: Path | str, what: str) -> Path:
    """A folder that must be there: of ``what``, for the error."""
    path = Path(path)
    if not path.is_dir():
        raise InputError(path, "", "no folder", f"the folder of {what} is needed here")
    return path


def _as_written(content: Any, location: tuple[int | str, ...]) -> tuple[int | str, ...]:
    """A location without the names of the alternatives that a value was tried as."""
    written: list[int | str] = []
    for number, part in enumerate(location):
        if isinstance(part, str) and isinstance(content, dict) and part not in content and number + 1 < len(location):
            continue
        if not (isinstance(part, str) and not isinstance(content, dict)):
            written.append(part)
        content = _inside(content, part)
    return tuple(written)


def _inside(content: Any, part: int | str) -> Any:
    try:
        return content[part]
    except (KeyError, IndexError, TypeError):
        return content


def _dotted(location: tuple[int | str, ...]) -> str:
    text = ""
    for part in location:
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text.lstrip(".")


def _keys_at(model: type[pydantic.BaseModel], location: tuple[int | str, ...]) -> list[str]:
    """The keys that ``model`` knows at a nested location."""
    current: Any = model
    for part in location:
        if isinstance(part, str) and hasattr(current, "model_fields") and part in current.model_fields:
            current = _inner_model(current.model_fields[part].annotation)
    return list(current.model_fields) if hasattr(current, "model_fields") else []


def _inner_model(annotation: Any) -> Any:
    """The pydantic model inside ``list[Model]``, ``Model | None``, ``dict[str, Model]``."""
    if hasattr(annotation, "model_fields"):
        return annotation
    for argument in getattr(annotation, "__args__", ()):
        found = _inner_model(argument)
        if found is not None:
            return found
    return None
