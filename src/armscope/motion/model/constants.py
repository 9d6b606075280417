"""What a model file of a motion may hold; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class ModelFileRules(Constants):
    """What a model file may hold."""

    largest: float = constant(
        1e9, "of any number", "judgement: no arm comes near it; squares of larger ones overflow", unit="SI"
    )
    least_knots: int = constant(4, "of a free curve", "derived: a cubic spline has no fewer", unit="columns")


MODEL_FILE = ModelFileRules()
