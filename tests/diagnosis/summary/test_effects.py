"""What is told of a named effect is all that the fitted model holds of it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis.summary.effects import _as_sure_as_its_size, _with_drive_of_background
from armscope.fitting.parameter_layout import parameter_layout
from armscope.inference.model_space import Candidate
from armscope.physics.effect import Part
from armscope.physics.elastic import JOINT_COMPLIANCE, UNKNOWN_MASSES
from armscope.physics.frames import free_frames
from armscope.physics.scene import Scene
from armscope.verdict.effects import Parameter
from armscope.verdict.sentences import headline
from tests.physics.scenes import arm_named, full_table
from tests.report import verdicts

ARM, JOINT = arm_named("six-axis"), 2
ROWS = full_table(ARM, 40, 3)
PLACED = {p.variant: p for p in JOINT_COMPLIANCE.place(ARM, ROWS) if p.location == f"joint {JOINT}"}
DRIVE, UNKNOWN = PLACED[""], PLACED[UNKNOWN_MASSES]
GIVE = 2e-6


def motor_turn(parts: tuple[Part, ...], payload: Array) -> Array:
    """(N,) turn of the motor by some parts under a payload, rad."""
    scene = Scene(ARM, replace(ROWS, payload=payload))
    terms = ((t, v) for part in parts for t, v in zip(part.placed.terms, part.values, strict=True))
    return np.sum([v * scene.driver(p.driver) for t, v in terms for p in t.products], axis=0, dtype=float)


@pytest.mark.parametrize("in_background", [True, False])
def test_a_drive_under_unknown_masses_is_told_by_how_far_a_payload_turns_it(in_background: bool) -> None:
    rng = np.random.default_rng(1)
    values = np.append(1e-6 * rng.normal(size=len(UNKNOWN.terms) - 1), -0.4 * GIVE)
    named, drive = Part(UNKNOWN, values), Part(DRIVE, np.array([GIVE]))
    background = (drive,) if in_background else ()
    layout = parameter_layout(free_frames(ROWS, False), [[DRIVE]], [UNKNOWN])
    root = 1e-7 * rng.normal(size=(len(layout.terms), len(layout.terms)))
    covariance = root @ root.T
    fit: Any = SimpleNamespace(layout=layout, model=SimpleNamespace(background=background))
    told, spread = _with_drive_of_background(fit, named, covariance)

    loaded, bare = np.full(len(ROWS), 8.0), np.zeros(len(ROWS))
    more = Scene(ARM, replace(ROWS, payload=loaded)).torques - Scene(ARM, replace(ROWS, payload=bare)).torques
    turned = motor_turn((named, *background), loaded) - motor_turn((named, *background), bare)
    number = [t.name for t in UNKNOWN.terms].index("compliance")
    assert turned == pytest.approx(told[number] * more[:, JOINT - 1], rel=1e-6, abs=1e-12)

    draws = rng.multivariate_normal(np.zeros(len(layout.terms)), covariance, 200_000)
    both = [layout.of(UNKNOWN)[number], *(layout.of(DRIVE) if in_background else [])]
    assert np.sqrt(spread[number, number]) == pytest.approx(draws[:, both].sum(axis=1).std(), rel=0.02)
    others = np.delete(np.arange(len(values)), number)
    assert told[others] == pytest.approx(values[others])
    assert spread[np.ix_(others, others)] == pytest.approx(
        covariance[np.ix_(layout.of(UNKNOWN), layout.of(UNKNOWN))][np.ix_(others, others)]
    )


def test_a_drive_under_stated_masses_is_told_as_it_is() -> None:
    layout = parameter_layout(free_frames(ROWS, False), [[DRIVE]], [DRIVE])
    drive = Part(DRIVE, np.array([GIVE]))
    fit: Any = SimpleNamespace(layout=layout, model=SimpleNamespace(background=(drive,)))
    told, spread = _with_drive_of_background(fit, drive, 4e-14 * np.eye(len(layout.terms)))
    assert (told.item(), spread.item()) == (GIVE, pytest.approx(4e-14))


@pytest.mark.parametrize(("spread", "sure"), [(0.1e-6, True), (1.5e-6, False)])
def test_a_name_whose_size_may_be_zero_is_hedged_in_the_headline_and_confirmed_before_its_cure(
    spread: float, sure: bool
) -> None:
    """A tool that bent was "replace the bearing of joint 6", of a size between -10 and +28 millionths."""
    size = Parameter("compliance", "rad/(N m)", GIVE, spread)
    found = verdicts.found("bearing_compliance", "joint 6", size)
    candidate = Candidate("bearing_compliance", "joint 6", np.arange(1), np.ones(1), family="elastic", region="6")
    told = _as_sure_as_its_size(found, candidate)
    assert (told.named_as == "effect") == sure == (not told.size_open)
    said = headline(verdicts.case(effects=(told,)).verdict)
    assert ("most likely" in said) == ("of a size that these rows do not determine" in said) == (not sure)
    assert ("The bearing of joint 6 tilts by" in said) == sure


@pytest.mark.parametrize(("inclusion", "sure"), [(0.0, False), (0.3, True), (None, True)])
def test_a_name_that_no_table_drawn_anew_has_is_told_by_kind_and_region(inclusion: float | None, sure: bool) -> None:
    size = Parameter("compliance", "rad/(N m)", GIVE, 0.1e-6)
    found = replace(verdicts.found("bearing_compliance", "joint 6", size), inclusion=inclusion)
    candidate = Candidate("bearing_compliance", "joint 6", np.arange(1), np.ones(1), family="elastic", region="6")
    assert (_as_sure_as_its_size(found, candidate).named_as == "effect") == sure
