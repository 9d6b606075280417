"""What a model file of a motion may hold; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class ModelFileRules(Constants):
    """What a model file may hold."""

    largest: float = 1e9
    """of any number [SI]; judgement: no arm comes near it; squares of larger ones overflow"""
    least_knots: int = 4
    """of a free curve [columns]; derived: a cubic spline has no fewer"""


MODEL_FILE = ModelFileRules()
