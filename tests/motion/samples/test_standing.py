"""A slide's strokes are short beside a hinge's turns in the same numbers, and it moves all the same."""

from __future__ import annotations

import numpy as np

from armscope.motion.check import doubts_about
from armscope.motion.samples.standing import still_span
from armscope.recordings.motions import Motions

TIME = np.arange(2000) / 100


def test_a_slide_of_short_strokes_does_not_stand() -> None:
    """15 mm to and fro was less than a degree."""
    q = np.column_stack([np.sin(TIME), 0.0075 * np.sin(3 * TIME)])
    effort = np.random.default_rng(1).normal(size=q.shape)
    motions = Motions(TIME, q, effort, "torque", np.array([False, True]), np.full(len(TIME), "a"))
    assert not [notice for notice in doubts_about(motions) if notice.kind == "joint stands"]


def test_servo_noise_is_no_motion_of_either() -> None:
    hinge, slide = still_span(np.array([False, True]))
    assert 1e-3 < slide < 0.0075 < hinge < 0.1
