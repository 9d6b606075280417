"""robot.yaml: the typed description of an arm, in the units its file states (mm, degrees, kg)."""

from __future__ import annotations

import re
from typing import Annotated, Literal, Self

import numpy as np
import pydantic
from pydantic import AfterValidator, Field

from armscope.core.inputs import Strict
from armscope.core.types import Array
from armscope.robot.constants import ARMS

Vector = Annotated[tuple[float, float, float], Field(description="x, y, z")]
Degrees = Annotated[float, Field(ge=-ARMS.degrees, le=ARMS.degrees)]
Millimetres = Annotated[float, Field(ge=-ARMS.longest_mm, le=ARMS.longest_mm)]
Length = Annotated[float, Field(gt=0, le=ARMS.longest_mm)]
Point = tuple[Millimetres, Millimetres, Millimetres]


Inertia = Annotated[float, Field(ge=-ARMS.most_inertia_kg_m2, le=ARMS.most_inertia_kg_m2)]
Ratio = Annotated[float, Field(ge=-ARMS.largest_ratio, le=ARMS.largest_ratio)]


def _on_earth(gravity: tuple[float, float, float]) -> tuple[float, float, float]:
    size = sum(value * value for value in gravity) ** 0.5
    if size > ARMS.strongest_gravity:
        raise ValueError(f"gravity is 9.81 m/s2 on Earth, at most {ARMS.strongest_gravity:g} anywhere, not {size:.4g}")
    return gravity


class DHRow(Strict):
    """One row of a Denavit-Hartenberg table; ``theta_offset_deg`` is added to the joint's angle.

    ``beta_deg`` turns about y after alpha (and a): the small angle that a calibrated arm needs between nearly parallel
    axes, for which D-H rows alone are ill-defined (Hayati & Mirmirani 1985).
    """

    a_mm: Millimetres = Field(description="length along x, mm")
    alpha_deg: Degrees = Field(description="turn about x, degrees")
    d_mm: Millimetres = Field(description="length along the joint's axis z, mm")
    theta_offset_deg: Degrees = Field(default=0.0, description="added to the joint's angle, degrees")
    beta_deg: Degrees = Field(default=0.0, description="turn about y behind alpha, degrees; 0 in data sheets")


class DH(Strict):
    """Denavit-Hartenberg table: ``standard`` (a_j, alpha_j behind joint j) or ``modified`` (Craig: before it)."""

    convention: Literal["standard", "modified"] = Field(
        default="standard",
        description="standard: Rz(theta) Tz(d) Tx(a) Rx(alpha); modified: Rx(alpha) Tx(a) Rz(theta) Tz(d)",
    )
    joints: tuple[DHRow, ...] = Field(
        min_length=1, max_length=ARMS.most_joints, description="one row per joint of the chain, from the base"
    )


def no_inertia_of_a_body(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> str:
    """Why no body has this inertia.

    Args:
        xx: about x through the centre of mass, kg m2, and so on
        yy: about y,
        zz: about z,
        xy: of x and y,
        xz: of x and z,
        yz: of y and z.

    Returns:
        The rule that it breaks; "" where it breaks none beyond rounding. That of a point, all zeros, breaks none.
    """
    least, middle, most = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if least >= -ARMS.rounded_away * most and least + middle >= most * (1 - ARMS.rounded):
        return ""
    return f"no body has principal inertias {least:.4g}, {middle:.4g}, {most:.4g}: none < 0, none above the others' sum"


class LinkMass(Strict):
    """Mass and centre of mass in the link's D-H frame (for ``tool_load``: in the last frame).

    ``inertia_kg_m2``: (xx, yy, zz, xy, xz, yz) about the centre of mass, axes of the same frame; without it the mass
    is a point, which is all that statics needs.
    """

    mass_kg: float = Field(ge=0, le=ARMS.heaviest_kg, description="kg")
    com_mm: Point = Field(
        description="centre of mass x, y, z in the row's D-H frame: behind the joint, turning with it; mm"
    )
    inertia_kg_m2: tuple[Inertia, Inertia, Inertia, Inertia, Inertia, Inertia] | None = Field(
        default=None, description="xx, yy, zz, xy, xz, yz about the centre of mass, axes of the same frame, kg m2"
    )

    @pydantic.field_validator("inertia_kg_m2")
    @classmethod
    def _of_a_body(cls, value: tuple[float, ...] | None) -> tuple[float, ...] | None:
        if value is not None:
            said = no_inertia_of_a_body(*value)
            if said:
                raise ValueError(said)
        return value


class Drive(Strict):
    """What a motor adds to the arm's dynamics, at the joint's side; what is not stated is not known.

    Stated friction is coulomb sign(dq) + viscous dq. ``gain_nm_per_a`` turns a recorded current into torque;
    ``gain_uncertainty`` is its relative standard deviation (0: exact; absent: the gain is free). The limits on speed,
    acceleration and torque bound the motions that `armscope excite` asks for.
    """

    rotor_inertia_kg_m2: float | None = Field(default=None, ge=0, description="rotor times gear squared, kg m2")
    coulomb_nm: float | None = Field(default=None, ge=0, description="friction that has the sign of the speed, N m")
    viscous_nm_s_rad: float | None = Field(default=None, ge=0, description="friction along with speed, N m s/rad")
    gain_nm_per_a: float | None = Field(default=None, description="torque per recorded current, N m/A")
    gain_uncertainty: float | None = Field(
        default=None, ge=0, description="relative standard deviation of the gain; 0: exact; absent: free"
    )
    speed_deg_s: float | None = Field(default=None, gt=0, description="largest speed of a commanded motion, degrees/s")
    acceleration_deg_s2: float | None = Field(default=None, gt=0, description="largest acceleration, degrees/s2")
    torque_nm: float | None = Field(default=None, gt=0, description="largest torque, N m")


class Instrument(Strict):
    """1-sigma per axis of the instrument and the robot's repeatability together."""

    sigma_mm: float = Field(ge=ARMS.finest_mm, le=ARMS.coarsest_mm, description="1-sigma per axis, mm")


class Parallelogram(Strict):
    """Five-bar linkage between the upper arm and the forearm: the crank turns with motor 3, a rod turns the forearm.

    Nominally the crank equals the rocker and the rod equals the upper arm, and the forearm follows motor 3 exactly.
    ``crank_angle_deg`` is the angle from the forearm's x axis (D-H frame 3) to the crank.
    """

    crank_mm: Length = Field(description="turned by motor 3, mm")
    rocker_mm: Length = Field(description="fixed to the forearm, mm")
    rod_mm: Length = Field(description="between crank and rocker, mm")
    upper_arm_mm: Length = Field(description="between axes 2 and 3, mm")
    crank_angle_deg: Degrees = Field(default=0.0, description="from the forearm's x axis to the crank, degrees")


class RobotDescription(Strict):
    """An arm as robot.yaml describes it: D-H rows or a URDF, what moves it, what it weighs."""

    name: str = Field(description="what reports call the arm")
    dh: DH | None = Field(default=None, description="D-H rows; or `urdf`, one of the two")
    urdf: str | None = Field(default=None, description="path of a URDF, relative to this file; meshes are not needed")
    tip: str | None = Field(default=None, description="with `urdf`: the frame that carries the tool")
    hold_joints: dict[str, float] = Field(
        default_factory=dict, description="with `urdf`: joints of the chain that stood still, and where (rad; m)"
    )
    actuation: tuple[dict[str, Ratio], ...] | None = Field(
        default=None,
        description="one row per joint of the chain: its angle is the sum of number x motor angle; else motor j's",
    )
    tool_mm: Point = Field(default=(0.0, 0.0, 0.0), description="tool point x, y, z in the last frame, mm")
    links: tuple[LinkMass, ...] | None = Field(
        default=None, description="with `dh`: one per row; without them loads are known up to unknown mass moments"
    )
    tool_load: LinkMass | None = Field(
        default=None, description="what the flange always carries; its centre of mass in the last frame"
    )
    drives: tuple[Drive, ...] | None = Field(
        default=None, description="one per motor; for arms in motion: what the drives add, and what they may do"
    )
    gravity_m_s2: Annotated[Vector, AfterValidator(_on_earth)] = Field(
        default=ARMS.gravity, description="in the base frame, m/s2: z up stands, z down hangs"
    )
    joint_limits_deg: tuple[tuple[Degrees, Degrees], ...] | None = Field(
        default=None, description="one [low, high] per motor, degrees; a URDF brings its own"
    )
    instrument: Instrument | None = Field(
        default=None, description="known noise; without it noise is learned from repeats and neighbours"
    )
    parallelogram: Parallelogram | None = Field(default=None, description="lengths of a five-bar linkage")
    source: dict[str, str] = Field(
        default_factory=dict, description="where the numbers come from, by place in this file"
    )

    @pydantic.field_validator("name", mode="before")
    @classmethod
    def _name_is_text(cls, value: object) -> object:
        return str(value) if isinstance(value, int | float) else value

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.dh is None) == (self.urdf is None):
            raise ValueError("an arm has either `dh` rows or a `urdf`, one of the two")
        if self.urdf is not None and self.tip is None:
            raise ValueError("`urdf` needs `tip`, the name of the frame that carries the tool")
        if self.urdf is not None and self.links is not None:
            raise ValueError("a URDF brings its own masses: leave out `links`")
        if self.urdf is not None and self.parallelogram is not None:
            raise ValueError("`parallelogram` needs `dh` rows: its angles count from their axes")
        if self.dh is None:
            return self
        n_joints = len(self.dh.joints)
        if self.tip is not None or self.hold_joints:
            raise ValueError("`tip` and `hold_joints` belong to a `urdf`, this arm has `dh` rows")
        if self.links is not None and len(self.links) != n_joints:
            raise ValueError(
                f"`links` needs one entry for each of the {n_joints} rows of `dh`, it has {len(self.links)}"
            )
        self.check_motors(n_joints, "rows of `dh`")
        return self

    def check_motors(self, n_joints: int, joints: str) -> None:
        """Whether what is said by motor fits the number of joints, which for a URDF only its file tells. Raises
        ValueError: it does not; ``joints`` is what the joints are called in the message."""
        if self.actuation is not None and len(self.actuation) != n_joints:
            raise ValueError(
                f"`actuation` needs one entry for each of the {n_joints} {joints}, it has {len(self.actuation)}"
            )
        for row, combination in enumerate(self.actuation or ()):
            for motor in combination:
                if not re.fullmatch(r"q[1-9]\d?", motor):
                    raise ValueError(f"`actuation[{row}]` names {motor!r}; motor angles are called q1, q2, ... q99")
        n_motors = self.n_motors(n_joints)
        turning = {motor for row in self.actuation or () for motor, coefficient in row.items() if coefficient != 0}
        if idle := [f"q{k + 1}" for k in range(n_motors) if self.actuation is not None and f"q{k + 1}" not in turning]:
            raise ValueError(f"`actuation` has motors up to q{n_motors}, but {', '.join(idle)} turns no joint")
        if self.drives is not None and len(self.drives) != n_motors:
            raise ValueError(f"`drives` needs one entry for each of the {n_motors} motors, it has {len(self.drives)}")
        if self.joint_limits_deg is not None:
            if len(self.joint_limits_deg) != n_motors:
                raise ValueError(
                    f"`joint_limits_deg` needs one pair for each of the {n_motors} motors, "
                    f"it has {len(self.joint_limits_deg)}"
                )
            for number, (low, high) in enumerate(self.joint_limits_deg):
                if low >= high:
                    raise ValueError(
                        f"`joint_limits_deg[{number}]` must be [low, high] with low < high, not [{low}, {high}]"
                    )

    def n_motors(self, n_joints: int) -> int:
        """Number of motor angles that move ``n_joints`` chain joints."""
        if self.actuation is None:
            return n_joints
        return max((int(motor[1:]) for row in self.actuation for motor in row), default=0)

    def actuation_matrix(self, n_joints: int) -> Array:
        """(n, m) positions of ``n_joints`` chain joints by motor positions."""
        if self.actuation is None:
            return np.eye(n_joints)
        matrix = np.zeros((n_joints, self.n_motors(n_joints)))
        for joint, combination in enumerate(self.actuation):
            for motor, coefficient in combination.items():
                matrix[joint, int(motor[1:]) - 1] = coefficient
        return matrix
