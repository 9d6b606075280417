"""Everything that the judgement rests on."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.diagnosis.held_out import RowSplit
from armscope.diagnosis.model_space import EffectSpace
from armscope.fitting.joint_scatter import Scattered
from armscope.fitting.linearisation import LinearisedTable
from armscope.fitting.refit import Refit
from armscope.inference.evidence import Hypothesis
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem
from armscope.measurement.channel import ChannelResiduals
from armscope.measurement.noise import Growth, Noise
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.verdict.schema import Notice


@dataclass(frozen=True, eq=False)
class Selected:
    """Where the rounds ended."""

    space: EffectSpace  # what competed
    problem: Problem  # the normal equations and priors of the last round
    blocks: list[NormalEquations]  # its normal equations by block of rows
    point: FittedModel  # where they were linearised
    found: Hypothesis  # the best hypothesis
    best: Hypothesis  # the same with names
    fit: Refit  # the exact fit of ``best``
    scatter: tuple[Scattered, ...]  # of motors that stand elsewhere each time
    growth: Growth | None  # of the noise with the distance
    table: LinearisedTable  # the rows, with what the rounds computed on them


@dataclass(frozen=True, eq=False)
class DiagnosisState(Selected):
    """Where the rounds of selection ended, and what they started from."""

    start: FittedModel  # the arm with its frames fitted, without effects
    recordings: Recordings  # the rows
    first: ChannelResiduals  # what the free frames leave of them
    noise: Noise  # what was known of it beforehand
    notices: tuple[Notice, ...]  # said already, before anything was selected
    split: RowSplit  # which block and fold each row is in
    # height in the base frame below which no pose may be asked for, m; None: that is not known
    floor: float | None = None
