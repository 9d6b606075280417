"""What rows do not tell of tool and base stays as stated; what they tell, or refute, does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.fitting.gauge import FrameColumns, Gauge, NamedFrames, covariance_of_others, gauge, untold_directions
from armscope.fitting.linearisation import point_residuals
from armscope.fitting.placement import frame_columns
from armscope.fitting.registration import fit_frames
from armscope.physics.frames import free_frames
from armscope.physics.model import AsStated
from armscope.recordings import Recordings
from tests.calibration.worlds import together

from ..compensation.keeping import level_poses, palletiser, recordings

AT = FrameColumns(np.arange(9), np.arange(6, 9))


def information(lean: float, rows: int = 60) -> NDArray[np.float64]:
    """(9, 9) of a base and a tool that turns about one axis, its attitude scattering by ``lean`` about others."""
    rng = np.random.default_rng(1)
    turned = Rotation.from_rotvec(rng.uniform(-1, 1, (rows, 3)) * [lean, lean, 3.0]).as_matrix()
    one = np.zeros(rows, dtype=np.intp)
    X = 1e3 * frame_columns(rng.uniform(-1, 1, (rows, 3)), turned, one, one, (1, 1)).reshape(-1, 9)
    return np.asarray(X.T @ X)


def held(lean: float, off_mm: float, noise_mm: float = 0.02) -> Gauge | None:
    """What is held of a tool that was fitted ``off_mm`` along its axis."""
    matrix = information(lean)
    return gauge(matrix, matrix, AT, np.array([0.0, 0.0, 1e-3 * off_mm]), noise_mm)


@pytest.mark.parametrize("lean", [0.0, 1e-4])
def test_a_shift_along_the_axis_about_which_the_tool_turns_is_the_bases(lean: float) -> None:
    found = held(lean, 12.0)
    assert found is not None
    np.testing.assert_allclose(np.abs(found.directions[:, 0]), [0, 0, 1], atol=1e-3)
    np.testing.assert_allclose(found.step[[2, 8]], [0.012, -0.012], rtol=1e-3)
    np.testing.assert_allclose(found.step[[0, 1, 6, 7]], 0.0, atol=2e-5)


def test_what_poses_tell_is_free() -> None:
    assert held(0.1, 12.0) is None
    assert not untold_directions(information(0.1), AT, 0.02).shape[1]


def test_what_is_told_weakly_is_held_unless_the_rows_refute_it() -> None:
    """A lean of a thousandth tells the tool to some 4 mm: 5 mm off is chance, 150 mm are not."""
    assert held(1e-3, 5.0) is not None
    assert held(1e-3, 150.0) is None


def test_nothing_is_uncertain_along_what_is_held() -> None:
    matrix = information(1e-4) + 1e-3 * np.eye(9)
    found = held(1e-4, 0.0)
    assert found is not None
    inverse = covariance_of_others(matrix, AT.tools, found.directions)
    assert np.abs(found.directions.T @ inverse[6:]).max() < 1e-12
    assert inverse[2, 2] < 1e-3 * np.linalg.inv(matrix)[2, 2]


def two_tools() -> tuple[Recordings, NDArray[np.float64]]:
    """A palletiser's points of two targets in two runs, the second target 40 mm above the first."""
    arm, rng = palletiser(), np.random.default_rng(2)
    tables = []
    for run, target, above in (("a", "one", 0.0), ("a", "two", 0.04), ("b", "one", 0.0), ("b", "two", 0.04)):
        rows = recordings(arm, level_poses(rng, 40), np.random.default_rng(3), tool=arm.tool + np.array([0, 0, above]))
        tables.append(replace(rows, run=np.full(40, run), target=np.full(40, target)))
    whole = together(*tables)
    number = np.arange(1.0, len(whole.run) + 1)
    return replace(whole, number=number, id=number.astype(int).astype(str)), np.array([0.0, 0.04])


def test_of_two_targets_what_lies_between_them_is_told_and_their_mean_is_not() -> None:
    rows, above = two_tools()
    model = fit_frames(palletiser(), rows)
    z = np.array([part.values[2] for part in model.tools])
    np.testing.assert_allclose(z - z.mean(), above - above.mean(), atol=2e-5)
    assert abs(z.mean()) < 1e-6
    assert np.sqrt(np.mean(point_residuals(model, rows) ** 2)) < 0.025


def test_it_is_told_in_the_axes_of_tool_and_base() -> None:
    arm, rng = palletiser(), np.random.default_rng(2)
    rows = recordings(arm, level_poses(rng, 40), rng)
    terms = tuple(term for placed in free_frames(rows, False) for term in placed.terms)
    named = NamedFrames.among(terms, np.arange(len(terms)))
    np.testing.assert_array_equal(named.tools, [6, 7, 8])
    np.testing.assert_array_equal(named.bases, [0, 1, 2])
    found = held(0.0, 1.0)
    assert found is not None
    assert named.told(found) == (AsStated("tool z", "base z"),)
