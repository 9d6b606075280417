"""The model of a motion is a file of its own: written, read back, it predicts what the verdict says it does."""

from __future__ import annotations

import importlib.resources
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml
from numpy.random import default_rng

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.motion.library.layout import DRY, LATER, OWN, TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.model import file as model_file
from armscope.motion.model.file import load_motion_model, save_motion_model
from armscope.motion.model.file_check import CauseReader
from armscope.motion.model.fitted import MotionModel, fitted_model, predicted_torque
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.predicting import torque_of_rows, torque_table
from armscope.motion.samples.preparation import preparation
from armscope.motion.samples.timing import stretches
from armscope.motion.verdict import relative
from tests.motion.moving import moved, robot

PUBLISHED = importlib.resources.files("armscope.motion") / "model.schema.json"


def loaded(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction that grows with load, and a cable, at joint 2."""
    extra = np.zeros_like(q)
    extra[:, 1] = 0.08 * np.abs(rigid[:, 1]) * np.sign(dq[:, 1]) + 6 * np.sin(2.3 * q[:, 1])
    return extra


@pytest.fixture(scope="module")
def found() -> MotionDiagnosis:
    """A diagnosis with a run that took no part."""
    arm = robot()
    return diagnose_motion(arm, moved(arm, 4, loaded, seconds=15.0), MotionSettings(cutoff=10.0, held_out=("path 2",)))


def every_cause() -> MotionModel:
    """A model with all causes of the library at once."""
    arm, motions, rng = robot(), moved(robot(), 5), default_rng(1)
    warm = motions.rows(slice(None))
    object.__setattr__(warm, "temperature", 20 + 10 * rng.random(motions.q.shape))
    placed = [each for each in place_causes(seen_in(arm, list(stretches(warm)), 0.02)) if each.of_background is None]
    return MotionModel(
        arm,
        preparation(200.0, 10.0, "test"),
        "torque",
        rng.normal(size=(3, OWN)),
        arm.inertial * (1 + 0.01 * rng.normal(size=30)),
        0.01 * rng.normal(size=3),
        tuple(FittedCause(each, 0.01 * rng.normal(size=each.width), 0.01 * np.eye(each.width)) for each in placed),
        response=1e-5,
        width_of_sides=np.array([0.002, 0.04, 0.002]),
        order_of_sides=np.array([0, 1, 2]),
    )


@pytest.mark.long
def test_the_error_of_its_predictions_is_the_verdicts(found: MotionDiagnosis, tmp_path: Path) -> None:
    save_motion_model(tmp_path / "model.yaml", found.model)
    motions = moved(robot(), 4, loaded, seconds=15.0)
    held_out = motions.rows(motions.run == "path 2")
    predicted, notes = torque_of_rows(load_motion_model(tmp_path / "model.yaml"), held_out)
    how = found.how
    kept = np.arange(how.edge, len(held_out) - how.edge, how.every)
    measured, expected = how.low_passed(held_out.effort, kept), how.low_passed(predicted, kept)
    assert not notes
    assert relative(measured - expected, measured) == pytest.approx(found.verdict.held_out.model, rel=1e-3)
    assert found.verdict.held_out.model < 0.7 * found.verdict.held_out.background


def test_a_run_without_any_temperature_is_not_predicted_where_the_model_follows_it() -> None:
    """It ended in an error of SciPy, or in cells without a number."""
    motions = moved(robot(), 6, runs=2, seconds=3.0)
    unknown = np.broadcast_to((motions.run == "path 2")[:, None], motions.q.shape)
    object.__setattr__(motions, "temperature", np.where(unknown, np.nan, 25.0))
    with pytest.raises(InputError, match="run path 2: found no temperature in any row"):
        torque_table(every_cause(), motions)


def test_a_load_of_one_run_is_taken_by_name_and_said() -> None:
    """The run of that name may be another motion; under another name its load was left out without a word."""
    motions = moved(robot(), 6, runs=2, seconds=3.0)
    object.__setattr__(motions, "temperature", np.full(motions.q.shape, 23.0))
    notes = torque_table(every_cause(), motions)[1]
    assert any("Run path 1 is taken to have what the model's own run of that name had" in note for note in notes)
    object.__setattr__(motions, "run", np.char.add(motions.run, " again"))
    notes = torque_table(every_cause(), motions)[1]
    assert any("of run path 1 of the model's own motion alone" in note for note in notes)


def test_what_follows_the_time_follows_it_since_the_run_began() -> None:
    """A clock of the day put all of a run at the end of the curve."""
    model, motions = every_cause(), moved(robot(), 6, runs=1, seconds=6.0)
    over_time = [each for each in model.causes if each.placed.driver == "time" and not each.placed.runs]
    assert over_time
    model = replace(model, causes=tuple(replace(each, values=1e3 * each.values) for each in over_time))
    torque, notes = torque_table(model, motions)
    later, _ = torque_table(model, motions.at_times(motions.time + 86400.0))
    names = ["tau1_nm", "tau2_nm", "tau3_nm"]
    np.testing.assert_allclose(later[names], torque[names], atol=0.01)
    assert any(note.startswith("Taken to come back in each run") for note in notes)


def test_where_the_motion_was_is_in_the_model_file(found: MotionDiagnosis, tmp_path: Path) -> None:
    save_motion_model(tmp_path / "model.yaml", found.model)
    again = load_motion_model(tmp_path / "model.yaml")
    assert found.model.positions is not None
    assert again.positions == pytest.approx(found.model.positions)


def test_a_model_read_back_predicts_the_same_whatever_is_in_it(tmp_path: Path) -> None:
    model, motions = every_cause(), moved(robot(), 6, runs=1, seconds=6.0)
    object.__setattr__(motions, "temperature", np.full(motions.q.shape, 23.0))
    save_motion_model(tmp_path / "model.yaml", model)
    again = load_motion_model(tmp_path / "model.yaml")
    (first, _), (second, _) = torque_of_rows(model, motions), torque_of_rows(again, motions)
    assert np.isfinite(first).all()
    np.testing.assert_allclose(second, first, rtol=1e-9)
    jsonschema.validate(yaml.safe_load((tmp_path / "model.yaml").read_text(encoding="utf-8")), published())


def test_rows_are_predicted_in_their_order_and_repeated_ones_like_the_row_before() -> None:
    model, motions = every_cause(), moved(robot(), 6, runs=2, seconds=6.0)
    object.__setattr__(motions, "temperature", np.full(motions.q.shape, 23.0))
    whole, _ = torque_of_rows(model, motions)
    mixed = np.argsort(np.tile(np.arange(len(motions) // 2), 2), kind="stable")  # the two runs' rows by turns
    np.testing.assert_allclose(torque_of_rows(model, motions.rows(mixed))[0], whole[mixed])


def published() -> Any:
    return json.loads(PUBLISHED.read_text(encoding="utf-8"))


def test_the_published_schema_is_the_one_that_the_types_generate() -> None:
    regenerate = "armscope schema motion-model > src/armscope/motion/model.schema.json"
    assert published() == model_file.schema(), f"regenerate it: {regenerate}"


@pytest.mark.parametrize(
    ("edit", "place"),
    [
        (lambda m: m.update(format="armscope motion model 9"), "format"),
        (lambda m: m["joints"].pop(), "joints"),
        (lambda m: m["links"][0].update(m="heavy"), "links[0].m"),
        (lambda m: m["causes"][0].update(effect="load_fricton"), "causes[0].effect"),
        (lambda m: m["causes"][0]["law"].update(kind="load fricton"), "causes[0].law.kind"),
        (lambda m: m["causes"][0]["law"].update(joints=[9]), "causes[0].law.joints"),
        (lambda m: m["causes"][0]["law"].update(joints=[1, 2]), "causes[0].law"),
        (lambda m: m["causes"][0]["law"].update(numbers=[]), "causes[0].law"),
        (lambda m: m["causes"][0]["law"].update(numbers=[0.0]), "causes[0].law"),
        (lambda m: m["causes"][0]["law"].update(kind="curve over speed", numbers=[1, 1, 9]), "causes[0].law.numbers"),
        (lambda m: m["causes"][0]["parameters"].append(m["causes"][0]["parameters"][0]), "causes[0].law"),
        (lambda m: m["causes"][0].update(inertial=[inertial(link=9)]), "causes[0].inertial[0]"),
        (lambda m: m["preparation"].update(rate_hz=0), "preparation.rate_hz"),
        (lambda m: m["robot"].pop("dh"), "robot"),
    ],
)
def test_an_edited_model_is_refused_with_the_place_of_the_edit(
    found: MotionDiagnosis, tmp_path: Path, edit: Any, place: str
) -> None:
    save_motion_model(tmp_path / "model.yaml", found.model)
    content = yaml.safe_load((tmp_path / "model.yaml").read_text(encoding="utf-8"))
    content["causes"].sort(key=lambda cause: cause["effect"] != "load_friction")
    edit(content)
    (tmp_path / "model.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    with pytest.raises(InputError) as told:
        load_motion_model(tmp_path / "model.yaml")
    assert told.value.place.startswith(place)


def test_a_cause_is_read_by_what_the_file_says_of_it() -> None:
    model = every_cause()
    read = CauseReader(model.arm, "model.yaml").causes([model_file.cause_out(cause) for cause in model.causes])
    for again, cause in zip(read, model.causes, strict=True):
        assert again.placed.parameters == cause.placed.parameters
        assert again.placed.columns == cause.placed.columns
        np.testing.assert_array_equal(again.values, cause.values)
        np.testing.assert_allclose(again.stderr, cause.stderr)


def inertial(link: int) -> dict[str, object]:
    return {"parameter": 1, "link": link, "what": "m", "per_unit": 1.0}


def dry_friction(late: float) -> tuple[Array, Array]:
    """Times, and joint 1's predicted torque of 4 N m of dry friction alone that changes sides later by some seconds."""
    arm = robot()
    layout = TorqueLayout(arm, (), False)
    coefficients = np.zeros(layout.width)
    own = coefficients[layout.own].reshape(-1, OWN)
    own[:, DRY], own[:, LATER] = 4.0, 4.0 * late
    coefficients[layout.own] = own.ravel()
    stretch = next(iter(stretches(moved(arm, 4, seconds=6.0, runs=1))))
    how = preparation(stretch.rate, 20.0, "given")
    models = [fitted_model(layout, each, [], how) for each in (coefficients, np.zeros(layout.width))]
    with_friction, without = (predicted_torque(model, [stretch])[0][:, 0] for model in models)
    return stretch.time, with_friction - without


def test_friction_that_changes_sides_later_is_predicted_as_a_shift_in_time() -> None:
    """What is fitted as a slope of friction over time is a step at another moment, not a spike beside the step."""
    (time, dry), (_, late) = dry_friction(0.0), dry_friction(0.005)
    assert np.max(np.abs(late)) == pytest.approx(4.0, abs=0.01)
    shifted = np.interp(time - 0.005, time, dry)
    assert np.sum((late - shifted) ** 2) < 0.2 * np.sum((late - dry) ** 2)


@pytest.mark.parametrize("late", [-0.06, 0.03, 0.1])
def test_no_joint_is_predicted_more_dry_friction_than_it_has(late: float) -> None:
    """Moves from point to point may fit shifts of tens of milliseconds: the rest was spikes of many times friction."""
    _, dry = dry_friction(late)
    assert np.max(np.abs(dry)) == pytest.approx(4.0, abs=0.01)
