"""The contract of recordings.csv, column by column: name, unit, meaning, and what no row can hold, with the source."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from armscope.core.inputs import LONGEST_NAME, InputError, nearest
from armscope.core.types import Array
from armscope.recordings.constants import POSSIBLE, READING
from armscope.recordings.first_lines import is_motion

AXES_MM = ["x_mm", "y_mm", "z_mm"]
ERROR_COLUMNS = ["dx_mm", "dy_mm", "dz_mm"]  # Of the tool point, measured minus nominal, in tables of studies
QUATERNION = ["qw", "qx", "qy", "qz"]

UNITS: dict[str, float] = {
    "rad": 1.0,
    "mrad": 1e-3,
    "deg": np.pi / 180,
    "gon": np.pi / 200,
    "um": 1e-6,
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "in": 0.0254,
    "ft": 0.3048,
}
"""SI of one. Tables of raw files may be in centimetres, inches or gons; those of armscope are not."""


@dataclass(frozen=True)
class Column:
    """A column of the contract."""

    name: str  # as it stands in the header; ``{j}`` is the motor's number, from 1
    unit: str  # of its numbers; empty for words
    meaning: str  # what it says, with sign and frame
    # low, high: no row holds less or more
    low: float = -POSSIBLE.number
    high: float = POSSIBLE.number
    rule: str = ""  # why, in the words of an error; says the source of the range

    def matches(self, header: str) -> bool:
        """Whether a header is this column, small and capital letters told apart."""
        return re.fullmatch(self.name.replace("{j}", r"[1-9]\d*"), header) is not None


LONGEST_UNIT = 1 + POSSIBLE.off_unit  # Of a unit quaternion's number, as it is printed
_ANGLE = "commanded angle of motor {j}; motors are counted from the base, the sign is the one of the robot's model"
_POINT = "measured tool point along {axis} of the measurement frame, which may stand anywhere"
_TURN = "measured orientation, measurement frame from tool frame, as a unit quaternion ({part}); all four or none"

COLUMNS = (
    Column("q{j}_rad", "rad", _ANGLE, -POSSIBLE.angle_rad, POSSIBLE.angle_rad, "a joint angle lies within two turns"),
    Column(
        "q{j}_deg",
        "deg",
        f"{_ANGLE}; in place of q{{j}}_rad",
        -POSSIBLE.angle_deg,
        POSSIBLE.angle_deg,
        "a joint angle lies within two turns",
    ),
    *(
        Column(
            f"{axis}_{unit}",
            unit,
            _POINT.format(axis=axis) + ("" if unit == "mm" else f"; in place of {axis}_mm"),
            -POSSIBLE.position_m / UNITS[unit],
            POSSIBLE.position_m / UNITS[unit],
            "no instrument sees a point beyond 10 km",
        )
        for unit in ("mm", "m")
        for axis in "xyz"
    ),
    Column("id", "", "name of the configuration, once per run and target; the row's number where there is none"),
    Column(
        "run",
        "",
        "name of the session: runs whose bases agree to some millimetres stand on one base, and a jump between them "
        "is told; others have a base each. Held-out folds go by it where no base jumped",
    ),
    Column("target", "", "which reflector was measured: the tool point is free for each"),
    Column("qw", "", _TURN.format(part="real part"), -LONGEST_UNIT, LONGEST_UNIT, "a quaternion has length 1"),
    *(
        Column(
            name, "", _TURN.format(part=f"along {name[1]}"), -LONGEST_UNIT, LONGEST_UNIT, "a quaternion has length 1"
        )
        for name in ("qx", "qy", "qz")
    ),
    Column("time_s", "s", "when the row was measured, from any zero"),
    Column(
        "temperature_c",
        "deg C",
        "of the arm's structure; lengths of robot.yaml hold at 20 deg C",
        POSSIBLE.coldest_c,
        POSSIBLE.warmest_c,
        "no temperature is below absolute zero, and steel melts before 2000 deg C",
    ),
    Column(
        "payload_kg",
        "kg",
        "point mass at the tool point, beyond `tool_load` of robot.yaml",
        0.0,
        POSSIBLE.payload_kg,
        "a payload is not negative, and the strongest arm that is sold carries 2300 kg (FANUC M-2000iA/2300)",
    ),
    Column("approach{j}", "", "sign of motor {j}'s last motion before it stopped: -1 or +1; 0 where it did not move"),
    Column(
        "dq{j}_rad_s",
        "rad/s",
        "speed of motor {j} when the row was measured",
        -POSSIBLE.speed_rad_s,
        POSSIBLE.speed_rad_s,
        "the fastest arms turn a joint at 42 rad/s (delta robots' fourth axis, makers' data sheets)",
    ),
    Column(
        "tau{j}_nm",
        "N m",
        "torque at joint {j}, positive along gravity's pull (the load's torque on the motor's axis); the torque with "
        "which the motor holds it is its opposite",
        -POSSIBLE.torque_nm,
        POSSIBLE.torque_nm,
        "the heaviest arm that is sold (11,000 kg, reach 4.7 m) needs less than 1e6 N m",
    ),
    Column("sigma_mm", "mm", "stated 1-sigma uncertainty of the point, alike along x, y and z"),
    *(Column(f"sigma_{axis}_mm", "mm", f"the same along {axis} alone; all three or none") for axis in "xyz"),
)


def angle_columns(motor_angles: Array) -> dict[str, Array]:
    """Motor angles (N, m), rad, as columns of a table: q1_rad, q2_rad, ..."""
    return {f"q{motor}_rad": angles for motor, angles in enumerate(motor_angles.T, start=1)}


def column_named(header: str) -> Column | None:
    """The column of the contract that a header names; None where it is none."""
    return next((column for column in COLUMNS if column.matches(header)), None)


def as_in_contract(headers: Iterable[str]) -> Mapping[str, str]:
    """Headers that are columns of the contract but for capital letters and blanks, by how the contract writes them.

    A header whose contract name stands in the table, too, stays as it is.
    """
    headers = [str(header) for header in headers]
    there, renamed = set(headers), {}
    for header in headers:
        plain = header.strip().lower()
        if plain not in there and column_named(plain) is not None:
            renamed[header] = plain
            there.add(plain)
    return renamed


def name_meant_by(header: str) -> str:
    """The column of the contract that a header is a misspelling of; "" for none."""
    number = re.search(r"[1-9]\d*", header)
    names = [column.name.replace("{j}", number[0] if number else "1") for column in COLUMNS]
    return next(iter(difflib.get_close_matches(header.strip().lower()[:LONGEST_NAME], names, 1, READING.alike)), "")


def counted_from_zero(headers: Iterable[str]) -> str:
    """What to do about a table whose motors are counted from 0; "" where they are not."""
    zero = next((header for header in headers if re.fullmatch(r"q0_(?:rad|deg)", header)), None)
    return f"Motors are counted from 1, nearest the base: call {zero} q1{zero[2:]}, and so on." if zero else ""


_BY_NAME = re.compile("joint|shoulder|elbow|wrist")
"""What joints are called where they have names for numbers: in URDFs, and in the logs of what reads these."""


class Names:
    """The columns that a table has, by its first line.

    Args:
        columns: their names, in the words of the contract.
        source: the file, for errors.
    """

    def __init__(self, columns: Sequence[str], source: Path | str) -> None:
        self.columns, self.source = columns, source

    def _error(self, found: str, rule: str, cure: str = "") -> InputError:
        return InputError(self.source, "line 1", found, rule, cure)

    def check_one_unit(self, one: str, other: str) -> None:
        """Refuse a quantity that stands there twice. Raises InputError: both columns are there."""
        if one in self.columns and other in self.columns:
            raise self._error(f"{one} and {other}", "one column per quantity", "Remove one of them.")

    def motor_angles(self, n_motors: int | None) -> list[str]:
        """The columns of ``n_motors`` motors' angles, or of as many as there are. Raises InputError: there are none,
        or others."""
        matches = (re.fullmatch(r"q([1-9]\d*)_(?:rad|deg)", name) for name in self.columns)
        found = {int(m[1]): m[0] for m in matches if m}
        self._refuse_slides()
        count = n_motors if n_motors is not None else max(found, default=0)
        if count == 0:
            cure = self._how_to_name_angles()
            raise self._error("no column q1_rad", "motor angles stand in q1_rad, q2_rad, ... (or _deg)", cure)
        for motor in range(1, count + 1):
            self.check_one_unit(f"q{motor}_rad", f"q{motor}_deg")
            if motor not in found:
                fewer = sorted(found) == list(range(1, motor))
                cure = f"The table has {motor - 1} motor angles: is this the right robot for the recordings?"
                cure = cure if fewer and motor > 1 else nearest(f"q{motor}_rad", self.columns)
                cure = counted_from_zero(self.columns) or (cure if found else self._how_to_name_angles())
                raise self._error(f"no column q{motor}_rad", f"the arm has motors q1 ... q{count}", cure)
        if max(found) > count:
            cure = "Is this the right robot for the recordings?"
            raise self._error(found[max(found)], f"the arm has {count} motors", cure)
        return [found[motor] for motor in range(1, count + 1)]

    def _refuse_slides(self) -> None:
        """Poses of joints that slide: rows with the slide at one place are those of an arm without it."""
        slide = next((name for name in self.columns if re.fullmatch(r"q[1-9]\d*_m", name)), None)
        if slide is not None:
            cure = (
                f"Keep the rows of one place of this slide, take {slide} out, count the motors that turn from q1, and "
                "state the place in robot.yaml, by the joint's name: hold_joints: {name: m}."
            )
            raise self._error(slide, "measured points are diagnosed for joints that turn; this one slides", cure)

    def _how_to_name_angles(self) -> str:
        """What to do about a table of whose columns none is called as a motor's angle."""
        by_name = [name for name in self.columns if _BY_NAME.search(name.lower()) and not re.search(r"\d", name)]
        if len(by_name) > 1:
            how = f"`armscope init {Path(self.source).name} -o mapping.yaml` drafts how to read it"
            return f"Its joints go by names, such as {by_name[0].strip()!r}: {how}."
        numbered = [name for name in self.columns if re.fullmatch(r"\s*[A-Za-z]\w*?_?1(?!\d).*", name)]
        like_q1 = [name for name in numbered if not re.match(r"\s*(tau|current|d+q|f|approach|[xyz])_?1", name.lower())]
        if not like_q1:
            return nearest("q1_rad", self.columns)
        return (
            f"If {like_q1[0].strip()!r} is motor 1's angle, call it q1_rad or q1_deg: the unit stands in the name. "
            "`armscope init` drafts a mapping for a whole table."
        )

    def positions(self, measured: bool) -> list[str]:
        """The columns of measured points; none where there are none and they need not be ``measured``. Raises
        InputError: some are missing, or they stand there twice."""
        for axis in "xyz":
            self.check_one_unit(f"{axis}_mm", f"{axis}_m")
        for unit in ("mm", "m"):
            columns = [f"{axis}_{unit}" for axis in "xyz"]
            present = [name for name in columns if name in self.columns]
            if len(present) == 3:
                return columns
            if present:
                missing = next(name for name in columns if name not in present)
                cure = nearest(missing, [name for name in self.columns if name not in present])
                raise self._error(f"no column {missing}", "x, y and z come together, in one unit", cure)
        if measured:
            self._refuse_motion()
            rule, cure = "measured positions stand in x_mm, y_mm, z_mm (or _m)", nearest("x_mm", self.columns)
            raise self._error("no column x_mm", rule, cure)
        return []

    def _refuse_motion(self) -> None:
        """Where there are no points: a table of an arm in motion, or one of which nothing but angles was recorded.
        Raises InputError: it is either."""
        points = "measured positions stand in x_mm, y_mm, z_mm (or _m)"
        if is_motion(list(self.columns)):
            cure = "It is a table of an arm in motion: `armscope diagnose`, `check` and `predict` take it."
            raise self._error("no column x_mm", points, cure)
        if set(self.columns) <= {"id", "run", "time_s"} | {name for name in self.columns if re.match("d?q[1-9]", name)}:
            found = "no columns x_mm, y_mm, z_mm, and neither tau1_nm nor current1_a"
            cure = "Angles alone tell nothing: which of both was recorded? A motion may have current1_a, ..., instead."
            raise self._error(found, f"{points}; of a motion, torques stand in tau1_nm, ...", cure)
