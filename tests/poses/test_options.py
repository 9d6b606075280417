from pathlib import Path

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.poses.obstacles import Surroundings, refusals
from armscope.poses.options import PoseOptions
from armscope.robot import load_arm

ROBOT = Path(__file__).parents[2] / "config" / "robots" / "six-axis.yaml"


def test_millimetres_and_names_are_those_of_the_command_line():
    options = PoseOptions("backlash, joint_compliance", tracker="4000,0,1500", floor_mm=100, radius_mm=50)
    around = options.around()
    assert options.names == ("backlash", "joint_compliance")
    assert (around.radius, around.floor) == (0.05, 0.1)
    np.testing.assert_allclose(around.tracker, [4, 0, 1.5])
    np.testing.assert_allclose(PoseOptions(tracker=(4000, 0, 1500)).around().tracker, around.tracker)
    assert PoseOptions(["backlash"]).names == ("backlash",)
    nothing = PoseOptions().around()
    assert (nothing.radius, nothing.floor, nothing.tracker) == (None, None, None)


def test_what_was_asked_for_is_kept():
    arm = load_arm(ROBOT)
    choice = PoseOptions(criterion="O3", floor_mm=500, candidates=100, starts=1).choose(arm, 15)
    assert choice.index == "O3"
    assert len(choice.candidates) == 100
    assert set(refusals(arm, choice.table.motor_angles, Surroundings(floor=0.5))) == {""}


@pytest.mark.parametrize("tracker", ["here", "1,2", (1, 2), (1, 2, float("nan")), 5])
def test_a_tracker_stands_somewhere(tracker):
    with pytest.raises(InputError, match="three numbers"):
        PoseOptions(tracker=tracker).around()


def test_a_criterion_is_one_of_five():
    with pytest.raises(InputError, match="O1, O2, O3, O4 or O5"):
        PoseOptions(criterion="O9").choose(load_arm(ROBOT), 15)
