"""Errors of measured orientations that go with the tool's attitude: seen by orientations, and by nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.rotations import turned_by
from armscope.measurement.channel import ORIENTATIONS
from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel, predict, predict_orientation
from armscope.physics.model_file import load_model, save_model
from armscope.physics.orientation_error import orientation_errors
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..diagnosis.planted import one_run
from .scenes import arm_named

ROWS = 80


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("six-axis")


@pytest.fixture(scope="module")
def table(arm: Arm) -> Recordings:
    rows = one_run(arm, ROWS, 3)
    return replace(rows, orientation=Rotation.random(ROWS, rng=1).as_quat(scalar_first=True))


def test_columns_are_turns_of_the_tool_and_move_no_point(arm: Arm, table: Recordings) -> None:
    scene = Scene(arm, table)
    posture = scene.posture()
    for placed in orientation_errors(table)[::7]:
        for number, term in enumerate(placed.terms):
            values = np.zeros(3)
            values[number] = 1e-6
            erring = scene.posture([Part(placed, values)])
            np.testing.assert_array_equal(erring.tool, posture.tool)
            turn = Rotation.from_matrix(
                erring.seen_rotation @ np.swapaxes(posture.frames.tool_rotation, 1, 2)
            ).as_rotvec()
            (product,) = term.products
            column = ORIENTATIONS.sensitivity(posture, product.direction) * scene.driver(product.driver)[:, None]
            np.testing.assert_allclose(1e6 * turn, column, atol=1e-6)
            assert posture.displacement(product.direction) is None


def test_waves_of_all_attitudes_are_orthogonal(arm: Arm, table: Recordings) -> None:
    """Mean squares over the rotations: one over an entry's row (Peter and Weyl); a Monte-Carlo of 20,000."""
    scene = Scene(arm, one_run(arm, 1, 0))
    many = Rotation.random(20_000, rng=2).as_matrix()
    scene.nominal = replace(scene.nominal, tool_rotation=many)
    waves = np.stack([scene.driver(placed.terms[0].products[0].driver) for placed in orientation_errors(table)])
    expected = np.diag([1 / 3] * 9 + [1 / 5] * 25)
    np.testing.assert_allclose(waves @ waves.T / len(many), expected, atol=0.015)


def test_all_together_are_as_large_as_is_plausible(table: Recordings) -> None:
    placed = orientation_errors(table)
    mean_square = sum(each.prior_scale[0] ** 2 / (3 if n < 9 else 5) for n, each in enumerate(placed))
    assert mean_square == pytest.approx(1e-6 * (1 + 1 / 4))


@pytest.mark.parametrize(("oriented", "waves"), [(0, 0), (17, 0), (18, 9), (67, 9), (68, 34)])
def test_few_orientations_tell_few_waves(table: Recordings, oriented: int, waves: int) -> None:
    quaternions = np.where(np.arange(ROWS)[:, None] < oriented, table.quaternions, np.nan)
    assert len(orientation_errors(replace(table, orientation=quaternions))) == waves


def test_a_model_that_holds_them_is_written_and_read_and_predicts_as_without(
    arm: Arm, table: Recordings, tmp_path
) -> None:
    placed = orientation_errors(table)[20]
    still = FittedModel(arm, {"": Base(turned_by(np.array([0.1, 0.2, 0.3])), np.zeros(3))})
    model = replace(still, background=(Part(placed, np.array([1e-3, 0.0, -1e-3])),))
    save_model(tmp_path / "model.yaml", model)
    read = load_model(tmp_path / "model.yaml")
    rows = replace(table, run=np.full(ROWS, ""))
    assert ORIENTATIONS.own_values(read) == 2
    np.testing.assert_array_equal(
        read.scene(rows).misread(read.everything), model.scene(rows).misread(model.everything)
    )
    np.testing.assert_array_equal(predict(read, rows), predict(still, rows))
    np.testing.assert_array_equal(predict_orientation(read, rows), predict_orientation(still, rows))
