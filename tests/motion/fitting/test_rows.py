"""What gains and delays are of: all torque of a joint, its own causes' too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.model_estimate import Estimate, stated_model
from armscope.motion.fitting.rows import build_rows
from armscope.motion.library import catalogue
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.samples.preparation import preparation
from armscope.motion.samples.timing import stretches
from tests.motion.moving import COULOMB, ROBOT, ROTOR, VISCOUS, moved, robot
from tests.motion.test_parts import seen
from tests.seeds import seeds

JOINT, STIFFNESS, GAIN = 1, 30.0, 0.3
PER_LOAD, GAINS = 0.07, np.array([11.0, 9.0, 10.5])


def sprung_and_misread(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A spring at joint 2, and all torque of that joint read a third too large."""
    j = JOINT
    own = rigid[:, j] + COULOMB[j] * np.sign(dq[:, j]) + VISCOUS[j] * dq[:, j] + ROTOR[j] * ddq[:, j]
    extra = np.zeros_like(q)
    extra[:, j] = (1 + GAIN) * (own + STIFFNESS * (q[:, j] - 0.1)) - own
    return extra


def rubbing_with_the_load(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """At joints 2 and 3."""
    return PER_LOAD * np.abs(rigid) * np.sign(dq) * [0, 1, 1]


@pytest.mark.long
def test_a_spring_behind_a_wrong_gain_has_its_own_stiffness() -> None:
    stated = [{"rotor_inertia_kg_m2": r, "coulomb_nm": c, "viscous_nm_s_rad": v}
              for r, c, v in zip(ROTOR, COULOMB, VISCOUS, strict=True)]  # fmt: skip
    arm = robot(drives=stated)
    found = diagnose_motion(arm, moved(arm, 3, sprung_and_misread, seconds=15.0), MotionSettings(cutoff=10.0)).verdict
    causes = {(each.effect, each.location): each.parameters[0] for each in found.effects}
    assert set(causes) == {("gravity_balance", "joint 2"), ("motor_constant", "joint 2")}
    assert causes["motor_constant", "joint 2"].value == pytest.approx(GAIN, abs=0.01)
    assert causes["gravity_balance", "joint 2"].value == pytest.approx(STIFFNESS, rel=0.03)


def test_what_a_gain_is_of_is_stated_and_never_fitted() -> None:
    """Of a fitted torque a gain of one, or a curve that holds it, is the whole model: friction and masses then end."""
    arm = robot()
    laid, how = list(stretches(moved(arm, 3))), preparation(200.0, 10.0, "test")
    causes = [each for each in place_causes(seen(moved(arm, 3))) if each.location == "joint 2"]
    kinds = {each.columns.kind: each for each in causes if isinstance(each.columns, Law)}
    layout = TorqueLayout(arm, tuple(kinds[kind] for kind in ("torque", "powers of torque", "curve over load")), True)

    def readings(model: Estimate) -> Array:
        rows = build_rows(layout, laid, how, model)
        gain, powers, curve = layout.columns
        at = np.concatenate([layout.gains[JOINT : JOINT + 1], gain, powers[:1], curve])
        return np.asarray(rows.columns[JOINT][:, np.searchsorted(rows.at[JOINT], at)], dtype=np.float64)

    plain = stated_model(arm)
    heavier = replace(plain, inertial=1.3 * plain.inertial, background=plain.background + 1.0)
    np.testing.assert_allclose(readings(heavier), readings(plain), atol=1e-4)
    rows = build_rows(layout, laid, how, plain)
    np.testing.assert_allclose(readings(plain)[:, 0], rows.nominal[:, JOINT], atol=1e-3)


def test_what_is_added_to_a_joint_is_recorded_by_its_gain() -> None:
    arm = robot()
    laid, how = list(stretches(moved(arm, 3))), preparation(200.0, 10.0, "test")
    layout = TorqueLayout(arm, (), True)
    twice = build_rows(layout, laid, how, replace(stated_model(arm), gain=np.full(3, 2.0)))
    once = replace(twice, gain=np.ones(3))
    rubbing, gains = np.zeros(layout.width), np.zeros(layout.width)
    rubbing[layout.own], gains[layout.gains] = 1.0, 1.0
    np.testing.assert_allclose(twice.modelled(rubbing), 2 * once.modelled(rubbing), rtol=1e-5)
    np.testing.assert_allclose(twice.modelled(gains), once.modelled(gains))


def test_rows_of_another_model_are_those_formed_anew() -> None:
    """From round to round samples are kept, and columns that don't follow the model."""
    arm, recorded = robot(), moved(robot(), 3)
    carrying = replace(recorded, payload=np.where(recorded.time < 5, 0.0, 1.5))
    laid, how = list(stretches(carrying)), preparation(200.0, 10.0, "test")
    slopes = catalogue.COMPLIANCE  # of these at the stated masses, until they are chosen and refined
    placed = tuple(each for each in place_causes(seen(recorded)) if each.cause is not slopes)
    layout, plain = TorqueLayout(arm, placed, True), stated_model(arm)
    other = replace(plain, inertial=1.1 * plain.inertial, background=plain.background + 1.0, delay=np.full(3, 0.01))
    anew = build_rows(layout, laid, how, other)
    first = build_rows(layout, laid, how, plain)
    kept = build_rows(layout, laid, how, other, before=first)
    np.testing.assert_array_equal(kept.nominal, anew.nominal)
    for j in range(3):
        scale = np.maximum(np.abs(anew.columns[j]).max(axis=0), 1e-9)
        np.testing.assert_allclose(kept.columns[j] / scale, anew.columns[j] / scale, atol=1e-6)
        assert np.abs(kept.columns[j] - first.columns[j]).max() > 0.01


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 4))
def test_friction_behind_gains_and_masses_that_are_off_has_its_own_size(seed: int) -> None:
    rng = np.random.default_rng(seed)
    links = [
        {
            **link,
            "mass_kg": link["mass_kg"] * (1 + 0.1 * rng.normal()),
            "com_mm": link["com_mm"] + 30 * rng.normal(size=3),
        }
        for link in ROBOT["links"]
    ]
    recorded = moved(robot(links=links), seed, rubbing_with_the_load, runs=3)
    currents = replace(recorded, kind="current", effort=recorded.effort / GAINS)
    arm = robot(drives=[{"gain_nm_per_a": 10.0}] * 3)
    found = diagnose_motion(arm, currents, MotionSettings(cutoff=10.0)).verdict
    rubbing = {each.location: each.parameters[0] for each in found.effects if each.effect == "load_friction"}
    assert set(rubbing) == {"joint 2", "joint 3"}
    assert [rubbing[place].value for place in sorted(rubbing)] == pytest.approx([PER_LOAD] * 2, rel=0.03)
    assert not [each for each in found.effects if each.effect in ("motor_constant", "payload_error", "unknown")]
    assert found.held_out.model < 0.01
