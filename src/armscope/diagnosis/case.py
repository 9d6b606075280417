"""Everything that the judgement rests on."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.diagnosis.noise import Noise
from armscope.diagnosis.rounds import Selected
from armscope.diagnosis.validation import Blocks
from armscope.diagnosis.verdict import Notice
from armscope.diagnosis.weights import Missed
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


@dataclass(frozen=True, eq=False)
class Evidence(Selected):
    """Where the rounds of selection ended, and what they started from; ``first``: what the free frames leave."""

    start: FittedModel
    recordings: Recordings
    first: Missed
    noise: Noise
    notices: tuple[Notice, ...]
    layout: Blocks
