"""Which columns of a foreign table look like an orientation: a quaternion proves itself, three angles are offered only.

A controller's log has angles such as A, B, C that it computed from its own model; taken for measured ones they would
confirm that model. Their convention depends on the maker. So they come as a comment that somebody takes out.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

import numpy as np

from armscope.recordings.importing.constants import DRAFT
from armscope.recordings.importing.draft_columns import unit_of
from armscope.recordings.importing.first_table import ForeignTable, column_list
from armscope.recordings.importing.stated_units import ANGLE_UNITS

QUATERNION_PART = re.compile(
    r"(.*[\s_.\-/])?(q|quat|quaternion|rot|rotation|ori|orient|orientation|o)?[\s_.\-\[(]*(?P<part>[wxyz])[\])]?"
)
NUMBERED_PART = re.compile(r"(?:q|quat|quaternion|rot|ori|orient)[\s_.\-\[(]*([0-4])[\])]?")
BY_ANGLES = {
    ("a", "b", "c"): "euler: {columns}, sequence: ZYX, unit: {unit}",
    ("w", "p", "r"): "euler: {columns}, sequence: xyz, unit: {unit}",
    ("roll", "pitch", "yaw"): "euler: {columns}, sequence: xyz, unit: {unit}",
    ("rx", "ry", "rz"): "rotation_vector: {columns}, unit: {unit}",
}
"""Names of three angles, and what they mostly are: KUKA's A, B, C about z, y, x; FANUC's W, P, R; UR's vector."""
COMPUTED = "the controller computed it"


def orientation_lines(table: ForeignTable, taken: Collection[int]) -> Iterator[str]:
    """The mapping's line of an orientation, or a comment with one; nothing where no columns look like it. ``taken``:
    columns that are something else: motor angles and the point."""
    free = {name.strip().lower(): column for column, name in enumerate(table.names) if column not in taken}
    named = _quaternion(table, free)
    if columns := named or _numbered_quaternion(table, free):
        said = f"quaternion: {column_list(table, columns)}, order: wxyz"
        why = "their length is 1" if named else "their length is 1; w first, as ABB counts them"
        yield f"  orientation: {{{said}}}   # guessed: {why}; leave it out where {COMPUTED}"
        return
    bare = {_without_unit(name): column for name, column in free.items()}
    for names, line in BY_ANGLES.items():
        if not set(names) <= set(bare):
            continue
        columns = [bare[name] for name in names]
        largest = np.nanmax(np.abs(table.values[:, columns]), initial=0.0)
        stated, _ = unit_of(table, columns, ANGLE_UNITS)
        unit = stated or ("rad" if largest <= DRAFT.radians_up_to else "deg")
        said = line.format(columns=column_list(table, columns), unit=unit)
        yield f"  # orientation: {{{said}}}   # guessed: not taken, as if {COMPUTED}"
        return


def _quaternion(table: ForeignTable, free: dict[str, int]) -> list[int]:
    """Columns of w, x, y, z whose squares sum to 1 in every row that has them."""
    parts = {found["part"]: column for name, column in free.items() if (found := QUATERNION_PART.fullmatch(name))}
    if set(parts) != set("wxyz"):
        return []
    columns = [parts[part] for part in "wxyz"]
    return columns if _of_unit_length(table, columns) else []


def _numbered_quaternion(table: ForeignTable, free: dict[str, int]) -> list[int]:
    """The columns q1 ... q4 (or q0 ... q3) beside the motors' own whose squares sum to 1 in every row."""
    numbered = {found[1]: column for name, column in free.items() if (found := NUMBERED_PART.fullmatch(name))}
    for numbers in ("1234", "0123"):
        if set(numbers) == set(numbered):
            columns = [numbered[number] for number in numbers]
            return columns if _of_unit_length(table, columns) else []
    return []


def _of_unit_length(table: ForeignTable, columns: list[int]) -> bool:
    lengths = np.linalg.norm(table.values[:, columns], axis=1)
    known = lengths[np.isfinite(lengths)]
    return bool(len(known) and np.all(np.abs(known - 1) < DRAFT.unit_length))


def _without_unit(name: str) -> str:
    """`rx [rad]`, `roll_deg` without what stands for the unit."""
    found = re.fullmatch(r"(.+?)[\s_.\-\[(]+([a-z°]+)[\])]?", name)
    return found[1] if found and found[2] in ANGLE_UNITS else name
