"""A work order done to the letter must leave what it says: its numbers are read from its words and put to work."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.core.averages import rms
from armscope.fitting.registration import fit_frames
from armscope.report.pages.diagnosis import steps_of_rows, write_report, write_work_order
from armscope.report.sectioning import Subject
from armscope.report.sections import locations
from armscope.report.sections import work_order as section
from armscope.robot.arm import build_arm
from armscope.verdict.contributions import contributions
from armscope.verdict.corrections import as_entered, corrected_rows, zero_offsets
from armscope.verdict.effects import Cause, Parameter
from armscope.verdict.family_cures import cure_of_family
from armscope.verdict.filenames import FILES
from armscope.verdict.files import write_verdict
from armscope.verdict.importance import expected
from armscope.verdict.schema import ANOTHER_MODEL, HeldOut, Notice
from armscope.verdict.tasks import Task, task_of
from armscope.verdict.work_order import WorkOrder, beside_scatter, work_order
from tests.physics.test_cure import World
from tests.report import verdicts
from tests.verdict.test_contributions import missed, verdict, world  # noqa: F401  (fixtures)


def degrees(words: str) -> list[float]:
    return [float(number.replace("−", "-")) for number in re.findall(r"([+−][0-9.]+)°", words)]


def test_a_zero_set_as_worded_takes_its_error_away(world: World, verdict) -> None:  # noqa: F811
    worth = contributions(verdict)
    (task,) = [task for task in work_order(verdict, worth).tasks if task.change == "mastering"]
    assert task.place == "joint 3"
    (stands_at,) = degrees(task.instruction)
    # a controller that shows 0 there will show what the joint stands at: the same command then turns it less
    commanded = world.session.commanded.copy()
    commanded[:, 2] -= np.radians(stands_at)
    left = missed(world, world.readings(commanded))
    assert left == pytest.approx(task.alone_mm, rel=0.05, abs=2e-3)
    named = zero_offsets(verdict).set_index("joint")["actual_minus_commanded_deg"]
    assert named["joint 3"] == pytest.approx(stands_at, abs=1e-4)
    entered = as_entered(zero_offsets(verdict)).set_index("joint").loc["joint 3"]
    assert entered["actual_minus_commanded_deg"] == stands_at
    assert f"{entered['actual_minus_commanded_mrad']:+} mrad".replace("-", "−") in task.instruction


def test_a_corrected_row_in_the_controllers_model_explains_what_is_predicted(world: World, verdict) -> None:  # noqa: F811
    rows, worth = corrected_rows(verdict), contributions(verdict)
    assert rows is not None
    (task,) = [task for task in work_order(verdict, worth).tasks if task.change == "D-H row"]
    content = world.arm.description.model_dump()
    for stated, row in zip(content["dh"]["joints"], rows.to_dict("records"), strict=True):
        for name in ("a_mm", "alpha_deg", "d_mm", "theta_offset_deg"):
            assert row[f"stated_{name}"] == stated[name]
            stated[name] = row[f"corrected_{name}"]
    corrected = build_arm(type(world.arm.description).model_validate(content))
    table = world.table()
    fitted = fit_frames(corrected, table)
    error = fitted.to_base(table.positions, table.run) - fitted.posture(fitted.scene(table)).tool
    assert 1e3 * np.sqrt(np.mean(error**2)) == pytest.approx(task.alone_mm, rel=0.05, abs=2e-3)


def test_expectations_fall_from_task_to_task_and_stand_on_the_page(verdict, tmp_path: Path) -> None:  # noqa: F811
    done = work_order(verdict, contributions(verdict)).tasks
    then = [task.then_mm for task in done]
    assert then == sorted(then, reverse=True)
    assert then[0] == pytest.approx(done[0].alone_mm)
    assert then[-1] < 0.1 * verdict.residual_before_mm
    page = write_report(verdict, tmp_path).with_name("work-order.html").read_text()
    assert all(task.confirm in page for task in done)
    assert all(f"{task.alone_mm:.3g}" in page for task in done)


def test_files_of_a_verdict_are_those_that_are_asked_for_before(verdict, tmp_path: Path) -> None:  # noqa: F811
    write_verdict(verdict, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} <= set(FILES)


def test_steps_that_pay_less_unfold_and_go_on_counting(monkeypatch, verdict, tmp_path: Path) -> None:  # noqa: F811
    monkeypatch.setattr(section, "SHOWN", 1)
    done = work_order(verdict, contributions(verdict)).tasks
    assert len(done) > 2
    page = write_report(verdict, tmp_path).read_text()
    assert f"{len(done) - 1} further steps" in page
    assert f"expected RMS after 1 to {len(done)}" in page
    assert page.count('<div class="task">') == len(done)


def test_what_pays_only_after_the_others_is_told_so_and_comes_after_them() -> None:
    """A cause that hides part of another: alone its cure makes the error larger."""
    two = [verdicts.found("joint_offset", f"joint {n}", Parameter("offset", "rad", 1e-3, 1e-5)) for n in (2, 3)]
    case = verdicts.case(effects=tuple(two))
    worth = contributions(case.verdict)
    large, first, second = np.random.default_rng(0).normal(0, 1, worth.left.shape), *worth.causes
    moved = (replace(first, moved=-0.3 * large), replace(second, moved=large))
    worth = replace(worth, causes=moved, smaller=None, small={}, left=0.02 * worth.left)
    done = work_order(case.verdict, worth).tasks
    assert [task.place for task in done] == ["joint 3", "joint 2"]
    assert [task.only_after for task in done] == [False, True]
    assert done[1].alone_mm > rms(worth.before) > done[0].then_mm > done[1].then_mm


def test_expectations_are_those_of_rows_that_took_no_part(verdict) -> None:  # noqa: F811
    worth = contributions(verdict)
    before, left = rms(worth.before), rms(worth.left)
    assert expected(verdict, worth, 0.2) == 0.2, "nothing was held out"
    held = replace(verdict, held_out=HeldOut(1.1 * before, 2 * left))
    assert expected(held, worth, before) == pytest.approx(1.1 * before)
    assert expected(held, worth, left) == pytest.approx(2 * left)
    between = [expected(held, worth, mm) for mm in np.linspace(left, before, 9)]
    assert between == sorted(between)


def test_a_minor_effect_that_pays_once_all_else_is_cured_is_a_task() -> None:
    """What hides part of another is minor, and its cure may still be most of what is left in its turn."""
    size = Parameter("offset", "rad", 1e-3, 1e-5)
    hidden = verdicts.found("joint_offset", "joint 2", size, minor=True)
    case = verdicts.case(effects=(verdicts.found("joint_offset", "joint 3", size), hidden))
    worth = contributions(case.verdict)
    single = replace(worth.causes[0], effects=(hidden,))
    large, noise = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    moved = {"causes": (replace(worth.causes[0], moved=large),), "small": {}, "left": 0.02 * noise}
    tasks = {}
    for size in (-0.3, -1e-3):
        one = replace(single, moved=size * large)
        tasks[size] = work_order(case.verdict, replace(worth, smaller=one, single=(one,), **moved)).tasks
    assert [(task.place, task.only_after) for task in tasks[-0.3]] == [("joint 3", False), ("joint 2", True)]
    assert [task.place for task in tasks[-1e-3]] == ["joint 3"]


def test_what_a_calibration_puts_right_is_not_put_right_again() -> None:
    """A row that was corrected once more after the calibration was off by as much again, where orders were obeyed."""
    row = verdicts.found("link_geometry", "link 4", Parameter("d", "mm", 0.1, 0.01))
    spring = verdicts.found("joint_compliance", "joint 2", Parameter("compliance", "rad/(N m)", 1e-6, 1e-8))
    case = verdicts.case(effects=(row, spring))
    worth = contributions(case.verdict)
    large, noise, own = np.random.default_rng(0).normal(0, 1, (3, *worth.left.shape))
    of_row = next(each for each in worth.causes if each.effects[0].family == "geometric")
    of_spring = next(each for each in worth.causes if each is not of_row)
    causes = (replace(of_row, moved=-0.3 * large), replace(of_spring, moved=0.5 * own))
    worth = replace(worth, causes=causes, smaller=None, single=(), small={"geometric": large}, left=0.02 * noise)
    tasks = work_order(case.verdict, worth).tasks
    assert [task.change for task in tasks].count("calibration") == 1
    (calibration,) = [task for task in tasks if task.change == "calibration"]
    assert "link 4" in calibration.instruction
    assert "link 4" not in [task.place for task in tasks]
    assert tasks[-1].then_mm == pytest.approx(rms(worth.left), rel=1e-6)


def test_a_row_is_corrected_by_itself_or_with_the_calibration_never_both() -> None:
    """Where the calibration pays only in the end, too."""
    row = verdicts.found("link_geometry", "link 4", Parameter("d", "mm", 0.1, 0.01))
    spring = verdicts.found("joint_compliance", "joint 2", Parameter("compliance", "rad/(N m)", 1e-6, 1e-8))
    case = verdicts.case(effects=(row, spring))
    worth = contributions(case.verdict)
    large, other, noise = np.random.default_rng(0).normal(0, 1, (3, *worth.left.shape))
    of_row, of_spring = sorted(worth.causes, key=lambda each: each.effects[0].location, reverse=True)
    # alone, the calibration makes it worse: what it puts right lies against the spring's
    causes = (replace(of_row, moved=-0.5 * large + 0.1 * other), replace(of_spring, moved=2 * large))
    worth = replace(worth, causes=causes, smaller=None, single=(), small={"geometric": -0.4 * large}, left=0.02 * noise)
    tasks = work_order(case.verdict, worth).tasks
    assert [task.place for task in tasks] == ["joint 2", "whole arm"]
    assert tasks[-1].then_mm == pytest.approx(rms(worth.left), rel=1e-6)


def test_where_it_is_another_model_of_the_arm_nothing_is_corrected(tmp_path: Path) -> None:
    """A UR5e's recordings beside a UR5: its links were to be "corrected" by 20 mm, step by step."""
    case = verdicts.case(effects=(verdicts.found("joint_offset", "joint 3", Parameter("offset", "rad", 1e-3, 1e-5)),))
    another = Notice(ANOTHER_MODEL, "Is this another model of the arm? A UR5e leaves 1 mm where this one leaves 15 mm.")
    for notices, told in (((another,), True), ((), False)):
        write_report(replace(case.verdict, notices=notices), tmp_path)
        page = (tmp_path / "work-order.html").read_text(encoding="utf-8")
        assert ("Change nothing at the arm" in page) == ("by this model of the arm" in page) == told
        assert ("zero_offsets.csv" in page) == (not told)
        assert ("<b>Do:</b>" in page) == ("once these steps are done" in page) == (not told)


def test_commands_by_the_whole_model_stand_in_place_of_the_other_steps() -> None:
    """A zero that is set anew and then commanded away, too, is off by as much again: seen where orders were obeyed."""
    case = verdicts.case(effects=(verdicts.found("joint_offset", "joint 3", Parameter("offset", "rad", 1e-3, 1e-5)),))
    worth = contributions(case.verdict)
    moved, rest = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    worth = replace(worth, causes=(replace(worth.causes[0], moved=3 * moved),), small={}, left=0.02 * rest)
    one = work_order(case.verdict, worth)
    assert [task.instead for task in one.tasks] == [False]
    assert not one.caution, "nothing stands beside it"
    both = work_order(case.verdict, replace(worth, smaller=replace(worth.causes[0], moved=rest)))
    assert [task.instead for task in both.tasks] == [False, True]
    assert both.tasks[1].instruction.startswith("In place of the steps above, compensate")
    assert "never on top" in both.caution


def test_minor_curves_that_the_headline_tells_together_are_one_step() -> None:
    """21 % of a real arm's error stood in its headline and in no step of its work order."""
    zero = verdicts.found("joint_offset", "joint 2", Parameter("offset", "rad", 1e-3, 1e-5))
    curves = [verdicts.unknown_curve(f"joint {n}", minor=True) for n in (3, 5)]
    case = verdicts.case(effects=(zero, *curves))
    worth = contributions(case.verdict)
    large, some, noise = np.random.default_rng(0).normal(0, 1, (3, *worth.left.shape))
    single = tuple(replace(worth.causes[0], effects=(each,), moved=0.25 * some) for each in curves)
    worth = replace(
        worth, causes=(replace(worth.causes[0], moved=large),), small={}, left=0.02 * noise,
        smaller=replace(single[0], moved=0.5 * some), single=single,
    )  # fmt: skip
    told = Cause(
        "unknown", "family", "arm", tuple(each.as_member for each in curves), False, True, 0.2, 0.01,
        "something unexplained at joint 3 (also: joint 5)", cure_of_family("unknown", curves, everywhere=False),
    )  # fmt: skip
    tasks = work_order(replace(case.verdict, causes=(told,)), worth).tasks
    assert [task.place for task in tasks] == ["joint 2", "joints 3 and 5"]
    assert "commanded = wanted - curve" in tasks[1].instruction
    assert all(f"curves.csv (unknown, joint {n}, " in tasks[1].cure for n in (3, 5))
    assert tasks[1].then_mm == pytest.approx(rms(worth.left))
    ranking = locations._ranking(replace(case.verdict, causes=(told,)))
    assert "Unexplained curves at joints 3 and 5" in [place.name for place in ranking]
    assert not [place for place in ranking if "minor effect" in place.name], "nothing stands twice"
    untold = work_order(replace(case.verdict, causes=(replace(told, share=0.01),)), worth).tasks
    assert "joints 3 and 5" not in [task.place for task in untold]
    vague = replace(single[0], effects=(replace(curves[0], named_as="region", title="unknown, around joint 3"),))
    unsettled = work_order(replace(case.verdict, causes=(told,)), replace(worth, single=(vague, single[1]))).tasks
    assert unsettled[1].unsettled, "what holds an unsettled member is settled first"


def test_a_drive_whose_joint_scatters_is_left_alone_until_that_is_settled() -> None:
    """Play whose side was not recorded goes with the angle at most poses: a gear's ratio was ordered for it."""
    ratio = verdicts.found("gear_ratio", "joint 2", Parameter("ratio", "rad/rad", 4e-4, 4e-5))
    for place, said in (("joint 2", True), ("joint 5", False)):
        scatter = verdicts.found("unknown", place, Parameter("scatter", "rad", 4e-4, 1e-5), family="unknown")
        case = verdicts.case(effects=(ratio, scatter))
        repair = contributions(case.verdict).causes[0]
        task = task_of(case.verdict.model.scene(case.recordings), repair, ratio)
        told = beside_scatter(task, case.verdict)
        assert told.unless.startswith("Settle first why joint 2 scatters") == said


def test_rows_that_the_calibration_finds_are_not_to_be_entered_besides(tmp_path: Path) -> None:
    """Seen: "change nothing there besides" in a step, and "Enter all of them together" under these rows."""
    link = verdicts.found("link_geometry", "link 2", Parameter("a", "mm", 0.5, 0.01))
    case = verdicts.case(effects=(link,))
    step = Task(
        "Small errors", "whole arm", "calibration", "", "Calibrate.", "", "", members=("link_geometry at link 2",)
    )
    zero, own = replace(step, change="mastering", members=()), replace(step, change="D-H row")
    rows = corrected_rows(case.verdict)
    assert rows is not None
    by_calibration, by_itself = WorkOrder((zero, step), ()), WorkOrder((own,), ())
    assert steps_of_rows(rows, by_calibration)[1] == "by the calibration of step 2, not besides"
    assert steps_of_rows(rows, by_itself)[1] == "step 1"
    assert not any(step for row, step in enumerate(steps_of_rows(rows, by_calibration)) if row != 1)
    for order, told in ((by_calibration, True), (by_itself, False)):
        subject = Subject(case.verdict)
        subject.__dict__["order"] = order
        write_work_order(subject, tmp_path)
        page = (tmp_path / "work-order.html").read_text(encoding="utf-8")
        assert ("enter those that it finds, not these" in page) == told
        assert ("Enter all of them together" in page) != told
        assert pd.read_csv(tmp_path / "corrected_dh.csv")["step"].dropna().tolist() == [steps_of_rows(rows, order)[1]]


@pytest.mark.parametrize(("minor", "steps"), [(False, 2), (True, 1)])
def test_a_major_effect_that_does_not_stand_apart_has_a_step_where_it_is_felt(minor: bool, steps: int) -> None:
    """What is one of more than six is no less a cause: it pays by a tenth, and so it is ordered."""
    gap = Parameter("gap", "rad", 2e-4, 1e-6)
    first, other = (verdicts.found("backlash", f"joint {n}", gap) for n in (2, 3))
    case = verdicts.case(effects=(first, replace(other, minor=minor)))
    worth = contributions(case.verdict)
    large, some, noise = np.random.default_rng(0).normal(0, 1, (3, *worth.left.shape))
    one = replace(worth.causes[0], effects=(replace(other, minor=minor),), moved=0.45 * some)
    causes = (replace(worth.causes[0], moved=large),)
    tasks = work_order(
        case.verdict, replace(worth, causes=causes, small={}, smaller=one, single=(one,), left=noise)
    ).tasks
    assert [task.place for task in tasks][:steps] == ["joint 2", "joint 3"][:steps]
    assert len([task for task in tasks if not task.instead]) == steps
