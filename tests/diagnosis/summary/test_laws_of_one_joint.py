"""A gear that errs once and twice per turn is told as two waves; what rows leave open of one is owned by the other."""

from __future__ import annotations

import functools
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary.laws_of_one_joint import curve_of_waves, doubts_of_laws
from armscope.diagnosis.summary.rivals import discriminability, too_close
from armscope.inference.constants import PRIORS
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, INTERVAL
from tests.diagnosis.planted import one_run, recorded
from tests.inference.test_search import SINGLE, search_on, space_of, with_curve
from tests.physics.scenes import arm_named
from tests.seeds import seeds

QUICK = Settings(resamples=0, cross_validation=False)


@functools.cache
def told_of(seed: int, half_range: float, amplitudes: tuple[float, float], trend: float = 0.0) -> Diagnosis:
    """A gear of joint 3 that errs by so much, rad, once and twice per turn, and by a trend, rad/rad."""
    arm, rng = arm_named("six-axis"), np.random.default_rng(seed)
    table = one_run(arm, 150, seed)
    angles = table.motor_angles.copy()
    angles[:, 2] = rng.uniform(-half_range, half_range, len(angles)) + 0.3
    turned = angles.copy()
    for per_turn, amplitude, phase in zip((1, 2), amplitudes, rng.uniform(-3, 3, 2), strict=True):
        turned[:, 2] += amplitude * np.cos(per_turn * angles[:, 2] - phase)
    turned[:, 2] += trend * angles[:, 2]
    plain = replace(table, payload=None, temperature=None, time=None, approach=None, speed=None)
    measured = recorded(arm, replace(plain, motor_angles=turned), {}, 0.03, seed)
    return diagnose(arm, replace(measured, motor_angles=angles), QUICK)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_gear_that_errs_once_and_twice_per_turn_has_both_names(seed: int) -> None:
    found = told_of(seed, 2.6, (4e-4, 3e-4)).effects
    assert {(e.effect, e.location, e.parameters[2].value) for e in found} == {
        ("gear_eccentricity", "joint 3", 1.0),
        ("gear_eccentricity", "joint 3", 2.0),
    }
    for effect in found:
        amplitude = effect.parameters[0]
        true = 4e-4 if effect.parameters[2].value == 1.0 else 3e-4
        assert abs(amplitude.value - true) < 1.5 * INTERVAL * amplitude.stderr


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_one_wave_is_told_as_one(seed: int) -> None:
    (once,) = told_of(seed, 2.6, (4e-4, 0.0)).effects
    assert (once.effect, once.named_as, once.parameters[2].value) == ("gear_eccentricity", "effect", 1.0)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_over_a_short_range_a_wave_may_be_a_trend_about_another_zero(seed: int) -> None:
    """Either the truth is named, with intervals that hold it, or what is named is said to be unsure."""
    verdict = told_of(seed, 1.1, (4e-4, 3e-4))
    waves = {e.parameters[2].value: e for e in verdict.effects if e.effect == "gear_eccentricity"}
    unsure = [e for e in verdict.effects if e.named_as != "effect"]
    assert set(waves) == {1.0, 2.0} or unsure
    for per_turn, effect in waves.items() if len(waves) == 2 else ():
        true = 4e-4 if per_turn == 1.0 else 3e-4
        amplitude = effect.parameters[0]
        assert abs(amplitude.value - true) < 1.5 * INTERVAL * amplitude.stderr


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_a_trend_alone_is_told_as_a_ratio(seed: int) -> None:
    (ratio,) = told_of(seed, 2.6, (0.0, 0.0), trend=4e-4).effects
    assert (ratio.effect, ratio.location, ratio.named_as) == ("gear_ratio", "joint 3", "effect")


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_trend_beside_a_wave_is_told_as_one_or_it_is_said_that_it_may_be_one(seed: int) -> None:
    found = told_of(seed, 1.1, (0.0, 3e-4), trend=4e-4).effects
    told = {(e.effect, e.location) for e in found} | {(a.effect, a.location) for e in found for a in e.alternatives}
    assert ("gear_ratio", "joint 3") in told
    once = [e for e in found if e.effect == "gear_eccentricity" and e.parameters[2].value == 1.0]
    assert all(e.named_as != "effect" for e in once)


def test_a_free_curve_gains_no_doubt_beside_a_law() -> None:
    search = search_on(space_of(with_curve()), {0: 0.3, 1: -0.2, 2: 0.25, 3: 0.2, 6: 0.3})
    best = search.best()
    assert best.candidates == {SINGLE, 6}
    assert doubts_of_laws(search, best, {}).keys() == {6}


@pytest.mark.parametrize(
    ("lead", "waves", "told"),
    [
        (PRIORS.excess_special_case_nats, 2, True),
        (PRIORS.excess_special_case_nats + 0.9 * INDISTINGUISHABLE_NATS, 2, True),
        (PRIORS.excess_special_case_nats + 1.1 * INDISTINGUISHABLE_NATS, 2, False),
        (INDISTINGUISHABLE_NATS, 1, False),
    ],
)
def test_waves_that_lead_by_what_they_were_spared_may_be_a_free_curve(lead: float, waves: int, told: bool) -> None:
    """A hose bends smoothly, too, and two waves of any phase say most of that."""
    pair = frozenset({0, 1})
    wave = SimpleNamespace(as_one=frozenset(), competes=True, columns=(0, 1))
    curve = SimpleNamespace(as_one=pair, competes=True, columns=tuple(range(12)))
    best = SimpleNamespace(candidates=frozenset(range(waves)), log_posterior=lead, noise=1.0, rss=0.0)
    other = SimpleNamespace(log_posterior=0.0, rss=0.0)
    search: Any = SimpleNamespace(
        space=SimpleNamespace(candidates=[wave, wave, curve]),
        without=lambda parent, gone: (parent, frozenset(gone)),
        additions=lambda base, count, without: [other] if base[1] == pair and without == {0, 1} else [],
    )
    found = curve_of_waves(search, best, 0)  # type: ignore[arg-type]
    assert [rival.candidate for rival in found] == [curve] * told
    apart = [discriminability(best, rival.hypothesis, wave, rival.candidate) for rival in found]  # type: ignore[arg-type]
    assert too_close(wave, found, apart) == [curve] * told  # type: ignore[arg-type]


def test_a_trend_with_a_small_second_wave_stands_beside_a_wave_that_fits_no_better() -> None:
    """Over less than a turn one wave of free phase is both: rows that know no better told it as if nothing else was."""
    verdict = told_of(3, 1.1, (0.0, 1e-4), trend=7e-4)
    wave = next(e for e in verdict.effects if e.effect == "gear_eccentricity")
    assert ("gear_ratio", "joint 3") in {(rival.effect, rival.location) for rival in wave.alternatives}
    assert wave.named_as != "effect"
