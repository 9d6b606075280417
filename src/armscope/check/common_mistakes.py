"""Common mistakes in a table, and the table with each of them undone."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from armscope.check.constants import TRIALS
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.arm import build_arm

MIRRORED = "left-handed frame"  # Kind of what makes the points a mirror image of the arm's
PARALLELOGRAM = ("base", "upper arm", "forearm")  # What the motors up to that of a parallelogram turn


@dataclass(frozen=True)
class Trial:
    """A mistake that may have been made: its kind as notices call it, what to say of it, and how to undo it.

    Most are in the table; where it is in robot.yaml, ``arm`` is the arm without it.
    """

    kind: str
    statement: str
    cure: str
    undo: Callable[[Recordings], Recordings]
    arm: Callable[[Arm], Arm] = lambda arm: arm


def trials(arm: Arm) -> Iterator[Trial]:
    """All mistakes that are tried, the usual ones first."""
    yield from _units()
    for shift in sorted({*range(-TRIALS.row_shift, TRIALS.row_shift + 1)} - {0}, key=abs):
        yield Trial(
            "rows out of step",
            f"the measured points come {abs(shift)} row(s) too {'late' if shift < 0 else 'early'} for the joint angles",
            "Join angles and points by what they have in common, not by their order.",
            partial(_shifted, shift=shift),
        )
    yield from _joints(arm.n_motors)
    yield from _several_signs(arm.n_motors)
    yield Trial(
        MIRRORED,
        "the measurement frame is left-handed: the points are a mirror image of the arm's",
        "Flip the sign of one axis, or exchange two, where the points come from (in mapping.yaml: two of `position`).",
        _changed("positions", partial(np.multiply, [1.0, 1.0, -1.0])),
    )
    yield from _of_the_arm(arm)


def _of_the_arm(arm: Arm) -> Iterator[Trial]:
    """What is usually wrong in D-H rows that were copied from a drawing or another program."""
    dh = arm.description.dh
    if dh is None:
        return
    other = "modified" if dh.convention == "standard" else "standard"
    yield Trial(
        "D-H convention",
        f"the D-H rows are in the {other} convention, not the {dh.convention} one that robot.yaml states",
        f"Write convention: {other} under dh in robot.yaml.",
        lambda table: table,
        lambda arm: _with_rows(arm, convention=other),
    )
    exchanged = [row.model_copy(update={"a_mm": row.d_mm, "d_mm": row.a_mm}) for row in dh.joints]
    yield Trial(
        "D-H columns",
        "a and d of the D-H rows are exchanged",
        "Exchange a_mm and d_mm in every row of robot.yaml: a is along x, d along the joint's axis z.",
        lambda table: table,
        lambda arm: _with_rows(arm, joints=exchanged),
    )
    mirrored = [row.model_copy(update={"alpha_deg": -row.alpha_deg}) for row in dh.joints]
    yield Trial(
        "D-H signs",
        "every alpha of the D-H rows has the other sign",
        "Change the sign of all alpha_deg in robot.yaml: they turn about x, right-handed.",
        lambda table: table,
        lambda arm: _with_rows(arm, joints=mirrored),
    )


def _with_rows(arm: Arm, **changes: Any) -> Arm:
    """An arm whose D-H table is another."""
    assert arm.description.dh is not None
    dh = arm.description.dh.model_copy(update=changes)
    return build_arm(arm.description.model_copy(update={"dh": dh}))


def _units() -> Iterator[Trial]:
    for factor, right, wrong, cure in (
        (np.pi / 180, "degrees", "radians", "Call the columns q1_deg ..., or say unit: deg in the mapping."),
        (180 / np.pi, "radians", "degrees", "Call the columns q1_rad ..., or say unit: rad in the mapping."),
    ):
        statement = f"the joint angles look like {right} that were declared as {wrong}"
        yield Trial("units", statement, cure, _changed("motor_angles", partial(np.multiply, factor)))
    for factor, right, wrong, cure in (
        (1e3, "metres", "millimetres", "Call the columns x_m, y_m, z_m."),
        (1e-3, "millimetres", "metres", "Call the columns x_mm, y_mm, z_mm."),
        (10.0, "centimetres", "millimetres", "Multiply them by 10."),
        (25.4, "inches", "millimetres", "Multiply them by 25.4."),
    ):
        statement = f"the positions look like {right} that were declared as {wrong}"
        yield Trial("units", statement, cure, _changed("positions", partial(np.multiply, factor)))
    for axis, others in (("x", "y and z"), ("y", "x and z"), ("z", "x and y")):
        for factor, right in ((1e3, "metres"), (10.0, "centimetres"), (25.4, "inches")):
            enlarged = np.where(np.array(list("xyz")) == axis, factor, 1.0)
            statement = f"{axis} looks like {right}, where {others} are millimetres"
            cure = f"Multiply {axis}_mm by {factor:g}: all three need one unit."
            yield Trial("units", statement, cure, _changed("positions", partial(np.multiply, enlarged)))


def _joints(n_motors: int) -> Iterator[Trial]:
    yield Trial(
        "joint order",
        "the joints stand in reverse order",
        "q1 is the joint nearest the base.",
        _changed("motor_angles", np.fliplr),
    )
    yield Trial(
        "joint sign",
        "every joint turns the other way than the arm's model says",
        "Give all angles the other sign.",
        _changed("motor_angles", np.negative),
    )
    yield from _parallelogram(n_motors)
    one_by_one = np.eye(n_motors)
    for motor in range(n_motors):
        yield Trial(
            "joint sign",
            f"joint {motor + 1} turns the other way than the arm's model says",
            f"Give q{motor + 1} the other sign, or turn the axis in robot.yaml (alpha of the rows beside it).",
            _changed("motor_angles", partial(np.multiply, 1 - 2 * one_by_one[motor])),
        )
    for motor, degrees in itertools.product(range(n_motors), (-90, 90, 180)):
        yield Trial(
            "joint zero",
            f"the zero of joint {motor + 1} is {abs(degrees)} degrees off",
            f"Add {degrees} degrees to q{motor + 1}, or to its theta_offset_deg in robot.yaml.",
            _changed("motor_angles", partial(np.add, np.radians(degrees) * one_by_one[motor])),
        )
    for one, other in itertools.combinations(range(n_motors), 2):
        order = np.arange(n_motors)
        order[[one, other]] = other, one
        yield Trial(
            "joint order",
            f"the angles of joints {one + 1} and {other + 1} are exchanged",
            "Exchange their columns.",
            _changed("motor_angles", partial(np.take, indices=order, axis=1)),
        )


def _several_signs(n_motors: int) -> Iterator[Trial]:
    """Makers count some joints the other way, as KUKA does 1, 4 and 6: of a symmetric arm, that is its mirror image."""
    if n_motors > TRIALS.signed_joints:
        return
    for many in range(2, n_motors):
        for several in itertools.combinations(range(n_motors), many):
            signs = np.where(np.isin(np.arange(n_motors), several), -1.0, 1.0)
            joints = enumerated([str(motor + 1) for motor in several])
            columns = enumerated([f"q{motor + 1}" for motor in several])
            yield Trial(
                "joint sign",
                f"joints {joints} turn the other way than the arm's model says",
                f"Give {columns} the other sign, or turn these axes in robot.yaml (actuation: -1). Jog joint "
                f"{several[0] + 1}: where its angle grows, does it turn as the model does?",
                _changed("motor_angles", partial(np.multiply, signs)),
            )


def _parallelogram(n_motors: int) -> Iterator[Trial]:
    """On many arms joint 3 is driven by a parallelogram, so that its motor holds the forearm's direction."""
    if n_motors < len(PARALLELOGRAM):
        return
    for sign, says, is_so in ((-1, "relative to link 2", "absolute"), (1, "absolute", "relative to link 2")):
        yield Trial(
            "parallelogram",
            f"q3 holds the forearm's angle {is_so}, where robot.yaml has it {says}",
            "Is joint 3 driven by a parallelogram? Then `actuation` in robot.yaml has {q3: 1, q2: -1} as its third "
            "row; else it has no such row.",
            _changed("motor_angles", partial(_third_by_second, sign=sign)),
        )


def _third_by_second(angles: Array, sign: int) -> Array:
    return np.asarray(angles + sign * angles[:, [1]] * (np.arange(angles.shape[1]) == len(PARALLELOGRAM) - 1))


def _changed(what: str, change: Callable[[Array], Array]) -> Callable[[Recordings], Recordings]:
    """A table with one of its arrays changed."""

    def undo(table: Recordings) -> Recordings:
        changed: dict[str, Any] = {what: change(getattr(table, what))}
        return replace(table, **changed)

    return undo


def _shifted(table: Recordings, shift: int) -> Recordings:
    """Points moved by some rows against the angles, within each run; what has no partner is left out."""
    kept, partner = [], []
    for run in np.unique(table.run):
        rows = np.flatnonzero(table.run == run)
        kept.append(rows[max(0, shift) : len(rows) + min(0, shift)])
        partner.append(rows[max(0, -shift) : len(rows) + min(0, -shift)])
    moved = table.rows(np.concatenate(kept))
    return replace(moved, positions=table.positions[np.concatenate(partner)])
