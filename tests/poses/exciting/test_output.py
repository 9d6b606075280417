"""What is said beside a motion: what collisions were looked for with, and what its share does not promise."""

from pathlib import Path
from types import SimpleNamespace

from armscope.poses.exciting.output import ONLY_THESE_PAIRS, motion_notes
from armscope.poses.obstacles import Surroundings
from armscope.robot import load_arm

ARM = load_arm(Path(__file__).parents[3] / "config" / "robots" / "sk120.yaml")


def test_a_motion_for_pairs_promises_nothing_of_others():
    limits = SimpleNamespace(assumed=("speeds assumed",))
    found = SimpleNamespace(arm=ARM, around=Surroundings(0.161, -0.1), limits=limits, pairs=())
    told = motion_notes(found)
    assert told[:2] == ["speeds assumed", "collisions: a floor at -100 mm"]
    assert any("link 2 and link 4 within 125 mm" in note for note in told)
    assert ONLY_THESE_PAIRS not in told
    found.pairs = ((("torque_offset", "joint 1"), ("cable_torque", "joint 1")),)
    assert motion_notes(found)[-1] == ONLY_THESE_PAIRS
