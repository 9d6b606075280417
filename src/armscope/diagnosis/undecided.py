"""The verdict where the rows do not allow one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.summary.unexplained import together
from armscope.measurement.noise import Noise
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.verdict.diagnosis import Diagnosis, Residuals
from armscope.verdict.schema import HeldOut, Notice, Unexplained
from armscope.verdict.sentences import headline


def undecided(
    start: FittedModel,
    recordings: Recordings,
    residuals: Array,
    noise: Noise,
    notices: tuple[Notice, ...],
    seconds: float,
) -> Diagnosis:
    """The verdict where no effect can honestly be named.

    Args:
        start: the arm with its frames.
        recordings: N rows.
        residuals: (N, 3) mm after the frames.
        noise: what is known of it.
        notices: why nothing can be named.
        seconds: taken so far.

    Returns:
        The verdict.
    """
    rms = float(np.sqrt(np.mean(residuals**2)))
    points = start.to_base(recordings.positions, recordings.run) * 1e3
    count = len(recordings)
    draft = Diagnosis(
        arm=start.arm.name,
        source=recordings.source,
        recordings=recordings,
        rows=count,
        runs=tuple(str(run) for run in np.unique(recordings.run)),
        answer="cannot tell",
        headline="",
        mismatch=None,
        noise_mm=noise.stated_mm or float("nan"),
        noise_source=noise.source,
        residual_before_mm=rms,
        residual_after_mm=rms,
        effects=(),
        background=together(()),
        background_families=(),
        unexplained=Unexplained(False),
        held_out=HeldOut(float("nan"), float("nan")),
        waterfall=(),
        atlas=None,
        residuals=Residuals(points, residuals, residuals, np.ones(count), recordings.id, recordings.run),
        suspects=(),
        next_poses=None,
        notices=notices,
        model=start,
        seconds=seconds,
    )
    return replace(draft, headline=headline(draft))
