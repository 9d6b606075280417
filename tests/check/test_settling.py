"""Angles and points that were not taken at one moment are told, and put right as told; play and plain arms are not."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from armscope.check.report import check
from armscope.check.suspicion import SETTLED, Suspicion
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.recordings.motion import last_moves
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like
from tests.seeds import seeds

SHARES = np.array([0.0, 1.1e-3, 0.0, 4e-4, 0.0, 0.0])


def told(table: Recordings) -> list[Suspicion]:
    return [each for each in check(table, ur_like()).suspicions if each.kind == SETTLED]


def session(seed: int, turned: Array | None = None, plain: bool = False) -> Recordings:
    """Rows of an arm that turns by more than its table says (N, m), rad; with errors of its own or without."""
    arm, rng = ur_like(), np.random.default_rng(seed)
    angles = poses(rng, 150, 6)
    more = np.zeros_like(angles) if turned is None else turned
    true = arm if plain else planted(arm, rng)
    rows = measured(true, angles + more, far_away(rng), {"": [0.0, 0.1, 0.1]}, 3e-5, rng)
    return replace(rows, motor_angles=angles)


def moves(seed: int) -> Array:
    return np.nan_to_num(last_moves(session(seed)))


@pytest.mark.parametrize("seed", seeds(4, 5, 6))
@pytest.mark.parametrize(("sign", "words"), [(1, "angles were read before"), (-1, "points were measured before")])
@pytest.mark.parametrize("plain", [True, False])
def test_motion_that_was_still_to_come_is_told_and_put_right(seed: int, sign: int, words: str, plain: bool) -> None:
    table = session(seed, sign * SHARES * moves(seed), plain)
    (found,) = told(table)
    assert found.statement.startswith(words)
    shares = {int(j): float(share) for j, share in re.findall(r"joint (\d) by (\S+) %", found.statement)}
    assert shares == {2: pytest.approx(0.11, rel=0.05), 4: pytest.approx(0.04, rel=0.15)}
    assert found.weight == ("problem" if plain else found.weight)
    more, less = "add" in found.cure, "take" in found.cure
    assert (more, less) == (sign > 0, sign < 0)
    by = np.array([shares.get(j + 1, 0.0) / 100 for j in range(6)]) * np.nan_to_num(last_moves(table))
    assert not told(replace(table, motor_angles=table.motor_angles + sign * by))


def test_play_is_not_for_it_follows_the_side_alone() -> None:
    side = np.sign(moves(7)) * (np.arange(6) == 1)
    assert not told(session(7, -5e-4 * side))


@pytest.mark.parametrize("seed", seeds(8, 9, 10, 11))
def test_an_arm_that_came_to_rest_is_not(seed: int) -> None:
    assert not told(session(seed))
    assert not told(session(seed, plain=True))


def hysteresis(seed: int) -> Array:
    """(N, m) rad by which joint 2 stays behind, full after a large change of an upright arm's load."""
    angles = session(seed).motor_angles
    load = np.sin(angles[:, 1]) + 0.3 * np.sin(angles[:, 1] + angles[:, 2])
    before = np.concatenate([load[:1], load[:-1]])
    return np.outer(5e-4 * np.tanh((before - load) / 0.6), np.arange(6) == 1)


@pytest.mark.parametrize("seed", seeds(4, 5, 6, 12))
def test_hysteresis_by_the_last_change_of_load_is_a_hint_with_its_share(seed: int) -> None:
    """It goes with the motion, too: a sound table was refused, though the law left ten times the noise's squares."""
    (found,) = told(session(seed, hysteresis(seed), plain=True))
    assert found.weight == "hint"
    assert "% of what a plain arm leaves" in found.statement
    assert "take that share" not in found.cure
    assert "Hysteresis" in found.cure


@pytest.mark.parametrize("seed", seeds(4, 5, 6, 12, 13))
@pytest.mark.parametrize(("noise_mm", "weight"), [(None, "problem"), (0.03, "problem"), (1e-3, "hint")])
def test_what_leaves_far_more_than_the_stated_noise_is_no_reason_to_refuse(
    seed: int, noise_mm: float | None, weight: str
) -> None:
    table = session(seed, SHARES * moves(seed), plain=True)
    arm = replace(ur_like(), sigma=None if noise_mm is None else 1e-3 * noise_mm)
    (found,) = [each for each in check(table, arm).suspicions if each.kind == SETTLED]
    assert found.weight == weight


def test_moves_are_from_the_row_before_of_the_same_run() -> None:
    table = session(3).rows(np.arange(6))
    table = replace(table, run=np.array(["a", "b"] * 3), time=np.array([3.0, 0.0, 2.0, 1.0, 1.0, 2.0]))
    moved = last_moves(table)
    np.testing.assert_allclose(moved[2], table.motor_angles[2] - table.motor_angles[4])
    np.testing.assert_allclose(moved[5], table.motor_angles[5] - table.motor_angles[3])
    assert np.isnan(moved[[4, 1]]).all()
