"""The audit in one sentence, and the printed cells that it marks."""

from dataclasses import replace

import pandas as pd
import pytest

from armscope.paper.audit import audit
from armscope.paper.audit_scope import AuditScope
from armscope.report.pages.paper_tables import audit_rows
from armscope.report.text.audit import audit_sentence, contradictions

QUICK = AuditScope(rises=tuple(range(-1500, 1501, 50)), corner_samples=1024, search_generations=5)


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
    sentence = audit_sentence(pd.DataFrame(rows).assign(searched="4096 sets of corners", thorough=True))
    assert sentence == (
        "Table 2 and Eqs. (15)–(20) can agree on trajectory II (root of the sum of squares); on I and III no path does."
        " Searched: 4096 sets of corners."
    )
    sentence = audit_sentence(pd.DataFrame(rows).assign(searched="1 set of corners", thorough=False))
    assert "on I and III none of the few that were tried does." in sentence


def test_what_was_hardly_searched_is_not_called_impossible():
    """One set of corners in a tiny box and three rises: nothing found says nothing."""
    tiny = AuditScope(rises=(-1500, 0, 1500), low=(900, -100, 500), high=(1000, 100, 700), corner_samples=1)
    table = audit(replace(tiny, search_generations=2))
    sentence, marks = audit_sentence(table), contradictions(table)
    assert "was found among the few that were tried: too few to say that there is none" in sentence
    assert "1 set of corners in a box from (900, -100, 500) to (1000, 100, 700) mm, and 3 rises" in sentence
    assert not marks.thorough
    words = "".join(audit_rows(table).columns)
    assert "some path of those tried obeys" in words


def test_a_pair_that_contradicts_marks_both_models_and_not_the_uncompensated_cell():
    row = {"trajectory": "test 3", "reading": "rss", "axis": "z", "check": "FDP(CI) and SDP(CI)", "possible": False}
    marks = contradictions(pd.DataFrame([row]).assign(searched="", thorough=True))
    assert marks.cells == {("FDP(CI)", "test 3", "z"), ("SDP(CI)", "test 3", "z")}
