"""The softest of several drives is the one that moves the tool most; by columns that are no robot's."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from armscope.diagnosis.drives_first import little_give_instead
from armscope.diagnosis.summary.soft_drives import _softest
from armscope.physics.elastic import JOINT_COMPLIANCE, LINK_BENDING
from tests.diagnosis.test_drives_first import searched

PLACED = [SimpleNamespace(effect=effect) for effect in (JOINT_COMPLIANCE, JOINT_COMPLIANCE, LINK_BENDING)]


def test_the_softest_of_two_springs_is_told_in_a_beams_place() -> None:
    search, found = searched(beam_itself=False)
    little = little_give_instead(search, found, 2)
    assert little is not None
    sizes = [abs(float(little.means(search.space.candidates[n].columns)[0])) for n in (0, 1)]
    space: Any = SimpleNamespace(families=search.space.families, candidates=search.space.candidates, placed=PLACED)
    assert _softest(space, little) == sizes.index(max(sizes))
