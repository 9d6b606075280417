"""Causes: family first, then place, then effect, as deep as the evidence goes."""

from __future__ import annotations

import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.verdict.schema import Verdict
from tests.diagnosis.planted import planted

QUICK = Settings(resamples=0, cross_validation=False)


def verdict_on(wanted: dict[tuple[str, str], list[float]], seed: int = 21) -> Verdict:
    arm, table = planted("four-axis", wanted, 120, 0.02, seed=seed)
    return diagnose(arm, table, QUICK)


def test_one_effect_is_one_cause_with_its_own_cure() -> None:
    verdict = verdict_on({("joint_compliance", "joint 3"): [2e-6]})
    (cause,) = verdict.causes
    (effect,) = verdict.effects
    assert (cause.family, cause.level, cause.place) == ("elastic", "effect", "joint 3")
    assert cause.members == ("joint_compliance at joint 3",)
    assert cause.cure == effect.cure
    assert cause.share == effect.share
    # without it, rows that took no part are as far off as they were before it was found
    assert abs(cause.held_out_gain_mm - (verdict.residual_before_mm - verdict.noise_mm)) < 0.1 * cause.held_out_gain_mm


@pytest.mark.long
def test_drives_that_give_way_are_one_cause_with_the_largest_first() -> None:
    verdict = verdict_on({("joint_compliance", "joint 2"): [1e-6], ("joint_compliance", "joint 3"): [2e-6]})
    (cause,) = verdict.causes
    assert (cause.level, cause.place) == ("family", "arm")
    shares = {f"{e.effect} at {e.location}": e.share for e in verdict.effects}
    assert [shares[member] for member in cause.members] == sorted(shares.values(), reverse=True)
    assert len(cause.members) == 2


@pytest.mark.long
def test_what_has_different_cures_is_several_causes() -> None:
    wanted = {("joint_compliance", "joint 3"): [2e-6], ("gear_ratio", "joint 1"): [2e-4]}
    verdict = verdict_on(wanted)
    assert {cause.family for cause in verdict.causes} == {"elastic", "transmission"}
    assert [cause.share for cause in verdict.causes] == sorted((c.share for c in verdict.causes), reverse=True)
    assert all(cause.held_out_gain_mm > 0 for cause in verdict.causes)


def test_nothing_missing_has_no_cause() -> None:
    assert verdict_on({}).causes == ()


def test_what_no_calibration_mends_is_a_cause_of_its_own() -> None:
    """An axis that wobbles counted as geometry, whose calibration was told as its cure."""
    wanted = {("axis_wobble", "joint 3"): [4e-4, 0.0, 0.0, 1e-4], ("link_geometry", "link 2"): [3e-4, 4e-4, 2e-4]}
    verdict = verdict_on(wanted)
    causes = {cause.members: cause for cause in verdict.causes}
    wobble = causes["axis_wobble at joint 3",]
    assert wobble.family == "geometric"
    assert "calibrate" not in wobble.cure
    assert not wobble.everywhere
