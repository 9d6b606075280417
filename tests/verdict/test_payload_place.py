"""Payloads whose place nobody stated: every page says so, and the tool comes before the load."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from armscope.report.pages.diagnosis import write_report
from armscope.report.sections.effects import findings
from armscope.robot import load_arm
from armscope.verdict.effects import Parameter
from armscope.verdict.payload_place import KIND, TOOL_FIRST, WRONG_ALIKE, instruction_of, of_payloads
from armscope.verdict.schema import Notice
from tests.report import verdicts

NOTICE = Notice(KIND, "Payloads are recorded and no `tool_mm` is stated.")
ALIKE = "Each of the 3 payloads alone gives the same value within its interval."
CENTRE = tuple(Parameter(f"com_{axis}", "mm", mm, 6.0) for axis, mm in zip("xyz", (5.5, -4.0, 137.0), strict=True))
LOAD = verdicts.found("payload_error", "payload", *CENTRE, rms_at_tool_mm=0.02, carries_over=ALIKE)


def test_a_load_without_a_stated_place_has_its_tool_stated_first(tmp_path: Path) -> None:
    case = verdicts.case(effects=(LOAD, verdicts.compliance("joint 2")), notices=(NOTICE,))
    stated = load_arm(verdicts.ROBOTS / "six-axis.yaml")
    description = stated.description.model_copy(update={"tool_mm": (0.0, 0.0, 0.0)})
    assert instruction_of(LOAD, replace(stated, description=description), "Weigh it.") == f"{TOOL_FIRST}weigh it."
    description = stated.description.model_copy(update={"tool_mm": (0.0, 0.0, 120.0)})
    assert instruction_of(LOAD, replace(stated, description=description), "Weigh it.") == "Weigh it."
    write_report(case.verdict, tmp_path)
    assert NOTICE.text.split("`")[0] in (tmp_path / "work-order.html").read_text()
    assert of_payloads(replace(case.verdict, effects=())) == ()


def test_payloads_that_hang_at_no_stated_place_do_not_confirm_each_other() -> None:
    case = verdicts.case(effects=(LOAD,), notices=(NOTICE,))
    (card,) = findings(case.verdict)["cards"]
    assert card.carries_over == f"{ALIKE} {WRONG_ALIKE}"
    (card,) = findings(replace(case.verdict, notices=()))["cards"]
    assert card.carries_over == ALIKE


def test_where_a_load_sits_is_one_number_on_every_page() -> None:
    """The card had "undetermined" for what the work order asked to enter: a load's place moves no tool by as much."""
    (card,) = findings(verdicts.case(effects=(LOAD,)).verdict)["cards"]
    assert [reading.value for reading in card.readings] == ["5.5 mm", "−4.0 mm", "137.0 mm"]


def test_a_card_does_not_say_that_stated_masses_are_not_known() -> None:
    free = [Parameter(f"compliance_times_moment_{n}", "rad/(m/s^2)", 1e-6, 1e-7) for n in (1, 2)]
    soft = verdicts.found("joint_compliance", "joint 2", *free, Parameter("compliance", "rad/(N m)", 6.7e-6, 1e-7))
    case = verdicts.case(effects=(soft,))
    assert case.arm.has_masses
    (card,) = findings(case.verdict)["cards"]
    assert "masses are not known" not in card.remark
    assert "mass moments were fitted" in card.remark
