"""What a calibration may change: constants, what each does to the tool, their values, and the arm that they make."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from armscope.core.rotations import turned_by
from armscope.core.types import Array
from armscope.robot import Arm, Chain, twist_jacobian
from armscope.robot.arm import build_arm
from armscope.robot.denavit_hartenberg import row_twist
from armscope.robot.description import DHRow

Unit = Literal["m", "rad"]

DH_FIELDS = {"theta": "theta_offset_deg", "a": "a_mm", "alpha": "alpha_deg", "d": "d_mm", "beta": "beta_deg"}
TWIST_NAMES = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True)
class Constant:
    """One constant of the arm's geometry: of joint ``joint`` (from 1); ``kind`` as in `DH_FIELDS` or `TWIST_NAMES`."""

    joint: int
    kind: str

    @property
    def unit(self) -> Unit:
        """Metres or radians."""
        return "m" if self.kind in ("a", "d", "x", "y", "z") else "rad"

    @property
    def name(self) -> str:
        """For tables: "joint 3 alpha"."""
        return f"joint {self.joint} {self.kind}"

    @property
    def is_zero_offset(self) -> bool:
        """Whether it is the joint's angle at encoder zero."""
        return self.kind in ("theta", "rz")


def constants_of(arm: Arm) -> tuple[Constant, ...]:
    """Everything that a geometric calibration may change.

    Arms with D-H rows: a, alpha, d, theta and the turn about y of every row. Arms from a URDF: the six of every joint's
    placement. Far more than can be identified: choosing among them is `identifiability`'s task.
    """
    kinds = tuple(DH_FIELDS) if arm.description.dh is not None else TWIST_NAMES
    return tuple(Constant(joint, kind) for joint in range(1, arm.n_joints + 1) for kind in kinds)


def nominal_values(arm: Arm, constants: tuple[Constant, ...]) -> Array:
    """(P,) what the D-H rows say, m and rad; NaN for a URDF's placements, which have no value of their own."""
    if arm.description.dh is None:
        return np.full(len(constants), np.nan)
    rows = arm.description.dh.joints
    stated = [float(getattr(rows[each.joint - 1], DH_FIELDS[each.kind])) for each in constants]
    to_si = [1e-3 if each.unit == "m" else np.pi / 180 for each in constants]
    return np.asarray(np.array(stated) * to_si)


def corrected(arm: Arm, constants: tuple[Constant, ...], values: Array) -> Arm:
    """The arm with ``values`` (m, rad) added to its constants.

    Only the arm's own arrays change for a URDF: its description still names the nominal file (see `export`).

    Args:
        arm: the nominal arm.
        constants: which of its constants.
        values: (P,) m or rad, to be added.

    Returns:
        The corrected arm.
    """
    if arm.description.dh is None:
        return _with_placements(arm, constants, values)
    changes: dict[int, dict[str, float]] = {}
    for constant, value in zip(constants, values, strict=True):
        row = arm.description.dh.joints[constant.joint - 1]
        field = DH_FIELDS[constant.kind]
        in_file = value * 1e3 if constant.unit == "m" else np.degrees(value)
        changes.setdefault(constant.joint, {})[field] = getattr(row, field) + float(in_file)
    rows = [
        row.model_copy(update=changes.get(joint, {})) for joint, row in enumerate(arm.description.dh.joints, start=1)
    ]
    return _with_rows(arm, rows)


def _with_rows(arm: Arm, rows: list[DHRow]) -> Arm:
    assert arm.description.dh is not None
    table = arm.description.dh.model_copy(update={"joints": tuple(rows)})
    return build_arm(arm.description.model_copy(update={"dh": table}))


def _with_placements(arm: Arm, constants: tuple[Constant, ...], values: Array) -> Arm:
    twists = np.zeros((arm.n_joints, 6))
    for constant, value in zip(constants, values, strict=True):
        twists[constant.joint - 1, TWIST_NAMES.index(constant.kind)] = value
    before = arm.before.copy()
    before[:, :3, 3] += np.einsum("nij,nj->ni", arm.before[:, :3, :3], twists[:, :3])
    before[:, :3, :3] = arm.before[:, :3, :3] @ turned_by(twists[:, 3:])
    return replace(arm, before=before)


def constant_columns(arm: Arm, frames: Chain, constants: tuple[Constant, ...]) -> Array:
    """(N, 3, P) displacement of the tool point by a unit of each constant, in base axes; m/m or m/rad.

    Exact for D-H rows at any values; for a URDF's placements exact at zero turns, and to their size beyond.

    Args:
        arm: the arm.
        frames: its frames at N poses.
        constants: P of its constants.

    Returns:
        (N, 3, P) m per m or rad, in base axes.
    """
    result = np.empty((len(frames.tool), 3, len(constants)))
    by_location: dict[str, list[tuple[int, Array]]] = {}
    for column, constant in enumerate(constants):
        location, twist = _twist(arm, constant)
        by_location.setdefault(location, []).append((column, twist))
    for location, members in by_location.items():
        twists = np.stack([twist for _, twist in members], axis=1)
        result[:, :, [column for column, _ in members]] = twist_jacobian(frames, location) @ twists
    return result


def turn_columns(arm: Arm, frames: Chain, constants: tuple[Constant, ...]) -> Array:
    """(N, 3, P) turn of the last frame by a unit of each constant, in base axes; rad/m (zero) or rad/rad.

    Args:
        arm: the arm.
        frames: its frames at N poses.
        constants: P of its constants.

    Returns:
        (N, 3, P) rad per m or rad, in base axes.
    """
    turns = np.empty((len(frames.tool), 3, len(constants)))
    for column, constant in enumerate(constants):
        location, twist = _twist(arm, constant)
        turns[:, :, column] = frames.frame(location)[0] @ twist[3:]
    return turns


def _twist(arm: Arm, constant: Constant) -> tuple[str, Array]:
    """Frame and twist (translation, rotation in its axes) that a unit of the constant is."""
    if arm.description.dh is not None:
        return row_twist(arm, constant.joint, constant.kind)
    return f"joint {constant.joint}", np.eye(6)[TWIST_NAMES.index(constant.kind)]


@dataclass(frozen=True, eq=False)
class State:
    """Values of everything that may be free."""

    rotations: Array  # (R, 3, 3) measurement frame from arm base, per base frame
    translations: Array  # (R, 3) measurement frame from arm base, per base frame
    tools: Array  # (K, 3) offsets in the last frame, m
    constants: Array  # (P,) added to the arm's constants, m and rad
    compliances: Array  # (m,) rad/(N m), angle += compliance * load
    tool_rotations: Array  # (K, 3, 3) last frame from measured tool frame; counts only where orientations are used

    def moved(self, step: Array) -> State:
        """A step in the order of `SetUp.names`; base steps are twists in the base's own axes."""
        n_bases, n_tools, n_constants = len(self.rotations), len(self.tools), len(self.constants)
        lengths = [6 * n_bases, 3 * n_tools, n_constants, len(self.compliances)]
        base, tools, constants, compliances, turns = np.split(step, np.cumsum(lengths))
        base = base.reshape(n_bases, 6)
        return State(
            rotations=self.rotations @ turned_by(base[:, 3:]),
            translations=self.translations + np.einsum("rij,rj->ri", self.rotations, base[:, :3]),
            tools=self.tools + tools.reshape(n_tools, 3),
            constants=self.constants + constants,
            compliances=self.compliances + compliances,
            tool_rotations=self.tool_rotations @ turned_by(turns.reshape(n_tools, 3)),
        )


@dataclass(frozen=True, eq=False)
class Posed:
    """An arm with a state's constants, its frames, and what is left of N rows: (N, 3) m, or (N, 6) with turns."""

    arm: Arm
    frames: Chain
    left: Array
