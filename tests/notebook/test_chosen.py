"""Chosen poses are told in words: a notebook shows no arrays."""

from pathlib import Path

import armscope
from armscope.notebook.chosen import ChosenPoses
from armscope.poses.choose import choose
from armscope.robot import load_arm

ROBOT = Path(__file__).parents[2] / "examples" / "one-effect" / "robot.yaml"


def test_they_say_how_many_for_what_and_what_no_pose_shows() -> None:
    chosen = ChosenPoses(**vars(choose(load_arm(ROBOT), 12, n_candidates=60, starts=1)))
    assert "12 poses of 120 kg parallelogram arm out of 60" in repr(chosen)
    assert "observability index O1" in repr(chosen)
    assert "joint 1 offset" in repr(chosen), "the base imitates it"


def test_they_are_compared_where_seeds_ask_for_it() -> None:
    """With the options of the command line, by their names."""
    options = {"candidates": 100, "starts": 1, "payload_kg": 0.0}
    found = armscope.choose_poses(ROBOT, 15, seeds=2, noise_mm=0.02, all_criteria=True, **options)
    assert set(found.compared["set"]) == {"chosen", "random", "grid", "O2", "O3", "O4", "O5"}
    assert set(found.compared["seed"]) == {0, 1}
    assert "compared" in repr(found)
    assert armscope.choose_poses(ROBOT, 15, **options).compared is None
