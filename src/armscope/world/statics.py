"""Where the tool of a concealed arm stands: prescribed angles, gravity, springs and gaps in equilibrium.

The equilibrium is found row by row with a chord Newton iteration on MuJoCo's generalised forces: every spring freedom z
moves by (gravity + spring force) / stiffness until the largest step is below `STEP_RAD`. The matrix left out, gravity's
own stiffness, is 10^-4 to 10^-2 of the springs', so each step gains two to four digits and the balance is exact to
rounding; `Balance.residual` says how exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.world.layout import Geometry, Layout, segment_hinges
from armscope.world.mechanism import Mechanism

LoadCurve = Callable[[float], float]

STEP_RAD = 1e-12
MAX_STEPS = 200


@dataclass(frozen=True, eq=False)
class Session:
    """What was commanded and what went on around it, one entry per row (SI units, degrees Celsius)."""

    commanded: Array  # (N, m) motor angles, rad
    payload: Array  # (N,) stated payload at the tool point, kg
    time: Array  # (N,) s, increasing
    temperature: Array  # (N,) deg C
    run: NDArray[np.int64]  # (N,) number of the run, from 1
    approach: Array  # (N, m) -1 or +1: sign of each motor's last motion
    speed: Array  # (N, m) rad/s

    def __len__(self) -> int:
        return len(self.commanded)

    def rows(self, which: Indices) -> Session:
        """The session's rows ``which``, in that order."""
        return Session(*(getattr(self, name)[which] for name in self.__dataclass_fields__))


@dataclass(eq=False)
class Hidden:
    """Everything a world conceals in the rows of one session; effects add to it (see `armscope.world.conceal`)."""

    layout: Layout  # geometry errors, freedoms and springs
    motor: Array  # (N, m) angle beyond the commanded one, rad
    chain: Array  # (N, n) angle of the chain's joints beyond what the motors command, rad
    small: dict[str, Array] = field(default_factory=dict)  # small slides (m) and hinges (rad) by name, (N,) each
    # angle of a motor (0-based) as a function of gravity's torque on it, N m to rad
    curves: list[tuple[int, LoadCurve]] = field(default_factory=list)
    payload_mass: float = 0.0  # added to the stated payload, kg
    payload_share: float = 0.0  # added to the stated payload, as a share of it
    scale: float = 0.0  # the instrument's length is (1 + scale) times the true one

    @classmethod
    def nothing(cls, geometry: Geometry, session: Session) -> Hidden:
        """No effect at all."""
        layout = Layout(row_errors=np.zeros((geometry.n_joints, 4)))
        return cls(layout, np.zeros((len(session), geometry.n_motors)), np.zeros((len(session), geometry.n_joints)))

    def move(self, name: str, amount: Array) -> None:
        """Add to a small slide or hinge; it may also be a spring."""
        self.layout = replace(self.layout, freedoms=self.layout.freedoms | {name})
        self.small[name] = self.small.get(name, 0.0) + amount

    def spring(self, name: str, compliance: float) -> None:
        """Make a freedom give way, rad/(N m); several at one place add their compliances."""
        before = self.layout.stiffness.get(name)
        total = compliance + (1 / before if before else 0.0)
        self.layout = replace(
            self.layout, freedoms=self.layout.freedoms | {name}, stiffness={**self.layout.stiffness, name: 1 / total}
        )

    def motor_spring(self, motor: int, compliance: float) -> None:
        """Make a motor (0-based) give way, rad/(N m)."""
        before = self.layout.motor_stiffness.get(motor)
        total = compliance + (1 / before if before else 0.0)
        self.layout = replace(self.layout, motor_stiffness={**self.layout.motor_stiffness, motor: 1 / total})

    def bend(self, link: int, flexibility: float) -> None:
        """Make a link (0-based) bend with 1/(E I) in 1/(N m^2)."""
        before = self.layout.flexibility.get(link, 0.0)
        self.layout = replace(self.layout, flexibility={**self.layout.flexibility, link: before + flexibility})

    def misshape(self, row: int, errors: Array) -> None:
        """Add (a m, alpha rad, d m, theta rad) to a D-H row (0-based)."""
        rows = self.layout.row_errors.copy()
        rows[row] += errors
        self.layout = replace(self.layout, row_errors=rows)


@dataclass(frozen=True, eq=False)
class Balance:
    """The arm in equilibrium at every row."""

    tool: Array  # (N, 3) tool point in the base frame, m, by the instrument's scale
    motor_torque: Array  # (N, m) gravity's torque on each motor there, N m
    residual: float  # largest force left over on a spring, as a share of the largest load on any spring
    tool_turn: Array  # (N, 3, 3) orientation of the tool in the base frame


def balance(geometry: Geometry, session: Session, hidden: Hidden) -> Balance:
    """The equilibrium of a concealed arm at every row of a session.

    Args:
        geometry: the arm's true geometry.
        session: angles and context of N rows.
        hidden: concealed springs, clearances and scale.

    Returns:
        Tool points (N, 3), m, orientations, motor torques (N, m), N m, and the largest force left over, as a share.

    Raises:
        RuntimeError: the springs are too weak to carry the arm.
    """
    mechanism = Mechanism(geometry, hidden.layout)
    start = _prescribed(mechanism, session, hidden)
    springs = _Springs(mechanism)
    tool, turn = np.empty((len(session), 3)), np.empty((len(session), 3, 3))
    torque = np.zeros((len(session), geometry.n_motors))
    residual = largest = 0.0
    needs_load = springs.count > 0 or bool(hidden.curves)
    payload = session.payload * (1 + hidden.payload_share) + hidden.payload_mass
    for row in mechanism.each_row(payload):
        if needs_load:
            torque[row], left, load = _settle(mechanism, start[row], springs, hidden.curves)
            residual, largest = max(residual, left), max(largest, load)
        else:
            mechanism.set_joints(start[row])
        tool[row], turn[row] = mechanism.tool(), mechanism.tool_turn()
    return Balance(tool * (1 + hidden.scale), torque, residual / largest if largest > 0 else 0.0, turn)


def _prescribed(mechanism: Mechanism, session: Session, hidden: Hidden) -> Array:
    """(N, freedoms) where every hinge and slide would stand if nothing gave way."""
    geometry = mechanism.geometry
    qpos = np.zeros((len(session), mechanism.n_freedoms))
    angles = (session.commanded + hidden.motor) @ geometry.actuation.T + hidden.chain
    qpos[:, mechanism.angle_columns()] = angles + mechanism.rows[:, 3]
    for name, amount in hidden.small.items():
        qpos[:, mechanism.index[name]] = amount
    return qpos


class _Springs:
    """The freedoms that give way: ``qpos = prescribed + spread @ z`` with stiffness per z, N m/rad."""

    def __init__(self, mechanism: Mechanism) -> None:
        layout, geometry = mechanism.layout, mechanism.geometry
        columns, stiffness = [], []
        for motor, value in layout.motor_stiffness.items():
            column = np.zeros(mechanism.n_freedoms)
            for j in np.flatnonzero(geometry.actuation[:, motor]):
                column[mechanism.index[f"give {j + 1}"]] = geometry.actuation[j, motor]
            columns.append(column)
            stiffness.append(value)
        hinges = dict(layout.stiffness)
        for link in layout.flexibility:
            for name in segment_hinges(link):
                hinges[name] = float(mechanism.model.joint(name).stiffness[0])
        for name, value in hinges.items():
            columns.append(np.eye(mechanism.n_freedoms)[mechanism.index[name]])
            stiffness.append(value)
        self.count = len(columns)
        self.spread = np.array(columns).T if columns else np.zeros((mechanism.n_freedoms, 0))
        self.stiffness = np.array(stiffness)


def _settle(
    mechanism: Mechanism, prescribed: Array, springs: _Springs, curves: list[tuple[int, LoadCurve]]
) -> tuple[Array, float, float]:
    """Motor torques, largest force left over and largest load on a spring; leaves the arm standing in equilibrium."""
    angles = mechanism.angle_columns()
    actuation = mechanism.geometry.actuation
    z, turned = np.zeros(springs.count), np.zeros(actuation.shape[1])
    # MuJoCo's springs rest at zero, these where their freedom is prescribed to stand
    rest = springs.stiffness * (springs.spread.T @ prescribed)
    for _ in range(MAX_STEPS):
        qpos = prescribed + springs.spread @ z
        qpos[angles] += actuation @ turned
        gravity, elastic = mechanism.load(qpos)
        torque = actuation.T @ gravity[angles]
        force = springs.spread.T @ (gravity + elastic) + rest
        step = force / springs.stiffness if springs.count else force
        now = np.zeros_like(turned)
        for motor, curve in curves:
            now[motor] += curve(float(torque[motor]))
        largest_step = max(np.abs(step).max(initial=0.0), np.abs(now - turned).max())
        if largest_step < STEP_RAD:
            load = np.abs(springs.spread.T @ gravity).max(initial=0.0)
            return torque, float(np.abs(force).max(initial=0.0)), float(load)
        z, turned = z + step, now
    raise RuntimeError("the arm finds no equilibrium: its springs are too weak for its weight")
