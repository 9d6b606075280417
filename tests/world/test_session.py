"""Sessions: poses within the limits, context as it would be recorded, and pose rules that do what they say."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.robot.description_file import load_description
from armscope.world.session import FEW_POSES, LOWEST_TOOL_M, POSE_RULES, SLACK_OF_PARALLELOGRAM_RAD, random_session
from armscope.world.strength import make_scene
from tests.world.by_hand import ARMS, ROBOTS


def session_of(arm, rule="free", count=80, seed=2):
    description = load_description(ROBOTS / f"{arm}.yaml")
    return description, random_session(description, np.random.default_rng(seed), count, rule, 12.0, 3.0)


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("rule", POSE_RULES)
def test_poses_keep_the_limits_and_stay_above_the_floor(arm, rule):
    description, session = session_of(arm, rule)
    low, high = np.radians(np.array(description.joint_limits_deg)).T
    assert np.all((session.commanded >= low - 1e-7) & (session.commanded <= high + 1e-7))
    _, tool = make_scene(description, session)
    assert np.all(tool[:, 2] > LOWEST_TOOL_M)


def test_a_parallelograms_linkage_stays_away_from_collinear():
    _, session = session_of("parallelogram-120kg")
    assert np.abs(session.commanded[:, 2] - session.commanded[:, 1]).max() <= SLACK_OF_PARALLELOGRAM_RAD


def test_context_looks_recorded():
    _, session = session_of("six-axis", count=300)
    assert np.all(np.diff(session.time) > 13)
    assert set(np.unique(session.approach)) == {-1.0, 1.0}
    assert np.unique(session.payload) == pytest.approx([0, 4, 8, 12])
    assert 2.9 < np.ptp(session.temperature) < 3.4
    assert session.run[0] == 1
    assert set(np.diff(session.run)) <= {0, 1}


def test_rules_remove_what_would_separate():
    assert not session_of("six-axis", "no_payload")[1].payload.any()
    lockstep = session_of("six-axis", "lockstep")[1].commanded
    assert np.corrcoef(lockstep[:, 1], lockstep[:, 2])[0, 1] > 0.999
    steady = session_of("six-axis", "constant_speed")[1]
    assert steady.speed == pytest.approx(0.3 * steady.commanded)
    ordered, free = (session_of("six-axis", rule)[1].commanded[:, 1] for rule in ("in_order", "free"))
    assert np.all(np.diff(ordered) >= 0)
    assert not np.all(np.diff(free) >= 0)
    assert len(np.unique(session_of("six-axis", "few")[1].commanded, axis=0)) <= FEW_POSES
    warm = session_of("six-axis", "warming_in_step")[1]
    assert np.corrcoef(warm.time, warm.temperature)[0, 1] > 0.99
    assert np.ptp(session_of("six-axis", "narrow")[1].commanded, axis=0).max() < 0.7
