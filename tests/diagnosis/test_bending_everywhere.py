"""Every link, the pedestal and all bearings give way a little, as no drive does: nothing else may get a name for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.backgrounds import ELASTIC
from armscope.physics.effect import Part
from armscope.physics.elastic import BASE_COMPLIANCE, BEARING_COMPLIANCE, LINK_BENDING
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.uneven_bearing import uneven_bearings

from ..physics.scenes import arm_named
from .planted import Wanted, one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, NOISE_MM, SHARE = 250, 0.02, 0.1


def bending(arm_name: str, seed: int) -> Wanted:
    """A tenth of what is plausible at every link, each a little otherwise, and at the base."""
    arm, rng = arm_named(arm_name), np.random.default_rng(seed)
    table = one_run(arm, ROWS, seed)
    beams = [p for p in LINK_BENDING.place(arm, table) if np.isfinite(p.terms[0].plausible)]
    base = next(p for p in BASE_COMPLIANCE.place(arm, table) if not p.variant)
    wanted = {p.key: [SHARE * p.terms[0].plausible * rng.uniform(0.5, 1.5)] for p in beams}
    return wanted | {base.key: [SHARE * base.terms[0].plausible]}


@pytest.mark.parametrize("arm_name", ["six-axis", "seven-axis"])
def test_what_bends_everywhere_gets_no_name(arm_name: str) -> None:
    arm = arm_named(arm_name)
    table = recorded(arm, one_run(arm, ROWS, seed=2), bending(arm_name, seed=2), NOISE_MM, seed=3)
    verdict = diagnose(arm, table, QUICK)
    assert not verdict.effects
    assert [small.family for small in verdict.background_families if small.present] == [ELASTIC]
    assert verdict.noise_mm == pytest.approx(NOISE_MM, rel=0.05)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_bearings_softer_about_one_axis_make_nothing_else_look_wrong(seed: int) -> None:
    """All of them, each about an axis of its own; before, D-H lengths and gears had names for it."""
    arm, rng = arm_named("six-axis"), np.random.default_rng(seed)
    table = one_run(arm, ROWS, seed)
    parts = []
    for even, uneven in zip(BEARING_COMPLIANCE.place(arm, table), uneven_bearings(arm, table), strict=True):
        if np.isfinite(even.terms[0].plausible):
            soft = SHARE * even.terms[0].plausible * rng.uniform(0.5, 1.5)
            half, turn = 0.35 * soft, 2 * rng.uniform(0, np.pi)
            parts.append(Part(even, np.array([soft - half])))
            parts.append(Part(uneven, half * np.array([np.cos(turn), np.sin(turn)])))
    points = predict(FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, (), tuple(parts)), table)
    measured = replace(table, positions=points + 1e-3 * NOISE_MM * rng.normal(size=points.shape))
    verdict = diagnose(arm, measured, QUICK)
    assert {effect.family for effect in verdict.effects} <= {ELASTIC}
    assert verdict.noise_mm == pytest.approx(NOISE_MM, rel=0.05)


@pytest.mark.parametrize("softer", [("link_bending", "link 2"), ("base_compliance", "base")])
def test_what_bends_far_more_than_the_rest_is_named(softer: tuple[str, str]) -> None:
    arm = arm_named("six-axis")
    wanted = dict(bending("six-axis", seed=2))
    wanted[softer] = [10 * value for value in wanted[softer]]
    found = diagnose(arm, recorded(arm, one_run(arm, ROWS, seed=2), wanted, NOISE_MM, seed=3), QUICK).effects[0]
    assert softer in {(found.effect, found.location), *((a.effect, a.location) for a in found.alternatives)}
