"""What is promised on other poses: the error of all rows, where too many to be bad shots fit nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.verdict.contributions import contributions
from armscope.verdict.diagnosis import promised, rows_it_rests_on
from armscope.verdict.importance import expected
from armscope.verdict.schema import NO_BAD_SHOTS, ROWS_LEFT_OUT, HeldOut, Notice, SuspectRow
from armscope.verdict.sentences import headline, makes_worse

from ..report import verdicts

MANY = (Notice(NO_BAD_SHOTS, "21 of 110 rows fit none of this."),)
SEEN = HeldOut(0.33, 0.0823, before_all_rows=0.376, after_all_rows=0.336)
"""Of an arm with play whose side nobody wrote down: 0.082 mm were promised, 0.409 mm were got."""


def test_bad_shots_are_in_no_promise_and_many_rows_that_fit_nothing_are():
    few = verdicts.case(effects=(verdicts.compliance(),), held_out=SEEN).verdict
    many = replace(few, notices=MANY)
    assert not promised(replace(few, notices=(replace(MANY[0], kind=ROWS_LEFT_OUT),))).of_all, (
        "a tenth may be bad shots"
    )
    assert promised(few).foretold == (0.0823, False)
    assert promised(many).foretold == (0.336, True)
    assert promised(replace(many, held_out=HeldOut(0.33, 0.0823))).foretold == (0.0823, False), "not known of all rows"


def test_what_a_step_leaves_goes_from_end_to_end_of_the_promise():
    verdict = verdicts.case(effects=(verdicts.compliance(),), held_out=SEEN, notices=MANY).verdict
    worth = contributions(verdict)
    ends = [expected(verdict, worth, mm) for mm in (rms(worth.before), rms(worth.left))]
    assert ends == pytest.approx([0.376, 0.336])
    worse = replace(verdict, held_out=replace(SEEN, after_all_rows=0.41))
    assert expected(worse, worth, rms(worth.left)) == pytest.approx(0.41), "never the error of the others instead"
    between = [expected(verdict, worth, mm) for mm in np.linspace(rms(worth.left), rms(worth.before), 7)]
    assert between == sorted(between)


def test_a_model_by_which_all_rows_get_worse_is_told_so():
    verdict = verdicts.case(effects=(verdicts.compliance(),), held_out=SEEN, notices=MANY).verdict
    assert not makes_worse(verdict)
    worse = replace(verdict, held_out=replace(SEEN, after_all_rows=0.5))
    assert makes_worse(worse)
    assert "get worse by it, from 0.376 mm to 0.5 mm" in headline(worse).replace("\u00a0", " ")


def test_a_model_by_which_the_rows_that_it_was_fitted_to_get_worse_too_is_told_so():
    """Seen: a link that bows with another joint's angle was told as scatter, and all rows were missed by more."""
    seen = HeldOut(0.136, 0.148, before_all_rows=0.138, after_all_rows=0.15)
    verdict = verdicts.case(effects=(verdicts.compliance(),), held_out=seen).verdict
    assert not makes_worse(verdict), "less is a matter of which rows"
    worse = replace(verdict, residual_before_mm=0.132, residual_after_mm=0.144)
    assert makes_worse(worse)
    assert "get worse by it, from 0.136 mm to 0.148 mm" in headline(worse).replace("\u00a0", " ")
    assert not makes_worse(replace(worse, held_out=replace(seen, after=0.13)))


def test_a_bad_shot_is_no_row_that_a_model_rests_on():
    """Seen: one row at the largest load of all counted for nothing, and commands were given up to there."""
    verdict = verdicts.case(effects=(verdicts.compliance(),), held_out=SEEN).verdict
    table = verdict.recordings
    bad = SuspectRow(str(table.id[3]), str(table.run[3]), 1.3, 0.1)
    rests = rows_it_rests_on(replace(verdict, suspects=(bad,)))
    assert rests.id.tolist() == [each for n, each in enumerate(table.id.tolist()) if n != 3]
    assert len(rows_it_rests_on(replace(verdict, suspects=()))) == len(table)
    assert len(rows_it_rests_on(replace(verdict, suspects=(bad,), notices=MANY))) == len(table), "no bad shots then"
