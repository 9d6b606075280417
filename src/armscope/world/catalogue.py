"""The worlds of the proof: what is concealed in which arm, at which strength, under which circumstances.

A `WorldSpec` says all that a world is made from; `armscope.world.folder.build` makes it. Half of the worlds have
seeds that stay the same; the other half's are derived from the seed of the proof, so that nobody can have tuned
anything to them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from armscope.world.effects import LIBRARY
from armscope.world.kinds import PAYLOAD
from armscope.world.outside import OUTSIDE
from armscope.world.rough import draw_broken
from armscope.world.spec import ARMS, KINDS, NOISE_MM, Category, Details, Recipe, WorldSpec, seeded

STRENGTHS = (0.5, 1.0, 2.0, 3.0, 5.0, 10.0)
FAINT = (2.0, 3.0, 4.0, 5.0, 6.5, 9.0)
"""Sizes of faint effects: in noise of a single reading, summed over all readings (square root of the noncentrality)."""
FIXED_SEED = 20061103
LATER_KINDS = (
    "zero_shift", "holder_sag", "loose_target/along", "loose_target/across",
    "compliance_change", "compliance_change/temperature",
)  # fmt: skip
"""What the vocabulary has gained: at the end, so that all other worlds keep their numbers and their seeds."""
FIRST_KINDS = [kind for kind in LIBRARY if kind.name not in LATER_KINDS]
CAUSES = (3.0, 10.0)  # Sizes of what stands out of a rough arm, in noise of a single reading
COMMON_KINDS = (
    "joint_compliance", "joint_compliance", "joint_offset", "joint_offset", "link_geometry", "link_geometry",
    "gear_eccentricity", "gear_eccentricity", "backlash", "bearing_compliance", "gear_ratio", "thermal_expansion",
    "axis_wobble", "link_bending", "base_compliance", "joint_coupling", "base_drift", "gear_mesh", "servo_lag",
)  # fmt: skip
"""What real arms have together, the usual suspects twice."""


def catalogue(proof_seed: int, size: Literal["small", "full"] = "small") -> list[WorldSpec]:
    """The worlds of a proof: 24 in the small one, some 500 in the full one."""
    recipes = list(_small() if size == "small" else _full())
    return [_spec(number, category, recipe, proof_seed) for number, (category, recipe) in enumerate(recipes)]


def _spec(number: int, category: Category, recipe: Recipe, proof_seed: int) -> WorldSpec:
    seeds, rng = seeded(number, FIXED_SEED, proof_seed)
    arm = ARMS[int(rng.integers(len(ARMS)))]
    details: Details = {"arm": arm, "rows": int(rng.choice([60, 100, 150, 200, 250, 300])), **recipe(rng)}
    low, high = NOISE_MM[str(details["arm"])]
    return WorldSpec.model_validate(
        {
            "id": f"world-{number:03d}",
            "category": category,
            **seeds,
            "sigma_mm": round(float(rng.uniform(low, high)), 3),
            "noise_stated": bool(rng.random() < 0.6),
            **details,
        }
    )


def _full() -> Iterator[tuple[Category, Recipe]]:
    for _ in range(48):
        yield "clean", _nothing
    for kind in FIRST_KINDS:
        for strength in STRENGTHS:
            yield "single", _single(kind.name, strength)
    for number in range(48):
        yield "multiple", _several(2 + number % 5, weak=number % 4 == 3)
    for kind in OUTSIDE:
        for strength in (2.0, 3.0, 5.0, 10.0):
            yield "outside", _single(kind.name, strength)
    for _ in range(2):
        for recipe in MISLEADING:
            yield "misleading", recipe
    for _ in range(2):
        for recipe in INSEPARABLE:
            yield "inseparable", recipe
    for _ in range(15):
        yield "real", _real_arm
    for number in range(16):
        yield "bad_shots", _bad_shots("outliers" if number < 8 else "heavy_tails", 1 + number % 3)
    for kind in FIRST_KINDS:
        if kind.driver != PAYLOAD:  # it never stands alone
            for size in FAINT:
                yield "faint", _faint(kind.name, size)
    for number in range(48):
        yield "rough", _rough(number % 4)
    for number in range(12):
        yield "rough_misleading", _rough(number % 2, ("in_order", "warming_in_step", "few")[number % 3])
    for name in LATER_KINDS:
        for strength in STRENGTHS:
            yield "single", _single(name, strength)
        for size in FAINT:
            yield "faint", _faint(name, size)


def _small() -> Iterator[tuple[Category, Recipe]]:
    for _ in range(4):
        yield "clean", _nothing
    singles = (
        ("joint_compliance", 3.0), ("joint_offset", 3.0), ("link_geometry", 5.0), ("gear_eccentricity", 3.0),
        ("backlash", 3.0), ("thermal_expansion", 5.0), ("bearing_compliance", 5.0), ("base_drift", 3.0),
    )  # fmt: skip
    for kind, strength in singles:
        yield "single", _single(kind, strength)
    for count in (2, 3, 4, 5):
        yield "multiple", _several(count, weak=False)
    for kind in ("unknown/local_bump", "unknown/loose_beyond", "unknown/load_dead_band"):
        yield "outside", _single(kind, 5.0)
    yield "misleading", MISLEADING[0]
    yield "misleading", MISLEADING[3]
    yield "inseparable", INSEPARABLE[0]
    yield "rough", _rough(1, rows=100)
    yield "bad_shots", _bad_shots("outliers", 1)


def _nothing(rng: np.random.Generator) -> Details:
    return {}


def _single(kind: str, strength: float) -> Recipe:
    def recipe(rng: np.random.Generator) -> Details:
        return {"effects": [{"kind": kind, "strength": strength}], **_arm_for(kind)}

    return recipe


def _faint(kind: str, size: float) -> Recipe:
    """About as small as one who knows what to test for would still see: far below the noise of one reading."""

    def recipe(rng: np.random.Generator) -> Details:
        rows = int(rng.choice([60, 100, 150, 200, 250, 300]))
        strength = float(f"{size / np.sqrt(3 * rows):.4g}")
        return {"effects": [{"kind": kind, "strength": strength}], "rows": rows, **_arm_for(kind)}

    return recipe


def _arm_for(kind: str) -> Details:
    """A linkage's errors need an arm that has one."""
    return {"arm": KINDS[kind].arm} if KINDS[kind].arm else {}


def _several(count: int, weak: bool) -> Recipe:
    """Two to six effects; if ``weak``, one of them near the threshold."""

    def recipe(rng: np.random.Generator) -> Details:
        names = list(dict.fromkeys(rng.permutation(COMMON_KINDS)))[:count]
        if count > 2 and "joint_compliance" in names:
            names[-1] = "joint_compliance"  # where one joint gives way, another does
        strengths = rng.choice([3.0, 4.0, 6.0, 9.0, 12.0], count)
        if weak:
            strengths[-1] = 1.5
        effects = [{"kind": str(name), "strength": float(size)} for name, size in zip(names, strengths, strict=True)]
        return {"effects": effects, "rows": int(rng.choice([150, 200, 250, 300]))}

    return recipe


def _misled(kind: str | None, **details: object) -> Recipe:
    def recipe(rng: np.random.Generator) -> Details:
        if kind is None:
            return dict(details)
        asked = {"kind": kind, "strength": float(rng.choice([3.0, 5.0, 10.0]))}
        return {"effects": [asked], **_arm_for(kind), **details}

    return recipe


MISLEADING: tuple[Recipe, ...] = (
    _misled("joint_compliance", masses="wrong"),
    _misled("joint_compliance", masses="wrong"),
    _misled("joint_compliance", masses="absent"),
    _misled("backlash", columns="missing"),
    _misled("thermal_expansion", columns="missing"),
    _misled("base_drift", columns="missing"),
    _misled("servo_lag", columns="missing"),
    _misled(None, columns="irrelevant"),
    _misled(None, columns="irrelevant", poses="warming_in_step"),
    _misled("gear_eccentricity", columns="irrelevant"),
    _misled("base_drift", poses="warming_in_step"),
    _misled("thermal_expansion", poses="warming_in_step"),
)


def _unseparated(
    kind: str,
    poses: str,
    location: str | None = None,
    arm: str | None = None,
    strengths: tuple[float, ...] = (3.0, 5.0),
) -> Recipe:
    def recipe(rng: np.random.Generator) -> Details:
        asked: Details = {"kind": kind, "strength": float(rng.choice(strengths)), "location": location}
        details: Details = {"effects": [asked], "poses": poses}
        return details | {"arm": arm} if arm else details

    return recipe


INSEPARABLE: tuple[Recipe, ...] = (
    _unseparated("joint_compliance", "no_payload", "joint 2", "parallelogram-120kg"),
    _unseparated("servo_lag", "constant_speed", "joint 2"),
    _unseparated("gear_ratio", "constant_speed", "joint 3"),
    _unseparated("gear_ratio", "lockstep", "joint 2", "six-axis"),
    _unseparated("joint_coupling", "lockstep", "joint 3 from joint 2", "six-axis"),
    _unseparated("gear_eccentricity", "narrow", strengths=(2.0,)),
    _unseparated("base_compliance", "free", "base", "six-axis"),
    _unseparated("bearing_compliance", "free", "joint 1", "parallelogram-120kg"),
)


def _real_arm(rng: np.random.Generator) -> Details:
    """Geometry of tolerance size, give in all directions and small curves everywhere; one effect that dominates."""
    arm = ARMS[int(rng.integers(len(ARMS)))]
    joints = 7 if arm == "seven-axis" else 6
    sizes: dict[str, tuple[float, float]] = {
        "joint_offset": (0.5, 1.5), "link_geometry": (0.3, 1.2), "joint_compliance": (0.3, 1.2),
        "bearing_compliance": (0.2, 0.8), "gear_eccentricity": (0.2, 0.6),
    }  # fmt: skip
    effects = [
        {
            "kind": kind,
            "strength": round(float(rng.uniform(*size)), 3),
            "location": f"{'link' if kind.startswith('link') else 'joint'} {j + 1}",
            "minor": True,
        }
        for kind, size in sizes.items()
        for j in range(joints)
    ]
    effects.append({"kind": "base_compliance", "strength": 0.5, "location": "base", "minor": True})
    dominant = str(
        rng.choice(["joint_compliance", "joint_offset", "gear_eccentricity", "bearing_compliance", "backlash"])
    )
    effects.insert(0, {"kind": dominant, "strength": float(rng.choice([10.0, 15.0, 20.0]))})
    return {"arm": arm, "rows": int(rng.choice([150, 200, 250, 300])), "effects": effects, "masses": "wrong"}


def _rough(causes: int, poses: str = "free", rows: int | None = None) -> Recipe:
    """Any assumption broken, each on its own; upon that, causes that stand out of what the arm has everywhere."""

    def recipe(rng: np.random.Generator) -> Details:
        broken = draw_broken(rng)
        kinds = list(dict.fromkeys(rng.permutation([*COMMON_KINDS, "payload_error"])))[:causes]
        effects = [{"kind": str(kind), "strength": float(np.exp(rng.uniform(*np.log(CAUSES))))} for kind in kinds]
        noise = "rough" if "instrument" in broken else "gaussian"
        count = rows or int(rng.choice([200, 250, 300]))
        return {"rough": broken, "effects": effects, "poses": poses, "noise": noise, "rows": count}

    return recipe


def _bad_shots(noise: str, count: int) -> Recipe:
    def recipe(rng: np.random.Generator) -> Details:
        return {**_several(max(count, 2), weak=False)(rng), "noise": noise} if count > 1 else {
            "effects": [{"kind": str(rng.choice(COMMON_KINDS)), "strength": 5.0}], "noise": noise,
            "rows": int(rng.choice([100, 200, 300])),
        }  # fmt: skip

    return recipe
