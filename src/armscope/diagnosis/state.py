"""Everything that the judgement rests on."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.diagnosis.held_out import RowSplit
from armscope.diagnosis.selection_loop import Selected
from armscope.measurement.channel import ChannelResiduals
from armscope.measurement.noise import Noise
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.verdict.schema import Notice


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
    """

    start: FittedModel
    recordings: Recordings
    first: ChannelResiduals
    noise: Noise
    notices: tuple[Notice, ...]
    split: RowSplit
