"""Arms built by an independent engine whose masses, payload or base are other than the library's columns assume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.model import predict
from armscope.physics.model_file import load_model, save_model
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.description import RobotDescription
from armscope.verdict.effects import FoundEffect
from armscope.verdict.schema import Verdict
from armscope.world.layout import Geometry
from armscope.world.statics import Hidden, Session, balance

from ..physics.scenes import arm_named
from .planted import one_run

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM = 0.02
DRIVES = {"joint 2": 1.0e-6, "joint 3": 3.3e-6}
WRONG = np.array([0.2, -0.15, 0.25, -0.2, 0.15, -0.1])
"""Of the stated masses of a six-axis arm, by which the true ones differ."""


def heavier(description: RobotDescription, shares: np.ndarray) -> RobotDescription:
    links = [
        link.model_copy(update={"mass_kg": link.mass_kg * float(1 + share)})
        for link, share in zip(description.links or (), shares, strict=True)
    ]
    return description.model_copy(update={"links": tuple(links)})


def measured(
    arm: Arm, masses: np.ndarray, hide: Callable[[Hidden], None], rows: int, seed: int, payload: float = 1.0
) -> Recordings:
    """A table of an arm with other masses and a payload other than stated by a factor, by MuJoCo's equilibrium."""
    table = replace(one_run(arm, rows, seed), temperature=None, approach=None, speed=None)
    rng = np.random.default_rng(seed)
    stated = rng.choice([0.0, 4.0, 10.0], rows)
    still = np.zeros_like(table.motor_angles)
    session = Session(
        table.motor_angles,
        payload * stated,
        np.arange(float(rows)),
        np.full(rows, 20.0),
        np.ones(rows, int),
        still,
        still,
    )
    geometry = Geometry(heavier(arm.description, masses))
    hidden = Hidden.nothing(geometry, session)
    hide(hidden)
    stood = balance(geometry, session, hidden)
    assert stood.residual < 1e-6
    positions = stood.tool + 1e-3 * NOISE_MM * rng.normal(size=stood.tool.shape)
    return replace(table, payload=stated, positions=positions)


def drives(hidden: Hidden) -> None:
    for place, compliance in DRIVES.items():
        hidden.motor_spring(int(place[-1]) - 1, compliance)


def named(verdict: Verdict) -> dict[tuple[str, str], FoundEffect]:
    return {(effect.effect, effect.location): effect for effect in verdict.effects}


def holds(effect: FoundEffect, parameter: str, truth: float) -> bool:
    (found,) = (p for p in effect.parameters if p.name == parameter)
    low, high = found.interval
    return bool(low <= truth <= high)


@pytest.mark.parametrize(
    "masses",
    [
        pytest.param(WRONG, id="wrong"),
        pytest.param(-WRONG, id="wrong the other way", marks=pytest.mark.long),
        pytest.param(np.full(6, 0.15), id="alike"),
        pytest.param(np.full(6, -0.15), id="alike the other way", marks=pytest.mark.long),
        # of masses as stated beside a payload that is not, the next test asks
        pytest.param(np.zeros(6), id="as stated", marks=pytest.mark.long),
    ],
)
def test_drives_are_told_alone_and_their_intervals_hold_whatever_the_masses(masses: np.ndarray) -> None:
    arm = arm_named("six-axis")
    verdict = diagnose(arm, measured(arm, masses, drives, 200, seed=11), QUICK)
    found = named(verdict)
    assert set(found) == {("joint_compliance", place) for place in DRIVES}
    for place, compliance in DRIVES.items():
        effect = found["joint_compliance", place]
        assert holds(effect, "compliance", compliance)
        assert effect.parameters[0].stderr < 0.1 * compliance
    said = any(notice.kind == "stated masses" for notice in verdict.notices)
    assert said == bool(masses.any())


@pytest.mark.long
def test_a_payload_wrong_by_a_factor_has_one_value_beside_the_drives(tmp_path: Path) -> None:
    arm = arm_named("six-axis")
    verdict = diagnose(arm, measured(arm, np.zeros(6), drives, 200, seed=12, payload=1.36), QUICK)
    found = named(verdict)
    assert set(found) == {*(("joint_compliance", place) for place in DRIVES), ("payload_error", "payload")}
    assert holds(found["payload_error", "payload"], "share", 0.36)
    assert all(holds(found["joint_compliance", place], "compliance", c) for place, c in DRIVES.items())
    assert "heavier than stated" in verdict.headline
    assert not [notice for notice in verdict.notices if notice.kind == "stated masses"]
    # the model file takes it back as it is
    save_model(tmp_path / "model.yaml", verdict.model)
    again = load_model(tmp_path / "model.yaml")
    np.testing.assert_allclose(
        predict(again, verdict.recordings), predict(verdict.model, verdict.recordings), atol=1e-9
    )


@pytest.mark.long
@pytest.mark.parametrize(("about_x", "about_y"), [(6e-8, 1e-8), (3e-8, 3e-8)], ids=["two axes", "one value"])
def test_a_base_softer_about_one_axis_is_told_about_both(about_x: float, about_y: float) -> None:
    arm = arm_named("six-axis")

    def base(hidden: Hidden) -> None:
        hidden.spring("base rx", about_x)
        hidden.spring("base ry", about_y)

    verdict = diagnose(arm, measured(arm, np.zeros(6), base, 160, seed=13), QUICK)
    assert set(named(verdict)) == {("base_compliance", "base")}
    (effect,) = verdict.effects
    if about_x == about_y:
        assert holds(effect, "compliance", about_x)
    else:
        assert holds(effect, "compliance_x", about_x)
        assert holds(effect, "compliance_y", about_y)
        assert holds(effect, "compliance_xy", 0.0)
