"""What a world is made from: the arm, the session, and the effects that it is to conceal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from armscope.core.inputs import Strict
from armscope.world.effects import LIBRARY
from armscope.world.kinds import Kind
from armscope.world.outside import OUTSIDE
from armscope.world.session import PoseRule

KINDS: dict[str, Kind] = {kind.name: kind for kind in LIBRARY + OUTSIDE}

ARMS = ("parallelogram-120kg", "six-axis", "seven-axis")
LARGEST_PAYLOAD_KG = {"parallelogram-120kg": 120.0, "six-axis": 20.0, "seven-axis": 12.0}
NOISE_MM = {"parallelogram-120kg": (0.02, 0.06), "six-axis": (0.012, 0.04), "seven-axis": (0.008, 0.025)}
Category = Literal[
    "clean", "single", "multiple", "outside", "misleading", "inseparable", "real", "bad_shots", "faint", "rough",
    "rough_misleading",
]  # fmt: skip


Details = dict[str, object]
Recipe = Callable[[np.random.Generator], Details]  # What a world of a kind is made from, as far as that is drawn


def seeded(number: int, fixed_seed: int, proof_seed: int) -> tuple[Details, np.random.Generator]:
    """Seeds of a catalogue's world: every other one's stays, by the Thue-Morse sequence, the others' are the proof's.

    Args:
        number: of the world, from 0; the sequence is in step with no period in a list of recipes.
        fixed_seed: of the worlds that stay.
        proof_seed: of the others.

    Returns:
        `seed` and `fresh` of its specification, and the generator that draws the rest.
    """
    fresh = number.bit_count() % 2 == 1
    sequence = np.random.SeedSequence([proof_seed if fresh else fixed_seed, int(fresh), number])
    return {"seed": int(sequence.generate_state(1)[0]), "fresh": fresh}, np.random.default_rng(sequence)


class EffectSpec(Strict):
    """An effect that a world is to conceal, of an arm that stands or of one that moves."""

    kind: str  # key of `KINDS`
    strength: float  # RMS at the tool in multiples of the noise; of an arm that moves, RMS torque
    location: str | None = None  # where; drawn among the places where it can be seen if left out
    minor: bool = False  # belongs to the background of a real arm, not to the story


class WorldSpec(Strict):
    """All that a world is made from."""

    id: str  # its folder's name; it says nothing about what is inside
    category: Category  # what it is there to show
    arm: str  # file in config/robots without its ending
    seed: int  # of everything random in it
    fresh: bool  # whether the seed comes from the proof's seed
    rows: int
    sigma_mm: float  # 1-sigma noise per axis
    effects: tuple[EffectSpec, ...] = ()
    poses: PoseRule = "free"  # rule of `armscope.world.session.POSE_RULES`
    # context in recordings.csv: `some` (all that is needed, others at random), `missing` (what the effects need is left
    # out), `irrelevant` (everything, and columns that mean nothing)
    columns: Literal["some", "missing", "irrelevant"] = "some"
    masses: Literal["right", "wrong", "absent"] = "right"  # what robot.yaml says about the links' masses
    # `gaussian`, `outliers` (2 % bad shots), `heavy_tails` (Student's t with 3 degrees of freedom), `rough` (see
    # `armscope.world.rough.rough_noise`)
    noise: Literal["gaussian", "outliers", "heavy_tails", "rough"] = "gaussian"
    rough: tuple[str, ...] = ()  # what the arm has everywhere, names of `armscope.world.rough.BLEMISHES`
    noise_stated: bool = True  # whether robot.yaml states the instrument's sigma
