"""The check figure shows every run and every joint."""

from dataclasses import replace

import numpy as np

from armscope.report.figures.check import draw_check
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


def test_runs_on_the_same_poses_do_not_hide_each_other():
    rng = np.random.default_rng(0)
    arm, angles = ur_like(), poses(rng, 40, 6)
    still = np.tile(angles[:1] + 0.1, (40, 1))
    recordings = measured(arm, np.vstack([angles, angles, angles, still]), far_away(rng), {"": [0, 0, 0.1]})
    recordings = replace(recordings, run=np.repeat(["first", "again", "and again", "one point"], 40))
    lines = draw_check(recordings, arm).axes[0].lines
    assert [line.get_markerfacecolor() == "none" for line in lines] == [False, True, True, False]
    assert lines[0].get_markersize() < lines[1].get_markersize() < lines[2].get_markersize()
    assert lines[3].get_marker() == "D"


def test_limits_are_inside_the_axes_and_the_points_of_long_tables_are_thinned(monkeypatch):
    rng = np.random.default_rng(0)
    monkeypatch.setattr("armscope.report.figures.check.MOST_POINTS", 30)
    arm = ur_like(joint_limits_deg=[[-360, 360]] * 6)
    recordings = measured(arm, poses(rng, 60, 6), far_away(rng), {"": [0, 0, 0.1]})
    figure = draw_check(recordings, arm)
    assert len(figure.axes[0].lines[0].get_xdata()) == 30
    coverage = next(axes for axes in figure.axes if "angle" in axes.get_xlabel())
    assert coverage.get_xlim() == (-360, 360)
    assert np.ma.filled(coverage.collections[0].get_array(), 0).sum() == 6 * 60
