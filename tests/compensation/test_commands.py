"""From recordings to commands by the command line."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from armscope.cli import app
from armscope.compensation.black_box import load_error_model, save_error_model
from armscope.compensation.compensate import compensate_black_box
from armscope.compensation.path import as_path
from armscope.compensation.physical import load_identified, save_identified
from armscope.compensation.rapid import read_rapid
from armscope.core.inputs import InputError
from armscope.physics.model_file import save_model
from armscope.recordings.columns import AXES_MM
from armscope.robot import forward_kinematics
from tests.robot.arms import CONFIG, SK120

from .arms import (
    CONTEXT,
    MIDDLE,
    black_box,
    identification_angles,
    physical,
    physical_path,
    sk120,
    table_of,
    wanted_points,
)


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def recordings(tmp_path):
    angles = identification_angles()
    nominal = forward_kinematics(sk120(), angles) * 1e3
    measured = nominal + [1.0, -2.0, 0.5] + nominal * 1e-3
    table = pd.DataFrame(np.column_stack([angles, measured]), columns=[*(f"q{j}_rad" for j in range(1, 7)), *"xyz"])
    table.rename(columns={axis: f"{axis}_mm" for axis in "xyz"}).to_csv(tmp_path / "recordings.csv", index=False)
    return tmp_path / "recordings.csv"


@pytest.mark.parametrize("method", ["least-squares", "swarm"])
def test_a_fitted_error_model_compensates_a_path_in_three_formats(recordings, tmp_path, method):
    model = tmp_path / "errormodel.json"
    fitted = run("fit-error-model", recordings, "-r", SK120, "-m", "FDP(CI)", "--method", method, "-o", model)
    assert fitted.exit_code == 0, fitted.output
    table_of(wanted_points(30)).to_csv(tmp_path / "path.csv", index=False)
    for name in ("a.csv", "a.json", "a.mod"):
        done = run("compensate", model, tmp_path / "path.csv", "-o", tmp_path / name, "-r", SK120)
        assert done.exit_code == 0, done.output
    table = pd.read_csv(tmp_path / "a.csv")
    commands = table[[f"q{j}_rad" for j in range(1, 7)]].to_numpy()
    nominal = forward_kinematics(sk120(), commands) * 1e3
    real = nominal + [1.0, -2.0, 0.5] + nominal * 1e-3
    assert np.abs(real - wanted_points(30) * 1e3).max() < 0.01
    np.testing.assert_allclose(read_rapid(tmp_path / "a.mod", 6), commands, atol=1e-8)
    content = json.loads((tmp_path / "a.json").read_text())
    assert (content["rows"], content["refused"], content["frame"]) == (30, 0, "base")
    assert content["commands"][4]["q2_rad"] == pytest.approx(commands[4, 1])


def test_a_partly_impossible_path_keeps_its_rows_and_gives_no_job(tmp_path):
    save_error_model(tmp_path / "m.json", black_box())
    wanted = wanted_points(10)
    wanted[3] = [9.0, 0, 0]
    table_of(wanted, id=[f"p{n}" for n in range(10)]).to_csv(tmp_path / "path.csv", index=False)
    done = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / "a.csv")
    assert done.exit_code == 3
    assert "refused: line 5 of the file: beyond reach" in done.output
    table = pd.read_csv(tmp_path / "a.csv")
    assert len(table) == 10
    assert table.loc[3, ["id", "status"]].tolist() == ["p3", "refused"]
    job = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / "a.mod")
    assert isinstance(job.exception, InputError)
    assert not (tmp_path / "a.mod").exists()


def test_points_of_the_instrument_taken_for_those_of_the_base_are_told_how_to_say_so(tmp_path):
    save_error_model(tmp_path / "m.json", black_box())
    said = []
    for name, away in (("all", [9.0, 0, 0]), ("one", np.repeat([[9.0, 0, 0], [0, 0, 0]], [1, 9], axis=0))):
        table_of(wanted_points(10) + away).to_csv(tmp_path / "path.csv", index=False)
        done = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / f"{name}.csv")
        assert done.exit_code == 3
        said.append("--frame measurement" in done.output)
    assert said == [True, False]


def test_rows_outside_by_different_distances_are_told_in_one_line(tmp_path):
    save_error_model(tmp_path / "m.json", black_box())
    turned = MIDDLE + np.linspace(0.9, 1.2, 6)[:, None] * np.eye(6)[0]
    table_of(forward_kinematics(sk120(), turned)).to_csv(tmp_path / "path.csv", index=False)
    done = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / "a.csv")
    lines = [line for line in done.output.splitlines() if line.startswith("refused")]
    causes = pd.read_csv(tmp_path / "a.csv")["reason"].str.replace(r" by .*", "", regex=True)
    assert causes.str.startswith("outside").sum() > 3
    assert len(lines) == causes.nunique() < pd.read_csv(tmp_path / "a.csv")["reason"].nunique()


def test_diagnosed_physics_needs_to_know_where_it_was_identified(tmp_path):
    model, identified = physical()
    points, middle = physical_path(12)
    save_model(tmp_path / "model.yaml", model)
    table_of(points, **CONTEXT).to_csv(tmp_path / "path.csv", index=False)
    start = ",".join(f"{value:.6f}" for value in middle)
    call = (
        "compensate",
        tmp_path / "model.yaml",
        tmp_path / "path.csv",
        "-o",
        tmp_path / "a.csv",
        "--start-rad",
        start,
    )
    assert "--recordings" in str(run(*call).exception)
    save_identified(tmp_path / "domain.json", identified)
    done = run(*call)
    assert done.exit_code == 0, done.output
    assert pd.read_csv(tmp_path / "a.csv")["residual_mm"].max() < 1e-5


def test_a_model_of_another_arm_is_an_error(tmp_path):
    save_error_model(tmp_path / "m.json", black_box())
    table_of(wanted_points(5)).to_csv(tmp_path / "path.csv", index=False)
    other = CONFIG / "robots" / "six-axis.yaml"
    done = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / "a.csv", "-r", other)
    assert isinstance(done.exception, InputError)
    assert "another arm" in str(done.exception)


@pytest.mark.parametrize(
    ("arguments", "found"),
    [
        (("-o", "a.xlsx"), "ending"),
        (("--start-rad", "1,2"), "6 angles"),
        (("--start-rad", "a,b"), "numbers"),
    ],
)
def test_options_that_cannot_be(tmp_path, arguments, found):
    save_error_model(tmp_path / "m.json", black_box())
    table_of(wanted_points(5)).to_csv(tmp_path / "path.csv", index=False)
    done = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / "a.csv", *arguments)
    assert isinstance(done.exception, InputError)
    assert found in str(done.exception)


def test_a_frame_that_is_none_is_refused_with_the_known_ones(tmp_path):
    done = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / "a.csv", "--frame", "world")
    assert done.exit_code == 2
    assert "'measurement'" in done.output


def test_model_files_come_back_and_broken_ones_are_errors(tmp_path):
    model = black_box()
    save_error_model(tmp_path / "m.json", model)
    again = load_error_model(tmp_path / "m.json")
    angles = identification_angles(10, 9)
    nominal = forward_kinematics(sk120(), angles)
    np.testing.assert_allclose(again.error_and_slope(angles, nominal)[0], model.error_and_slope(angles, nominal)[0])
    content = json.loads((tmp_path / "m.json").read_text())
    content["coefficients"][0].pop()
    for broken in ("{", "[]", json.dumps({**content}), json.dumps({**content, "format": "other"})):
        (tmp_path / "broken.json").write_text(broken)
        with pytest.raises(InputError) as error:
            load_error_model(tmp_path / "broken.json")
        assert "broken.json" in str(error.value)


def test_a_domain_file_comes_back(tmp_path):
    _, identified = physical()
    save_identified(tmp_path / "domain.json", identified)
    again = load_identified(tmp_path / "domain.json")
    assert again.arm == identified.arm
    assert again.payload_kg == identified.payload_kg
    np.testing.assert_allclose(again.domain.low, identified.domain.low)
    (tmp_path / "domain.json").write_text("{}")
    with pytest.raises(InputError):
        load_identified(tmp_path / "domain.json")


def test_blended_regions_compensate_too(recordings, tmp_path):
    model = tmp_path / "errormodel.json"
    call = ("fit-error-model", recordings, "-r", SK120, "-m", "FDP(CI)", "-o", model, "--regions")
    assert run(*call, 4).exit_code == 0
    fitted = load_error_model(model)
    assert fitted.coefficients.shape == (4, 3, 4)
    path = as_path(table_of(wanted_points(30)), "path", sk120())
    result = compensate_black_box(fitted, path)
    assert result.reached.all()
    nominal = forward_kinematics(sk120(), result.commands) * 1e3
    assert np.abs(nominal + [1.0, -2.0, 0.5] + nominal * 1e-3 - wanted_points(30) * 1e3).max() < 1e-3
    assert run(*call, "auto").exit_code == 0
    assert load_error_model(model).coefficients.shape == (1, 3, 4)  # one law everywhere needs no regions
    assert isinstance(run(*call, 3).exception, InputError)
    assert isinstance(run(*call, 64).exception, InputError)


def test_products_compensate_too(recordings, tmp_path):
    model = tmp_path / "errormodel.json"
    call = ("fit-error-model", recordings, "-r", SK120, "-m", "Fourier 3 (AI)", "-o", model, "--products")
    assert run(*call).exit_code == 0
    fitted = load_error_model(model)
    assert fitted.name == "Fourier 3 (AI) with products"
    result = compensate_black_box(fitted, as_path(table_of(wanted_points(30)), "path", sk120()))
    assert result.reached.all()
    nominal = forward_kinematics(sk120(), result.commands) * 1e3
    assert np.abs(nominal + [1.0, -2.0, 0.5] + nominal * 1e-3 - wanted_points(30) * 1e3).max() < 0.1
    assert isinstance(run(*call, "--regions", 2).exception, InputError)


def test_what_the_model_leaves_of_its_own_rows_is_said_of_a_correction():
    """The predicted rest, nothing, is what the model thinks of itself."""
    model = replace(black_box(), rms_mm=np.array([0.8, 0.0, 0.6]))
    path = as_path(table_of(wanted_points(5)), "points", model.arm)
    (note,) = compensate_black_box(model, path).notes
    assert note.endswith("what the model leaves of the rows that it was fitted to: 1 mm RMS of the distance")
    (note,) = compensate_black_box(replace(model, rms_mm=np.full(3, 50.0)), path).notes
    assert note.endswith("86.6 mm RMS of the distance"), "whether the arm gets better does not follow from that"


def test_a_miss_that_is_nothing_is_not_told_to_its_last_bit(tmp_path):
    """A model without errors, by which the nominal arm is right."""
    model, identified = physical()
    save_model(tmp_path / "model.yaml", replace(model, parts=()))
    save_identified(tmp_path / "domain.json", identified)
    points, middle = physical_path(5)
    table_of(points, **CONTEXT).to_csv(tmp_path / "path.csv", index=False)
    start = ",".join(map(str, middle))
    told = run(
        "compensate", tmp_path / "model.yaml", tmp_path / "path.csv", "-o", tmp_path / "c.csv", "--start-rad", start
    )
    assert told.exit_code == 0, told.output
    assert "5 of 5 rows: predicted miss below 0.001 mm RMS of the distance; corrected, the model expects" in told.output


def test_a_model_that_is_worse_than_base_and_tool_alone_is_warned_of(tmp_path):
    """Points of an instrument that stands 20 mm beside the base: a model of them without --register takes the shift."""
    angles = identification_angles()
    points = forward_kinematics(sk120(), angles) * 1e3
    turn = Rotation.from_rotvec([0.0, 0.0, 0.004]).as_matrix()
    table = {f"q{j + 1}_rad": angles[:, j] for j in range(6)} | dict(zip(AXES_MM, (points @ turn.T).T, strict=True))
    pd.DataFrame(table).to_csv(tmp_path / "r.csv", index=False)
    words = ("fit-error-model", tmp_path / "r.csv", "--robot", SK120, "-o", tmp_path / "e.json", "--model", "FDP(AI)")
    done = run(*words)
    assert done.exit_code == 0, done.output
    assert "base and tool alone leave" in done.stderr
    assert "it makes the arm worse. Give --register." in done.stderr


def test_commands_say_for_which_load_temperature_and_side_they_are(tmp_path):
    save_error_model(tmp_path / "m.json", black_box())
    sides = {f"approach{j}": [1, -1, 1] for j in range(1, 7)} | {
        "payload_kg": [0.0, 2.0, 4.0],
        "temperature_c": [20.0, 21.0, 22.0],
    }
    table_of(wanted_points(3), **sides).to_csv(tmp_path / "path.csv", index=False)
    done = run("compensate", tmp_path / "m.json", tmp_path / "path.csv", "-o", tmp_path / "a.csv")
    assert done.exit_code == 0, done.output
    table = pd.read_csv(tmp_path / "a.csv")
    for name, values in sides.items():
        assert table[name].tolist() == values
