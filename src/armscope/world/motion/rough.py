"""Arms in motion as rough as real ones: each assumption of a diagnosis of torques is broken at random, on its own.

What is here is no story: every effect stands in truth.yaml under `rough`, with its name and size, so that naming it is
right and leaving it out is right, too. How noise is and how fast runs are is here as well. All sizes are
`armscope.world.motion.constants.ROUGH_MOTION`'s: assumptions, each with its basis.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.world.constants import Pair
from armscope.world.kinds import joints, links
from armscope.world.layout import Geometry
from armscope.world.motion.constants import ROUGH_MOTION as ROUGH
from armscope.world.motion.kinds import LIBRARY, UNKNOWN, Concealed, Kind
from armscope.world.motion.mechanism import Dynamics
from armscope.world.motion.session import GRID_HZ, WARMING_C, Session
from armscope.world.motion.stage import Numbers, PlainArm, Stage, stage_of
from armscope.world.motion.virtual_arm import VirtualArm
from armscope.world.rough import between

OF = {kind.name: kind for kind in LIBRARY}
LEAST_SHARE = -0.7  # A body keeps some of its inertia
DRIFTS = 3  # Waves that a wandering zero is made of
AS_GOOD = {
    "rest": ("coulomb_friction",), "bend": ("coulomb_friction", "viscous_friction"), "warm": ("viscous_friction",),
}  # fmt: skip
"""Names that are as good at each joint as a blemish's own: stated friction is off where it has another shape.

Where masses are off, what is too much at the last link may as well be its load.
"""


def _bent(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """What a power of the speed is beside the speed itself; they agree at the usual speed."""
    share = stage.session.speed[:, joint] / numbers["usual"]
    power = np.abs(share) ** numbers["power"] * np.sign(share)
    return np.asarray(numbers["viscous"] * numbers["usual"] * (power - share))


def _wandering(session: Session, torque: Array, joint: int, numbers: Numbers) -> Array:
    """A zero that comes and goes over the whole session."""
    rng, time = np.random.default_rng(int(numbers["seed"])), np.arange(len(session)) / GRID_HZ
    periods, phases = 2 * ROUGH.drift_s * np.exp(rng.uniform(0, 1, DRIFTS)), rng.uniform(0, 2 * np.pi, DRIFTS)
    found = np.array(torque)
    found[:, joint] += (
        numbers["rms"] * np.sqrt(2 / DRIFTS) * np.sin(2 * np.pi * time[:, None] / periods + phases).sum(1)
    )
    return found


def _thicker(dynamics: Dynamics, place: Location, numbers: Numbers) -> Dynamics:
    return dynamics.changed("inertia", place.index, numbers["share"] * dynamics.inertia[place.index])


BENT = Kind(
    "viscous_curve", joints, lambda rng, _: {}, {"viscous": "N m s/rad", "usual": "rad/s", "power": ""}, ("viscous",),
    {}, pulls=_bent,
)  # fmt: skip
WANDERING = Kind(
    UNKNOWN, joints, lambda rng, _: {}, {"rms": "N m", "seed": ""}, ("rms",), {}, records=_wandering,
    driver="time", shape="drift",
)  # fmt: skip
THICKER = Kind(
    "link_inertia", links, lambda rng, _: {}, {"share": ""}, ("share",), {}, changes=_thicker, driver="acceleration",
    shape="share",
)  # fmt: skip

Drawn = list[Concealed]
Blemish = Callable[[np.random.Generator, PlainArm], Drawn]
Draw = Callable[[np.random.Generator, PlainArm, int], tuple[Kind, dict[str, float]]]


def _masses(rng: np.random.Generator, arm: PlainArm) -> Drawn:
    mass, centre, inertia = (between(rng, pair) for pair in (ROUGH.mass_share, ROUGH.centre_m, ROUGH.inertia_share))
    found = []
    for place, weighs in zip(links(arm.description), arm.dynamics.mass, strict=True):
        moment = dict(zip(("mx", "my", "mz"), (weighs * rng.normal(0, centre, 3)).tolist(), strict=True))
        found.append(Concealed(OF["link_mass"], place, {"mass": float(weighs * rng.normal(0, mass))}))
        found.append(Concealed(OF["link_first_moment"], place, moment))
        found.append(Concealed(THICKER, place, {"share": max(float(rng.normal(0, inertia)), LEAST_SHARE)}))
    return found


def _in_each(draw: Draw) -> Blemish:
    """The same in every joint (from 0), with numbers of its own."""

    def drawn(rng: np.random.Generator, arm: PlainArm) -> Drawn:
        each = ((place, draw(rng, arm, joint)) for joint, place in enumerate(joints(arm.description)))
        return [Concealed(kind, place, numbers) for place, (kind, numbers) in each]

    return drawn


def _either(rng: np.random.Generator, pair: Pair) -> float:
    return float(rng.choice([-1.0, 1.0])) * between(rng, pair)


def _rest(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    more = between(rng, ROUGH.rest_share) * arm.dynamics.coulomb[joint]
    return OF["stribeck_friction"], {"stribeck": float(more), "speed": between(rng, ROUGH.rest_speed)}


def _dry_sides(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    return OF["torque_offset"], {"offset": float(_either(rng, ROUGH.side_share) * arm.dynamics.coulomb[joint])}


def _viscous_sides(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    more = _either(rng, ROUGH.side_share) * arm.dynamics.viscous[joint]
    return OF["asymmetric_friction"], {"viscous_difference": float(more)}


def _bend(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    viscous, power = float(arm.dynamics.viscous[joint]), between(rng, ROUGH.bend_power)
    return BENT, {
        "viscous": viscous,
        "usual": float(np.sqrt(np.mean(arm.session.speed[:, joint] ** 2))),
        "power": power,
    }


def _loaded(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    return OF["load_friction"], {"per_load": between(rng, ROUGH.load_share)}


def _warm(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    gone = between(rng, ROUGH.warm_share) * arm.dynamics.viscous[joint]
    return OF["thermal_friction"], {"per_kelvin": float(-gone / WARMING_C)}


def _line(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    amplitude = between(rng, ROUGH.ripple_of_noise) * float(arm.sigma[joint])
    waves, phase = round(between(rng, ROUGH.ripple_waves)), float(rng.uniform(-np.pi, np.pi))
    return OF["torque_ripple"], {"amplitude": amplitude, "per_turn": float(waves), "phase": phase}


def _cable(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    angle = arm.session.angle[:, joint]
    middle = float(angle.mean() + rng.uniform(-0.3, 0.3))
    usual = float(np.std(0.4 * (angle - middle) + (angle - middle) ** 3))
    pull = _either(rng, ROUGH.cable_of_noise) * float(arm.sigma[joint])
    return OF["cable_torque"], {"torque": pull / usual, "middle": middle}


def _gains(rng: np.random.Generator, arm: PlainArm) -> Drawn:
    spread = between(rng, ROUGH.gain_share)
    return _in_each(lambda draws, *_: (OF["motor_constant"], {"gain": float(draws.normal(0, spread))}))(rng, arm)


def _late(rng: np.random.Generator, arm: PlainArm) -> Drawn:
    delay = between(rng, ROUGH.late_s)
    return _in_each(lambda *_: (OF["torque_delay"], {"delay": delay}))(rng, arm)


def _drift(rng: np.random.Generator, arm: PlainArm, joint: int) -> tuple[Kind, dict[str, float]]:
    rms = between(rng, ROUGH.drift_of_noise) * float(arm.sigma[joint])
    return WANDERING, {"rms": rms, "seed": float(rng.integers(2**31))}


def _told_elsewhere(rng: np.random.Generator, arm: PlainArm) -> Drawn:
    return []


def _both(first: Blemish, second: Blemish) -> Blemish:
    return lambda rng, arm: first(rng, arm) + second(rng, arm)


BLEMISHES: dict[str, tuple[float, Blemish]] = {
    "masses": (0.7, _masses), "rest": (0.6, _in_each(_rest)),
    "sides": (0.5, _both(_in_each(_dry_sides), _in_each(_viscous_sides))), "bend": (0.5, _in_each(_bend)),
    "loaded": (0.5, _in_each(_loaded)), "warm": (0.5, _in_each(_warm)), "lines": (0.5, _in_each(_line)),
    "cables": (0.4, _in_each(_cable)), "gains": (0.4, _gains), "late": (0.4, _late), "drift": (0.4, _in_each(_drift)),
    "noise": (0.6, _told_elsewhere), "pace": (0.5, _told_elsewhere),
}  # fmt: skip
"""What may be rough: how often it is, and what it conceals.

| name | the assumption that it breaks |
|---|---|
| masses | stated masses, centres and inertias are right |
| rest | friction is dry and viscous |
| sides | friction is the same in both directions |
| bend | it grows in proportion to speed |
| loaded | it does not hang on the load |
| warm | nor on how long the arm has run |
| lines | gears run evenly where nothing is wrong with them |
| cables | only gravity pulls |
| gains | torque is read true |
| late | at the moment at which it is there |
| drift | from a zero that stays |
| noise | its noise is Gaussian, and the same at all speeds |
| pace | all runs go equally fast |
"""


def draw_broken(rng: np.random.Generator) -> list[str]:
    """Names of what is rough in an arm in motion, each drawn on its own."""
    return [name for name, (share, _) in BLEMISHES.items() if rng.random() < share]


def blemishes(arm: PlainArm, broken: tuple[str, ...], rng: np.random.Generator) -> Drawn:
    """What is rough in an arm.

    Args:
        arm: the arm, with the noise of its torques.
        broken: names of `BLEMISHES`.
        rng: draws the numbers.

    Returns:
        What it has everywhere.
    """
    return [each for name in broken for each in BLEMISHES[name][1](rng, arm)]


def changes_alone(arm: VirtualArm, drawn: Drawn, plain: Array) -> list[Array]:
    """What each does to the torques of the arm by itself.

    Args:
        arm: the arm.
        drawn: what is rough in it.
        plain: (T, n) its torques without.

    Returns:
        (T, n) of each, N m.
    """
    stage = stage_of(Geometry(arm.description), arm.dynamics, arm.session)
    return [_alone(arm, each, plain, stage) for each in drawn]


def _alone(arm: VirtualArm, each: Concealed, plain: Array, stage: Stage) -> Array:
    kind, found = each.kind, np.zeros_like(plain)
    if kind.pulls is not None:
        found[:, each.joint] = kind.pulls(stage, each.joint, each.numbers)
    elif kind.records is not None:
        found = kind.records(arm.session, plain, each.joint, each.numbers) - plain
    else:
        found = arm.torques([each]) - plain
    return found


def also_allowed(broken: tuple[str, ...], n_joints: int) -> list[tuple[str, str]]:
    """Names that are as good as a blemish's own, of an arm with so many joints."""
    straight = {effect for name in broken for effect in AS_GOOD.get(name, ())}
    load = [("payload_error", "payload")] if "masses" in broken else []
    clock = [("torque_delay", "all joints")] if "late" in broken else []  # all are late by the same
    return load + clock + [(effect, f"joint {j + 1}") for effect in sorted(straight) for j in range(n_joints)]


def paces_of(broken: tuple[str, ...], runs: int, rng: np.random.Generator) -> tuple[float, ...]:
    """How fast each run goes, over what limits allow: one of those to be fitted, and the test, as fast as that.

    Args:
        broken: names of `BLEMISHES`.
        runs: how many there are, the test among them.
        rng: draws the paces.

    Returns:
        A share for each run.
    """
    if "pace" not in broken:
        return (1.0,) * runs
    slower = [between(rng, ROUGH.pace) for _ in range(runs - 2)]
    return (*rng.permutation([1.0, *slower]).tolist(), 1.0)
