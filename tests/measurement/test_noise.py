"""What rows' noise is like: repeats that are no new poses, readings that grow worse with distance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from armscope.diagnosis import Settings, diagnose
from armscope.fitting.registration import fit_frames
from armscope.measurement.noise import distances, growth, independence_weights, poses
from armscope.recordings import Recordings
from armscope.robot import Arm
from tests.seeds import seeds

from ..diagnosis.planted import one_run, recorded
from ..physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)


@pytest.mark.parametrize(("of_pose", "of_reading"), [(0.03, 0.01), (0.02, 0.02), (0.01, 0.05)])
def test_visits_count_by_what_is_wrong_with_them(of_pose: float, of_reading: float) -> None:
    """Against the definition: how much the mean of k visits varies less than a single one."""
    rng = np.random.default_rng(1)
    pose = np.repeat(np.arange(400), 10)
    left = of_pose * rng.normal(size=(400, 3))[pose] + of_reading * rng.normal(size=(4000, 3))
    shares = independence_weights(left, pose, np.ones(4000, dtype=bool))
    means = left.reshape(400, 10, 3).mean(axis=1)
    counted = np.mean(left**2) / np.mean(means**2)
    assert shares.sum() / 400 == pytest.approx(counted, rel=0.15)


def test_visits_are_independent_where_only_the_reading_is_wrong_and_where_poses_do_not_recur() -> None:
    rng = np.random.default_rng(2)
    left = 0.02 * rng.normal(size=(4000, 3))
    everything = np.ones(4000, dtype=bool)
    np.testing.assert_array_equal(independence_weights(left, np.repeat(np.arange(400), 10), everything), 1.0)
    np.testing.assert_array_equal(independence_weights(left, np.arange(4000), everything), 1.0)


def test_a_pose_is_the_same_for_every_run_and_target() -> None:
    """What is wrong with it is the arm's, whoever looks and whenever."""
    table = one_run(arm_named("six-axis"), 6, 1).rows(np.array([0, 1, 0, 1, 0, 1]))
    table = replace(table, run=np.repeat(["1", "2"], [4, 2]), target=np.array(["a", "a", "b", "b", "a", "a"]))
    assert poses(table).tolist() == [0, 1, 0, 1, 0, 1]


def four_reflectors(arm: Arm, of_pose: float, of_reading: float, seed: int) -> Recordings:
    """Forty poses, each with an error of its own (mm per axis) that no physics explains, seen by four reflectors."""
    rng = np.random.default_rng(seed)
    once = recorded(arm, one_run(arm, 40, seed), {}, of_pose, seed=seed, turn_noise_mrad=0.0)
    turned = Rotation.from_quat(once.orientation, scalar_first=True).as_matrix()
    places = np.array([[0.0, 0, 0], [0.15, 0, 0], [0, 0.15, 0], [0, 0, 0.15]])
    points = (once.positions[:, None] + np.einsum("nij,kj->nki", turned, places)).reshape(-1, 3)
    every = once.rows(np.repeat(np.arange(40), 4))
    points += 1e-3 * of_reading * rng.normal(size=points.shape)
    return replace(
        every,
        id=np.arange(160).astype(str),
        target=np.tile(list("abcd"), 40),
        positions=points,
        orientation=None,
        time=None,
    )


@pytest.mark.parametrize("seed", seeds(5, 6, 7))
def test_reflectors_seen_at_one_pose_are_no_evidence_for_names(seed: int) -> None:
    arm = arm_named("four-axis")
    verdict = diagnose(arm, four_reflectors(arm, 0.05, 0.01, seed), QUICK)
    assert verdict.effects == ()
    assert verdict.noise_mm == pytest.approx(np.hypot(0.05, 0.01), rel=0.2)


@pytest.mark.long
def test_poses_visited_often_are_no_evidence_for_names() -> None:
    """Forty poses, each with an error of its own that no physics explains, visited 25 times each."""
    arm = arm_named("four-axis")
    rng = np.random.default_rng(3)
    table = recorded(arm, one_run(arm, 40, 5), {}, 0.05, seed=6).rows(np.tile(np.arange(40), 25))
    table = replace(
        table,
        id=np.arange(1, 1001).astype(str),
        positions=table.positions + 1e-5 * rng.normal(size=(1000, 3)),
        time=None,
    )
    verdict = diagnose(arm, table, QUICK)
    assert verdict.effects == ()
    assert verdict.noise_mm == pytest.approx(np.hypot(0.05, 0.01), rel=0.15)


def tracked(seed: int, near: float, slope: float, wanted: dict[tuple[str, str], list[float]]) -> Recordings:
    """A table whose instrument stands metres away; noise near^2 + (slope d)^2, mm and mm/m."""
    arm = arm_named("four-axis")
    table = recorded(arm, one_run(arm, 300, seed), wanted, 0.0, seed=seed + 1)
    moved = table.positions + np.array([2.6, 1.4, 0.3])
    size = 1e-3 * np.hypot(near, slope * np.linalg.norm(moved, axis=1))
    noise = size[:, None] * np.random.default_rng(seed).normal(size=(300, 3))
    return replace(table, positions=moved + noise, time=None)


STIFFNESS = {("joint_compliance", "joint 2"): [2e-7]}


@pytest.mark.long
def test_noise_that_grows_with_distance_is_found_and_its_rows_count_less() -> None:
    table = tracked(11, 0.004, 0.02, STIFFNESS)
    verdict = diagnose(arm_named("four-axis"), table, QUICK)
    (told,) = [notice.text for notice in verdict.notices if notice.kind == "noise by distance"]
    away = np.linalg.norm(table.positions, axis=1)
    assert f"at {away.max():.1f} m" in told
    assert "grows with the distance" in verdict.noise_source
    assert {(e.effect, e.location) for e in verdict.effects} == {("joint_compliance", "joint 2")}
    assert verdict.noise_mm == pytest.approx(0.02 * np.median(away), rel=0.1)


def test_the_size_of_the_growth_is_right() -> None:
    rng = np.random.default_rng(4)
    away = rng.uniform(1.5, 7.0, 3000)
    left = np.hypot(0.02, 0.015 * away)[:, None] * rng.normal(size=(3000, 3))
    found = growth(left, away, np.ones(3000, dtype=bool))
    assert found is not None
    np.testing.assert_allclose(found.at(np.array([2.0, 6.0])), np.hypot(0.02, 0.015 * np.array([2.0, 6.0])), rtol=0.04)


@pytest.mark.parametrize("seed", seeds(*range(5)))
def test_constant_noise_stays_silent(seed: int) -> None:
    rng = np.random.default_rng(seed)
    away = rng.uniform(1.5, 7.0, 2000)
    assert growth(0.03 * rng.normal(size=(2000, 3)), away, np.ones(2000, dtype=bool)) is None
    if seed == 0:
        verdict = diagnose(arm_named("four-axis"), tracked(21, 0.05, 0.0, STIFFNESS), QUICK)
        assert all(notice.kind != "noise by distance" for notice in verdict.notices)


@pytest.mark.long
@pytest.mark.parametrize("rows", [*(pytest.param(rows, marks=pytest.mark.long) for rows in (8, 20)), 50])
def test_few_rows_of_constant_noise_hardly_ever_seem_to_grow(rows: int) -> None:
    """Below 1 in 200 by the evidence asked for; a table of fifty rows that grows clearly is still seen to."""
    rng = np.random.default_rng(rows)
    all_rows = np.ones(rows, dtype=bool)
    tables = [(rng.uniform(1.5, 7.0, rows), 0.03 * rng.normal(size=(rows, 3))) for _ in range(400)]
    assert sum(growth(left, away, all_rows) is not None for away, left in tables) <= 4
    away = rng.uniform(0.5, 7.0, rows)
    assert rows < 50 or growth(np.hypot(0.01, 0.02 * away)[:, None] * rng.normal(size=(rows, 3)), away, all_rows)


@pytest.mark.long
def test_standard_errors_are_right_where_noise_grows() -> None:
    """Errors over worlds in units of their standard errors: their mean square is that of chi2, 99.8 % of the time."""
    squares = []
    for seed in range(100, 108):
        verdict = diagnose(arm_named("four-axis"), tracked(seed, 0.004, 0.02, STIFFNESS), QUICK)
        (found,) = [effect for effect in verdict.effects if effect.effect == "joint_compliance"]
        squares.append(((found.parameters[0].value - 2e-7) / found.parameters[0].stderr) ** 2)
    low, high = chi2.ppf([0.001, 0.999], len(squares))
    assert low < sum(squares) < high


def test_no_instrument_stands_within_the_arms_reach() -> None:
    arm = arm_named("four-axis")
    far = tracked(11, 0.004, 0.02, {})
    assert distances(fit_frames(arm, far), far) is not None
    near = replace(far, positions=far.positions - np.array([2.6, 1.4, 0.3]))
    assert distances(fit_frames(arm, near), near) is None
