"""A model that makes the error larger orders nothing, on no page and in no file."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.report.pages.diagnosis import write_report
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.not_yet import NOT_YET, curing_only_what_helps
from armscope.verdict.schema import HeldOut
from armscope.verdict.sentences import makes_worse

from ..report import verdicts

NUMBERS = "zero_offsets.csv", "corrected_dh.csv"


def diagnosed(after: float) -> Diagnosis:
    effects = (
        verdicts.compliance(),
        verdicts.found("joint_offset", "joint 2", verdicts.Parameter("offset", "rad", 1e-3, 1e-5)),
    )
    return verdicts.case(effects=effects, held_out=HeldOut(1.3, after)).verdict


@pytest.mark.parametrize(("after", "orders"), [(0.1, True), (6.8, False)])
def test_only_a_model_that_helps_orders_anything(tmp_path, after, orders):
    verdict = diagnosed(after)
    told = curing_only_what_helps(verdict)
    assert (told is verdict) == orders
    assert all((effect.cure == NOT_YET) != orders for effect in told.effects)
    report = write_report(verdict, tmp_path).read_text().replace("\u00a0", " ")
    order = (tmp_path / "work-order.html").read_text()
    assert [(tmp_path / name).exists() for name in NUMBERS] == [orders, orders]
    assert ("zero_offsets.csv" in order) == orders
    assert ("<b>Do:</b>" in order) == orders
    assert (NOT_YET in order) != orders
    assert (NOT_YET in report) != orders
    if not orders:
        assert all(effect.confirm in order for effect in verdict.effects), "what to confirm stands there all the same"


def test_a_model_that_is_base_and_tool_alone_is_not_worse_than_they_are_by_rounding() -> None:
    """Of noise alone, with nothing named, it was told that "the model with these names meets the rows worse"."""
    verdict = verdicts.case(effects=()).verdict
    before = verdict.residual_before_mm
    more = before * (1 + 1e-13)
    same = replace(verdict, residual_after_mm=more, held_out=HeldOut(before, more, 5, "configuration", before, more))
    assert not makes_worse(same)
    worse = replace(same, residual_after_mm=1.01 * before, held_out=replace(same.held_out, after=1.2 * before))
    assert makes_worse(worse)


def test_scatter_alone_makes_nothing_worse_and_says_what_to_record() -> None:
    """Play of which nobody wrote down the side: "change nothing" stood in place of "write down the side"."""
    loose = replace(
        verdicts.found("unknown", "joint 2", verdicts.Parameter("scatter", "rad", 8e-4, 1e-5)), cure="Write the side."
    )
    verdict = verdicts.case(effects=(loose,), held_out=HeldOut(0.46, 0.52)).verdict
    verdict = replace(verdict, background=replace(verdict.background, present=False))
    assert not makes_worse(verdict)
    beside = diagnosed(6.8)
    told = curing_only_what_helps(replace(beside, effects=(*beside.effects, loose)))
    assert [effect.cure == NOT_YET for effect in told.effects] == [True, True, False]
