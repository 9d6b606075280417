"""The figure of an exciting motion shows every joint within its limits."""

import numpy as np

from armscope.poses.exciting.output import trajectory_table
from armscope.poses.exciting.search import MotionRequest, excite
from armscope.poses.obstacles import Surroundings
from armscope.report.figures.exciting_motion import motion_figure
from armscope.robot import load_arm
from tests.world.motion.arms import FOLDER


def test_every_joint_is_drawn_and_stays_within_what_is_drawn_as_its_limit():
    arm = load_arm(FOLDER / "two-axis.yaml")
    found = excite(arm, MotionRequest(period=5.0, rounds=5), Surroundings(radius=0.01))
    figure = motion_figure(found, trajectory_table(found, 100))
    panels = figure.axes
    assert [len([line for line in panel.lines if len(line.get_xdata()) > 2]) for panel in panels] == [2] * 4
    for panel in panels[1:]:
        for line in panel.lines:
            assert np.abs(line.get_ydata()).max() <= 1 + 1e-9
    assert "condition number" in panels[0].get_title(loc="left")
