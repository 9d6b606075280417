"""What is planted in a motion is found by name, place and size; what is not there is not named."""

import functools
from types import SimpleNamespace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion import pipeline
from armscope.motion.library.catalogue import COULOMB as COULOMB_CAUSE
from armscope.motion.library.catalogue import ROTOR as ROTOR_CAUSE
from armscope.motion.library.causes import Cause
from armscope.motion.library.changes_catalogue import LOAD_CHANGE
from armscope.motion.library.laws import Law
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.recordings.motions import as_motions
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, Plant, behind_its_drive, clinging, moved, robot
from tests.seeds import seeds


@functools.cache
def diagnosed(plant: Plant | None, seed: int = 1, **more: float) -> MotionDiagnosis:
    """What is said of an arm with ordinary friction and what was planted: of the same plant once in a process."""
    arm = robot()
    return diagnose_motion(arm, moved(arm, seed, plant, **more), MotionSettings(cutoff=10.0))


def names(found: MotionDiagnosis) -> list[tuple[str, str]]:
    return [(cause.effect, cause.location) for cause in found.verdict.effects]


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_an_arm_with_ordinary_friction_has_nothing_missing(seed: int) -> None:
    found = diagnosed(None, seed)
    assert found.verdict.answer == "nothing missing"
    assert found.verdict.held_out.model < 0.02 < found.verdict.held_out.stated


def test_friction_and_rotors_are_told_in_one_line_per_joint() -> None:
    for told, coulomb in zip(diagnosed(None, 1).verdict.background, COULOMB, strict=True):
        dry = next(parameter for parameter in told.parameters if parameter.name == "coulomb")
        low, high = dry.interval
        assert low - 0.02 * coulomb < coulomb < high + 0.02 * coulomb
        assert [parameter.name for parameter in told.parameters] == ["coulomb", "viscous", "inertia"]


def rubbing_with_load(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2 that grows with its load."""
    extra = np.zeros_like(q)
    extra[:, 1] = 0.08 * np.abs(rigid[:, 1]) * np.sign(dq[:, 1])
    return extra


def test_friction_that_grows_with_load_is_found_at_its_joint() -> None:
    found = diagnosed(rubbing_with_load)
    assert names(found) == [("load_friction", "joint 2")]
    cause = found.verdict.effects[0]
    low, high = cause.parameters[0].interval
    assert low - 0.004 < 0.08 < high + 0.004
    assert cause.consistent
    assert found.verdict.held_out.model < found.verdict.held_out.background


@pytest.mark.parametrize(
    ("joint", "compliance", "seconds"), [(1, 1.5e-3, 10.0), pytest.param(2, 6e-3, 15.0, marks=pytest.mark.long)]
)
def test_a_drive_that_gives_way_is_found_from_its_motors_encoder_alone(
    joint: int, compliance: float, seconds: float
) -> None:
    """The motors' places follow from the links' exactly, and the diagnosis hears of neither the links nor the law."""
    arm = robot()
    motions = as_motions(behind_its_drive(arm, joint, compliance, seconds=seconds), "motions.csv", 3)
    found = diagnose_motion(arm, motions)
    assert names(found) == [("joint_compliance", f"joint {joint + 1}")]
    (cause,) = found.verdict.effects
    low, high = cause.parameters[0].interval
    assert low < compliance < high < 1.1 * low
    law = found.model.causes[0].placed.columns
    assert isinstance(law, Law)
    assert law.numbers[1] == pytest.approx(cause.parameters[0].value, rel=0.02)  # exact there, no slope at zero
    assert "mrad per N m" in found.verdict.headline


@pytest.mark.long
def test_no_drive_gives_way_against_its_torque() -> None:
    """By as much as is named from one run where it is the right way round."""
    motions = as_motions(behind_its_drive(robot(), 1, -0.75e-3), "motions.csv", 3)
    motions = motions.rows(np.flatnonzero(motions.run == motions.runs[0]))
    assert "joint_compliance" not in [effect for effect, _ in names(diagnose_motion(robot(), motions))]


@pytest.mark.long
def test_a_torque_constant_that_is_off_is_no_drive_that_gives_way() -> None:
    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        whole = rigid + COULOMB * np.sign(dq) + VISCOUS * dq + ROTOR * ddq
        return np.asarray(-0.06 * whole * [0, 1, 0])

    assert names(diagnosed(plant)) == [("motor_constant", "joint 2")]


def test_what_no_cause_has_is_located_and_not_called_something_else() -> None:
    found = diagnosed(clinging)
    assert names(found) == [("unknown", "joint 2")]
    assert found.verdict.effects[0].driver == "way since the last reversal"
    assert found.verdict.answer == "cannot tell"


@pytest.mark.long
def test_friction_that_is_uneven_over_the_turn_is_located_with_its_size() -> None:
    def off_centre(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return np.sign(dq) * (0.6 * np.cos(q) - 0.8 * np.sin(q)) * [0, 1, 0]

    found = diagnosed(off_centre)
    assert names(found) == [("unknown", "joint 2")]
    (cause,) = found.verdict.effects
    assert cause.driver == "joint angle and direction"
    assert "follows the joint angle and direction by no known law" in found.verdict.headline
    for parameter, true in zip(cause.parameters, (-0.8, 0.6), strict=True):
        low, high = parameter.interval
        assert low < true < high < low + 0.3


def test_a_delay_is_found_to_the_millisecond_though_friction_jumps() -> None:
    def late(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        true = rigid + COULOMB * np.sign(dq) + VISCOUS * dq + ROTOR * ddq
        extra = np.zeros_like(q)
        extra[6:, 2] = true[:-6, 2] - true[6:, 2]
        return extra

    found = diagnosed(late)
    assert names(found) == [("torque_delay", "joint 3")]
    assert abs(found.verdict.effects[0].parameters[0].value - 0.03) < 0.001


@pytest.mark.long
def test_friction_that_turns_early_takes_nothing_from_the_rotor() -> None:
    def early(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return COULOMB * (np.sign(dq + 0.002 * ddq) - np.sign(dq))

    for told, rotor in zip(diagnosed(early).verdict.background, ROTOR, strict=True):
        inertia = next(parameter for parameter in told.parameters if parameter.name == "inertia")
        assert abs(inertia.value - rotor) < 3 * inertia.stderr < 0.05 * rotor


def test_a_payload_that_nobody_stated_is_weighed() -> None:
    arm = robot()
    heavier = robot(tool_load={"mass_kg": 1.5, "com_mm": [0, 0, 0]})
    found = diagnose_motion(arm, moved(heavier, 3), MotionSettings(cutoff=10.0))
    assert names(found)[0] == ("payload_error", "payload")
    low, high = found.verdict.effects[0].parameters[0].interval
    assert low - 0.05 < 1.5 < high + 0.05


@pytest.mark.long
def test_a_run_that_is_held_out_takes_no_part() -> None:
    arm = robot()
    motions = moved(arm, 4)
    found = diagnose_motion(arm, motions, MotionSettings(cutoff=10.0, held_out=("path 2",)))
    assert found.verdict.runs == ("path 1",)
    assert found.verdict.held_out.what == "runs path 2"
    assert found.test is not None


@pytest.mark.parametrize("stands", [True, False])
def test_what_changes_within_a_run_takes_nothing_along_when_it_goes(
    monkeypatch: pytest.MonkeyPatch, stands: bool
) -> None:
    """A selection with a load that comes and goes may have many names beside it that only stand with it."""

    def selection(*causes: Cause) -> SimpleNamespace:
        placed = [SimpleNamespace(cause=cause) for cause in causes]
        candidates = frozenset(range(len(causes)))
        return SimpleNamespace(
            rows=SimpleNamespace(layout=SimpleNamespace(placed=placed)),
            best=SimpleNamespace(candidates=candidates),
            space=SimpleNamespace(starts=(None, None)),
        )

    without, wider = selection(ROTOR_CAUSE), selection(LOAD_CHANGE, COULOMB_CAUSE)
    left = selection(COULOMB_CAUSE)
    monkeypatch.setattr(pipeline, "rather_all_links", lambda selected, start: selected)
    monkeypatch.setattr(pipeline, "tenable", lambda at, rate: left if at is wider and not stands else at)
    assert pipeline._that_stands(without, wider, 100.0) is (wider if stands else without)  # type: ignore[arg-type, comparison-overlap]
