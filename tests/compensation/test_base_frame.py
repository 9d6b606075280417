"""Commands in the arm's own base frame, executed where recordings do not tell base, tool and instrument apart."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.fitting.registration import fit_frames
from armscope.physics.model import AsStated
from armscope.physics.model_file import load_model, save_model
from armscope.robot import chain
from tests.calibration.worlds import far_away, measured

from .keeping import (
    NOISE_M,
    commanded,
    downward_poses,
    level_poses,
    missed_mm,
    palletiser,
    recordings,
    six_axes,
)

LEVEL = (AsStated("tool z", "base z"),)
ZERO = 8e-4


@pytest.mark.parametrize("zero", [0.0, ZERO])
def test_a_palletiser_stays_as_good_as_it_was_or_becomes_better(zero, tmp_path):
    arm, rng, zeros = palletiser(), np.random.default_rng(3), np.array([0.0, zero, 0.0, 0.0])
    rows, angles = recordings(arm, level_poses(rng, 60), rng, zeros), 0.8 * level_poses(rng, 20)
    found, result = commanded(arm, rows, angles)
    assert missed_mm(arm, angles, result.commands, zeros) < 0.02
    assert found.model.undetermined == LEVEL
    save_model(tmp_path / "model.yaml", found.model)
    assert load_model(tmp_path / "model.yaml").undetermined == LEVEL
    assert any("not tell tool z from base z" in note for note in result.notes)
    assert any(notice.kind == "tool as stated" for notice in found.notices)
    assert not any("tool_mm" in note for note in commanded(arm, rows, angles, frame="measurement")[1].notes)


def test_an_arm_whose_flange_looks_down_becomes_better():
    arm, rng, zeros = six_axes(), np.random.default_rng(4), np.array([0, 0, ZERO, 0, 0, 0])
    angles = downward_poses(rng, 60)
    found, result = commanded(arm, recordings(arm, angles, rng, zeros), angles[:20])
    assert missed_mm(arm, angles[:20], angles[:20], zeros) > 0.4
    assert missed_mm(arm, angles[:20], result.commands, zeros) < 0.03
    assert found.model.undetermined == LEVEL
    np.testing.assert_allclose(found.model.tools[0].values[2], 0.0, atol=2e-5)


@pytest.mark.parametrize("lean", [0.02, 2.5])
def test_a_tool_that_is_stated_wrongly_is_found_where_poses_tell_it(lean):
    """By 0.15 m, as a tool_mm left at zero is: nothing of that may be kept, even where poses lean by a degree."""
    arm, rng = six_axes((0.0, 0.0, 0.0)), np.random.default_rng(5)
    angles = downward_poses(rng, 80) + lean * rng.uniform(-1, 1, (80, 6)) * [0, 0, 0, 1, 1, 1]
    tool = np.array([0.03, -0.045, 0.15])
    model = fit_frames(arm, recordings(arm, angles, rng, tool=tool))
    np.testing.assert_allclose(model.tools[0].values, tool, atol=1.5e-3 if lean < 1 else 2e-5)
    assert not model.undetermined


def set_up_again(arm, angles, zeros, rng, move_m):
    """The same arm from two places of the instrument, a little apart."""
    rotation, translation = far_away(rng)
    parts = [
        measured(arm, angles[half] + zeros, (rotation, translation + move), {"": arm.tool}, NOISE_M, rng, run=run)
        for half, move, run in ((slice(0, 50), 0.0, "mon"), (slice(50, 100), move_m, "tue"))
    ]
    joined = {n: np.concatenate([getattr(p, n) for p in parts]) for n in ("positions", "run", "target", "id")}
    return replace(parts[0], **joined, motor_angles=angles, number=np.arange(1.0, 101.0))


def test_where_the_instrument_stood_is_nothing_to_commands_in_the_base_frame():
    arm, rng, zeros = six_axes(), np.random.default_rng(12), np.array([0, 0, 5e-4, 0, 0, 0])
    angles = rng.uniform(-2, 2, (100, 6))
    rows = set_up_again(arm, angles, zeros, rng, np.array([2e-3, 1e-3, -1.5e-3]))
    found, result = commanded(arm, rows, angles[:20])
    assert "or the instrument was set up again" in found.headline
    before = missed_mm(arm, angles[:20], angles[:20], zeros)
    told = 1e3 * np.sqrt(np.nanmean(result.uncorrected**2))
    assert told == pytest.approx(before, rel=0.05), "what is told is the arm's, not the instrument's"
    assert missed_mm(arm, angles[:20], result.commands, zeros) < 0.03


def test_orientations_are_right_but_for_one_turn_on_the_flange():
    """The zero of the last joint hides in how the tool sits; what is left is the same turn about it at every point."""
    arm, rng, zeros = six_axes(), np.random.default_rng(6), np.array([0, 0, ZERO, 0, -6e-4, 2e-3])
    angles = rng.uniform(-2, 2, (90, 6))
    _, result = commanded(arm, recordings(arm, angles, rng, zeros), angles[:20], pose=True)
    at = np.flatnonzero(result.reached)
    assert len(at) > 10
    wanted, reached = (chain(arm, q).tool_rotation for q in (angles[at], result.commands[at] + zeros))
    left = np.swapaxes(wanted, 1, 2) @ reached
    turns = np.stack([left[:, 2, 1] - left[:, 1, 2], left[:, 0, 2] - left[:, 2, 0], left[:, 1, 0] - left[:, 0, 1]]) / 2
    assert np.linalg.norm(turns.mean(axis=1)) == pytest.approx(2e-3, rel=0.05)
    assert turns.std(axis=1).max() < 5e-5
    assert any("the zero of the last joint" in note for note in result.notes)
    assert result.turn_open


@pytest.mark.parametrize("frame", ["base", "measurement"])
def test_a_loose_target_makes_no_command_in_the_arms_own_base_wrong_and_is_told_of_in_the_others(frame):
    """A stiff arm without an error, whose target falls by 0.3 mm along an axis of the tool that leans."""
    arm, rng = six_axes(), np.random.default_rng(6)
    angles = rng.uniform(-1, 1, (80, 6)) * [2.0, 0.6, 0.6, 2.0, 1.5, 2.0]
    rows = recordings(arm, angles, rng)
    frames = chain(arm, angles)
    pull = frames.tool_rotation.transpose(0, 2, 1) @ [0, 0, -1.0] @ (direction := np.array([0.48, -0.6, 0.64]))
    falls = np.einsum("nij,nj->ni", frames.tool_rotation, np.outer(3e-4 * np.sign(pull), direction))
    seen = Rotation.align_vectors(*(points - points.mean(axis=0) for points in (rows.positions, frames.tool)))[0]
    table = replace(rows, positions=rows.positions + seen.apply(falls))
    found, result = commanded(arm, table, angles[:20], frame=frame)
    assert [effect.effect for effect in found.effects] == ["loose_target"]
    assert any("the target is loose" in note for note in result.notes) == (frame == "measurement")
    if frame == "base":
        assert missed_mm(arm, angles[:20], result.commands, np.zeros(6)) < 0.005
