"""Which columns of a foreign table look like motor angles and measured points, and in which units they stand."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.recordings.constants import POSSIBLE
from armscope.recordings.importing.constants import DRAFT
from armscope.recordings.importing.first_table import ForeignTable, below_name, printable
from armscope.recordings.importing.stated_units import ANGLE_UNITS, LENGTH_UNITS, OTHER_UNITS, stated_unit, unknown_unit

COMMANDED = ("target", "cmd", "command", "commanded", "set", "desired", "nominal", "ref", "soll", "指令", "理论")
MEASURED = ("measured", "meas", "actual", "act", "ist", "tracker", "laser", "leica", "faro", "mcs", "测量", "实测")

AXIS = re.compile(r"(?<![a-z])(?:pos|coord|p)?([xyz])(?![a-z])")


def points_of(table: ForeignTable, taken: Sequence[int]) -> list[list[int]]:
    """The three columns of each measured point, those of one name with numbers 1, 2, ... in their order. Returns
    Columns along x, y, z by reflector; nothing where no columns look like a point."""
    if not table.header:
        return [list(range(len(taken), len(taken) + 3))] if taken else []
    found: dict[str, dict[str, int]] = {}
    for column, name in enumerate(table.names):
        if column in taken:
            continue
        apart = re.sub(r"(?<=[a-z])(?=[XYZ](?![A-Za-z]))", " ", name)  # PosX
        for match in AXIS.finditer(apart.lower().replace("_", " ")):
            rest = (apart[: match.start(1)] + "?" + apart[match.end(1) :]).lower()
            found.setdefault(rest, {})[match[1]] = column
    whole = {rest: [axes[a] for a in "xyz"] for rest, axes in found.items() if set(axes) == set("xyz")}
    whole = {rest: columns for rest, columns in whole.items() if not _NO_POINT.search(rest)}
    if not whole:
        return []
    best = max(whole, key=lambda rest: (_measured(rest), -whole[rest][0]))
    alike = {_number(rest): columns for rest, columns in whole.items() if _bare(rest) == _bare(best)}
    numbered = [alike.get(number) for number in range(1, len(alike) + 1)]
    several = [columns for columns in numbered if columns is not None]
    return several if len(several) == len(alike) > 1 else [whole[best]]


_NO_POINT = re.compile(r"r\?|rot|orient|q\?|quat|force|f\?|sigma")
"""What stands beside an axis' letter where a column is no length."""


def _measured(rest: str) -> int:
    """Whether a name says that it is measured (1) or commanded (-1)."""
    return any(word in rest for word in MEASURED) - any(word in rest for word in COMMANDED)


def _bare(rest: str) -> str:
    return re.sub(r"\d+", "#", rest)


def _number(rest: str) -> int:
    numbers = re.findall(r"\d+", rest)
    return int(numbers[0]) if len(numbers) == 1 else -1


JOINT = re.compile(r"(?P<word>.*?)[\s_.\[(\-]*(?P<number>\d{1,2})(?!\d)[\])]?(?P<rest>\D*)")
"""A column of one motor: words, its number, and what may follow: a unit, words."""
ANGLE_WORDS = (
    *("q", "j", "joint", "theta", "th", "axis", "axe", "achse", "gelenk", "a", "angle", "ang", "pos", "position"),
    *("eje", "articulación", "articulacion", "junta", "eixo", "giunto", "asse", "articulation", "关节", "轴"),
    *("encoder", "motor", "rax", "s"),
)
BESIDE = {
    "torque": ("tau", "torque", "trq", "moment", "effort"),
    "speed": ("dq", "qd", "v", "vel", "velocity", "speed", "omega"),
    "approach": ("approach", "dir", "direction"),
}
NOT_ANGLES = ("current", "i", "temp", "temperature", "volt", "m", "ddq", "qdd", "acc")
MAKERS_LETTERS = ("s", "l", "u", "r", "b", "t")
"""How Yaskawa-Motoman names the six motors of an arm, from the base to the tool."""
UR_JOINTS = (
    ("shoulder pan", "shoulder lift", "elbow", "wrist 1", "wrist 2", "wrist 3"),
    ("base", "shoulder", "elbow", "wrist 1", "wrist 2", "wrist 3"),
)
"""The six joints of a Universal Robots arm, from the base on; its logs have them in the order of the alphabet, too."""


def largest_of(values: Array) -> float:
    """The largest size of some numbers; 0 where there is none."""
    known = values[np.isfinite(values)]
    return float(np.abs(known).max()) if len(known) else 0.0


def numbered_columns(table: ForeignTable) -> dict[str, dict[int, int]]:
    """Columns that are numbered, by what stands before the number: {word: {number: column}}."""
    groups: dict[str, dict[int, int]] = {}
    for column, name in enumerate(table.names):
        found = JOINT.fullmatch(name.strip())
        if table.header and found and np.isfinite(table.values[:, column]).any():
            behind = _without_unit(found["rest"].lower())
            groups.setdefault(f"{found['word'].lower()} {behind}".strip(), {}).setdefault(int(found["number"]), column)
    return groups


def words_of(name: str) -> list[str]:
    """A name's words in small letters, without its numbers."""
    return [part for part in re.split(r"[^a-z°]+", name.lower()) if part]


def _without_unit(words: str) -> str:
    """What stands behind a number, without the unit at its end: `_rad`, ` [Grad]`, ` angle (deg)`."""
    bare = words.strip(" _.-")
    whole = bare.strip("[]() ")
    units = {*ANGLE_UNITS, *LENGTH_UNITS, *OTHER_UNITS}
    if whole in units:
        return ""
    ends = re.fullmatch(r"(.*?)[\s_.\-\[(]+([^\s_.\-\[(]+?)[\])]?", bare)
    return ends[1].strip(" _.-[]()") if ends and ends[2] in units else bare


def ur_joints(table: ForeignTable) -> list[int]:
    """Columns of angles named as Universal Robots' joints, from the base on; none where one is missing."""
    beside = {"joint", "q", "pos", "position", "angle", *ANGLE_UNITS}
    named: dict[str, int] = {}
    for column, name in enumerate(table.names if table.header else ()):
        words = [word for word in re.findall(r"[a-z]+|\d+", name.lower()) if word not in beside]
        if np.isfinite(table.values[:, column]).any():
            named.setdefault(" ".join(words), column)
    return next(([named[joint] for joint in joints] for joints in UR_JOINTS if set(joints) <= set(named)), [])


def _named_joints(table: ForeignTable) -> list[int]:
    """Columns of angles named by joint, as in a URDF (`elbow_joint`), or by a maker's letters, in the table's order."""
    bare = {words_of(name)[0]: column for column, name in reversed([*enumerate(table.names)]) if words_of(name)}
    if table.header and set(MAKERS_LETTERS) <= set(bare):
        return [bare[letter] for letter in MAKERS_LETTERS]
    others = {each for names in BESIDE.values() for each in names} | set(NOT_ANGLES)
    named = [column for column, name in enumerate(table.names) if table.header and "joint" in words_of(name)]
    known = [column for column in named if np.isfinite(table.values[:, column]).any()]
    return [column for column in known if not set(words_of(table.names[column])) & others]


def in_a_row(group: dict[int, int]) -> list[int]:
    """The columns numbered 1, 2, ... (or 0, 1, ...) without a gap; none where there are fewer than an arm has."""
    start = 0 if 0 in group else 1
    count = next(n for n in range(start, start + len(group) + 1) if n not in group) - start
    return [group[start + n] for n in range(count)] if count >= DRAFT.fewest_motors else []


def motor_columns(table: ForeignTable) -> list[int]:
    """The columns that look like motor angles, from the base on; none where none do."""
    if not table.header:
        return _leading(table)
    ranked = []
    for word, group in numbered_columns(table).items():
        parts = re.findall(r"[^\W\d_]+", word)
        others = {each for names in BESIDE.values() for each in names} | set(NOT_ANGLES)
        columns = in_a_row(group)
        if not columns or not set(parts) & set(ANGLE_WORDS) or set(parts) & (others - set(ANGLE_WORDS)):
            continue
        commanded = bool(set(parts) & set(COMMANDED)) - bool(set(parts) & set(MEASURED))
        ranked.append((commanded, len(columns), -columns[0], columns))
    named = ur_joints(table) or _named_joints(table)
    if len(named) >= DRAFT.fewest_motors and all(len(named) > count for _, count, *_ in ranked):
        return named
    return max(ranked)[-1] if ranked else []


def _leading(table: ForeignTable) -> list[int]:
    """Without names: columns from the left that stay within a turn, the three behind them being the point."""
    spans = [largest_of(table.values[:, [column]]) for column in range(table.values.shape[1])]
    count = len(spans) - 3
    return list(range(count)) if count >= DRAFT.fewest_motors and max(spans[:count]) <= POSSIBLE.angle_deg else []


FILL_IN = "FILL_IN"  # What no mapping takes for a unit: `armscope import` asks for one


def unit_of(table: ForeignTable, columns: Sequence[int], units: dict[str, str]) -> tuple[str | None, str]:
    """The unit that a table states for the columns of one quantity, and how it is known.

    Args:
        table: the table.
        columns: those of the quantity.
        units: what mappings call each word for one.

    Returns:
        The unit and the words of a comment; `FILL_IN` where the table states one that is not known, None and no word
        where it states none.

    Raises:
        InputError: the columns state several units.
    """
    cells = [(table.names[column] if table.header else "", below_name(table, column)) for column in columns]
    if unknown := next((word for cell in cells if (word := unknown_unit(*cell, units))), ""):
        known = ", ".join(dict.fromkeys(units.values()))
        return FILL_IN, f"to fill in: the table says {printable(unknown)!r}, which is none of {known}"
    stated = list(dict.fromkeys(unit for cell in cells if (unit := stated_unit(*cell, units))))
    if len(stated) > 1:
        names = ", ".join(table.names[column] for column in columns)
        rule = f"the columns of one quantity have one unit, these have {' and '.join(stated)}"
        raise InputError(table.file, f"line {table.skip + 1}", names, rule, "Convert the columns of one of them.")
    return (stated[0], "stated by the table") if stated else (None, "")


def filled_in(text: str) -> str:
    """A draft with any known unit where one is left open, to see whether all else of it holds."""
    kinds = {"position": "mm", "reflectors": "mm", "speed": "rad/s", "speeds": "rad/s", "time": "s"}
    lines = []
    for line in text.split("\n"):
        unit = kinds.get(line.strip().partition(":")[0], "rad")
        lines.append(line.replace(f"unit: {FILL_IN}", f"unit: {unit}").replace(f"scale: {FILL_IN}", "scale: 1"))
    return "\n".join(lines)
