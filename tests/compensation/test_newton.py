"""A path solved some rows at a time, by several processes, gives what it gives at once."""

from dataclasses import replace

import numpy as np

from armscope.compensation import newton
from armscope.compensation.constants import COMMANDS
from armscope.compensation.forward import NominalArm
from armscope.compensation.newton import Wanted, correct, solve_commands
from armscope.core.parallel import processes
from armscope.robot import load_arm, tool_frames


def test_pieces_and_processes_do_not_matter(monkeypatch):
    arm = load_arm("config/robots/six-axis.yaml")
    rng = np.random.default_rng(1)
    angles = rng.uniform(-0.6, 0.6, (50, arm.n_motors))
    wanted, start = Wanted(tool_frames(arm, angles)[0]), angles + rng.normal(0, 0.02, angles.shape)
    free = np.ones(arm.n_motors, dtype=bool)
    whole = solve_commands(NominalArm(arm), wanted, start, free)
    monkeypatch.setattr(newton, "COMMANDS", replace(COMMANDS, rows_at_a_time=7))
    with processes(2):
        pieces = solve_commands(NominalArm(arm), wanted, start, free)
    np.testing.assert_allclose(pieces.angles, whole.angles, atol=1e-12)
    assert np.array_equal(pieces.converged, whole.converged)
    assert whole.converged.all()


def test_what_is_missed_is_told_before_and_after():
    arm = load_arm("config/robots/six-axis.yaml")
    angles = np.random.default_rng(2).uniform(-0.5, 0.5, (4, arm.n_motors))
    points = tool_frames(arm, angles)[0]
    found = correct(NominalArm(arm), Wanted(points + 1e-3), angles, np.ones(arm.n_motors, dtype=bool), np.arange(4))
    np.testing.assert_allclose(found.uncorrected, np.sqrt(3) * 1e-3)
    np.testing.assert_allclose(found.predicted, points + 1e-3, atol=1e-9)
    assert np.isnan(found.residual_turn).all()
