"""What the rounds of selection leave behind for the judgement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.diagnosis.evidence import Hypothesis, Problem
from armscope.diagnosis.noise import Growth, Noise
from armscope.diagnosis.problem import Gram
from armscope.diagnosis.refit import Refit
from armscope.diagnosis.scatter import Scattered
from armscope.diagnosis.validation import Blocks
from armscope.diagnosis.verdict import Notice
from armscope.diagnosis.weights import Missed
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Evidence:
    """Everything that the rounds of selection leave behind.

    ``first`` is what the free frames alone leave; ``point`` is where ``blocks`` were linearised; ``best`` is ``found``
    with names.
    """

    start: FittedModel
    recordings: Recordings
    first: Missed
    noise: Noise
    notices: tuple[Notice, ...]
    layout: Blocks
    problem: Problem
    blocks: list[Gram]
    point: FittedModel
    found: Hypothesis
    best: Hypothesis
    fit: Refit
    scatter: tuple[Scattered, ...]
    growth: Growth | None
