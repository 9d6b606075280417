"""What is said beside a motion: what collisions were looked for with, and what its share does not promise."""

import json
from pathlib import Path
from types import SimpleNamespace

import pandas as pd

from armscope.poses.exciting.output import ONLY_THESE_PAIRS, motion_notes, write_excitation
from armscope.poses.exciting.search import MotionRequest, excite
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


def test_what_is_largest_is_that_of_the_table_which_is_played(tmp_path: Path) -> None:
    """Planned on a coarser grid, shares of the limits were up to a hundredth below those of the table beside them."""
    six = load_arm(Path(__file__).parents[3] / "examples" / "moving-arm" / "robot.yaml")
    found = excite(six, MotionRequest(period=10.0, rounds=0, seed=1), Surroundings(radius=0.01))
    write_excitation(tmp_path / "motion.csv", found, 500.0)
    told = json.loads((tmp_path / "motion.json").read_text())["largest"]
    table = pd.read_csv(tmp_path / "motion.csv")
    for motor in range(1, 7):
        speed = table[f"dq{motor}_rad_s"].abs().max() / found.limits.path.speed[motor - 1]
        assert told["speed_share"][motor - 1] >= round(speed, 4)
        assert told["torque_nm"][motor - 1] >= round(table[f"tau{motor}_nm"].abs().max(), 3)
