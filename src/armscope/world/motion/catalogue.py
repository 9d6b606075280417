"""The moving worlds of the proof: what is concealed in which arm, how large, under which circumstances.

Half of the worlds have seeds that stay the same; the other half's come from the seed of the proof, so that nobody can
have tuned anything to them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from armscope.core.inputs import Strict
from armscope.core.types import Array
from armscope.world.kinds import joints
from armscope.world.motion.kinds import GRIPPER, LIBRARY, Kind
from armscope.world.motion.links import LINKED
from armscope.world.motion.rough import draw_broken
from armscope.world.motion.session import GRID_HZ, PathRule, Session
from armscope.world.motion.stage import Numbers, Stage, sign
from armscope.world.spec import Details, EffectSpec, Recipe, seeded


def _hysteresis(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """Dahl's law, the core of LuGre's (Canudas de Wit et al. 1995): friction comes back over a way, not a speed.

    dz/dt = v (1 - sign(v) z / way): z / way goes from -1 to 1 over a few times `way` after each reversal.
    """
    state = 0.0
    shares = np.empty(len(stage.session))
    steps = stage.session.speed[:, joint] / GRID_HZ / numbers["way"]
    for row, step in enumerate(steps):
        # exact over a step of constant speed
        side = np.sign(step)
        state = side + (state - side) * np.exp(-abs(step)) if step else state
        shares[row] = state
    return numbers["torque"] * shares


def _eccentric(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """A gear off its centre meshes tight on one side of the turn: dry friction goes up and down once per turn."""
    turned = stage.session.angle[:, joint] - numbers["phase"]
    return numbers["torque"] * np.cos(turned) * sign(stage.session, joint)


def _play(session: Session, torque: Array, joint: int, numbers: Numbers) -> Array:
    """Torque goes through a play: what is recorded follows only once the torque has changed by its width."""
    found = np.array(torque)
    half = numbers["width"] / 2
    for run in session.runs():
        follows = torque[run.start, joint]
        for row in range(run.start, run.stop):
            follows = min(max(follows, torque[row, joint] - half), torque[row, joint] + half)
            found[row, joint] = follows
    return found


def _saturating(session: Session, torque: Array, joint: int, numbers: Numbers) -> Array:
    """A sensor that reads less and less of more: limit tanh(torque / limit); the loss grows with 1 / limit^2."""
    found = np.array(torque)
    limit = 1 / np.sqrt(numbers["per_square"])
    found[:, joint] = limit * np.tanh(torque[:, joint] / limit)
    return found


OUTSIDE: tuple[Kind, ...] = (
    Kind("unknown", joints, lambda rng, _: {"torque": 1.0, "way": float(rng.uniform(0.03, 0.1))},
         {"torque": "N m", "way": "rad"}, ("torque",), {}, pulls=_hysteresis, shape="hysteresis"),
    Kind("unknown", joints, lambda rng, _: {"width": 1.0}, {"width": "N m"}, ("width",), {}, records=_play,
         driver="load", shape="torque_play"),
    Kind("unknown", joints, lambda rng, _: {"torque": 1.0, "phase": float(rng.uniform(-np.pi, np.pi))},
         {"torque": "N m", "phase": "rad"}, ("torque",), {}, pulls=_eccentric, shape="eccentric_friction"),
    Kind("unknown", joints, lambda rng, _: {"per_square": 1.0}, {"per_square": "1/(N m)^2"}, ("per_square",), {},
         records=_saturating, driver="load", shape="saturating_sensor"),
)  # fmt: skip


KINDS: dict[str, Kind] = {kind.name: kind for kind in (*LIBRARY, GRIPPER, *OUTSIDE, *LINKED)}
ARMS = ("two-axis", "six-axis", "seven-axis")
RATES = (100, 125, 250)  # Hz; divisors of the grid's rate
FIXED_SEED = 20261122
STRENGTHS = (3.0, 5.0, 10.0)
OUT_OF_ROUGH = (2.0, 3.0, 5.0)  # Sizes of what stands out of a rough arm, over its noise and all that is rough together

Category = Literal["clean", "single", "multiple", "outside", "confounded", "rough"]
Size = Literal["small", "full"]


class MotionSpec(Strict):
    """All that a moving world is made from."""

    id: str  # its folder's name; it says nothing about what is inside
    category: Category  # what it is there to show
    arm: str  # file in config/motion without its ending
    seed: int  # of everything random in it
    fresh: bool  # whether the seed comes from the proof's seed
    rate: int  # Hz of the recorded rows
    noise: float  # standard deviation of the torque's noise as a share of each joint's RMS torque
    effects: tuple[EffectSpec, ...] = ()
    stated: bool = False  # whether robot.yaml states friction and rotor inertia
    current: bool = False  # whether motor currents are recorded instead of torques, with exact gains in robot.yaml
    linked: bool = False  # whether every link has an encoder of its own beside its motor's
    # rule, joint: how the training runs move: freely, or one joint (0-based) one way only, or hardly at all
    rule: PathRule = "free"
    joint: int | None = None
    # what the arm has everywhere, names of `armscope.world.motion.rough.BLEMISHES`; what it conceals besides is so many
    # times as large as noise and that together
    rough: tuple[str, ...] = ()
    durations: tuple[float, ...] = (14.0, 14.0, 10.0)  # s, of the training runs and, last, of the test path


def catalogue(proof_seed: int, size: Size = "small") -> list[MotionSpec]:
    """The worlds of a proof. ``proof_seed``: from which the seeds of every second world are derived."""
    recipes = list(_small() if size == "small" else _full())
    return [_spec(number, category, recipe, proof_seed) for number, (category, recipe) in enumerate(recipes)]


def _spec(number: int, category: Category, recipe: Recipe, proof_seed: int) -> MotionSpec:
    seeds, rng = seeded(number, FIXED_SEED, proof_seed)
    details: Details = {"arm": str(rng.choice(ARMS)), **recipe(rng)}
    return MotionSpec.model_validate(
        {
            "id": f"motion-{number:03d}",
            "category": category,
            **seeds,
            "rate": int(rng.choice(RATES)),
            "noise": round(float(rng.uniform(0.008, 0.025)), 4),
            "stated": bool(rng.random() < 0.4),
            "current": bool(rng.random() < 0.2),
            **details,
        }
    )


def _full() -> Iterator[tuple[Category, Recipe]]:
    for _ in range(30):
        yield "clean", _nothing
    for kind in LIBRARY:
        for strength in STRENGTHS:
            yield "single", _single(kind.name, strength)
    for number in range(30):
        yield "multiple", _several(2 + number % 3)
    for kind in OUTSIDE:
        for strength in (*STRENGTHS, 5.0):
            yield "outside", _single(kind.name, strength)
    for recipe in CONFOUNDED:
        for _ in range(3):
            yield "confounded", recipe
    for _ in range(3):
        yield "clean", _linked
    for kind in (*LINKED, GRIPPER):
        for strength in STRENGTHS:
            yield "single", _single(kind.name, strength)
    for number in range(36):
        yield "rough", _rough(number % 3)


def _small() -> Iterator[tuple[Category, Recipe]]:
    for _ in range(2):
        yield "clean", _nothing
    for name in ("asymmetric_friction", "load_friction", "torque_offset", "torque_delay", "link_mass", "payload_error"):
        yield "single", _single(name, 5.0)
    yield "multiple", _several(2)
    for kind in OUTSIDE[:2]:
        yield "outside", _single(kind.name, 5.0)
    yield "confounded", CONFOUNDED[0]
    yield "single", _single("joint_compliance", 5.0)
    yield "clean", _linked
    for name in ("joint_elasticity", "joint_play"):
        yield "single", _single(name, 5.0)
    yield "rough", _rough(1)


def _nothing(rng: np.random.Generator) -> Details:
    return {}


def _linked(rng: np.random.Generator) -> Details:
    return {"linked": True}


def _single(kind: str, strength: float) -> Recipe:
    return lambda rng: {"effects": [{"kind": kind, "strength": strength}], **_circumstances([kind], rng)}


def _circumstances(kinds: list[str], rng: np.random.Generator) -> Details:
    """An arm that has such a place, and friction in robot.yaml where the cause is a departure from it."""
    details: Details = {}
    if any("coupled" in kind or kind == "gravity_direction" for kind in kinds):
        details["arm"] = str(rng.choice(ARMS[1:]))
    if any(KINDS[kind].stated for kind in kinds):
        details["stated"] = True
    if any(KINDS[kind].lies is not None for kind in kinds):
        details["linked"] = True
    return details


def _several(count: int) -> Recipe:
    def recipe(rng: np.random.Generator) -> Details:
        kinds = [str(name) for name in rng.permutation([kind.name for kind in LIBRARY])[:count]]
        effects = [{"kind": kind, "strength": float(rng.choice([4.0, 6.0, 9.0]))} for kind in kinds]
        return {"effects": effects, **_circumstances(kinds, rng)}

    return recipe


def _rough(count: int) -> Recipe:
    def recipe(rng: np.random.Generator) -> Details:
        kinds = [str(name) for name in rng.permutation([kind.name for kind in (*LIBRARY, GRIPPER)])[:count]]
        effects = [{"kind": kind, "strength": float(rng.choice(OUT_OF_ROUGH))} for kind in kinds]
        return {"rough": draw_broken(rng), "effects": effects, **_circumstances(kinds, rng)}

    return recipe


def _unseparated(kind: str, rule: PathRule, joint: int, arm: str, strength: float = 5.0) -> Recipe:
    def recipe(rng: np.random.Generator) -> Details:
        asked = {"kind": kind, "strength": strength, "location": f"joint {joint + 1}"}
        details = {"effects": [asked], "arm": arm, "rule": rule, "joint": joint, **_circumstances([kind], rng)}
        # where a joint turns one way only, friction that nobody stated would take all of it
        return details | {"stated": True} if rule == "one_way" else details

    return recipe


CONFOUNDED: tuple[Recipe, ...] = (
    _unseparated("torque_offset", "one_way", 3, "six-axis"),
    _unseparated("coulomb_friction", "one_way", 0, "seven-axis"),
    _unseparated("gravity_balance", "narrow", 1, "six-axis"),
    _unseparated("cable_torque", "narrow", 3, "seven-axis", 3.0),
)
"""A joint that turns one way only: friction and offset are one column; one that hardly turns: every curve is a line."""
