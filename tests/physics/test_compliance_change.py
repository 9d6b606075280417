"""A drive that gives way by more when it is warm, or from some moment on, is told with its size; others are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.physics.compliance_change import COMPLIANCE_CHANGE, compliance_change, plausible_change
from armscope.physics.effect import Part, Placed
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.verdict.diagnosis import Diagnosis
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named
from tests.seeds import seeds

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM, GIVE, ROWS = 0.02, 6e-6, 150


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("six-axis")


@pytest.fixture(scope="module")
def poses(arm: Arm) -> Recordings:
    """Poses of which nothing is recorded but temperature and order."""
    table = one_run(arm, ROWS, 7)
    warm = np.random.default_rng(3).uniform(12, 36, ROWS)
    return replace(table, payload=None, approach=None, speed=None, torque=None, time=None, temperature=warm)


def giving_way(arm: Arm, poses: Recordings, share: Array) -> Recordings:
    """Joint 2 gives way by this share of GIVE in each row."""
    rigid, soft = (recorded(arm, poses, {("joint_compliance", "joint 2"): [c]}, 0.0, 11) for c in (0.0, GIVE))
    noise = 1e-3 * NOISE_MM * np.random.default_rng(5).normal(size=rigid.positions.shape)
    return replace(rigid, positions=rigid.positions + share[:, None] * (soft.positions - rigid.positions) + noise)


def changes(verdict: Diagnosis) -> list[tuple[str, str]]:
    return sorted((effect.effect, effect.location) for effect in verdict.effects)


BOTH = [("compliance_change", "joint 2"), ("joint_compliance", "joint 2")]


def test_a_drive_that_softens_with_warmth_is_told_so(arm: Arm, poses: Recordings) -> None:
    assert poses.temperature is not None
    verdict = diagnose(arm, giving_way(arm, poses, 1 + 0.04 * (poses.temperature - 20)), QUICK)
    assert changes(verdict) == BOTH
    sizes = {p.name: p for effect in verdict.effects for p in effect.parameters}
    for name, size in (("compliance", GIVE), ("give_per_k", 0.04 * GIVE)):
        assert abs(sizes[name].value - size) < 3 * sizes[name].stderr
    assert "µrad per N m and K more the warmer it is" in verdict.headline.replace("\u00a0", " ")


def test_a_drive_that_gives_way_by_more_from_some_row_on_is_told_so(arm: Arm, poses: Recordings) -> None:
    table = giving_way(arm, replace(poses, temperature=None), np.where(np.arange(ROWS) < 90, 1.0, 1.6))
    verdict = diagnose(arm, table, QUICK)
    assert changes(verdict) == BOTH
    sizes = {p.name: p for effect in verdict.effects for p in effect.parameters}
    assert abs(sizes["give"].value - 0.6 * GIVE) < 3 * sizes["give"].stderr
    assert abs(sizes["row"].value - 91) <= 3
    assert "more from row 91 on" in verdict.headline.replace("\u00a0", " ")


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_a_drive_that_gives_way_alike_in_all_rows_has_no_change(arm: Arm, poses: Recordings, seed: int) -> None:
    measured = recorded(arm, poses, {("joint_compliance", "joint 2"): [GIVE]}, NOISE_MM, seed)
    assert changes(diagnose(arm, measured, QUICK)) == BOTH[1:]


def test_it_is_sought_with_the_temperature_and_from_run_to_run(arm: Arm, poses: Recordings) -> None:
    cold = replace(poses, temperature=np.full(ROWS, 21.0))
    assert not list(COMPLIANCE_CHANGE.place(arm, cold))
    days = replace(cold, run=np.repeat(["monday", "tuesday", "friday"], ROWS // 3))
    told = {placed.driver for placed in COMPLIANCE_CHANGE.place(arm, days)}
    assert told == {"between runs monday and tuesday", "between runs tuesday and friday"}
    assert {placed.driver for placed in COMPLIANCE_CHANGE.place(arm, poses)} == {"temperature"}


def test_it_turns_the_drive_by_its_load_from_then_on(arm: Arm, poses: Recordings) -> None:
    scene = Scene(arm, poses)
    placed = compliance_change(poses, 40, 1, 3, plausible_change(scene, 3))
    ((direction, turn),) = scene.amounts([Part(placed, np.array([1e-6]))]).items()
    assert (direction.location, direction.axis) == ("motor 3", "turn")
    expected = 1e-6 * scene.torques[:, 2] * (np.arange(ROWS) >= 40)
    np.testing.assert_allclose(turn, expected, atol=1e-15)


def as_worded(placed: Placed, value: float, poses: Recordings, load: Array) -> Array:
    """What the card says to take from the wanted angle, by hand."""
    assert poses.temperature is not None
    words = placed.effect.cure.words
    if placed.variant == "temperature":
        assert "commanded = wanted - give_per_k x load x (temperature - 20 C)" in words
        return value * load * (poses.temperature - 20)
    assert "commanded = wanted - give x load x after" in words
    return value * load * (np.arange(ROWS) >= 40)


@pytest.mark.parametrize("kind", ["temperature", "moment"])
def test_its_cure_as_worded_takes_it_away(arm: Arm, poses: Recordings, kind: str) -> None:
    scene = Scene(arm, poses)
    later = compliance_change(poses, 40, 1, 2, plausible_change(scene, 2))
    warm = next(p for p in COMPLIANCE_CHANGE.place(arm, poses) if p.location == "joint 2")
    placed, value = (warm, 3e-7) if kind == "temperature" else (later, 6e-6)
    part = Part(placed, np.array([value]))
    commanded = poses.motor_angles.copy()
    commanded[:, 1] -= as_worded(placed, value, poses, scene.torques[:, 1])
    wanted = chain(arm, poses.motor_angles).tool
    before = np.linalg.norm(scene.posture([part]).tool - wanted, axis=1)
    after = np.linalg.norm(Scene(arm, replace(poses, motor_angles=commanded)).posture([part]).tool - wanted, axis=1)
    assert before.max() > 1e-3
    assert after.max() < 0.02 * before.max()
    by_code = placed.effect.cure.commanded
    assert by_code is not None
    np.testing.assert_allclose(by_code(scene, part), commanded, atol=1e-12)
