"""`diagnose --exit-code` ends with the answer: one rule for points and motions."""

from pathlib import Path

import pandas as pd
import pytest
import yaml
from tests.motion.moving import ROBOT, clinging, robot, table
from typer.testing import CliRunner

from armscope.cli import app
from armscope.cli.endings import exit_code_of
from armscope.core.files import read_json
from armscope.verdict.schema import Answer

POINTS = Path(__file__).parents[2] / "examples" / "clean"


@pytest.mark.parametrize(
    ("answer", "code"), [("nothing missing", 0), ("explained", 10), ("partly explained", 10), ("cannot tell", 2)]
)
def test_the_answer_alone_decides(answer: Answer, code: int) -> None:
    assert exit_code_of(answer) == code


@pytest.mark.parametrize("command", ["diagnose", "calibrate"])
def test_an_output_that_cannot_be_is_told_before_anything_is_read(command: str, tmp_path: Path, monkeypatch) -> None:
    """Within half a second: whoever names the folder of his robot.yaml need not wait for tables and kinematics."""
    (tmp_path / "robot.yaml").write_text((POINTS / "robot.yaml").read_text())
    (tmp_path / "predicted.csv").write_text((POINTS / "recordings.csv").read_text())
    monkeypatch.setattr("armscope.cli.robots.arm_and_tables", lambda *_: pytest.fail("was read"))
    line = f"{command} {tmp_path / 'predicted.csv'} -r {tmp_path / 'robot.yaml'} -o {tmp_path} --force"
    done = CliRunner().invoke(app, line.split())
    assert "an input of this command" in str(done.exception)


def test_check_tells_once_how_columns_were_read(tmp_path: Path) -> None:
    head, rows = (POINTS / "recordings.csv").read_text().split("\n", 1)
    (tmp_path / "loud.csv").write_text(f"{head.replace('q1_rad', 'Q1_RAD')}\n{rows}")
    said = CliRunner().invoke(app, ["check", str(tmp_path / "loud.csv")]).output
    assert said.count("columns read as") == 1, said


@pytest.mark.parametrize("kind", ["points", "motions"])
def test_points_and_motions_that_cannot_tell_end_alike(kind: str, tmp_path: Path) -> None:
    file, arm = tmp_path / "table.csv", tmp_path / "robot.yaml"
    if kind == "motions":
        arm.write_text(yaml.safe_dump(ROBOT))
        table(robot(), 1, clinging).to_csv(file, index=False)
        more = "--cutoff 10"
    else:
        arm.write_text((POINTS / "robot.yaml").read_text())
        mistaken = pd.read_csv(POINTS / "recordings.csv")
        mistaken[["x_mm", "y_mm", "z_mm"]] = mistaken[["x_mm", "y_mm", "z_mm"]].sample(frac=1, random_state=0).values
        mistaken.to_csv(file, index=False)
        more = "--resamples 0 --no-cross-validation --anyway"
    line = f"diagnose {file} -r {arm} -o {tmp_path / 'out'} --no-report --exit-code {more}"
    done = CliRunner().invoke(app, line.split())
    assert read_json(tmp_path / "out" / "verdict.json", "")["answer"] == "cannot tell", done.output
    assert done.exit_code == 2
