"""The check figure shows every run and every joint."""

import numpy as np

from armscope.report.check_figure import draw_check
from armscope.report.style import save_figure
from tests.calibration.worlds import far_away, measured, poses, ur_like


def test_points_and_coverage_are_drawn_with_units_and_every_row_is_counted(tmp_path):
    rng = np.random.default_rng(0)
    arm = ur_like(joint_limits_deg=[[-150, 150]] * 6)
    recordings = measured(arm, poses(rng, 60, 6), far_away(rng), {"": [0, 0, 0.1]})
    for robot in (arm, None):
        figure = draw_check(recordings, robot)
        panels = {axes.get_xlabel() + axes.get_ylabel(): axes for axes in figure.axes}
        assert {"x (m)y (m)", "x (m)z (m)"} < set(panels)
        coverage = panels["joint angle (degrees)"]
        counts = coverage.collections[0].get_array()
        assert np.ma.filled(counts, 0).reshape(6, -1).sum(axis=1).tolist() == [60] * 6
        assert len(coverage.lines) == (12 if robot is arm else 0)
        written = save_figure(figure, tmp_path / "check.png", ["png"])
        assert written[0].stat().st_size > 5000
