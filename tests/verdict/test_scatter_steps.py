"""To find out what a joint's scatter follows is a step, which lowers no error by itself."""

from dataclasses import replace
from pathlib import Path

from armscope.report.pages.diagnosis import write_report
from armscope.report.sectioning import Subject
from armscope.report.sections.effects import EFFECTS
from armscope.verdict.contributions import contributions
from armscope.verdict.effects import Parameter
from armscope.verdict.scatter_steps import LOWERS_NOTHING, finding_out
from armscope.verdict.tasks import FIND_OUT
from armscope.verdict.work_order import work_order
from tests.report import verdicts

SCATTER = verdicts.found(
    "unknown", "joint 2", Parameter("scatter", "rad", 2.3e-4, 1e-5),
    family="unknown", cure="Find what the scatter follows.", driver="nothing", share=0.9,
)  # fmt: skip
OFFSET = verdicts.found("joint_offset", "joint 3", Parameter("offset", "rad", 1e-3, 1e-5))


def test_scatter_alone_has_a_step(tmp_path: Path) -> None:
    """It was "no single repair pays: the causes found are small" under a scatter of all of the error."""
    case = verdicts.case(effects=(SCATTER,))
    worth = contributions(case.verdict)
    order = work_order(case.verdict, replace(worth, small={}))
    (step,) = (task for task in order.tasks if not task.instead)
    assert (step.place, step.change, step.instruction) == ("joint 2", FIND_OUT, "Find what the scatter follows.")
    assert step.finds_out
    assert step.needs == LOWERS_NOTHING
    assert step.then_mm == step.alone_mm
    assert not [told for told in order.besides if "scatter" in told], "it is told once"
    subject = Subject(case.verdict)
    subject.__dict__["order"] = order
    assert not [worth for _, _, members in EFFECTS.context(subject)["families"] for _, worth in members if worth]
    write_report(case.verdict, tmp_path)
    page, printed = ((tmp_path / name).read_text("utf-8") for name in ("report.html", "work-order.html"))
    assert "the causes found are small" not in page
    assert "No single repair is called for" not in printed
    assert LOWERS_NOTHING in printed


def test_it_comes_after_what_pays_and_before_what_stands_in_its_place() -> None:
    case = verdicts.case(effects=(OFFSET, SCATTER))
    worth = contributions(case.verdict)
    tasks = work_order(case.verdict, replace(worth, small={}, left=0.1 * worth.left)).tasks
    changes = [task.change for task in tasks]
    assert FIND_OUT in changes
    after = changes[changes.index(FIND_OUT) + 1 :]
    assert set(after) <= {"corrected commands"}


def test_only_scatter_is_to_be_found_out() -> None:
    assert SCATTER.scatters
    assert not OFFSET.scatters
    case = verdicts.case(effects=(OFFSET,))
    tasks = work_order(case.verdict, contributions(case.verdict)).tasks
    assert finding_out(tasks, case.verdict, 0.1) == []
