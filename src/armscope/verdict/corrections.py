"""What a verdict puts right in a controller's model, as tables: zeros of the motors, and D-H rows or URDF origins."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from armscope.core.rotations import turned_by
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.physics.effect import AXES
from armscope.physics.geometric import JOINT_OFFSET, LINK_GEOMETRY
from armscope.physics.linkage_words import BARS, OF_WHAT
from armscope.physics.zero_shift import ZERO_SHIFT
from armscope.robot import Arm, controllers
from armscope.robot.arm import build_arm
from armscope.robot.urdf_writing import axes_told, origins_of_file, turns_of_file
from armscope.verdict.constants import ORDER
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import INTERVAL, FoundEffect, Parameter
from armscope.verdict.entries import entry_decimals, length
from armscope.verdict.untold import beyond_arms, untold

NUMBERS = {
    "a_mm": ("a", "a"), "alpha_deg": ("alpha", "α"), "d_mm": ("d", "d"),
    "theta_offset_deg": ("theta", "θ offset"), "beta_deg": ("beta", "β"),
}  # fmt: skip
"""Of a D-H row, as robot.yaml calls them: what an effect calls its error, and its name for people."""


SETS_A_ZERO = {JOINT_OFFSET.name: "offset", ZERO_SHIFT.name: "jump"}  # What sets a zero, and the parameter by which


def zero_offsets(verdict: Diagnosis) -> pd.DataFrame:
    """The zeros of all motors as found: actual angle minus commanded angle, with 95 % intervals (half width).

    One that jumped stands as it is since then; those that were not named, or are but one reading of several, as 0.
    """
    rows, open_ = [], {each.location for each in unsettled(verdict)}
    for j in range(1, verdict.model.arm.n_motors + 1):
        found = [p for e in _settled(verdict) if e.effect in SETS_A_ZERO and e.location == f"joint {j}"
                 for p in e.parameters if p.name == SETS_A_ZERO[e.effect] and not untold(p, e)]  # fmt: skip
        value = sum(p.value for p in found)
        half = INTERVAL * math.hypot(*(p.stderr for p in found)) if found else float("nan")
        rows.append(
            (
                f"joint {j}",
                math.degrees(value),
                1e3 * value,
                1e3 * half,
                "named" if found else "to be settled" if f"joint {j}" in open_ else "not named",
            )
        )
    columns = ["joint", "actual_minus_commanded_deg", "actual_minus_commanded_mrad", "half_interval_95_mrad", "cause"]
    return pd.DataFrame(rows, columns=columns)


def as_entered(zeros: pd.DataFrame) -> pd.DataFrame:
    """The table of `zero_offsets` with the digits of the work order: none beyond what their intervals leave."""
    halves = zeros["half_interval_95_mrad"].tolist()
    mrad = [entry_decimals("mrad", half / INTERVAL) for half in halves]
    degrees = [entry_decimals("°", math.degrees(1e-3 * half / INTERVAL)) for half in halves]
    rounded = zeros.copy()
    for column, decimals in zip(zeros.columns[1:4], (degrees, mrad, mrad), strict=True):
        rounded[column] = [round(value, digits) for value, digits in zip(zeros[column].tolist(), decimals, strict=True)]
    return rounded


def unsettled(verdict: Diagnosis) -> list[FoundEffect]:
    """Zeros and links that are but one reading of several: until that is settled nothing is entered for them."""
    entered = (JOINT_OFFSET.name, LINK_GEOMETRY.name)
    return [each for each in verdict.effects if each.effect in entered and _is_open(each, verdict)]


def _settled(verdict: Diagnosis) -> list[FoundEffect]:
    return [each for each in verdict.effects if not _is_open(each, verdict)]


def _is_open(effect: FoundEffect, verdict: Diagnosis) -> bool:
    """Whether an effect is but one reading: without a name, or with one that the poses to measure next ask about."""
    poses = verdict.next_poses
    if effect.same_cure:
        return False
    return effect.named_as != "effect" or (poses is not None and poses.ask_about(effect))


def wrongly_stated(verdict: Diagnosis) -> bool:
    """Whether a link is off by more than arms show: a table of corrections without that would be half of one."""
    return any(effect.effect == LINK_GEOMETRY.name and beyond_arms(effect) for effect in verdict.effects)


def corrected_rows(verdict: Diagnosis) -> pd.DataFrame | None:
    """The D-H rows as stated and as found, mm and degrees, without the zeros. Returns a line per row; None for an
    arm that has no D-H rows, or is wrongly stated."""
    dh = verdict.model.arm.description.dh
    if dh is None or wrongly_stated(verdict):
        return None
    rows = []
    for j, stated in enumerate(dh.joints, start=1):
        found = {p.name: p for e in _settled(verdict) if (e.effect, e.location) == (LINK_GEOMETRY.name, f"link {j}")
                 for p in e.parameters if not untold(p, e)}  # fmt: skip
        row: dict[str, object] = {"row": j, "convention": dh.convention}
        for name, (key, _) in NUMBERS.items():
            value, step = getattr(stated, name), found[key].value if key in found else 0.0
            step = math.degrees(step) if name.endswith("deg") else step
            row |= {f"stated_{name}": value, f"correction_{name}": step, f"corrected_{name}": value + step}
        rows.append(row)
    return pd.DataFrame(rows)


def changes(table: pd.DataFrame) -> bool:
    """Whether a table of `corrected_rows`, `corrected_origins` or `zero_offsets` holds any correction."""
    if "changed" in table:
        return bool(table["changed"].any())
    columns = ["actual_minus_commanded_deg"] if "cause" in table else table.filter(like="correction_").columns
    return bool(table[columns].any(axis=None))


class CorrectedCell(NamedTuple):
    """Of the table of corrected rows: a number as stated, and as corrected, "" where it is not."""

    stated: str
    corrected: str = ""


def corrected_table(verdict: Diagnosis) -> tuple[list[str], list[list[CorrectedCell]]]:
    """The same rows to be read by people.

    What is corrected has its interval beside it and as many decimals as that leaves.

    Returns:
        The heads of the columns, the row's number first, and the rows; both empty where there are none.
    """
    table = corrected_rows(verdict)
    if table is None:
        return [], []
    numbers = [name for name in NUMBERS if name != "beta_deg" or table[f"corrected_{name}"].any()]
    rows = [
        [CorrectedCell(str(row["row"])), *(_corrected(row, name, verdict) for name in numbers)]
        for row in table.to_dict("records")
    ]
    return ["row", *(NUMBERS[name][1] for name in numbers)], rows


def _corrected(row: Mapping[Any, Any], name: str, verdict: Diagnosis) -> CorrectedCell:
    stated = f"{row[f'stated_{name}']:.10g}".replace("-", "−")
    if not row[f"correction_{name}"]:
        return CorrectedCell(stated)
    known = {
        (e.location, p.name): p.stderr for e in verdict.effects if e.effect == LINK_GEOMETRY.name for p in e.parameters
    }
    stderr = known.get((f"link {row['row']}", NUMBERS[name][0]), math.nan)
    unit, stderr = ("°", math.degrees(stderr)) if name.endswith("deg") else ("mm", stderr)
    decimals, half = entry_decimals(unit, stderr), INTERVAL * stderr
    beside = f" ± {half:.{decimals}f}" if half > 0 else ""
    return CorrectedCell(stated, f"{row[f'corrected_{name}']:.{decimals}f}{beside}".replace("-", "−"))


def corrected_origins(verdict: Diagnosis) -> pd.DataFrame | None:
    """The origins of the chain's joints in the URDF as stated and as found, without the zeros. Returns a line per
    joint; None for D-H rows, or an arm that is wrongly stated."""
    arm = verdict.model.arm
    if arm.description.dh is not None or wrongly_stated(verdict):
        return None
    found = {e.location: e for e in _settled(verdict) if e.effect == LINK_GEOMETRY.name}
    rows = []
    for j, (name, stated) in enumerate(zip(arm.joint_names, origins_of_file(arm), strict=True), start=1):
        effect = found.get(f"link {j}")
        origins = {"stated": stated, "corrected": stated if effect is None else corrected_origin(arm, effect, j)}
        row: dict[str, object] = {"joint": name, "changed": effect is not None}
        for which, origin in origins.items():
            xyz, rpy = place_and_angles(origin)
            row |= {f"{which}_{axis}_m": value for axis, value in zip("xyz", xyz, strict=True)}
            row |= {f"{which}_{axis}_rad": value for axis, value in zip(("roll", "pitch", "yaw"), rpy, strict=True)}
        rows.append(row)
    return pd.DataFrame(rows)


def corrected_origin(arm: Arm, effect: FoundEffect, joint: int) -> Array:
    """(4, 4) the origin of a URDF's joint once the errors of its link are put right.

    Args:
        arm: of the URDF.
        effect: a link's geometry: tx, ty, tz (mm), rx, ry (rad) along and about the axes in which it is told.
        joint: its number, from 1.

    Returns:
        The origin as the file states it, moved by the errors.
    """
    told = {p.name: p.value for p in effect.parameters if not untold(p, effect)}
    errors = np.array([told.get(axis, 0.0) for axis in AXES]) * np.array([1e-3, 1e-3, 1e-3, 1, 1, 1])
    turned = errors[3:] if np.abs(errors[3:]).max() > ORDER.turned_origin_rad else np.zeros(3)
    moved = np.eye(4)
    moved[:3, 3], moved[:3, :3] = errors[:3], turned_by(turned)
    to_file = turns_of_file(arm)[joint - 1] @ axes_told(arm)[joint - 1]
    corrected: Array = origins_of_file(arm)[joint - 1] @ to_file @ moved @ np.linalg.inv(to_file)
    return corrected


def place_and_angles(origin: Array) -> tuple[Array, Array]:
    """xyz (m) and roll, pitch, yaw (rad) of a placement (4, 4), as a URDF writes them."""
    from scipy.spatial.transform import Rotation  # slow to import, and of URDFs alone

    angles = Rotation.from_matrix(origin[:3, :3]).as_euler("xyz", suppress_warnings=True)
    return origin[:3, 3] + 0.0, angles + 0.0  # no minus before a zero


def corrected_ur_kinematics(verdict: Diagnosis) -> dict[str, Any] | None:
    """`armscope.robot.controllers.ur_kinematics` of an arm whose rows and zeros are put right.

    None where nothing is: a file of the nominal arm would undo what the maker calibrated.
    """
    arm = verdict.model.arm
    rows, zeros = corrected_rows(verdict), zero_offsets(verdict)["actual_minus_commanded_deg"]
    if rows is None or arm.description.dh is None or not (changes(rows) or zeros.any()):
        return None
    rows = rows.assign(corrected_theta_offset_deg=rows["corrected_theta_offset_deg"] + zeros)
    joints = [
        row.model_copy(update={name: float(rows[f"corrected_{name}"].iloc[j]) for name in NUMBERS})
        for j, row in enumerate(arm.description.dh.joints)
    ]
    dh = arm.description.dh.model_copy(update={"joints": joints})
    return controllers.ur_kinematics(build_arm(arm.description.model_copy(update={"dh": dh})))


ALL_OF_THEM = "both before anything is measured: one without the other can make it worse"
NOT_SURE = "no bar is surely off (each interval holds zero), so change none before it was measured"
PPM = 1e6


def bars_set_right(parameters: Sequence[Parameter]) -> str:
    """How each bar that is off is changed; one whose interval holds zero is left as it is. ``parameters``: of the
    parallelogram: the errors of its bars, lengths or shares of the rocker's."""
    bars = sorted((p for p in parameters if p.name in BARS), key=lambda p: BARS.index(p.name))
    if not bars:
        return "–"
    off = [p for p in bars if abs(p.value) > INTERVAL * p.stderr]
    if not off:
        return NOT_SURE
    changes = [f"make the {p.name} {'shorter' if p.value > 0 else 'longer'} by {_by_how_much(p)}" for p in off]
    kept = [f"leave the {p.name} as it is (its error may be none)" for p in bars if p not in off]
    return "; ".join([enumerated(changes), *([ALL_OF_THEM] if len(off) > 1 else []), *kept])


def _by_how_much(bar: Parameter) -> str:
    if bar.unit == "mm":
        return length(abs(bar.value), bar.stderr).removeprefix("+")
    half = f" (± {PPM * INTERVAL * bar.stderr:.0f})" if bar.stderr > 0 else ""
    return f"{PPM * abs(bar.value):.0f} ppm{half} {OF_WHAT}"
