"""What remains is told in one way: as noise, with a pattern, or above a stated noise, of which one then asks."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.verdict.remainder import ABOVE_NOISE, above_what, asked_of_noise, still_open
from armscope.verdict.schema import NOISE_EXCEEDED, Notice, Unexplained
from armscope.verdict.sentences import headline
from tests.report import verdicts

EXCESS = Unexplained(True, None, None, 0.03, f"{ABOVE_NOISE}the stated noise, that follows nothing in the table")
PATTERN = Notice("model error", "What is left is more than noise, and no effect explains it.")


@pytest.mark.parametrize("patterned", [False, True])
def test_what_is_above_the_stated_noise_is_not_no_more_than_noise(patterned: bool) -> None:
    """Both stood on one page: "no more than noise in size, yet with a pattern", and "follows nothing in the table"."""
    notices = (PATTERN,) if patterned else ()
    size = {"residual_after_mm": 0.049, "noise_mm": 0.051, "notices": notices, "unexplained": EXCESS}
    said = still_open(verdicts.case(effects=(verdicts.compliance(),), **size).verdict)
    assert said.startswith("0.049 mm remain, above the stated noise, ")
    assert ("with a pattern" in said) == patterned
    assert ("follow nothing that was recorded" in said) != patterned
    assert "no more than noise" not in said


def test_what_has_a_place_or_lies_within_the_noise_exceeds_nothing() -> None:
    assert above_what(EXCESS) == "above the stated noise"
    assert above_what(replace(EXCESS, location="joint 4")) == ""
    assert above_what(Unexplained(False)) == ""


@pytest.mark.parametrize("asked", [True, False])
def test_where_nothing_can_be_told_the_stated_uncertainty_is_asked_for(asked: bool) -> None:
    notice = Notice(NOISE_EXCEEDED, "What remains is above the stated noise: is it too small?")
    case = verdicts.case(effects=(), unexplained=EXCESS, notices=(notice,) if asked else ())
    verdict = replace(case.verdict, answer="cannot tell", mismatch=True, residual_after_mm=0.0299)
    assert asked_of_noise(verdict) == ("is it too small?" if asked else "")
    said = headline(verdict)
    assert "above the stated noise" in said
    assert said.endswith(": is it too small?" if asked else "recorded.")
