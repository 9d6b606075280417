"""Where temperatures are recorded, a zero that moved is that: one that also drifts, which contains it, is no rival."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.comparison.changes import compare
from armscope.recordings import Recordings
from tests.comparison.test_changes import ARM, session


def warm(table: Recordings, seed: int) -> Recordings:
    return replace(table, temperature=np.random.default_rng(seed).uniform(20, 30, len(table)))


def test_a_zero_that_moved_has_no_doubt_from_one_that_also_drifts():
    before, after = warm(session(1), 1), warm(session(2, offsets={2: 5e-4}.items()), 2)
    found = compare(ARM, {"a": before, "b": after})
    (change,) = found.changes
    assert (change.effect, change.location, change.alternatives) == ("joint_offset", "joint 2", ())
    assert "or another" not in found.headline
