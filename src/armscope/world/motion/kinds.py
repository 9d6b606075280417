"""What moving worlds can conceal: each kind with its places, its numbers, and the physics that it changes.

A kind acts in one of four ways: on the mechanism (`changes`: masses, friction, springs that MuJoCo simulates), as a
torque beside it (`pulls`: laws of friction and curves that MuJoCo has no name for), on what is recorded
(`records`), or on where a link that has an encoder of its own lies beside its motor (`lies`). Signs: torque is the
motor's, positive along the joint's angle; friction that is positive resists.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.kinds import joints, links
from armscope.world.motion.mechanism import Coupling, Dynamics, Spring
from armscope.world.motion.session import COLD_C, GRID_HZ, Session
from armscope.world.motion.stage import Numbers, PlainArm, Stage, sign

UNKNOWN = "unknown"
Changes = Callable[[Dynamics, Location, Numbers], Dynamics]
Pulls = Callable[[Stage, int, Numbers], Array]
Records = Callable[[Session, Array, int, Numbers], Array]


@dataclass(frozen=True)
class Kind:
    """A cause that can be concealed."""

    effect: str  # its name in the vocabulary, `UNKNOWN` for what no library has
    places: Callable[[RobotDescription], list[str]]  # where it can stand on an arm
    # its numbers at unit size; those in `scaled` grow in proportion
    draw: Callable[[np.random.Generator, RobotDescription], dict[str, float]]
    units: Mapping[str, str]
    scaled: tuple[str, ...]  # names of the numbers that the size multiplies
    largest: Mapping[str, float]  # how far the scaled numbers may go before the thing would be absurd, by name
    # changes, pulls, records, lies: its physics, one of them; a drive that winds up pulls, too
    changes: Changes | None = None
    pulls: Pulls | None = None
    records: Records | None = None
    lies: Pulls | None = None
    driver: str = "speed"
    needs: tuple[str, ...] = ()  # columns of motions.csv without which nobody could see it
    stated: bool = False  # whether robot.yaml states what it departs from (ordinary friction is in every arm)
    shape: str = ""  # which of several kinds of one effect, and of those outside the library
    # (arm, joint from 0, its numbers) whether a body can be so; anything can where it is not given
    possible: Callable[[PlainArm, int, Numbers], bool] | None = None

    @property
    def outside(self) -> bool:
        """Whether no cause of the library is this one."""
        return self.effect == UNKNOWN

    @property
    def name(self) -> str:
        """As catalogues call it."""
        return f"{self.effect}/{self.shape}" if self.shape else self.effect


@dataclass(frozen=True)
class Concealed:
    """A kind at a place with its numbers."""

    kind: Kind
    location: str
    numbers: Numbers

    @property
    def joint(self) -> int:
        """(0-based) where it stands; 0 for base and payload."""
        return max(Location.of(self.location).index, 0)

    def sized(self, factor: float) -> Concealed:
        """With its scaled numbers multiplied."""
        grown = {name: value * factor for name, value in self.numbers.items() if name in self.kind.scaled}
        return replace(self, numbers={**self.numbers, **grown})

    @property
    def absurd(self) -> bool:
        """Whether a number is beyond what can be."""
        return any(abs(self.numbers[name]) > most for name, most in self.kind.largest.items())


def loaded_joints(description: RobotDescription) -> list[str]:
    """Joints that gravity loads; joint 1 of a standing arm is not."""
    standing = abs(description.gravity_m_s2[2]) > 0
    return joints(description)[1:4] if standing else joints(description)


def _wrist(description: RobotDescription) -> list[str]:
    count = len(joints(description))
    return [f"joint {count} from joint {count - 1}"] if count >= 6 else []


def _either(name: str, **fixed: float) -> Callable[[np.random.Generator, RobotDescription], dict[str, float]]:
    return lambda rng, _: {name: float(rng.choice([-1.0, 1.0])), **fixed}


def _more(name: str, **fixed: float) -> Callable[[np.random.Generator, RobotDescription], dict[str, float]]:
    return lambda rng, _: {name: 1.0, **fixed}


def _direction(*names: str) -> Callable[[np.random.Generator, RobotDescription], dict[str, float]]:
    def draw(rng: np.random.Generator, _: RobotDescription) -> dict[str, float]:
        values = rng.normal(size=len(names))
        return dict(zip(names, (values / np.linalg.norm(values)).tolist(), strict=True))

    return draw


def _added(array: str, name: str) -> Changes:
    return lambda dynamics, place, numbers: dynamics.changed(array, place.index, numbers[name])


def _heavier(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    """More of the same: the centre stays, the inertia about it grows with the mass."""
    by = numbers["mass"] / dynamics.mass[place.index]
    return dynamics.changed("mass", place.index, numbers["mass"]).changed(
        "inertia", place.index, by * dynamics.inertia[place.index]
    )


def _off_centre(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    moment = np.array([numbers["mx"], numbers["my"], numbers["mz"]])
    return dynamics.changed("centre", place.index, moment / dynamics.mass[place.index])


def _thicker(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    return dynamics.changed("inertia", place.index, np.array([numbers["inertia"]] * 3 + [0.0] * 3))


def _carries(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    return replace(dynamics, load=dynamics.load + numbers["mass"])


def _holds(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    """A gripper, as the cube that it is: beyond the tool point, with the inertia of its size."""
    return replace(
        dynamics,
        load=numbers["mass"],
        load_centre=np.array([0.0, 0.0, numbers["reach"]]),
        load_inertia=numbers["mass"] * numbers["side"] ** 2 / 6,
    )


def _some_gripper(rng: np.random.Generator, _: RobotDescription) -> dict[str, float]:
    return {"mass": 1.0, "reach": float(rng.uniform(0.03, 0.15)), "side": float(rng.uniform(0.05, 0.25))}


def _balanced(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    spring = Spring(place.index, numbers["stiffness"], numbers["rest"])
    return replace(dynamics, springs=(*dynamics.springs, spring))


def _coupled(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    rubs = {name: numbers.get(name, 0.0) for name in ("coulomb", "viscous", "inertia")}
    return replace(dynamics, couplings=(*dynamics.couplings, Coupling(place.index, place.source - 1, **rubs)))


def _tilted(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    """The base stands turned by small angles about x and y: gravity turns the other way in its axes."""
    turn = np.array([numbers["x"], numbers["y"], 0.0])
    return replace(dynamics, gravity=dynamics.gravity - np.cross(turn, dynamics.gravity))


def _cable(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """A harness that is bent more and more: a cubic of the angle, no torque in the middle."""
    angle = stage.session.angle[:, joint] - numbers["middle"]
    return numbers["torque"] * (0.4 * angle + angle**3)


def _ripple(stage: Stage, joint: int, numbers: Numbers) -> Array:
    turn = numbers["per_turn"] * stage.session.angle[:, joint] - numbers["phase"]
    return numbers["amplitude"] * np.cos(turn)


def _stribeck(stage: Stage, joint: int, numbers: Numbers) -> Array:
    slow = np.exp(-((stage.session.speed[:, joint] / numbers["speed"]) ** 2))
    return numbers["stribeck"] * slow * sign(stage.session, joint)


def _late(session: Session, torque: Array, joint: int, numbers: Numbers) -> Array:
    """Each run's torque, read some milliseconds ago."""
    found = np.array(torque)
    for run in session.runs():
        time = np.arange(run.stop - run.start) / GRID_HZ
        found[run, joint] = np.interp(time - numbers["delay"], time, torque[run, joint])
    return found


def _gain(session: Session, torque: Array, joint: int, numbers: Numbers) -> Array:
    found = np.array(torque)
    found[:, joint] *= 1 + numbers["gain"]
    return found


GRIPPER = Kind(
    "payload_error", lambda _: ["payload"], _some_gripper, {"mass": "kg", "reach": "m", "side": "m"}, ("mass",), {},
    changes=_holds, driver="load", shape="gripper",
)  # fmt: skip
"""A body that nobody stated: no point at the tool, and it resists being turned."""

FIXED_FRICTION = {"coulomb": "N m", "viscous": "N m s/rad"}
LIBRARY: tuple[Kind, ...] = (
    Kind("coulomb_friction", joints, _more("coulomb"), {"coulomb": "N m"}, ("coulomb",), {},
         changes=_added("coulomb", "coulomb"), stated=True),
    Kind("viscous_friction", joints, _more("viscous"), {"viscous": "N m s/rad"}, ("viscous",), {},
         changes=_added("viscous", "viscous"), stated=True),
    Kind("asymmetric_friction", joints, _either("viscous_difference"), {"viscous_difference": "N m s/rad"},
         ("viscous_difference",), {},
         pulls=lambda stage, j, x: x["viscous_difference"] * np.abs(stage.session.speed[:, j]),
         possible=PlainArm.resists_either_way),
    Kind("stribeck_friction", joints, _more("stribeck", speed=0.15), {"stribeck": "N m", "speed": "rad/s"},
         ("stribeck",), {}, pulls=_stribeck),
    Kind("load_friction", loaded_joints, _more("per_load"), {"per_load": ""}, ("per_load",), {"per_load": 0.3},
         pulls=lambda stage, j, x: x["per_load"] * np.abs(stage.load[:, j]) * sign(stage.session, j), driver="load"),
    Kind("thermal_friction", joints, lambda rng, _: {"per_kelvin": -1.0}, {"per_kelvin": "N m s/(rad K)"},
         ("per_kelvin",), {}, needs=("temperature_c",), driver="temperature",
         pulls=lambda stage, j, x: (
             x["per_kelvin"] * (stage.session.temperature - COLD_C) * stage.session.speed[:, j]),
         possible=PlainArm.resists_when_warm),
    Kind("rotor_inertia", joints, _more("inertia"), {"inertia": "kg m^2"}, ("inertia",), {},
         changes=_added("rotor", "inertia"), driver="acceleration", stated=True),
    Kind("torque_offset", joints, _either("offset"), {"offset": "N m"}, ("offset",), {},
         pulls=lambda stage, j, x: np.full(len(stage.session), x["offset"]), driver="constant"),
    Kind("motor_constant", joints, _either("gain"), {"gain": ""}, ("gain",), {"gain": 0.4}, records=_gain,
         driver="load"),
    Kind("torque_delay", joints, _more("delay"), {"delay": "s"}, ("delay",), {"delay": 0.05}, records=_late,
         driver="time"),
    Kind("joint_compliance", loaded_joints, _more("compliance"), {"compliance": "rad/(N m)"}, ("compliance",), {},
         pulls=Stage.behind_its_drive, driver="load", possible=PlainArm.holds_its_link),
    Kind("link_mass", links, _either("mass"), {"mass": "kg"}, ("mass",), {}, changes=_heavier, driver="load",
         possible=PlainArm.mass_may_be),
    Kind("link_first_moment", links, _direction("mx", "my", "mz"), dict.fromkeys(("mx", "my", "mz"), "kg m"),
         ("mx", "my", "mz"), {}, changes=_off_centre, driver="load", possible=PlainArm.centre_may_be),
    Kind("link_inertia", links, _more("inertia"), {"inertia": "kg m^2"}, ("inertia",), {}, changes=_thicker,
         driver="acceleration"),
    Kind("payload_error", lambda _: ["payload"], _more("mass"), {"mass": "kg"}, ("mass",), {}, changes=_carries,
         driver="load"),
    Kind("gravity_balance", loaded_joints, lambda rng, _: {"stiffness": 1.0, "rest": float(rng.uniform(-0.5, 0.5))},
         {"stiffness": "N m/rad", "rest": "rad"}, ("stiffness",), {}, changes=_balanced, driver="joint angle"),
    Kind("cable_torque", joints, lambda rng, _: {"torque": 1.0, "middle": float(rng.uniform(-0.3, 0.3))},
         {"torque": "N m/rad^3", "middle": "rad"}, ("torque",), {}, pulls=_cable, driver="joint angle"),
    Kind("torque_ripple", joints,
         lambda rng, _: {"amplitude": 1.0, "per_turn": float(rng.integers(3, 25)), "phase": float(rng.uniform(-3, 3))},
         {"amplitude": "N m", "per_turn": "", "phase": "rad"}, ("amplitude",), {}, pulls=_ripple,
         driver="joint angle"),
    Kind("coupled_friction", _wrist, lambda rng, _: {"coulomb": 1.0, "viscous": 0.7}, FIXED_FRICTION,
         ("coulomb", "viscous"), {}, changes=_coupled),
    Kind("coupled_inertia", _wrist, _more("inertia"), {"inertia": "kg m^2"}, ("inertia",), {}, changes=_coupled,
         driver="acceleration"),
    Kind("gravity_direction", lambda arm: ["base"] if abs(arm.gravity_m_s2[2]) else [], _direction("x", "y"),
         {"x": "rad", "y": "rad"}, ("x", "y"), {"x": 0.3, "y": 0.3}, changes=_tilted, driver="load"),
)  # fmt: skip
