"""The audit in one sentence, and the printed cells that it marks."""

import pandas as pd
import pytest

from armscope.paper.audit import AuditScope, audit
from armscope.report.text.audit import audit_sentence, contradictions

QUICK = AuditScope(rises=tuple(range(-1500, 1501, 300)), corner_samples=128, search_generations=5)


@pytest.mark.long
def test_no_path_makes_the_printed_numbers_agree():
    table = audit(QUICK)
    assert audit_sentence(table).startswith(
        "No path that the text allows makes Table 2 and Eqs. (15)–(20) agree on any"
    )
    marks = contradictions(table)
    assert marks.trajectories == {"test 1", "test 2", "test 3"}
    assert {("Uncompensated", "test 2", "x"), ("FDP(CI)", "test 2", "x")} <= marks.cells
    assert not [cell for cell in marks.cells if cell[0].endswith("(AI)")]


def test_a_trajectory_that_agrees_is_named():
    rows = [
        {"trajectory": f"test {k}", "reading": reading, "axis": "x, y, z", "check": "all together", "possible": good}
        for k in (1, 2, 3)
        for reading, good in (("rss", k == 2), ("rms", False))
    ]
    sentence = audit_sentence(pd.DataFrame(rows))
    assert sentence == (
        "Table 2 and Eqs. (15)–(20) can agree on trajectory II (root of the sum of squares); on I and III no path does."
    )


def test_a_pair_that_contradicts_marks_both_models_and_not_the_uncompensated_cell():
    row = {"trajectory": "test 3", "reading": "rss", "axis": "z", "check": "FDP(CI) and SDP(CI)", "possible": False}
    marks = contradictions(pd.DataFrame([row]))
    assert marks.cells == {("FDP(CI)", "test 3", "z"), ("SDP(CI)", "test 3", "z")}
