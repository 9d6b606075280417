"""Causes that pay only together, and those that do nothing before others: one step, or in the order that works."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from armscope.core.averages import rms
from armscope.report.pages.diagnosis import write_work_order
from armscope.report.sectioning import Subject
from armscope.report.sections import cures, effects
from armscope.verdict.contributions import contributions
from armscope.verdict.doubts import OPEN
from armscope.verdict.effects import Parameter
from armscope.verdict.entered_together import CALIBRATED_LAST, CALIBRATION, calibrated_last, pays_together
from armscope.verdict.tasks import Task
from armscope.verdict.work_order import work_order
from tests.report import verdicts


def test_causes_that_work_against_each_other_are_entered_together(tmp_path: Path) -> None:
    """Each alone would make it worse; together they are all of the error, and one step with its own promise."""
    against = [verdicts.found("joint_offset", f"joint {n}", Parameter("offset", "rad", 1e-3, 1e-5)) for n in (2, 3)]
    case = verdicts.case(effects=tuple(against))
    worth = contributions(case.verdict)
    large, error = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    first, second = worth.causes
    moved = (replace(first, moved=large), replace(second, moved=0.2 * error - large))
    worth = replace(worth, causes=moved, small={}, left=0.02 * worth.left)
    order = work_order(case.verdict, worth)
    (task,) = order.tasks
    assert (task.place, task.change, task.only_after) == ("joints 2 and 3", "mastering together", False)
    assert all(f"Reset the zero of joint {n}" in task.instruction for n in (2, 3))
    assert task.then_mm == task.alone_mm == pytest.approx(rms(worth.left))
    assert not order.besides
    assert not order.caution
    assert order.step_of("joint_offset at joint 2") == "step 1, only together with joint 3"
    subject = Subject(case.verdict)
    subject.__dict__["order"] = order  # in the place of what is calculated once
    write_work_order(subject, tmp_path)
    assert "step 1, only together with joint 3" in (tmp_path / "work-order.html").read_text()
    entered = pd.read_csv(tmp_path / "zero_offsets.csv").set_index("joint")["step"]
    assert entered["joint 3"] == "step 1, only together with joint 2"


def test_what_is_to_be_settled_first_is_no_part_of_what_is_entered_together() -> None:
    vague = [
        verdicts.found(
            "joint_offset", f"joint {n}", Parameter("offset", "rad", 1e-3, 1e-5),
            named_as="region", title=f"geometric, around joint {n}",
        )
        for n in (2, 3)
    ]  # fmt: skip
    case = verdicts.case(effects=tuple(vague))
    worth = contributions(case.verdict)
    large, error = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    moved = tuple(replace(c, moved=m) for c, m in zip(worth.causes, (large, 0.2 * error - large), strict=True))
    order = work_order(case.verdict, replace(worth, causes=moved, small={}, left=0.02 * worth.left))
    assert [task.change for task in order.tasks] == ["corrected commands"]
    assert "joint 2" in order.tasks[0].instruction
    assert "joint 3" in order.tasks[0].instruction


def test_the_fewest_that_pay_together_are_entered_together() -> None:
    """A third that moves the tool for itself is no part of the step."""
    three = [verdicts.found("joint_offset", f"joint {n}", Parameter("offset", "rad", 1e-3, 1e-5)) for n in (2, 3, 4)]
    case = verdicts.case(effects=tuple(three))
    worth = contributions(case.verdict)
    large, error, idle = np.random.default_rng(0).normal(0, 1, (3, *worth.left.shape))
    parts = (large, error - large, 0.05 * idle)
    moved = tuple(replace(c, moved=m) for c, m in zip(worth.causes, parts, strict=True))
    left = 0.02 * worth.left - parts[2]
    tasks = work_order(case.verdict, replace(worth, causes=moved, small={}, left=left)).tasks
    assert tasks[0].place == "joints 2 and 3"


def test_nothing_is_entered_together_that_leaves_as_much() -> None:
    (task,) = work_order(*(lambda case: (case.verdict, contributions(case.verdict)))(verdicts.single())).tasks[:1]
    left, idle = np.random.default_rng(0).normal(0, 1, (2, 50, 3))
    assert not pays_together([(task, 0.1 * idle), (task, -0.1 * idle)], left)
    assert not pays_together([(task, left)], left), "one is no set"


def test_what_pays_only_after_a_calibration_is_done_before_it_is_measured_for() -> None:
    """A calibration takes up part of a wave that is still there: corrected after it, the wave was corrected twice."""
    wave = verdicts.found("joint_compliance", "joint 2", Parameter("compliance", "rad/(N m)", 1e-6, 1e-8))
    case = verdicts.case(effects=(wave,))
    worth = contributions(case.verdict)
    large, other, noise = np.random.default_rng(0).normal(0, 1, (3, *worth.left.shape))
    # alone it makes the error larger: the geometry hides part of it
    causes = (replace(worth.causes[0], moved=-0.3 * large + 0.1 * other),)
    worth = replace(worth, causes=causes, smaller=None, single=(), small={"geometric": large}, left=0.01 * noise)
    (task,) = (each for each in work_order(case.verdict, worth).tasks if not each.instead)
    assert task.change == CALIBRATION
    assert task.what.startswith("Joint 2 gives way")
    assert "; and small errors of geometry" in task.what
    assert task.instruction.index("(1)") < task.instruction.index("(2) Calibrate the geometry")
    assert task.instruction.startswith(CALIBRATED_LAST)
    assert "joint_compliance at joint 2" in task.members
    assert not task.only_after


@pytest.mark.parametrize(
    "more", [{"change": OPEN}, {"requires": "elastic"}, {"beside_scatter": True, "unless": "Settle first."}]
)
def test_what_cannot_be_done_before_a_calibration_keeps_its_own_step(more: dict[str, Any]) -> None:
    """Told to do it first and to leave it until something is settled, one does either."""
    calibration = Task("A", "whole arm", CALIBRATION, "", "Do it.", "", "")
    wave = replace(Task("B", "joint 4", "gear", "", "Do it.", "", "", members=("b at joint 4",)), **more)
    jobs = [(task, np.zeros((2, 3))) for task in (calibration, wave)]
    assert calibrated_last(jobs, np.zeros((2, 3))) == jobs
    sure = replace(wave, change="gear", requires="", beside_scatter=False)
    assert len(calibrated_last([jobs[0], (sure, jobs[1][1])], np.zeros((2, 3)))) == 1


def test_what_is_done_before_a_calibration_stays_a_step_of_its_own() -> None:
    tasks = [
        Task(what, "whole arm", change, "", "Do it.", "", "", members=members)
        for what, change, members in (("A", "gear", ("a at b",)), ("B", CALIBRATION, ()), ("C", "elastic model", ()))
    ]
    jobs = [(task, np.zeros((2, 3))) for task in tasks]
    assert calibrated_last(jobs, np.zeros((2, 3))) == jobs


def test_payload_data_come_after_what_gives_way_and_promise_nothing_alone(tmp_path: Path) -> None:
    """Before the controller corrects for gravity, the load's mass is a number that it does not use."""
    load = verdicts.found("payload_error", "payload", Parameter("mass", "kg", 2.4, 0.1))
    case = verdicts.case(effects=(load, verdicts.compliance("joint 2"), verdicts.compliance("joint 3")))
    worth = contributions(case.verdict)
    large, other = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    of = {cause.effects[0].location: cause for cause in worth.causes}
    shares = {"payload": 2 * large, "joint 2": large, "joint 3": other}  # by gain, the payload would come first
    causes = tuple(replace(of[place], moved=moved) for place, moved in shares.items())
    worth = replace(worth, causes=causes, smaller=None, small={}, left=0.02 * worth.left)
    order = work_order(case.verdict, worth)
    assert [task.place for task in order.tasks] == ["joint 2", "joint 3", "payload"]
    assert order.tasks[2].needs.endswith("by steps 1 and 2")
    subject = Subject(case.verdict)
    subject.__dict__.update(order=order, worth=worth)
    write_work_order(subject, tmp_path)
    (step,) = re.findall(r"The payload is not as stated.*?</li>", (tmp_path / "work-order.html").read_text(), re.DOTALL)
    assert "after 1 to 3 (by itself it changes nothing" in step
    assert "if this alone is done" not in step
    switches = dict(cures._context(subject)["switches"])
    assert "alone it changes nothing" in switches["Payload error at payload"]
    cards = {family: cards for family, _, cards in effects._context(subject)["families"]}["elastic"]
    assert {shown.location: bool(worth) for shown, worth in cards} == {
        "payload": False,
        "joint 2": True,
        "joint 3": True,
    }


def test_what_no_row_holds_is_mended_in_a_step_of_its_own_before_the_calibration() -> None:
    """Seen: a calibration that claimed an axis that wobbles, and promised the error without it."""
    wobble = verdicts.found("axis_wobble", "joint 2", Parameter("amplitude", "rad", 2e-4, 1e-6))
    link = verdicts.found("link_geometry", "link 3", Parameter("a", "mm", 0.1, 1e-3))
    case = verdicts.case(effects=(link, wobble))
    worth = contributions(case.verdict)
    large, tilt, row, noise = np.random.default_rng(0).normal(0, 1, (4, *worth.left.shape))
    causes = (replace(worth.causes[0], moved=0.1 * row), replace(worth.causes[1], moved=0.1 * tilt))
    worth = replace(worth, causes=causes, smaller=None, single=(), small={"geometric": large}, left=0.01 * noise)
    repaired, calibrated = (task for task in work_order(case.verdict, worth).tasks if not task.instead)
    assert (repaired.place, repaired.change) == ("joint 2", "bearing")
    assert calibrated.change == CALIBRATION
    assert calibrated.members == ("link_geometry at link 3",)
    assert "This puts right link 3, too" in calibrated.instruction
    assert "joint 2" not in calibrated.instruction
    assert repaired.then_mm > calibrated.then_mm
    assert calibrated.alone_mm == pytest.approx(np.sqrt(np.mean((0.1 * tilt + 0.01 * noise) ** 2)))
