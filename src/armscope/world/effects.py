"""The vocabulary's effects as concealed worlds build them: the contract's conventions, written down once.

Motor angle j is meant by "joint j", except where it says axis. q is the commanded angle, tau the motor's torque from
gravity (virtual work), T the temperature, t the time. Lengths hold at 20 C.

| effect | location | parameters (name, unit) | what is built |
|---|---|---|---|
| base_drift | base | x y z mm/h, rx ry rz rad/h | base slides and hinges move by rate x t, t from the session's zero |
| base_shift | base | x y z mm, rx ry rz rad, time s | base jumps at that time |
| base_compliance | base | compliance rad/(N m) | springs about base x and y |
| joint_offset | joint j | offset rad | angle + offset |
| gear_ratio | joint j | ratio rad/rad | angle + ratio q |
| gear_eccentricity | joint j | amplitude rad, phase rad, per_turn 1/turn | + amplitude cos(per_turn q - phase); 1, 2 |
| gear_mesh | joint j | amplitude rad, phase rad, per_turn 1/turn | the same, 5 to 60 |
| backlash | joint j | gap rad | - approach gap/2; variant load: + gap/2 to the side gravity loads |
| joint_compliance | joint j | compliance rad/(N m) | motor spring |
| bearing_compliance | joint j | compliance rad/(N m) | springs across axis j, two directions, at its D-H origin |
| axis_wobble | joint j | amplitude rad, phase rad, direction rad, per_turn 1/turn | tilt of axis j, see below |
| servo_lag | joint j | delay s | - speed x delay |
| joint_coupling | joint j from joint k | coupling rad/rad | angle j + coupling q_k |
| link_geometry | link j | alpha rad, a mm, d mm (a subset) | D-H row j is that much larger |
| link_bending | link j | flexibility 1/(N m^2) | 1/(E I) of a beam along D-H row j, in segments |
| thermal_expansion | link j | coefficient 1/K | a and d of row j grow by coefficient (T - 20) |
| parallelogram_geometry | parallelogram | rod mm, rocker mm | bars longer, loop closed by Newton's method |
| instrument_scale | instrument | scale m/m | measured = (1 + scale) true |
| payload_error | payload | mass kg; variant centre: com_x com_y com_z mm | added to what is stated |

axis_wobble tilts axis j, before it turns, by amplitude cos(per_turn theta - phase) about the fixed direction
(cos direction, sin direction, 0) of the frame that carries it; theta is the chain's angle.
link_bending: a beam of length L along e, loaded at its end by the force F and moment M of everything that hangs on D-H
frame j (its own mass included), turns there by L/(E I) (M + L/2 e x F) and moves by L^2/(2 E I) M x e + L^3/(3 E I) F,
the parts along e left out; bent by segments, so to 0.4 %.
Cyclic effects also list `linear`: cosine and sine parts, as in amplitude cos(per_turn q - phase) =
cosine cos(per_turn q) + sine sin(per_turn q); axis_wobble has them about x and about y.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.kinds import (
    ANGLE,
    APPROACH,
    CONSTANT,
    LOAD,
    PAYLOAD,
    SPEED,
    TEMPERATURE,
    TIME,
    Concealed,
    Kind,
    Parameter,
    Scene,
    Values,
    joints,
    links_longer_than,
    number,
    only,
    second_number,
)
from armscope.world.mechanism import BASE_FREEDOMS
from armscope.world.statics import Hidden

HOUR_S = 3600.0
REFERENCE_C = 20.0
SOFT_SIDE = 0.001
"""Share of a joint's largest load within which a gap that gravity loads passes from one side to the other."""


def twist_parameters(per: str = "", si: float = 1.0) -> tuple[Parameter, ...]:
    """Three translations in mm and three rotations in rad, each ``per`` something."""
    return tuple(
        Parameter(name, ("rad" if name.startswith("r") else "mm") + per, (1.0 if name.startswith("r") else 1e-3) * si)
        for name in ("x", "y", "z", "rx", "ry", "rz")
    )


def _draw_twist(rng: np.random.Generator) -> dict[str, float]:
    """Millimetres and milliradians about a place a metre or two away: both matter at the tool."""
    size = np.array([1e-3] * 3 + [0.5e-3] * 3)
    return dict(zip(("x", "y", "z", "rx", "ry", "rz"), (rng.normal(0, 1, 6) * size).tolist(), strict=True))


def _move_base(hidden: Hidden, values: Values, progress: Array) -> None:
    for freedom in BASE_FREEDOMS:
        hidden.move(freedom, values[freedom.split()[1]] * progress)


def _hide_drift(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    _move_base(hidden, values, scene.session.time)


def _draw_drift(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {name: value / HOUR_S for name, value in _draw_twist(rng).items()}


def _draw_shift(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    """The jump falls between two rows, in the middle half of the session."""
    time = scene.session.time
    row = int(rng.integers(len(time) // 4, 3 * len(time) // 4))
    return {**_draw_twist(rng), "time": float((time[row] + time[row + 1]) / 2)}


def _hide_shift(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    _move_base(hidden, values, (scene.session.time > values["time"]).astype(float))


def _hide_base_compliance(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    for freedom in ("base rx", "base ry"):
        hidden.spring(freedom, values["compliance"])


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


def _hide_link_geometry(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    errors = [values.get("a", 0.0), values.get("alpha", 0.0), values.get("d", 0.0), 0.0]
    hidden.misshape(number(location), np.array(errors))


def linear_numbers(effect: Concealed) -> dict[str, float]:
    """Cosine and sine parts, rad, of an effect with a phase; nothing for the others."""
    values = effect.values
    if "phase" not in values:
        return {}
    order = f"{values['per_turn']:.0f}"
    cosine, sine = values["amplitude"] * np.cos(values["phase"]), values["amplitude"] * np.sin(values["phase"])
    if "direction" not in values:
        return {f"cosine_{order}": float(cosine), f"sine_{order}": float(sine)}
    x, y = np.cos(values["direction"]), np.sin(values["direction"])
    return {
        "cosine_rx": float(cosine * x),
        "sine_rx": float(sine * x),
        "cosine_ry": float(cosine * y),
        "sine_ry": float(sine * y),
    }


def _draw_link_geometry(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    """All three numbers, of tolerance proportions: a millimetre goes with a milliradian."""
    return {name: float(rng.normal(0, 1) * 1e-3) for name in ("alpha", "a", "d")}


def _hide_thermal(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    link = number(location)
    rows = scene.geometry.rows
    along_a, along_d = scene.geometry.lengthening(link, rows)
    growth = rows[link, 0] * along_a + rows[link, 2] * along_d
    warmer = values["coefficient"] * (scene.session.temperature - REFERENCE_C)
    for axis, amount in zip("xyz", growth, strict=True):
        if amount != 0:
            hidden.move(f"shift {link + 1} {axis}", amount * warmer)


def _hide_linkage(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    linkage = scene.description.parallelogram
    assert linkage is not None
    elbow = scene.chain_angles()[:, 2] + scene.geometry.rows[2, 3]
    crank = elbow + np.radians(linkage.crank_angle_deg)
    rocker = close_loop(
        crank,
        linkage.crank_mm * 1e-3,
        linkage.rod_mm * 1e-3 + values["rod"],
        linkage.rocker_mm * 1e-3 + values["rocker"],
        linkage.upper_arm_mm * 1e-3,
    )
    hidden.chain[:, 2] += rocker - crank


def close_loop(crank_angle: Array, crank: float, rod: float, rocker: float, upper_arm: float) -> Array:
    """(N,) angle of the rocker, rad, from the upper arm's direction; crank and rocker point alike, lengths in m.

    Newton's method on |upper arm + rocker - crank| = rod, started from the ideal parallelogram.

    Args:
        crank_angle: (N,) rad, from the upper arm's direction.
        crank, rod, rocker, upper_arm: lengths of the bars, m.

    Returns:
        (N,) rad.

    Raises:
        RuntimeError: bars of these lengths don't meet.
    """
    angle = np.array(crank_angle, dtype=float)
    for _ in range(50):
        gap = upper_arm + rocker * np.exp(1j * angle) - crank * np.exp(1j * crank_angle)
        slope = np.real(np.conj(gap) * 1j * rocker * np.exp(1j * angle)) / np.abs(gap)
        step = (np.abs(gap) - rod) / slope
        angle -= step
        if np.abs(step).max() < 1e-14:
            return angle
    raise RuntimeError("the parallelogram's bars can't be joined")


def _hide_scale(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.scale += values["scale"]


def _hide_payload_mass(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.payload_mass += values["mass"]


def _hide_payload_centre(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    centre = np.array([values["com_x"], values["com_y"], values["com_z"]])
    hidden.layout = replace(hidden.layout, payload_offset=hidden.layout.payload_offset + centre)


def _compliance(scene: Scene, torque: float) -> float:
    """A compliance by which ``torque`` turns half a milliradian."""
    return 5e-4 / max(torque, 1e-3)


def _compliance_at(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {"compliance": _compliance(scene, scene.largest_torque(number(location)))}


def _compliance_across(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {"compliance": _compliance(scene, float(np.abs(scene.torque).max()))}


def _couplings(description: RobotDescription) -> list[str]:
    """Each joint from the one before it, and the last from the one before that: cables and hollow wrists."""
    count = len(joints(description))
    return [f"joint {j} from joint {j - 1}" for j in range(2, count + 1)] + [f"joint {count} from joint {count - 2}"]


def _linkages(description: RobotDescription) -> list[str]:
    return ["parallelogram"] if description.parallelogram is not None else []


def _links(description: RobotDescription) -> list[str]:
    return [place.replace("joint", "link") for place in joints(description)]


_COMPLIANCE = (Parameter("compliance", "rad/(N m)"),)
_CYCLIC = (
    Parameter("amplitude", "rad"),
    Parameter("phase", "rad", scales=False),
    Parameter("per_turn", "1/turn", scales=False),
)


def _phase(rng: np.random.Generator) -> float:
    return float(rng.uniform(-np.pi, np.pi))


LIBRARY: tuple[Kind, ...] = (
    Kind(
        "base_drift", "", TIME, twist_parameters("/h", 1 / HOUR_S), ("time_s",), only("base"), _draw_drift, _hide_drift
    ),
    Kind(
        "base_shift", "", TIME, (*twist_parameters(), Parameter("time", "s", scales=False)), ("time_s",), only("base"),
        _draw_shift, _hide_shift,
    ),
    Kind(
        "base_compliance", "", LOAD, _COMPLIANCE, ("payload_kg",), only("base"), _compliance_across,
        _hide_base_compliance,
    ),
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
        "joint_compliance", "", LOAD, _COMPLIANCE, ("payload_kg",), joints, _compliance_at,
        lambda hidden, scene, place, values: hidden.motor_spring(number(place), values["compliance"]),
    ),
    Kind("bearing_compliance", "", LOAD, _COMPLIANCE, ("payload_kg",), joints, _compliance_across, _hide_bearing),
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
        "link_geometry", "", CONSTANT,
        (Parameter("alpha", "rad"), Parameter("a", "mm", 1e-3), Parameter("d", "mm", 1e-3)), (),
        _links, _draw_link_geometry, _hide_link_geometry,
    ),
    Kind(
        "link_bending", "", LOAD, (Parameter("flexibility", "1/(N m^2)"),), ("payload_kg",), links_longer_than(0.1),
        lambda rng, scene, place: {"flexibility": 2 * _compliance(scene, float(np.abs(scene.torque).max()))},
        lambda hidden, scene, place, values: hidden.bend(number(place), values["flexibility"]),
    ),
    Kind(
        "thermal_expansion", "", TEMPERATURE, (Parameter("coefficient", "1/K"),), ("temperature_c",),
        links_longer_than(0.1), lambda rng, scene, place: {"coefficient": 2e-5}, _hide_thermal,
    ),
    Kind(
        "parallelogram_geometry", "", ANGLE, (Parameter("rod", "mm", 1e-3), Parameter("rocker", "mm", 1e-3)), (),
        _linkages,
        lambda rng, scene, place: {bar: float(rng.normal(0, 3e-4)) for bar in ("rod", "rocker")}, _hide_linkage,
    ),
    Kind(
        "instrument_scale", "", CONSTANT, (Parameter("scale", "m/m"),), (), only("instrument"),
        lambda rng, scene, place: {"scale": float(rng.choice([-1, 1]) * 1e-4)}, _hide_scale,
    ),
    Kind(
        "payload_error", "", PAYLOAD, (Parameter("mass", "kg"),), ("payload_kg",), only("payload"),
        lambda rng, scene, place: {"mass": float(0.3 * scene.session.payload.max())}, _hide_payload_mass,
    ),
    Kind(
        "payload_error", "centre", PAYLOAD, tuple(Parameter(f"com_{axis}", "mm", 1e-3) for axis in "xyz"),
        ("payload_kg",), only("payload"),
        lambda rng, scene, place: {f"com_{axis}": float(rng.normal(0, 0.15)) for axis in "xyz"}, _hide_payload_centre,
    ),
)  # fmt: skip
"""Every effect of the vocabulary that a world can conceal; the frames are off in every world anyway."""
