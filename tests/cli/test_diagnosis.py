"""What the console says beside a diagnosis' answer."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from armscope.cli.diagnosis import _notes
from armscope.recordings.table import unmeasured
from armscope.robot.library import nominal_description
from armscope.verdict.schema import Notice, SuspectRow


@pytest.fixture
def arm() -> Any:
    from armscope.robot.arm import build_arm

    return build_arm(nominal_description("ur5e"))


def notes(arm: Any, rows: int = 12, **verdict: Any) -> list[str]:
    given: Any = SimpleNamespace(**{"mismatch": None, "notices": (), "suspects": ()} | verdict)
    return list(_notes(given, arm, unmeasured(np.zeros((rows, 6)))))


def test_rows_that_look_like_bad_shots_are_named(arm: Any) -> None:
    rows = [SuspectRow("4", "", 1000882.07, 1e-28), *(SuspectRow(str(n), "b", 0.5123, 0.1) for n in range(7))]
    assert notes(arm) == []
    assert notes(arm, suspects=rows[:2]) == [
        "rows that look like bad shots, and count for little: 4 (1000882 mm off), b: 0 (0.51 mm off)"
    ]
    assert notes(arm, suspects=rows)[0].endswith("b: 3 (0.51 mm off), ... (8 in all: suspects.csv)")


def test_where_rows_are_too_few_it_is_said_how_many_are_needed(arm: Any) -> None:
    obstacle = Notice(
        "fewer rows than parameters", "12 rows hold 36 numbers, 9 of which base and tool take up: too few."
    )
    assert notes(arm, notices=(obstacle,))[-1] == "of these runs and targets a diagnosis needs 15 rows at least."


def test_a_tool_that_moved_between_runs_is_told(arm: Any) -> None:
    moved = Notice("tool exchanged", "From run to run the tool lies elsewhere, its point up to 6.16 mm.")
    assert notes(arm, mismatch=True, effects=(), notices=(moved,)) == [moved.text]
