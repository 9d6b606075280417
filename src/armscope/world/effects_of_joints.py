"""What goes wrong in a joint and its drive, as concealed worlds build it (conventions: `armscope.world.effects`)."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.kinds import (
    ANGLE,
    APPROACH,
    COMPLIANCE,
    CONSTANT,
    LOAD,
    SPEED,
    TEMPERATURE,
    TIME,
    Kind,
    Parameter,
    Scene,
    Values,
    compliance_across,
    compliance_for,
    joints,
    moment,
    number,
    second_number,
)
from armscope.world.statics import Hidden

SOFT_SIDE = 0.001
"""Share of a joint's largest load within which a gap that gravity loads passes from one side to the other."""


def _turn_motor(hidden: Hidden, location: str, amount: Array | float) -> None:
    hidden.motor[:, number(location)] += amount


def _hide_cyclic(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    angle = scene.session.commanded[:, number(location)]
    _turn_motor(hidden, location, values["amplitude"] * np.cos(values["per_turn"] * angle - values["phase"]))


def _hide_backlash_by_load(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """The gap closes on the side gravity loads; around zero load it changes sides softly, as oil and friction do."""
    half = values["gap"] / 2
    # no steeper than gravity's torque changes across the gap, so that there is one equilibrium
    soft = max(SOFT_SIDE, values["gap"]) * scene.largest_torque(number(location))
    hidden.curves.append((number(location), lambda torque: half * min(max(torque / soft, -1.0), 1.0)))


def _hide_bearing(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    for axis in "xy":
        hidden.spring(f"tilt {number(location) + 1} {axis}", values["compliance"])


def _hide_wobble(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    joint = number(location)
    angle = scene.chain_angles()[:, joint]
    tilt = values["amplitude"] * np.cos(values["per_turn"] * angle - values["phase"])
    hidden.move(f"tilt {joint + 1} x", tilt * np.cos(values["direction"]))
    hidden.move(f"tilt {joint + 1} y", tilt * np.sin(values["direction"]))


def _compliance_at(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {"compliance": compliance_for(scene, scene.largest_torque(number(location)))}


def _couplings(description: RobotDescription) -> list[str]:
    """Each joint from the one before it, and the last from the one before that: cables and hollow wrists."""
    count = len(joints(description))
    return [f"joint {j} from joint {j - 1}" for j in range(2, count + 1)] + [f"joint {count} from joint {count - 2}"]


_CYCLIC = (
    Parameter("amplitude", "rad"),
    Parameter("phase", "rad", scales=False),
    Parameter("per_turn", "1/turn", scales=False),
)


def _phase(rng: np.random.Generator) -> float:
    return float(rng.uniform(-np.pi, np.pi))


JOINTS: tuple[Kind, ...] = (
    Kind(
        "joint_offset", "", CONSTANT, (Parameter("offset", "rad"),), (), joints,
        lambda rng, scene, place: {"offset": float(rng.choice([-1, 1]) * 1e-3)},
        lambda hidden, scene, place, values: _turn_motor(hidden, place, values["offset"]),
    ),
    Kind(
        "gear_ratio", "", ANGLE, (Parameter("ratio", "rad/rad"),), (), joints,
        lambda rng, scene, place: {"ratio": float(rng.choice([-1, 1]) * 1e-3)},
        lambda hidden, scene, place, values: _turn_motor(
            hidden, place, values["ratio"] * scene.session.commanded[:, number(place)]
        ),
    ),
    Kind(
        "gear_eccentricity", "", ANGLE, _CYCLIC, (), joints,
        lambda rng, scene, place: {"amplitude": 3e-4, "phase": _phase(rng), "per_turn": float(rng.integers(1, 3))},
        _hide_cyclic,
    ),
    Kind(
        "gear_mesh", "", ANGLE, _CYCLIC, (), joints,
        lambda rng, scene, place: {"amplitude": 3e-4, "phase": _phase(rng), "per_turn": float(rng.integers(5, 61))},
        _hide_cyclic,
    ),
    Kind(
        "backlash", "", APPROACH, (Parameter("gap", "rad"),), ("approach",), joints,
        lambda rng, scene, place: {"gap": 5e-4},
        lambda hidden, scene, place, values: _turn_motor(
            hidden, place, -scene.session.approach[:, number(place)] * values["gap"] / 2
        ),
    ),
    Kind(
        "backlash", "load", LOAD, (Parameter("gap", "rad"),), ("payload_kg",), joints,
        lambda rng, scene, place: {"gap": 5e-4}, _hide_backlash_by_load,
    ),
    Kind(
        "joint_compliance", "", LOAD, COMPLIANCE, ("payload_kg",), joints, _compliance_at,
        lambda hidden, scene, place, values: hidden.motor_spring(number(place), values["compliance"]),
    ),
    Kind("bearing_compliance", "", LOAD, COMPLIANCE, ("payload_kg",), joints, compliance_across, _hide_bearing,
         unloaded=True),
    Kind(
        "axis_wobble", "", ANGLE, (_CYCLIC[0], _CYCLIC[1], Parameter("direction", "rad", scales=False), _CYCLIC[2]), (),
        joints,
        lambda rng, scene, place: {
            "amplitude": 3e-4, "phase": _phase(rng), "direction": float(rng.uniform(0, np.pi)),
            "per_turn": float(rng.integers(1, 3)),
        },
        _hide_wobble,
    ),
    Kind(
        "servo_lag", "", SPEED, (Parameter("delay", "s"),), ("speed",), joints,
        lambda rng, scene, place: {"delay": 1e-3},
        lambda hidden, scene, place, values: _turn_motor(
            hidden, place, -scene.session.speed[:, number(place)] * values["delay"]
        ),
    ),
    Kind(
        "joint_coupling", "", ANGLE, (Parameter("coupling", "rad/rad"),), (), _couplings,
        lambda rng, scene, place: {"coupling": float(rng.choice([-1, 1]) * 5e-4)},
        lambda hidden, scene, place, values: _turn_motor(
            hidden, place, values["coupling"] * scene.session.commanded[:, second_number(place)]
        ),
    ),
    Kind(
        "zero_shift", "", TIME, (Parameter("jump", "rad"), Parameter("time", "s", scales=False)), ("time_s",), joints,
        lambda rng, scene, place: {"jump": float(rng.choice([-1, 1]) * 5e-4), "time": moment(rng, scene)},
        lambda hidden, scene, place, values: _turn_motor(
            hidden, place, np.where(scene.session.time > values["time"], values["jump"], 0.0)
        ),
    ),
    Kind(
        "compliance_change", "", TIME, (Parameter("give", "rad/(N m)"), Parameter("time", "s", scales=False)),
        ("payload_kg", "time_s"), joints,
        lambda rng, scene, place: {"give": _compliance_at(rng, scene, place)["compliance"], "time": moment(rng, scene)},
        lambda hidden, scene, place, values: _turn_motor(
            hidden, place,
            np.where(scene.session.time > values["time"], values["give"] * scene.torque[:, number(place)], 0.0),
        ),
    ),
    Kind(
        "compliance_change", "temperature", TEMPERATURE, (Parameter("give_per_k", "rad/(N m K)"),),
        ("payload_kg", "temperature_c"), joints,
        lambda rng, scene, place: {"give_per_k": 0.1 * _compliance_at(rng, scene, place)["compliance"]},
        lambda hidden, scene, place, values: _turn_motor(
            hidden, place, values["give_per_k"] * scene.torque[:, number(place)] * (scene.session.temperature - 20)
        ),
    ),
)  # fmt: skip
"""In the order of the catalogue."""
