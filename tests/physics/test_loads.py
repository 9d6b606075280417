"""Errors of stated masses and payloads move an arm as another arm, whose masses are those, would move."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Part, Placed
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.loads import STATED_MASSES, mass_errors, torque_stderr
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.model_file import load_model, save_model
from armscope.physics.payload import payload_errors
from armscope.physics.scene import Scene
from armscope.physics.tilting import BASE_COMPLIANCE, BEARING_COMPLIANCE
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.arm import build_arm

from .scenes import ARMS, arm_named, full_table

SMALL = 1e-8
"""rad/(N m): what gives way so little is loaded as a rigid arm is, to a part in a million."""


def giving(arm: Arm, table: Recordings) -> list[Part]:
    effects: list[Placed] = [
        p for e in (JOINT_COMPLIANCE, BEARING_COMPLIANCE, BASE_COMPLIANCE) for p in e.place(arm, table) if not p.variant
    ]
    return [Part(p, SMALL * (1 + np.arange(len(p.terms)) + n)) for n, p in enumerate(effects)]


def heavier(arm: Arm, shares: np.ndarray) -> Arm:
    """The arm with other masses, as its description would state them."""
    links = [
        link.model_copy(update={"mass_kg": link.mass_kg * float(1 + share)})
        for link, share in zip(arm.description.links, shares, strict=True)
    ]
    return build_arm(arm.description.model_copy(update={"links": tuple(links)}))


@pytest.mark.parametrize("name", ARMS)
def test_masses_in_error_move_the_arm_as_one_with_those_masses(name: str) -> None:
    arm = arm_named(name)
    table = full_table(arm, 30, seed=3)
    parts = giving(arm, table)
    placed = mass_errors(arm, table, parts)
    assert [p.location for p in placed] == [*(f"link {j}" for j in range(1, arm.n_joints + 1)), "all links", "payload"]
    assert {p.effect for p in placed} == {STATED_MASSES}
    shares = np.random.default_rng(4).uniform(-0.3, 0.3, arm.n_joints + 2)
    errors = [Part(p, np.array([share])) for p, share in zip(placed, shares, strict=True)]
    rigid = Scene(arm, table).posture().tool
    found = Scene(arm, table).posture([*parts, *errors]).tool - rigid
    assert table.payload is not None
    loaded = replace(table, payload=(1 + shares[-1]) * table.payload)
    true = Scene(heavier(arm, shares[:-2] + shares[-2]), loaded).posture(parts).tool - rigid
    stated = Scene(arm, table).posture(parts).tool - rigid
    assert np.abs(found - true).max() < 1e-3 * np.abs(true - stated).max()


def test_loads_that_were_recorded_need_no_masses() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 30, seed=3)
    table = replace(table, torque=Scene(arm, table).torques)
    drives = [part for part in giving(arm, table) if part.placed.effect is JOINT_COMPLIANCE]
    assert mass_errors(arm, table, drives) == []
    assert {p.variant for p in payload_errors(table, drives)} == set()
    bearings = [part for part in giving(arm, table) if part.placed.effect is BEARING_COMPLIANCE]
    assert len(mass_errors(arm, table, bearings)) == arm.n_joints + 2


def test_what_does_not_give_way_shows_no_mass() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 30, seed=3)
    assert mass_errors(arm, table, []) == []
    stiff = [Part(part.placed, np.zeros(len(part.values))) for part in giving(arm, table)]
    assert mass_errors(arm, table, stiff) == []


def test_a_payload_wrong_by_a_factor_moves_the_arm_as_that_payload_does() -> None:
    arm = arm_named("six-axis")
    table = replace(full_table(arm, 30, seed=3), payload=np.repeat([0.0, 4.0, 9.0], 10))
    parts = giving(arm, table)
    (factor,) = (p for p in payload_errors(table, parts) if p.variant == "factor")
    rigid = Scene(arm, table).posture().tool
    found = Scene(arm, table).posture([*parts, Part(factor, np.array([0.36]))]).tool - rigid
    true = Scene(arm, replace(table, payload=1.36 * table.payload)).posture(parts).tool - rigid
    np.testing.assert_allclose(found, true, rtol=0, atol=1e-4 * np.abs(true).max())


def test_one_payload_is_not_told_by_a_factor() -> None:
    arm = arm_named("six-axis")
    table = replace(full_table(arm, 30, seed=3), payload=np.full(30, 5.0))
    assert {p.variant for p in payload_errors(table, giving(arm, table))} == {"mass", "centre"}


def test_a_model_with_loads_in_error_is_read_back(tmp_path: Path) -> None:
    arm = arm_named("seven-axis")
    table = full_table(arm, 25, seed=9)
    parts = [Part(part.placed, 100 * part.values) for part in giving(arm, table)]
    payload = [Part(p, np.full(len(p.terms), 0.02)) for p in payload_errors(table, parts)]
    assert {part.placed.variant for part in payload} == {"mass", "factor", "centre"}
    errors = tuple(Part(p, np.array([0.1])) for p in mass_errors(arm, table, parts))
    base = Base(np.eye(3), np.zeros(3))
    model = FittedModel(arm, {"1": base, "2": base}, (), (*parts, *payload), errors)
    save_model(tmp_path / "model.yaml", model)
    read = load_model(tmp_path / "model.yaml")
    np.testing.assert_allclose(predict(read, table), predict(model, table), rtol=0, atol=1e-12)
    assert np.abs(predict(model, table) - predict(replace(model, background=()), table)).max() > 1e-6


def test_a_loads_standard_error_is_how_it_varies_with_masses_that_are_off_each_by_itself() -> None:
    arm, draws = arm_named("six-axis"), 300
    table = replace(full_table(arm, 20, seed=5), payload=None)
    shares = PLAUSIBLE.mass_share * np.random.default_rng(1).normal(size=(draws, arm.n_joints))
    loads = [Scene(heavier(arm, each), table).torques[:, 1] for each in shares]
    np.testing.assert_allclose(torque_stderr(Scene(arm, table), 2), np.std(loads, axis=0), rtol=0.2)
    measured = replace(table, torque=Scene(arm, table).torques)
    assert not torque_stderr(Scene(arm, measured), 2).any()
