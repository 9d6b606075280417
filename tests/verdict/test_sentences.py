"""Causes as clauses: what is small everywhere is told with its worst place, and stays small errors in a headline."""

from __future__ import annotations

from dataclasses import replace

from armscope.verdict.effects import Cause
from armscope.verdict.schema import Background
from armscope.verdict.sentences import cause_in_words, headline
from tests.report import verdicts

GIVE = Background("elastic", present=True, size=0.4, rms_at_tool_mm=0.4, share=0.1)


def test_small_errors_everywhere_are_told_with_their_worst_place() -> None:
    assert cause_in_words("elastic", (), GIVE) == "all joints and links give way"
    assert cause_in_words("elastic", (), replace(GIVE, worst="joint 2")) == (
        "all joints and links give way, most at joint 2"
    )


def test_with_a_worst_place_they_are_still_what_a_headline_tells_last() -> None:
    said = cause_in_words("elastic", (), replace(GIVE, worst="joint 2"))
    zero = Cause("geometric", "effect", "joint 3", ("joint offset at joint 3",), False, False, 0.8, 0.1, "the zero", "")
    give = Cause("elastic", "family", "arm", (), True, False, 0.1, 0.1, said, "")
    told = headline(replace(verdicts.case(effects=(verdicts.compliance(),)).verdict, causes=(zero, give)))
    assert told.startswith("The zero – 80 % of the squared error. Small errors of stiffness in the whole arm (10 %)")
