"""Zeros elsewhere are told with joint and turn; turned signs and loads that are not stated are none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.recordings.motions import Motions
from tests.check.test_motion_readings import recorded, said
from tests.seeds import seeds


@pytest.fixture(scope="module", params=seeds(1, 2, 3))
def good(request: pytest.FixtureRequest) -> Motions:
    return recorded(request.param)


@pytest.mark.parametrize(("joint", "turn"), [(2, 90), (2, -90), (3, 90), (3, 180), (3, -90)])
def test_a_zero_elsewhere_is_told_with_joint_and_turn_and_no_sign_is_blamed(
    good: Motions, joint: int, turn: int
) -> None:
    off = np.where(np.arange(1, 6) == joint, np.radians(turn), 0.0)
    (told,) = said(replace(good, q=good.q + off))
    back = "+180" if turn == 180 else f"{-turn:+d}"
    assert told.startswith(f"problem with q{joint} {back} deg the stated masses leave ")


def test_a_shoulder_turned_by_half_a_turn_is_like_gravity_that_points_up_so_that_no_zero_is_sure(good: Motions) -> None:
    told = said(replace(good, q=good.q + np.array([0, np.pi, 0, 0, 0])))
    assert any("tau2_nm has the sign opposite" in each for each in told)
    assert not any(each.startswith("problem with q") for each in told)


def test_a_turned_sign_is_no_zero_elsewhere(good: Motions) -> None:
    for joint in (1, 2, 3):
        signs = np.where(np.arange(1, 6) == joint, -1.0, 1.0)
        told = said(replace(good, effort=good.effort * signs))
        assert len(told) == 1
        assert told[0].startswith(f"problem tau{joint}_nm has the sign opposite")


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_load_that_is_not_stated_is_no_zero_elsewhere(seed: int) -> None:
    assert not [each for each in said(recorded(seed, carried=2.0)) if "leave" in each]
