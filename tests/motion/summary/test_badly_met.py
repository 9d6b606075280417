"""A run that was held out and is met many times as badly as what was fitted is an answer of its own."""

from __future__ import annotations

from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.summary.held_out_errors import HeldOutErrors
from tests.motion.moving import carrying, moved, robot


def test_a_load_of_the_run_that_is_held_out_is_not_nothing() -> None:
    """It said "Nothing is missing … met to 25 %"."""
    found = diagnose_motion(robot(), carrying(3, 8.0), MotionSettings(cutoff=15.0, held_out=("path 2",))).verdict
    assert found.answer == "cannot tell"
    assert found.unexplained.location == "run path 2"
    assert found.headline.startswith("Cannot tell what is missing. Run path 2 is met to ")


def test_another_path_of_the_same_arm_is_no_other_arm() -> None:
    settings = MotionSettings(cutoff=15.0, held_out=("path 2",))
    assert diagnose_motion(robot(), moved(robot(), 3, runs=3), settings).verdict.answer == "nothing missing"


def test_runs_that_are_met_badly_are_named_with_their_errors() -> None:
    errors = HeldOutErrors(0.2, 0.2, 0.2, fitted=0.008, badly=(("a", 0.25), ("b", 0.3)))
    assert errors.badly_words == (
        "run a is met to 25 %, run b to 30 %, where the motion that was fitted is met to 0.80 %"
    )
