"""Small errors everywhere: where they are largest is told, if it is clearly one place."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary.constants import TELLING
from armscope.diagnosis.summary.unexplained import load_in_question
from armscope.physics.effect import Part
from armscope.physics.elastic import JOINT_COMPLIANCE, UNKNOWN_MASSES
from armscope.recordings import Recordings
from armscope.verdict.schema import NOISE_EXCEEDED, Background

from ...physics.scenes import arm_named
from ..planted import one_run, planted, recorded

QUICK = Settings(resamples=0, cross_validation=False)


def geometry_of(link_2: float) -> Background:
    """Of an arm with errors of 0.04 mm and mrad in every row, those of link 2 so many times as large."""
    wanted = {("link_geometry", f"link {j}"): [0.04e-3, -0.04e-3, 0.04e-3] for j in (1, 2, 3, 4, 5)}
    wanted[("link_geometry", "link 2")] = [link_2 * 0.04e-3] * 3
    verdict = diagnose(*planted("six-axis", wanted, 150, 0.02, seed=3), QUICK)
    assert not any(effect.location == "link 2" for effect in verdict.effects)
    return next(family for family in verdict.background_families if family.family == "geometric")


@pytest.mark.long
@pytest.mark.parametrize(("times", "worst"), [(2.5, "link 2"), (1.0, "")])
def test_the_worst_place_of_a_family_is_told_where_there_is_one(times: float, worst: str) -> None:
    family = geometry_of(times)
    assert family.present
    assert family.worst == worst


def twice(error_of_pose_mm: float) -> Recordings:
    """Sixty poses, each read twice with 0.02 mm of noise, off by something that follows nothing in the table."""
    arm, rng = arm_named("six-axis"), np.random.default_rng(4)
    once = replace(one_run(arm, 60, 4), time=None, temperature=None)
    both = replace(once.rows(np.tile(np.arange(60), 2)), id=np.arange(120).astype(str))
    read = recorded(arm, both, {}, 0.02, 5)
    off = np.tile(rng.normal(0, error_of_pose_mm * 1e-3, (60, 3)), (2, 1))
    return replace(read, positions=read.positions + off)


def test_what_repeats_of_a_pose_do_not_show_is_no_noise() -> None:
    """ "The 0.088 mm that remain are noise" was told of a loose nest, where repeats scattered by 0.019 mm."""
    found = diagnose(arm_named("six-axis"), twice(0.1), QUICK)
    assert found.unexplained.present
    assert "repeats of a pose" in found.unexplained.description or found.unexplained.location is not None
    assert "noise." not in found.headline.replace("more than noise", "")
    assert found.answer in ("partly explained", "cannot tell")


def test_where_repeats_scatter_as_all_does_nothing_is_left() -> None:
    found = diagnose(arm_named("six-axis"), twice(0.0), QUICK)
    assert found.answer == "nothing missing"
    assert not found.unexplained.present


@pytest.mark.parametrize(("noise_mm", "said"), [(15.0, "cannot tell"), (1.0, "nothing missing")])
def test_what_no_instrument_is_as_coarse_as_is_no_noise(noise_mm: float, said: str) -> None:
    """ "28.9 mm per axis, which is noise" was told of an arm whose joint 6 was counted the other way."""
    arm = arm_named("six-axis")
    assert 1.0 < TELLING.coarsest_noise * 1e3 * arm.reach < 15.0
    once = replace(one_run(arm, 80, 4), time=None, temperature=None)
    found = diagnose(arm, recorded(arm, once, {}, noise_mm, 5), QUICK)
    assert found.answer == said
    assert ("far above the noise of any instrument" in found.headline) == (said == "cannot tell")


@pytest.mark.parametrize("joint", ["joint 2", "joint 6"])
@pytest.mark.parametrize(("variant", "asked"), [(UNKNOWN_MASSES, True), ("", False)])
def test_what_hangs_at_the_flange_is_asked_where_masses_do_not_fit(variant: str, asked: bool, joint: str) -> None:
    """A gripper of 30 kg that nobody had stated made the drives of a wrist come out fifteen times too soft."""
    arm = arm_named("six-axis")
    drives = {each.variant: each for each in JOINT_COMPLIANCE.place(arm, one_run(arm, 40, 3)) if each.location == joint}
    part = Part(drives[variant], np.full(len(drives[variant].terms), 1e-6))
    state = SimpleNamespace(fit=SimpleNamespace(model=SimpleNamespace(arm=arm, parts=(part,))))
    told = load_in_question(state)
    assert bool(told) == asked
    if asked:
        assert told[0].text.startswith(f"{joint.capitalize()} gives way to another load than the stated masses make")
        assert ("does the target sit loosely" in told[0].text) == (joint == "joint 6"), "an arm of six joints"
    unknown = SimpleNamespace(arm=replace(arm, masses=np.zeros_like(arm.masses)), parts=(part,))
    assert not load_in_question(SimpleNamespace(fit=SimpleNamespace(model=unknown)))


@pytest.mark.parametrize(("stated_mm", "asked"), [(0.02, True), (0.06, False)])
def test_a_stated_noise_that_is_exceeded_by_what_follows_nothing_is_asked_for(stated_mm: float, asked: bool) -> None:
    """Of noise of 0.06 mm where 0.02 mm were stated it was said to measure more poses."""
    arm = arm_named("six-axis")
    once = replace(one_run(arm, 60, 4), time=None, temperature=None)
    sure = replace(arm, sigma=1e-3 * stated_mm)
    found = diagnose(sure, recorded(arm, once, {}, 0.06, 5), QUICK)
    assert found.mismatch == asked
    assert any(notice.kind == NOISE_EXCEEDED and "sigma_mm" in notice.text for notice in found.notices) == asked
    assert ("is the `sigma_mm` of robot.yaml too small" in found.headline) == asked
