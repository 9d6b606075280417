"""Text that is no table of armscope, told by its first line: JSON, HTML, a table of blanks, a table without names."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)
_PROGRAM = re.compile(
    r"\s*(module|(local )?(const|pers|var)|proc|mov(e?[jlc]|eabsj)|&access|def|decl|e6(axis|pos)|ptp|lin|/job)\b",
    re.IGNORECASE,
)
"""How lines of RAPID, KRL, URScript and INFORM begin."""
_COMMENT = ("#", "%", "//", ";", "!")
_TO_CSV = "Save it as CSV: a first line with the columns' names, then a row per point, separated by commas."


def by_hand(names: Sequence[str], file: str) -> str:
    """What to do about a file of whose columns none looks like an angle or a point."""
    if {"a", "alpha", "d"} <= {name.strip().lower() for name in names}:
        return f"D-H rows? `armscope init - -o robot.yaml < {shlex.quote(file)}` reads them."
    return (
        "Write the mapping by hand: docs/bring-your-recordings.md shows one of points and one of motions. If this is a "
        "robot's program, write its poses as a table first."
    )


def what_it_is(header: Sequence[str], file: str) -> tuple[str, str, str] | None:
    """What a first line says about a file that can't be read by its columns' names.

    Args:
        header: the first line's cells.
        file: the file, as the user named it, for the command that converts it.

    Returns:
        What was found, what is allowed and how to mend it; None where the line may name columns.
    """
    line = ",".join(header).strip()
    if file.endswith((".yaml", ".yml")):
        cure = "A robot.yaml is given by --robot, a mapping.yaml by `armscope import --mapping`."
        return f"YAML, {line[:40]!r}", "tables are CSV", cure
    by_draft = (
        f"`armscope init {shlex.quote(file)} -o mapping.yaml` drafts how to read it, `armscope import` converts it."
    )
    if "\0" in line:
        return "zero bytes, as in UTF-16", "tables are UTF-8 text", "Save it as UTF-8."
    if line.startswith(("{", "[{", "[[")) or line in ("[", "{"):
        return f"JSON, {line[:40]!r}", "tables are CSV", _TO_CSV
    if line.startswith("<"):
        return f"HTML or XML, {line[:40]!r}", "tables are CSV", _TO_CSV
    if _PROGRAM.match(line) and "q1" not in line.lower():
        cure = "Write its poses as a table: a first line q1_deg,...,x_mm,y_mm,z_mm, then a row per pose."
        return f"a robot's program, {line[:40]!r}", "tables are CSV", cure
    if len(header) == 1 and line.startswith(_COMMENT):
        cure = f"Remove the lines above the columns' names. Or {by_draft}"
        return f"a comment, {line[:40]!r}", "the first line names the columns", cure
    if len(header) == 1 and re.search(r"[;\t|]|\S\s+\S+\s+\S", line):
        return line, "columns are separated by commas", by_draft
    if len(header) > 1 and all(_NUMBER.fullmatch(cell.strip()) for cell in header):
        rule = "the first line names the columns"
        return f"numbers, {line[:40]!r}", rule, "Write a line q1_rad,q2_rad,...,x_mm,y_mm,z_mm above them."
    if len(header) > 1 and all(re.fullmatch(r"'.*'", cell.strip()) for cell in header):
        return (
            f"names in single quotes, {header[0]}",
            "only double quotes may stand around a cell",
            "Remove the quotes.",
        )
    return None
