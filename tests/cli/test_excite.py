"""What a planned motion is better by is told in words; log determinants and conditions stand in the JSON alone."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.cli.excite import _maximised
from armscope.core.inputs import InputError
from armscope.poses.exciting.criterion import MotionScore

ROBOT = Path(__file__).parents[2] / "examples" / "one-effect" / "robot.yaml"


def test_what_was_maximised_is_told_of_both_motions() -> None:
    shown = SimpleNamespace(base=range(25))
    found: Any = SimpleNamespace(before=MotionScore(-53.4, 52.0), after=MotionScore(-45.2, 58.3), pairs=(), shown=shown)
    told = _maximised(found)
    assert "1.18 times as surely as from the median random motion" in told  # exp(8.2 / 50)
    assert not {"determinant", "condition", "-53.4", "58.3"} & set(told.split())
    found.before, found.after, found.pairs = MotionScore(0.1, 52.0), MotionScore(0.4, 58.3), ((),)
    told = _maximised(found)
    assert told == "least share that can't be imitated: 10% of the median random motion, 40% of this one"


@pytest.mark.long
def test_a_motion_is_planned_for_an_arm_given_either_way_and_not_for_none_or_two(tmp_path: Path) -> None:
    robot = ["-r", str(ROBOT)]
    planned = CliRunner().invoke(app, ["excite", *robot, "--rounds", "0", "-o", str(tmp_path / "motion.csv")])
    assert planned.exit_code == 0
    assert (tmp_path / "motion.csv").is_file()
    with pytest.raises(InputError, match="Leave one of them out"):
        CliRunner().invoke(app, ["excite", str(ROBOT), *robot, "-o", str(tmp_path / "two.csv")], catch_exceptions=False)
    with pytest.raises(InputError, match="found no arm"):
        CliRunner().invoke(app, ["excite", "-o", str(tmp_path / "none.csv")], catch_exceptions=False)
