"""A load that some runs carry and the table does not tell: what gives way is loaded otherwise in them.

Nothing jumped in such an arm, though its joints stand elsewhere from a run on, by more the more they are loaded.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from armscope.core.words import rounded
from armscope.physics.clause import Told
from armscope.physics.drift import when
from armscope.physics.effect import Cure, Driver, Effect, Part, Placed, Product, Term
from armscope.physics.model import FittedModel
from armscope.physics.payload import what_bears
from armscope.physics.placing import nowhere
from armscope.physics.set_ups import in_order_of_time
from armscope.recordings import Recordings


def payload_changes(recordings: Recordings, elastic: Sequence[Part]) -> Iterator[Placed]:
    """A load from some run on, or in one run alone, beside what is stated: first-order in what gives way at present.

    Args:
        recordings: the rows.
        elastic: parts of the model, as they are fitted at present.

    Yields:
        One per run but the first, and one more per run that is neither first nor last, kg at the tool point.
    """
    loaded = what_bears(recordings, elastic)
    runs = in_order_of_time(recordings) if loaded else []
    for number, run in enumerate(runs[1:], 1):
        yield _carried(loaded, [run], f"in run {run} alone")
        if run != runs[-1]:
            yield _carried(loaded, runs[number:], f"from run {run} on")


def _carried(loaded: Sequence[Product], runs: Sequence[str], told: str) -> Placed:
    through = tuple(Product(g.direction, Driver("heavier during run", (g.driver, *runs)), g.factor) for g in loaded)
    mass = Term("mass", "kg", 1.0, through, math.inf)
    return Placed(PAYLOAD_CHANGE, "payload", (mass,), (1.0,), told, variant=told)


def carrying_as_stated(model: FittedModel) -> FittedModel:
    """A model without the loads that recorded runs carried unsaid: what an arm will carry is what is stated then."""
    return replace(model, parts=tuple(part for part in model.parts if part.placed.effect is not PAYLOAD_CHANGE))


def _changed(told: Told) -> str:
    mass = told.numbers["mass"].value
    return f"the payload is {rounded(abs(mass))} kg {'heavier' if mass > 0 else 'lighter'} than stated{when(told)}"


PAYLOAD_CHANGE = Effect(
    "payload_change",
    "elastic",
    nowhere,  # it needs a model that gives way
    "Some runs were recorded with another load than the table says, so everything that gives way is loaded otherwise.",
    "Ask who recorded the runs what the arm carried in each (a gripper, a target's holder, a workpiece), and weigh it.",
    Cure(
        "State in column payload_kg what each run carried, and diagnose again.",
        otherwise="It is no error of the arm.",
        change="recordings",
        instruction="State in payload_kg what the arm carried in each run, and diagnose again: reset no zero for it.",
    ),
    clauses=(_changed, "the payload is another one than stated"),
    labels={"mass": "is heavier by"},
    atlas="gravity load",
    needs=("several runs",),
    requires="elastic",
    several=True,
)

EFFECTS = [PAYLOAD_CHANGE]
