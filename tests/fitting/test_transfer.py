"""What was learned on one run, applied to another: it helps where it is the arm's, and only frames may adapt."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.diagnosis import Settings, diagnose
from armscope.fitting.registration import fit_frames
from armscope.fitting.transfer import belongs_to_the_arm, transfer
from armscope.physics.effect import Driver, Part
from armscope.physics.freeform import held
from armscope.physics.model import FittedModel, predict
from armscope.physics.model_file import load_model, save_model
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..diagnosis.planted import one_run, recorded
from ..physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
NOISE = 0.02
ARMS = {("joint_compliance", "joint 2"): [5e-7]}
RUNS = {("base_drift", "base"): [2e-4, 0.0, -1e-4, 0.0, 2e-4, 0.0]}


@pytest.fixture(scope="module")
def learned() -> tuple[Arm, FittedModel]:
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 150, 3), ARMS | RUNS, NOISE, seed=4)
    return arm, diagnose(arm, table, QUICK).model


@pytest.fixture(scope="module")
def other(learned: tuple[Arm, FittedModel]) -> Recordings:
    """Another day: other poses, another base far away, no drift."""
    table = replace(one_run(learned[0], 120, 7), run=np.full(120, "later"))
    return recorded(learned[0], table, ARMS, NOISE, seed=8, far=True)


@pytest.mark.long
def test_what_belongs_to_the_arm_is_applied_and_what_belongs_to_the_run_is_not(
    learned: tuple[Arm, FittedModel], other: Recordings
) -> None:
    result = transfer(learned[1], other)
    assert [name for name in result.applied if "background" not in name] == ["joint_compliance at joint 2"]
    assert result.left_mm == pytest.approx(np.sqrt(3) * NOISE, rel=0.08)
    bare = transfer(learned[1], other, ())
    assert not bare.applied
    assert bare.left_mm > 5 * result.left_mm
    errors = 1e3 * (other.positions - predict(result.model, other))
    assert np.sqrt(np.mean(np.sum(errors**2, axis=1))) == pytest.approx(result.left_mm, rel=1e-9)


def test_a_drive_that_works_loose_between_runs_is_of_these_runs(other: Recordings) -> None:
    """What changed between recordings was taken for what all of them share, and had no name."""
    two = replace(other, run=np.where(np.arange(len(other)) < 60, "a", "b"))
    placed = [each for each in library(arm_named("six-axis"), two) if each.name == "compliance_change"]
    assert len(placed) > 2
    assert {each.driver: belongs_to_the_arm(each) for each in placed} == {
        "temperature": True, "between runs a and b": False
    }  # fmt: skip


def test_the_parameters_stay_as_they_were_learned(learned: tuple[Arm, FittedModel], other: Recordings) -> None:
    (part,) = transfer(learned[1], other, ["joint_compliance"]).model.parts
    same = next(p for p in learned[1].parts if p.placed.name == "joint_compliance")
    np.testing.assert_array_equal(part.values, same.values)


def test_a_drift_of_one_run_hurts_another(learned: tuple[Arm, FittedModel], other: Recordings) -> None:
    both = transfer(learned[1], other, ["elastic", "drift"])
    assert both.left_mm > 2 * transfer(learned[1], other, ["elastic"]).left_mm


@pytest.mark.long
def test_kept_frames_hold_where_nothing_moved(learned: tuple[Arm, FittedModel]) -> None:
    arm, _ = learned
    table = recorded(arm, one_run(arm, 150, 3), ARMS, NOISE, seed=4)
    model = diagnose(arm, table.rows(np.arange(100)), QUICK).model
    rest = table.rows(np.arange(100, 150))
    kept = transfer(model, rest, refitted=())
    bare = transfer(fit_frames(arm, table.rows(np.arange(100))), rest, refitted=())
    assert kept.left_mm == pytest.approx(np.sqrt(3) * NOISE, rel=0.2)
    assert bare.left_mm > 5 * kept.left_mm
    moved = replace(rest, positions=rest.positions + np.array([1e-3, 0, 0]))
    assert transfer(model, moved, refitted=()).left_mm == pytest.approx(1.0, rel=0.05)
    assert transfer(model, moved, refitted=("base",)).left_mm < 2 * NOISE
    assert transfer(model, moved, refitted=("tool",)).left_mm > 0.3, "a tool does not move with the base"


def test_a_tool_that_is_not_known_and_effects_that_are_not_there_are_told(
    learned: tuple[Arm, FittedModel], other: Recordings
) -> None:
    with pytest.raises(InputError, match="p9"):
        transfer(learned[1], replace(other, target=np.full(len(other), "p9")), refitted=("base",))
    with pytest.raises(InputError, match="backlash"):
        transfer(learned[1], other, ["backlash"])


def test_a_curve_goes_no_farther_than_it_was_learned(tmp_path_factory: pytest.TempPathFactory) -> None:
    arm = arm_named("six-axis")
    table = one_run(arm, 80, 3)
    angle = np.append(np.linspace(-1.0, 1.0, 79), 2.5)  # the last row stands alone: a home pose
    table.motor_angles[:, 1] = angle
    curve = next(p for p in library(arm, table) if p.key == ("unknown", "joint 2") and p.variant == "angle")
    part = Part(held(curve, table), np.random.default_rng(0).normal(size=len(curve.terms)) * 1e-4)
    probe = one_run(arm, 5, 4)
    probe.motor_angles[:, 1] = [-0.3, -1.0, -1.4, -0.3 + 2 * np.pi, 2.2]

    def turn(placed: Part) -> np.ndarray:
        scene = Scene(arm, probe)
        drivers = [(v, t.products[0].driver) for v, t in zip(placed.values, placed.placed.terms, strict=True)]
        return np.asarray(sum(v * scene.driver(d) for v, d in drivers))

    free, kept = turn(Part(curve, part.values)), turn(part)
    assert kept[0] == pytest.approx(free[0], abs=1e-12)
    assert kept[2] == pytest.approx(free[1], abs=1e-12), "its end value is held"
    assert kept[3] == pytest.approx(free[0], abs=1e-12), "a full turn away is the same place"
    probe.motor_angles[4, 1] = 1.0
    assert kept[4] == pytest.approx(turn(Part(curve, part.values))[4], abs=1e-12)
    # and so it is in the file
    path = tmp_path_factory.mktemp("model") / "model.yaml"
    save_model(path, FittedModel(arm, {}, (), (part,)))
    assert load_model(path).parts[0].placed.terms[3].products[0].driver == Driver("sine", (2, *_count(part), -1.0, 1.0))


def _count(part: Part) -> tuple[float]:
    return (part.placed.terms[3].products[0].driver.arguments[1],)  # type: ignore[return-value]


def test_small_give_of_a_base_stays_with_that_base(learned: tuple[Arm, FittedModel], other: Recordings) -> None:
    arm, model = learned
    tilts = next(p for p in library(arm, other) if p.name == "base_compliance" and not p.variant)
    gives = Part(tilts, np.array([2e-7]))
    on_its_base = replace(model, background=(*model.background, gives))
    assert transfer(on_its_base, other).left_mm == pytest.approx(transfer(model, other).left_mm, rel=1e-9)
    named = replace(model, parts=(*model.parts, gives))
    assert transfer(named, other).left_mm > 2 * transfer(model, other).left_mm
