"""Compliances of one arm agree between runs, another arm's do not; intervals own up to what a run can't tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.files import write_yaml
from armscope.real.compliance_tables import agreement_in_words, compare_runs
from armscope.real.compliances import Give, as_heavy_as_recorded, compare_compliances, fit_give, gravity_as_recorded
from armscope.real.constants import COMPLIANCE
from armscope.real.reference import ReferenceCompliances
from armscope.real.simulated_comparison import compare_on_simulated_arms, draw_arm, simulate_recordings
from armscope.recordings import Recordings
from armscope.robot import chain
from armscope.robot.gravity import gravity_torques
from tests.physics.scenes import arm_named
from tests.real.recorded import ROBOT, table

HEAVIER = 1.4


def rows(arm, count, seed, run, moving, payload=0.0):
    """Commanded angles with torques as recorded: links heavier than stated, a payload, a sensor's ripple."""
    rng = np.random.default_rng(seed)
    angles = np.where(moving, rng.uniform(-1.2, 1.2, (count, arm.n_motors)), 0.0)
    frames = chain(arm, angles)
    kilograms = np.full(count, payload)
    alone = gravity_torques(arm, frames)
    torque = HEAVIER * alone + gravity_torques(arm, frames, kilograms) - alone
    ripple = 0.01 * np.abs(torque).max() * rng.normal(size=torque.shape)
    return Recordings(
        motor_angles=angles,
        positions=np.full((count, 3), np.nan),
        run=np.full(count, run),
        target=np.full(count, ""),
        id=np.arange(1, count + 1).astype(str),
        orientation=np.tile([1.0, 0, 0, 0], (count, 1)),
        payload=kilograms,
        torque=torque + ripple,
    )


@pytest.fixture(scope="module")
def runs():
    arm = arm_named("seven-axis")
    everywhere = rows(arm, 150, 1, "all joints", np.ones(7, dtype=bool))
    two = rows(arm, 100, 2, "two joints", np.arange(7) < 2, payload=2.0)
    return arm, everywhere, two


def test_masses_are_as_heavy_as_the_torques_say_whatever_is_carried(runs):
    arm, everywhere, two = runs
    for each in (everywhere, two):
        assert as_heavy_as_recorded(arm, each)[1] == pytest.approx(HEAVIER, rel=0.01)
        clean = gravity_as_recorded(arm, each)
        assert np.sqrt(np.mean((clean - each.torque) ** 2)) < 0.015 * np.abs(each.torque).max()


@pytest.mark.long
@pytest.mark.parametrize("arms", [2, pytest.param(4, marks=pytest.mark.long)])
def test_one_arm_agrees_with_itself_and_a_softer_one_does_not(runs, arms):
    arm, everywhere, two = runs
    found = compare_on_simulated_arms(arm, everywhere, two, (2, 4), arms=arms, seed=3).set_index("arm")
    assert found.loc["the same arm", "agree"] == arms
    assert found.loc["an arm 15 % softer", "agree"] == 0
    assert (found["held"] >= 0.8 * found["numbers"]).all()


@pytest.mark.long
def test_a_run_of_two_joints_knows_that_it_cannot_tell_drives_apart(runs):
    arm, everywhere, two = runs
    rng = np.random.default_rng(5)
    drawn = draw_arm(arm, everywhere, rng)
    one, other = (fit_give(arm, simulate_recordings(arm, each, drawn, 1.0, rng), "x") for each in (everywhere, two))
    assert one.stderr[3] < 0.5 * COMPLIANCE.prior_rad_nm
    assert other.stderr[3] > 0.5 * COMPLIANCE.prior_rad_nm
    # joint 1 turns about gravity's line: no load, nothing learned
    assert other.stderr[0] == pytest.approx(COMPLIANCE.prior_rad_nm)
    together = compare_compliances(one, other)
    assert len(together.directions) >= 1
    assert together.stderr[0] < 0.1 * COMPLIANCE.prior_rad_nm


def measured(rng, truth, rows_, noise):
    """What a linear measurement with Gaussian noise says of a truth that was drawn from the prior."""
    columns = rows_ / noise
    posterior = np.linalg.inv(columns.T @ columns + np.eye(len(truth)) / COMPLIANCE.prior_rad_nm**2)
    mean = posterior @ columns.T @ (columns @ truth + rng.normal(size=len(rows_)))
    return Give("run", 0, mean, posterior, posterior, 0.0, 1.0)


def test_probabilities_are_what_they_say_where_everything_is_known():
    """Under a shared truth a probability below 5 % comes up in 5 % of the cases; a shift of 4 sigma is seen."""
    rng = np.random.default_rng(1)
    probabilities = []
    for _ in range(600):
        truth = COMPLIANCE.prior_rad_nm * rng.normal(size=4)
        one = measured(rng, truth, rng.normal(size=(3, 4)), 3e-5)
        other = measured(rng, truth, rng.normal(size=(2, 4)), 1e-5)
        probabilities.append(compare_compliances(one, other).probability)
    told = np.array(probabilities)[np.isfinite(probabilities)]
    assert len(told) > 300
    # the F distribution of so many blocks is a little wider than the chi-square that holds here
    assert 0.015 < np.mean(told < 0.05) < 0.065
    assert 0.42 < np.mean(told < 0.5) < 0.55
    one = measured(rng, np.array([COMPLIANCE.prior_rad_nm, 0.0]), np.eye(2), 1e-5)
    other = measured(rng, np.array([0.2 * COMPLIANCE.prior_rad_nm, 0.0]), np.eye(2), 1e-5)
    assert compare_compliances(one, other).probability < 1e-4


def test_runs_that_determine_nothing_in_common_are_not_said_to_agree():
    rng = np.random.default_rng(0)
    one, other = (measured(rng, np.zeros(2), row[None], 1e-6) for row in np.eye(2))
    assert np.isnan(compare_compliances(one, other).probability)


def test_a_combination_is_told_by_its_largest_weights():
    direction = -np.array([0.0, 0.5, 0.02, 0.0, -1.0, 0.0])
    assert agreement_in_words(direction, 3) == "bearing 2 - 0.5 drive 2"


@pytest.mark.long
def test_tables_hold_every_run_and_every_pair(runs):
    arm, everywhere, two = runs
    rng = np.random.default_rng(7)
    drawn = draw_arm(arm, everywhere, rng)
    one, other = (simulate_recordings(arm, each, drawn, 1.0, rng) for each in (everywhere, two))
    arrays = {name: value for name, value in vars(one).items() if isinstance(value, np.ndarray)}
    joined = replace(one, **{name: np.concatenate([value, getattr(other, name)]) for name, value in arrays.items()})
    stated = ReferenceCompliances(
        runs=("all joints", "two joints"), learned_on="all joints", microrad_per_nm={2: 1e6 * drawn.drives[1]}
    )
    values, pairs = compare_runs(arm, joined, stated)
    mine = values[(values["of"] == "joint 2") & (values["run"] == "all joints")]
    assert list(mine["learned"]) == ["points alone", "points and orientations"]
    assert (mine["low"] < mine["reference"]).all()
    assert (mine["reference"] < mine["high"]).all()
    assert values["reference"].notna().sum() == 2
    assert (pairs["probability"] > 0.05).all()
    assert np.allclose(pairs["one_value"] - pairs["other_value"], pairs["difference"], atol=1e-6)


def test_what_is_needed_and_missing_is_said(tmp_path):
    table(20).to_csv(tmp_path / "recordings.csv", index=False)
    run = {"name": "one", "run": "one", "figures_mm": {"nominal": [1.0, 0.1]}}
    reference = {"source": "here", "runs": [run]}
    write_yaml(tmp_path / "none.yaml", reference)
    wanted = {"runs": ["one", "two"], "learned_on": "one", "microrad_per_nm": {2: 60.0}}
    write_yaml(tmp_path / "wanted.yaml", reference | {"compliances": wanted})
    for name, said in (("none", "which runs to compare"), ("wanted", "no column tau1_nm")):
        words = ["real", "compliances", str(tmp_path / "recordings.csv"), str(ROBOT), str(tmp_path / f"{name}.yaml")]
        result = CliRunner().invoke(app, [*words, "-o", str(tmp_path)])
        assert result.exit_code != 0
        assert said in str(result.exception) + result.output
