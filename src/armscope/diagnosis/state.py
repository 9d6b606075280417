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
    """Where the rounds ended.

    Attributes:
        space: what competed.
        problem: the normal equations and priors of the last round.
        blocks: its normal equations by block of rows.
        point: where they were linearised.
        found: the best hypothesis.
        best: the same with names.
        fit: the exact fit of ``best``.
        scatter: of motors that stand elsewhere each time.
        growth: of the noise with the distance.
        table: the rows, with what the rounds computed on them.
    """

    space: EffectSpace
    problem: Problem
    blocks: list[NormalEquations]
    point: FittedModel
    found: Hypothesis
    best: Hypothesis
    fit: Refit
    scatter: tuple[Scattered, ...]
    growth: Growth | None
    table: LinearisedTable


@dataclass(frozen=True, eq=False)
class DiagnosisState(Selected):
    """Where the rounds of selection ended, and what they started from.

    Attributes:
        start: the arm with its frames fitted, without effects.
        recordings: the rows.
        first: what the free frames leave of them.
        noise: what was known of it beforehand.
        notices: said already, before anything was selected.
        split: which block and fold each row is in.
        floor: height in the base frame below which no pose may be asked for, m; None: that is not known.
    """

    start: FittedModel
    recordings: Recordings
    first: ChannelResiduals
    noise: Noise
    notices: tuple[Notice, ...]
    split: RowSplit
    floor: float | None = None
