"""What a joint's scatter grows with is told where the residuals show it, and is not where it is alike in all rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary.scatter_laws import _load_is_said
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.effects import FoundEffect
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM, GIVE, ROWS = 0.02, 6e-6, 150


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("six-axis")


@pytest.fixture(scope="module")
def poses(arm: Arm) -> Recordings:
    """Poses of which nothing is recorded but the order."""
    table = one_run(arm, ROWS, 7)
    return replace(table, payload=None, approach=None, speed=None, torque=None, time=None, temperature=None)


def between(one: Recordings, other: Recordings, share: Array) -> Recordings:
    """Rows on the way from one table's points to another's, with noise."""
    noise = 1e-3 * NOISE_MM * np.random.default_rng(5).normal(size=one.positions.shape)
    return replace(one, positions=one.positions + share[:, None] * (other.positions - one.positions) + noise)


def scatter_of(arm: Arm, table: Recordings) -> tuple[FoundEffect, str]:
    verdict = diagnose(arm, table, QUICK)
    (found,) = [e for e in verdict.effects if any(p.name == "scatter" for p in e.parameters)]
    return found, verdict.headline.replace("\u00a0", " ")


def sizes(found: FoundEffect) -> dict[str, tuple[float, float]]:
    return {p.name: (p.value, p.stderr) for p in found.parameters}


def test_a_load_that_nobody_recorded_is_told_as_that(arm: Arm, poses: Recordings) -> None:
    stated = replace(poses, payload=np.zeros(ROWS))
    bare, loaded = (
        recorded(arm, replace(stated, payload=np.full(ROWS, kg)), {("joint_compliance", "joint 2"): [GIVE]}, 0.0, 11)
        for kg in (0.0, 12.0)
    )
    carried = np.random.default_rng(8).integers(0, 2, ROWS).astype(float)
    found, headline = scatter_of(arm, replace(between(bare, loaded, carried), payload=None))
    assert sizes(found)["unsaid_load"][0] == pytest.approx(6.0, rel=0.2), "12 kg, or none"
    assert "as if what the arm carries changed" in headline
    assert "payload_kg" in found.cure


def test_rows_whose_load_is_recorded_carry_no_other(poses: Recordings) -> None:
    """Seen on an iiwa with three recorded payloads: "as if what the arm carries changed from row to row by 1.5 kg"."""
    payload = np.linspace(0.0, 2.5, ROWS)
    assert _load_is_said(replace(poses, payload=payload)).all()
    payload[:10] = np.nan
    assert _load_is_said(replace(poses, payload=payload)).sum() == ROWS - 10
    assert not _load_is_said(replace(poses, payload=np.zeros(ROWS))).any(), "a template's zeros say nothing"
    assert not _load_is_said(replace(poses, payload=None)).any()


def test_a_joint_that_scatters_alike_in_all_rows_grows_with_nothing(arm: Arm, poses: Recordings) -> None:
    stands = poses.motor_angles.copy()
    stands[:, 1] += np.random.default_rng(9).normal(0, 4e-4, ROWS)
    measured = recorded(arm, replace(poses, motor_angles=stands), {}, NOISE_MM, 11)
    found, headline = scatter_of(arm, replace(measured, motor_angles=poses.motor_angles))
    assert list(sizes(found)) == ["scatter"]
    assert "no single column of the table tells" in headline
