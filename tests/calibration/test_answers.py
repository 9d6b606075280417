"""What a calibration engineer asks of the answer: what is held and why, what is shared, how well it does elsewhere."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import yaml
from typer.testing import CliRunner

from armscope.calibration.calibrate import calibrate
from armscope.calibration.confounding import Confounded, kind_of
from armscope.calibration.export import export, frames_content
from armscope.calibration.fit import least_squares
from armscope.calibration.geometry import constants_of, corrected
from armscope.calibration.model import set_up
from armscope.cli import app
from armscope.core.inputs import InputError
from armscope.robot import load_arm
from armscope.robot.arm import build_arm
from tests.calibration.worlds import far_away, measured, planted, poses, together, ur_like
from tests.robot.arms import random_masses

TOOL = {"": [0.05, 0.1, 0.2]}
NOISE_M = 2e-5


@pytest.fixture
def rng():
    return np.random.default_rng(0)


def changed(arm, **values):
    """The arm with constants off: joint_2_a=1e-3."""
    constants = constants_of(arm)
    wrong = {name.replace("_", " "): value for name, value in values.items()}
    assert wrong.keys() <= {each.name for each in constants}
    return corrected(arm, constants, np.array([wrong.get(each.name, 0.0) for each in constants]))


def test_what_is_held_is_named_with_what_it_imitates(rng):
    recordings = measured(planted(ur_like(), rng), poses(rng, 80, 6), far_away(rng), TOOL, run="")
    calibration = calibrate(ur_like(), recordings)
    partners = {each.name: each.partners for each in calibration.held}
    assert partners["joint 1 theta"] == ("base rz",)
    assert partners["joint 1 d"] == ("base z",)
    assert partners["joint 6 d"] == ("tool z",)
    parallel = {"joint 2 d", "joint 3 d", "joint 4 d"}  # three axes side by side: their shifts add up
    assert len(parallel & partners.keys()) == 2
    assert {partners[name] for name in parallel & partners.keys()} == {tuple(parallel - partners.keys())}
    assert "joint 1 theta: as base rz" in calibration.text()


def test_partners_undo_what_a_held_parameter_does(rng):
    """By the exact arm: the held parameter changes, its partners alone are fitted again, and nothing is to be seen."""
    tools = [{"p1": [0.05, 0.1, 0.2], "p2": [0.1, 0.0, 0.2]}, {"p1": [0.05, 0.1, 0.2]}]
    parts = [
        measured(ur_like(), poses(rng, 60, 6), far_away(rng), tool, run=f"run {k}") for k, tool in enumerate(tools)
    ]
    calibration = calibrate(ur_like(), together(*parts))
    assert {each.name: each.partners for each in calibration.held}["joint 1 theta"] == ("base rz",)
    rows, names = calibration.set_up, np.array(calibration.set_up.names)
    for each in calibration.held:
        step = np.where(names == each.name, 1e-4, 0.0)
        moved = calibration.state.moved(step)
        before = np.sqrt(np.mean(rows.residuals(moved) ** 2))
        partners = np.array([kind_of(name) in each.partners for name in names])
        after = np.sqrt(np.mean(rows.residuals(least_squares(rows, moved, partners).state) ** 2))
        assert after <= 1.1 * each.left * before + 1e-7
        # and no partner is idle
        for idle in each.partners if each.left < 0.02 else ():
            others = partners & ~np.array([kind_of(name) == idle for name in names])
            without = rows.residuals(least_squares(rows, moved, others).state)
            assert np.sqrt(np.mean(without**2)) > after


def test_a_joint_that_stands_still_hardly_moves_the_tool(rng):
    angles = poses(rng, 80, 6)
    angles[:, 4:] = 0.3
    level = calibrate(ur_like(links=random_masses(rng, 6)), measured(ur_like(), angles, far_away(rng), TOOL), "offsets")
    assert {"joint 5 theta", "joint 6 theta"} <= {each.name for each in level.held}


def two_runs(rng, tools, bases=None, noise=NOISE_M):
    arm = planted(ur_like(), rng, 2e-4, 2e-4)
    bases = bases or [far_away(rng)] * 2
    return together(
        *(
            measured(arm, poses(rng, 60, 6), base, {"": tool}, noise, rng, run)
            for run, tool, base in zip("ab", tools, bases, strict=True)
        )
    )


def test_a_tool_that_was_exchanged_is_free_in_every_run_and_that_is_said(rng):
    tools = [[0.05, 0.1, 0.2], [0.05, -0.1, 0.2]]
    recordings = two_runs(rng, tools)
    found = calibrate(ur_like(), recordings)
    np.testing.assert_allclose(found.state.tools, tools, atol=1e-3)  # the last joint's errors imitate a tool's
    assert any("it was exchanged, and is free in every run" in note for note in found.notes)
    assert found.doubts == ()
    insisted = calibrate(ur_like(), recordings, tool_per_run=False)
    assert any("one tool for all runs" in doubt for doubt in insisted.doubts)


def test_a_tool_that_stayed_is_one(rng):
    found = calibrate(ur_like(), two_runs(rng, [[0.05, 0.1, 0.2]] * 2))
    assert (len(found.state.tools), found.notes, found.doubts) == (1, (), ())


@pytest.mark.parametrize("length", [3, 4, 8])
def test_many_short_runs_are_no_reason_to_free_their_tools(rng, length):
    """Frames of their own always come nearer to so few rows."""
    arm = planted(ur_like(), rng)
    short = [measured(arm, poses(rng, length, 6), far_away(rng), TOOL, NOISE_M, rng, f"run {k}") for k in range(12)]
    assert calibrate(ur_like(), together(*short)).notes == ()


def test_one_base_for_all_is_doubted_only_where_it_was_moved(rng):
    tools = [[0.05, 0.1, 0.2]] * 2
    assert calibrate(ur_like(), two_runs(rng, tools), one_base=True).doubts == ()
    moved = calibrate(ur_like(), two_runs(rng, tools, [far_away(rng), far_away(rng)]), one_base=True)
    assert any("one base frame for all runs" in doubt for doubt in moved.doubts)


def test_a_drawing_far_off_is_doubted_and_an_encoder_zero_is_not(rng):
    def found(**wrong):
        recordings = measured(changed(ur_like(), **wrong), poses(rng, 80, 6), far_away(rng), TOOL)
        return calibrate(ur_like(), recordings)

    (doubt,) = found(joint_2_a=0.15).doubts
    assert "joint 2 a by 150 mm" in doubt
    assert found(joint_3_theta=0.2).doubts == ()


def test_errors_in_sample_and_held_out_stand_side_by_side(rng):
    recordings = two_runs(rng, [[0.05, 0.1, 0.2]] * 2, noise=1e-4)
    whole, a, b = calibrate(ur_like(), recordings, splits=5).misses.to_dict("records")
    assert [whole["run"], a["run"], b["run"]] == ["all", "a", "b"]
    assert (whole["rows"], a["rows"]) == (120, 60)
    noise_mm = 0.1 * np.sqrt(3)
    spent = 36 / 360  # of 360 numbers, 36 parameters
    assert whole["in_sample_mm"] == pytest.approx(noise_mm * np.sqrt(1 - spent), rel=0.1)
    assert whole["held_out_mm"] == pytest.approx(noise_mm * np.sqrt(1 + spent / 0.7), rel=0.1)
    assert whole["in_sample_mm"] < noise_mm < whole["held_out_mm"] < whole["frames_only_mm"]
    assert whole["held_out_mm"] ** 2 == pytest.approx(np.mean([a["held_out_mm"] ** 2, b["held_out_mm"] ** 2]), rel=0.1)


def test_a_calibration_that_gains_nothing_elsewhere_says_so(rng):
    def notes(arm):
        return calibrate(ur_like(), measured(arm, poses(rng, 60, 6), far_away(rng), TOOL, 1e-4, rng), splits=5).notes

    assert any("no better than base and tool alone" in note for note in notes(ur_like()))
    assert notes(planted(ur_like(), rng)) == ()


def test_rows_whose_base_took_no_part_are_not_tested(rng):
    """A run of one configuration is either learned from or not to be foretold."""
    one_pose = measured(ur_like(), poses(rng, 1, 6), far_away(rng), TOOL, NOISE_M, rng, "single")
    one_pose = replace(one_pose, target=np.array(["its own"]))
    recordings = together(measured(ur_like(), poses(rng, 60, 6), far_away(rng), TOOL, NOISE_M, rng), one_pose)
    misses = calibrate(ur_like(), recordings, splits=5).misses.set_index("run")
    assert np.isnan(misses.loc["single", "held_out_mm"])
    assert misses.loc["all", "held_out_mm"] < 0.06


def test_a_base_that_one_pose_cannot_tell_is_marked_in_the_frames(rng, tmp_path):
    one_pose = measured(ur_like(), poses(rng, 1, 6), far_away(rng), TOOL, NOISE_M, rng, "single")
    recordings = together(measured(ur_like(), poses(rng, 60, 6), far_away(rng), TOOL, NOISE_M, rng), one_pose)
    export(calibrate(ur_like(), recordings), tmp_path)
    many, single = yaml.safe_load((tmp_path / "frames.yaml").read_text())["base_frames"]
    assert "not_identified" not in many
    assert len(single["not_identified"]) == 3


def test_compliances_without_loads_are_refused(rng):
    recordings = measured(ur_like(), poses(rng, 60, 6), far_away(rng), TOOL)
    with pytest.raises(InputError, match=r"level.*'compliance'.*nor recorded torques.*`links`"):
        calibrate(ur_like(), recordings, "compliance")


@pytest.mark.parametrize(("sign", "noted"), [(1, False), (-1, True)])
def test_a_joint_that_turns_against_its_load_is_noted(rng, sign, noted):
    arm = build_arm(ur_like(links=random_masses(rng, 6)).description)
    angles = poses(rng, 80, 6)
    recordings = measured(arm, angles, far_away(rng), TOOL)
    torque = set_up(arm, recordings).loads
    turned = measured(arm, angles + sign * 1e-5 * torque * (np.arange(6) == 1), far_away(rng), TOOL)
    found = calibrate(arm, replace(turned, motor_angles=angles), "compliance")
    assert found.state.compliances[1] == pytest.approx(sign * 1e-5, rel=0.05)
    content = frames_content(found)
    assert content["compliances_rad_per_nm"]["q2"] == found.state.compliances[1]
    assert content["loads"] == "gravity of the mass table"
    text = "turns against its load, which no spring does: joint 2; does gravity_m_s2 point the right way?"
    assert found.notes == ((text,) if noted else ())


def test_links_without_mass_are_named_where_loads_follow_from_masses(rng):
    links = [dict(link, mass_kg=0) if number == 3 else link for number, link in enumerate(random_masses(rng, 6))]
    arm = ur_like(links=links)
    recordings = measured(arm, poses(rng, 60, 6), far_away(rng), TOOL, NOISE_M, rng)
    (note,) = calibrate(arm, recordings, "compliance").notes
    assert note == "no mass is stated for what turns with joint 4: it counts as weightless"
    assert calibrate(arm, recordings, "geometric").notes == ()


def test_many_partners_are_told_by_the_frames_they_belong_to():
    many = Confounded("joint 1 rx", ("base rx", "base y", "base ry", "tool of p1 z"), 0.01)
    assert many.text() == "joint 1 rx: as base with tool of p1"
    assert replace(many, left=0.2).text().endswith("tool of p1 and more")
    assert Confounded("joint 6 d", ("tool z",), 0.0).text() == "joint 6 d: as tool z"
    assert Confounded("joint 6 d", (), 1.0).text() == "joint 6 d: hardly moves the tool"


@pytest.mark.long
def test_the_command_writes_what_was_found_and_nothing_that_is_doubtful(rng, tmp_path):
    from armscope.core.files import write_yaml

    def written(recordings, name, *options):
        angles = {f"q{j + 1}_rad": recordings.motor_angles[:, j] for j in range(6)}
        points = {f"{axis}_mm": 1e3 * recordings.positions[:, k] for k, axis in enumerate("xyz")}
        table = pd.DataFrame({"id": recordings.id, "run": recordings.run} | angles | points)
        table.to_csv(tmp_path / f"{name}.csv", index=False)
        line = ["calibrate", tmp_path / f"{name}.csv", "-r", tmp_path / "robot.yaml", "-o", tmp_path / name, *options]
        return CliRunner().invoke(app, list(map(str, line)))

    write_yaml(tmp_path / "robot.yaml", ur_like().description.model_dump(exclude_defaults=True))
    good = written(two_runs(rng, [[0.05, 0.1, 0.2]] * 2), "good")
    assert good.exit_code == 0, good.output
    assert "held out" in good.output
    fitted = pd.read_csv(tmp_path / "good" / "calibration.csv")
    covariance = pd.read_csv(tmp_path / "good" / "covariance.csv", index_col="parameter")
    assert list(covariance.index) == list(covariance.columns) == list(fitted["parameter"])
    np.testing.assert_allclose(np.sqrt(np.diag(covariance)), fitted["stderr"])
    upper = fitted.set_index("parameter").loc["joint 2 a"]
    rows = yaml.safe_load((tmp_path / "good" / "robot.yaml").read_text())["dh"]["joints"]
    assert 1e3 * (upper["nominal"] + upper["value"]) == pytest.approx(rows[1]["a_mm"])
    assert f"becomes {rows[1]['a_mm']:.6g} mm" in good.output
    held = pd.read_csv(tmp_path / "good" / "held.csv").set_index("parameter")
    assert held.loc["joint 6 d", "imitated_by"] == "tool z"
    assert (tmp_path / "good" / "misses.csv").is_file()

    unknown = written(two_runs(rng, [[0.05, 0.1, 0.2]] * 2), "unknown", "--target", "p1")
    assert "no such target" in str(unknown.exception)
    assert not list((tmp_path / "unknown").glob("*"))

    moved = two_runs(rng, [[0.05, 0.1, 0.2]] * 2, [far_away(rng), far_away(rng)])
    bad = written(moved, "bad", "--one-base")
    assert isinstance(bad.exception, InputError)
    assert "should not be used" in str(bad.exception)
    assert not list((tmp_path / "bad").glob("*"))
    assert written(moved, "bad", "--one-base", "--anyway").exit_code == 0


def test_constants_that_help_no_other_pose_are_not_written_as_corrections(rng, tmp_path):
    """A noisy tracker and an arm that is as drawn: robot.yaml has its tool, and D-H rows as they were."""
    from armscope.core.files import write_yaml

    nominal = ur_like()
    rows = measured(nominal, poses(rng, 40, 6), far_away(rng), {"": [0.05, 0.1, 0.2]})
    noisy = rows.positions * 1e3 + rng.normal(0, 0.5, (40, 3))
    angles = {f"q{j + 1}_rad": rows.motor_angles[:, j] for j in range(6)}
    points = {f"{axis}_mm": noisy[:, k] for k, axis in enumerate("xyz")}
    pd.DataFrame(angles | points).to_csv(tmp_path / "recordings.csv", index=False)
    write_yaml(tmp_path / "robot.yaml", nominal.description.model_dump(exclude_defaults=True))
    for options, as_drawn in (((), True), (("--anyway",), False)):
        line = ["calibrate", str(tmp_path), "-o", str(tmp_path / f"out{len(options)}"), *options]
        done = CliRunner().invoke(app, line)
        assert done.exit_code == 0, done.output
        assert "the nominal arm serves as well" in done.output
        assert ("these constants are not written" in done.output) is as_drawn
        written = load_arm(tmp_path / f"out{len(options)}" / "robot.yaml")
        assert np.allclose(written.before, nominal.before, atol=1e-9) is as_drawn
        if as_drawn:
            np.testing.assert_allclose(written.tool, [0.05, 0.1, 0.2], atol=2e-3)
