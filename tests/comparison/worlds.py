"""An arm that is moved, and measured, with zeros that are off: what is advised is executed on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.fitting.linearisation import point_residuals
from armscope.fitting.registration import fit_frames
from armscope.recordings import Recordings
from armscope.robot import chain
from tests.comparison.test_changes import ARM, session

NOISE_M = 3e-5


def recorded(q: Array, zeros: Mapping[int, float], rng: np.random.Generator) -> Recordings:
    """Rows of an arm whose joints are off by ``zeros`` (rad by joint) and by nothing else."""
    turned = q.copy()
    for joint, size in zeros.items():
        turned[:, joint - 1] += size
    points = chain(ARM, turned).tool
    return replace(session(1, rows=len(q)), motor_angles=q, positions=points + rng.normal(0, NOISE_M, points.shape))


def off(q: Array, zeros: Mapping[int, float]) -> float:
    """What base and tool leave of such an arm, RMS per axis, mm."""
    table = recorded(q, zeros, np.random.default_rng(99))
    return rms(point_residuals(fit_frames(ARM, table), table))
