"""Sums that follow from earlier ones are those that are made anew."""

import dataclasses

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.sums import Earlier, sums_by_joint
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.timing import stretches
from tests.motion.moving import moved, robot


@pytest.fixture(scope="module")
def rows() -> MotionRows:
    arm = robot()
    train = list(stretches(moved(arm, 8)))
    how, _ = chosen_cutoff(arm, train, 10.0)
    layout = TorqueLayout(arm, tuple(place_causes(seen_in(arm, train, 0.02))), False)
    return build_rows(layout, train, how, stated_model(arm))


def weights(rows: MotionRows, moved_share: float) -> tuple[Array, Array]:
    rng = np.random.default_rng(1)
    before = rng.uniform(0.5, 1.0, rows.torque.shape) * ~rows.still
    after = np.where(rng.random(before.shape) < moved_share, rng.uniform(0, 1, before.shape) * (before > 0), before)
    after[:5] = 0.0
    return before, after


def test_sums_by_hand(rows: MotionRows) -> None:
    row, _ = weights(rows, 0.0)
    block = np.arange(len(rows)) % 2
    run = rows.run[-1]
    (part,) = (each for each in sums_by_joint(rows, row, block)[1] if (each.joint, each.run) == (2, run))
    which = (block == 1) & (rows.run == run)
    X = rows.columns[2][which].astype(np.float64)
    y = (rows.torque - rows.nominal)[which, 2]
    by_hand = X.T @ (row[which, 2][:, None] * X)
    np.testing.assert_allclose(part.sums.G, by_hand, atol=1e-12 * np.diag(by_hand).max())
    np.testing.assert_allclose(part.sums.b, X.T @ (row[which, 2] * y), atol=1e-9 * np.abs(part.sums.b).max())
    assert part.sums.yy == pytest.approx(float(row[which, 2] @ y**2))
    assert part.sums.n == pytest.approx(row[which, 2].sum())


@pytest.mark.parametrize("moved_share", [0.0, 0.05, 0.9])
@pytest.mark.parametrize("fresh", [0, 4])
def test_what_follows_from_earlier_sums_is_what_is_made_anew(rows: MotionRows, moved_share: float, fresh: int) -> None:
    before, after = weights(rows, moved_share)
    block = np.arange(len(rows)) % 3
    earlier = Earlier(rows, before, sums_by_joint(rows, before, block))
    kept = [part.sums.G.copy() for parts in earlier.blocks for part in parts]
    columns = [each.copy() for each in rows.columns]
    for each in columns:
        each[:, 3 : 3 + fresh] += np.random.default_rng(2).normal(size=(len(rows), fresh)).astype(np.float32)
    other = dataclasses.replace(rows, columns=tuple(columns))
    found, anew = sums_by_joint(other, after, block, earlier), sums_by_joint(other, after, block)
    for own, expected in zip(found, anew, strict=True):
        assert [(part.joint, part.run) for part in own] == [(part.joint, part.run) for part in expected]
        for part, known in zip(own, expected, strict=True):
            scale = np.sqrt(np.outer(np.diag(known.sums.G), np.diag(known.sums.G))) + 1e-12
            assert np.abs((part.sums.G - known.sums.G) / scale).max() < 1e-9
            np.testing.assert_allclose(part.sums.b, known.sums.b, rtol=1e-7, atol=1e-7 * np.abs(known.sums.b).max())
            assert part.sums.yy == pytest.approx(known.sums.yy)
            assert part.sums.n == pytest.approx(known.sums.n)
    for part, was in zip((part for parts in earlier.blocks for part in parts), kept, strict=True):
        np.testing.assert_array_equal(part.sums.G, was)  # the earlier ones stay as they were
