"""Jumps of one kind are told apart by when they were."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.report.sections.effect_cards import title_of
from armscope.verdict.moments import since
from tests.report import verdicts


@pytest.mark.parametrize(
    ("driver", "told"),
    [
        ("between runs s1 and s2", " between runs s1 and s2"),
        ("in run b alone", " in run b alone"),
        ("run b", " in run b"),
    ],
)
def test_jumps_between_runs_are_told_apart(driver: str, told: str) -> None:
    """Three bars, three switches and three cards were all called "Base shift"."""
    effect = replace(verdicts.found("base_shift", "base", verdicts.Parameter("x", "mm", 0.6, 0.02)), driver=driver)
    assert since(effect) == told
    assert title_of(effect).endswith(told)


def test_a_jump_within_a_run_is_told_by_its_row_and_what_is_no_jump_by_nothing() -> None:
    row = verdicts.Parameter("row", "", 86.0, 0.3)
    jumped = replace(verdicts.found("tool_shift", "tool", row), driver="from then on, run a")
    assert since(jumped) == ", from row 86 of run a"
    assert since(verdicts.compliance()) == ""
