"""Chosen poses are told in words: a notebook shows no arrays."""

from pathlib import Path

from armscope.notebook.chosen import ChosenPoses
from armscope.poses.choose import choose
from armscope.robot import load_arm

ROBOT = Path(__file__).parents[2] / "examples" / "one-effect" / "robot.yaml"


def test_they_say_how_many_for_what_and_what_no_pose_shows() -> None:
    chosen = ChosenPoses(**vars(choose(load_arm(ROBOT), 12, n_candidates=60, starts=1)))
    assert "12 poses of 120 kg parallelogram arm out of 60" in repr(chosen)
    assert "observability index O1" in repr(chosen)
    assert "joint 1 offset" in repr(chosen), "the base imitates it"
