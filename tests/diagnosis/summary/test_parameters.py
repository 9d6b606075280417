"""Values that rows leave open are not told; values that no arm shows are questioned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary.parameters import beyond_plausible, parameters, undetermined
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Part
from armscope.physics.geometric import LINK_GEOMETRY
from armscope.physics.loose_target import HOLDER_SAG
from armscope.physics.wobble import AXIS_WOBBLE
from tests.diagnosis.planted import planted
from tests.physics.scenes import arm_named, full_table

QUICK = Settings(resamples=0, cross_validation=False)


def test_a_value_whose_error_is_as_large_as_any_arms_is_left_open() -> None:
    arm = arm_named("six-axis")
    placed = next(p for p in LINK_GEOMETRY.place(arm, full_table(arm, 30, 1)) if p.location == "link 3")
    errors = {"a": 0.1, "d": 0.9, "alpha": 0.1}
    stderr = np.array([errors[t.name] * t.plausible for t in placed.terms])
    assert undetermined(placed, np.diag(stderr**2)) == ("d",)


@pytest.mark.long
def test_lengths_along_parallel_axes_that_only_their_sum_shows_are_not_told_singly() -> None:
    """d of link 2 and of link 3 shift the arm alike: axes 2 and 3 are parallel."""
    arm, table = planted("six-axis", {("link_geometry", "link 2"): [0.0, 0.0, 1.5e-3]}, 120, 0.02, seed=4)
    verdict = diagnose(arm, table, QUICK)
    for effect in verdict.effects:
        assert not {p.name for p in effect.parameters} & set(effect.undetermined)
        for p in effect.parameters:
            if p.unit == "mm":
                assert p.stderr < 1e3 * PLAUSIBLE.length_m


def test_what_no_arm_shows_is_questioned() -> None:
    arm = arm_named("six-axis")
    placed = next(p for p in LINK_GEOMETRY.place(arm, full_table(arm, 30, 1)) if p.location == "link 3")
    values = np.array([24e-3 if term.name == "a" else 0.0 for term in placed.terms])
    said = beyond_plausible([Part(placed, values)])
    assert said is not None
    assert "a of link 3 by +24 mm" in said.text
    assert beyond_plausible([Part(placed, 0.1 * values)]) is None
    assert replace(said, text="").kind == "implausible"
    assert "drawing" in said.text


def test_a_holder_that_bends_too_far_asks_for_no_drawing() -> None:
    """Seen on a real arm: a target's holder sagged by 1.6 mm, and the page asked for another convention of rows."""
    sag = next(iter(HOLDER_SAG.place(arm_named("six-axis"), full_table(arm_named("six-axis"), 30, 1))))
    said = beyond_plausible([Part(sag, np.array([5 * term.plausible for term in sag.terms]))])
    assert said is not None
    assert "drawing" not in said.text
    assert "Measure it by itself first" in said.text


@pytest.mark.parametrize("against", [1.0, -1.0])
def test_a_tilt_that_runs_round_is_as_large_as_its_circle_whatever_noise_makes_of_that(against: float) -> None:
    """Noise makes an ellipse of a circle: told by its longer half axis, amplitudes came out two errors too large."""
    arm = arm_named("six-axis")
    placed = next(p for p in AXIS_WOBBLE.place(arm, full_table(arm, 30, 1)) if p.variant == "2")
    tilt, error = 2e-4, 1e-5
    rng = np.random.default_rng(0)
    circle = np.array([tilt, 0.0, 0.0, against * tilt])
    noisy = [parameters(placed, circle + error * rng.normal(size=4), error**2 * np.eye(4)) for _ in range(200)]
    sizes = np.array([told[0].value for told in noisy])
    assert np.mean([len(told) == 3 for told in noisy]) > 0.9  # amplitude, direction, times per turn
    assert abs(sizes.mean() - tilt) < 3 * sizes.std() / np.sqrt(len(sizes))
    assert np.mean([told[0].interval[0] < tilt < told[0].interval[1] for told in noisy]) > 0.9


def test_a_tilt_in_one_plane_has_a_phase() -> None:
    arm = arm_named("six-axis")
    placed = next(p for p in AXIS_WOBBLE.place(arm, full_table(arm, 30, 1)) if p.variant == "1")
    told = parameters(placed, np.array([2e-4, 0.0, 0.0, 0.0]), 1e-10 * np.eye(4))
    assert [p.name for p in told] == ["amplitude", "phase", "direction", "per_turn"]
