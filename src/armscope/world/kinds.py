"""What a kind of concealed effect is: where it can sit, which numbers it has, how it is built into the mechanism."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array, Indices
from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry
from armscope.world.statics import Hidden, Session

Values = Mapping[str, float]
LEAST_TORQUE = 0.02  # Share of the arm's largest torque below which a joint counts as unloaded

ANGLE, LOAD, APPROACH = "joint angle", "gravity load", "side of approach"
TEMPERATURE, TIME, PAYLOAD, SPEED, CONSTANT = "temperature", "time", "payload", "speed", "constant"


@dataclass(frozen=True, eq=False)
class Scene:
    """The nominal arm in a session, before anything is concealed."""

    description: RobotDescription
    geometry: Geometry
    session: Session
    torque: Array  # (N, m) gravity's torque on each motor of the rigid arm, N m
    torque_scale: Array  # (m,) its largest size in the whole session, N m
    tool_turn: Array  # (N, 3, 3) orientation of the last frame in the base frame

    def chain_angles(self) -> Array:
        """(N, n) commanded angles of the chain's joints, rad."""
        return self.session.commanded @ self.geometry.actuation.T

    def largest_torque(self, motor: int) -> float:
        """Largest gravity torque on a motor (0-based) in the session, N m."""
        return float(self.torque_scale[motor])

    def loads(self, motor: int) -> bool:
        """Whether gravity turns a motor (0-based) by more than a trace."""
        return bool(self.torque_scale[motor] > LEAST_TORQUE * self.torque_scale.max())

    def rows(self, which: Indices) -> Scene:
        """The scene's rows ``which``; the torque scale stays that of the whole session."""
        return replace(
            self, session=self.session.rows(which), torque=self.torque[which], tool_turn=self.tool_turn[which]
        )


@dataclass(frozen=True)
class Parameter:
    """A number of an effect, in the unit that truth.yaml states."""

    # name, unit: as in truth.yaml
    name: str
    unit: str
    si: float = 1.0  # what one unit is in SI (mm: 1e-3)
    scales: bool = True  # whether the effect's size is proportional to it


Draw = Callable[[np.random.Generator, Scene, str], dict[str, float]]
Hide = Callable[[Hidden, Scene, str, Values], None]


@dataclass(frozen=True)
class Kind:
    """A kind of effect."""

    effect: str  # its name in the vocabulary; `unknown` outside the library
    variant: str  # tells kinds of one name apart ("" if there is one only)
    driver: str
    parameters: tuple[Parameter, ...]  # its numbers, in order
    needs: tuple[str, ...]  # columns of recordings.csv without which nobody can see what drives it
    places: Callable[[RobotDescription], list[str]]  # where in an arm it can sit
    draw: Draw  # its numbers at some natural size, in SI units, at random
    hide: Hide  # builds it into a mechanism, numbers in SI units
    sentence: str = ""  # what it is, for whoever opens the seal
    unloaded: bool = False  # an effect of load that is there whether or not gravity turns the joint's motor
    arm: str = ""  # the only one of the proof's arms that has such a place; "" where all have one

    @property
    def name(self) -> str:
        """Effect and variant, the key in the catalogue."""
        return f"{self.effect}/{self.variant}" if self.variant else self.effect

    @property
    def outside(self) -> bool:
        """Whether no effect of the library is this one."""
        return self.effect == "unknown"


@dataclass(frozen=True)
class Concealed:
    """One effect at one place with its numbers (SI units)."""

    kind: Kind
    location: str
    values: Values

    def scaled(self, factor: float) -> Concealed:
        """The same effect, ``factor`` times as large."""
        scaling = {parameter.name for parameter in self.kind.parameters if parameter.scales}
        values = {name: value * factor if name in scaling else value for name, value in self.values.items()}
        return Concealed(self.kind, self.location, values)

    def hide(self, hidden: Hidden, scene: Scene) -> None:
        """Build it into ``hidden``."""
        self.kind.hide(hidden, scene, self.location, self.values)

    def stated(self) -> list[dict[str, object]]:
        """Its numbers as truth.yaml lists them."""
        return [
            {"name": p.name, "unit": p.unit, "value": float(f"{self.values[p.name] / p.si:.6g}")}
            for p in self.kind.parameters
            if p.name in self.values
        ]


def number(location: str) -> int:
    """0-based number of the joint or link that a location names first."""
    return Location.of(location).index


def second_number(location: str) -> int:
    """0-based number of the joint that drives a coupling."""
    return Location.of(location).source - 1


def joints(description: RobotDescription) -> list[str]:
    """Every joint (as many motors as chain joints in all arms here)."""
    assert description.dh is not None
    return [f"joint {j + 1}" for j in range(len(description.dh.joints))]


def links(description: RobotDescription) -> list[str]:
    """The link behind every joint."""
    return [place.replace("joint", "link") for place in joints(description)]


def links_longer_than(metres: float) -> Callable[[RobotDescription], list[str]]:
    """The D-H rows whose straight length exceeds ``metres``."""

    def places(description: RobotDescription) -> list[str]:
        assert description.dh is not None
        rows = enumerate(description.dh.joints, start=1)
        return [f"link {j}" for j, row in rows if np.hypot(row.a_mm, row.d_mm) > metres * 1e3]

    return places


def only(place: str) -> Callable[[RobotDescription], list[str]]:
    """One place that every arm has."""
    return lambda description: [place]


def moment(rng: np.random.Generator, scene: Scene) -> float:
    """A time (s) between two rows, in the middle half of the session."""
    time = scene.session.time
    row = int(rng.integers(len(time) // 4, 3 * len(time) // 4))
    return float((time[row] + time[row + 1]) / 2)


def compliance_for(scene: Scene, torque: float) -> float:
    """A compliance by which ``torque`` turns half a milliradian."""
    return 5e-4 / max(torque, 1e-3)


def compliance_across(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    """A compliance that the arm's largest torque turns by half a milliradian.

    Args:
        rng: not asked.
        scene: the arm in its session.
        location: not asked.

    Returns:
        It by its name, rad/(N m).
    """
    return {"compliance": compliance_for(scene, float(np.abs(scene.torque).max()))}


COMPLIANCE = (Parameter("compliance", "rad/(N m)"),)
