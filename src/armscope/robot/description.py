"""robot.yaml: the typed description of an arm, in the units its file states (mm, degrees, kg)."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Literal, Self

import numpy as np
import pydantic
from pydantic import AfterValidator, Field

from armscope.core.inputs import InputError, Strict, load

Vector = Annotated[tuple[float, float, float], Field(description="x, y, z")]
Degrees = Annotated[float, Field(ge=-720, le=720)]
Millimetres = Annotated[float, Field(ge=-20_000, le=20_000)]
Length = Annotated[float, Field(gt=0, le=20_000)]
Point = tuple[Millimetres, Millimetres, Millimetres]

HEAVIEST_KG = 20_000.0
"""The heaviest robot arm that is sold weighs 11,000 kg and carries 2,300 kg (FANUC M-2000iA/2300, data sheet)."""
STRONGEST_GRAVITY = 12.0
"""m/s2; on Earth 9.76 to 9.84 (International Gravity Formula 1980 and altitude); less on the Moon, none in orbit."""
COARSEST_MM = 100.0
"""1-sigma per axis: what is coarser than 0.1 m measures no arm (indoor radio positioning is that coarse)."""
LARGEST_RATIO = 1000.0
"""Of an actuation: gears of arms reduce by 30 to 320 (harmonic and cycloidal drives, makers' catalogues)."""
ROUNDED = 1e-3
"""Inertias in files are rounded: the sum of two principal ones may fall short of the third by this share."""

Ratio = Annotated[float, Field(ge=-LARGEST_RATIO, le=LARGEST_RATIO)]


def _on_earth(gravity: tuple[float, float, float]) -> tuple[float, float, float]:
    size = sum(value * value for value in gravity) ** 0.5
    if size > STRONGEST_GRAVITY:
        raise ValueError(f"gravity is 9.81 m/s2 on Earth, at most {STRONGEST_GRAVITY:g} anywhere, not {size:.4g}")
    return gravity


class DHRow(Strict):
    """One row of a Denavit-Hartenberg table; ``theta_offset_deg`` is added to the joint's angle.

    ``beta_deg`` turns about y after alpha (and a): the small angle that a calibrated arm needs between nearly parallel
    axes, for which D-H rows alone are ill-defined (Hayati & Mirmirani 1985).
    """

    a_mm: Millimetres
    alpha_deg: Degrees
    d_mm: Millimetres
    theta_offset_deg: Degrees = 0.0
    beta_deg: Degrees = 0.0


class DH(Strict):
    """Denavit-Hartenberg table: ``standard`` (a_j, alpha_j behind joint j) or ``modified`` (Craig: before it)."""

    convention: Literal["standard", "modified"] = "standard"
    joints: tuple[DHRow, ...] = Field(min_length=1)


class LinkMass(Strict):
    """Mass and centre of mass in the link's D-H frame (for ``tool_load``: in the last frame).

    ``inertia_kg_m2``: (xx, yy, zz, xy, xz, yz) about the centre of mass, axes of the same frame; without it the mass
    is a point, which is all that statics needs.
    """

    mass_kg: float = Field(ge=0, le=HEAVIEST_KG)
    com_mm: Point
    inertia_kg_m2: tuple[float, float, float, float, float, float] | None = None

    @pydantic.field_validator("inertia_kg_m2")
    @classmethod
    def _of_a_body(cls, value: tuple[float, ...] | None) -> tuple[float, ...] | None:
        if value is not None:
            xx, yy, zz, xy, xz, yz = value
            least, middle, most = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            if least < 0 or least + middle < most * (1 - ROUNDED):
                principal = f"{least:.4g}, {middle:.4g}, {most:.4g}"
                raise ValueError(f"no body has principal inertias {principal}: none < 0, none above the others' sum")
        return value


class Drive(Strict):
    """What a motor adds to the arm's dynamics, at the joint's side; what is not stated is not known.

    Stated friction is coulomb sign(dq) + viscous dq. ``gain_nm_per_a`` turns a recorded current into torque;
    ``gain_uncertainty`` is its relative standard deviation (0: exact; absent: the gain is free). The limits on speed,
    acceleration and torque bound the motions that `armscope excite` asks for.
    """

    rotor_inertia_kg_m2: float | None = Field(default=None, ge=0)
    coulomb_nm: float | None = Field(default=None, ge=0)
    viscous_nm_s_rad: float | None = Field(default=None, ge=0)
    gain_nm_per_a: float | None = None
    gain_uncertainty: float | None = Field(default=None, ge=0)
    speed_deg_s: float | None = Field(default=None, gt=0)
    acceleration_deg_s2: float | None = Field(default=None, gt=0)
    torque_nm: float | None = Field(default=None, gt=0)


class Instrument(Strict):
    """1-sigma per axis of the instrument and the robot's repeatability together."""

    sigma_mm: float = Field(gt=0, le=COARSEST_MM)


class Parallelogram(Strict):
    """Five-bar linkage between the upper arm and the forearm: the crank turns with motor 3, a rod turns the forearm.

    Nominally the crank equals the rocker and the rod equals the upper arm, and the forearm follows motor 3 exactly.
    ``crank_angle_deg`` is the angle from the forearm's x axis (D-H frame 3) to the crank.
    """

    crank_mm: Length
    rocker_mm: Length
    rod_mm: Length
    upper_arm_mm: Length
    crank_angle_deg: Degrees = 0.0


class RobotDescription(Strict):
    """An arm as robot.yaml describes it: D-H rows or a URDF, what moves it, what it weighs."""

    name: str
    dh: DH | None = None
    urdf: str | None = None
    tip: str | None = None
    hold_joints: dict[str, float] = Field(default_factory=dict)
    actuation: tuple[dict[str, Ratio], ...] | None = None
    tool_mm: Point = (0.0, 0.0, 0.0)
    links: tuple[LinkMass, ...] | None = None
    tool_load: LinkMass | None = None
    drives: tuple[Drive, ...] | None = None
    gravity_m_s2: Annotated[Vector, AfterValidator(_on_earth)] = (0.0, 0.0, -9.81)
    joint_limits_deg: tuple[tuple[Degrees, Degrees], ...] | None = None
    instrument: Instrument | None = None
    parallelogram: Parallelogram | None = None
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
        """Whether what is said by motor fits the number of joints, which for a URDF only its file tells.

        Raises:
            ValueError: it does not; ``joints`` is what the joints are called in the message.
        """
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


def load_description(path: Path | str) -> RobotDescription:
    """Read robot.yaml.

    Raises:
        InputError: a key, value, unit or number of rows that can't be; it names the place and the rule.
    """
    description = load(RobotDescription, path)
    if description.urdf is not None:
        urdf = Path(path).parent / description.urdf
        if not urdf.is_file():
            raise InputError(path, "urdf", description.urdf, "the URDF must be a readable file", f"Looked for {urdf}.")
        # in full: a model.yaml that names it is read from other folders, too
        description = description.model_copy(update={"urdf": str(urdf.resolve())})
    return description
