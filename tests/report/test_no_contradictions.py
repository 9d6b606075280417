"""One page never says two things of one question: poses that settle it or do not, shares that cancel, rows left out."""

from dataclasses import replace

import numpy as np

from armscope.report.pages.diagnosis import write_report
from armscope.verdict.diagnosis import NextPoses
from armscope.verdict.schema import SuspectRow
from tests.report import verdicts
from tests.report.test_diagnosis_page import Page


def test_poses_that_would_settle_nothing_are_not_asked_for(tmp_path):
    """Seen: "These poses would settle it" above "no number of repeats within reason would"."""
    vague = replace(verdicts.compliance(), named_as="region", title="elastic, around joint 2")
    first, few = f"{vague.as_member}", np.zeros((4, 6))
    for repeats, settle in ((3.0, True), (float("inf"), False)):
        poses = NextPoses(few, np.zeros(4), np.full(4, 0.01), first, "base_compliance at base", repeats)
        verdict = verdicts.case(effects=(vague,), next_poses=poses).verdict
        write_report(verdict, tmp_path)
        page = Page((tmp_path / "report.html").read_text()).words
        assert poses.ask_about(vague)
        assert ("These poses would tell the two apart." in page) == settle
        assert ("no number of repeats within reason would settle it" in page) != settle
        assert ("No further poses would tell the two apart; the tests at the arm do" in page) != settle


def test_causes_that_cancel_in_part_and_rows_that_count_little_are_told(tmp_path):
    """Seen: "2 causes: 19 % together" of 81 % and -62 %; and a work order without a word on the bad shots."""
    zero, link = (verdicts.compliance(place, share=share) for place, share in (("joint 3", -0.6), ("joint 2", 0.8)))
    suspects = (SuspectRow("7", "", 3.0, 0.0),)
    write_report(verdicts.case(effects=(link, zero), suspects=suspects).verdict, tmp_path)
    assert "in part they cancel each other" in (tmp_path / "report.html").read_text()
    assert "bad shots among them, as it seems: 1," in (tmp_path / "work-order.html").read_text()


def test_poses_to_measure_next_say_what_they_keep_clear_of(tmp_path):
    vague = replace(verdicts.compliance(), named_as="region", title="elastic, around joint 2")
    rival, checked = "base_compliance at base", "Checked: joint limits. Obstacles unknown: run slowly."
    for count, repeats in ((4, 3.0), (0, float("inf"))):
        poses = NextPoses(
            np.zeros((count, 6)), np.zeros(count), np.full(count, 0.01), vague.as_member, rival, repeats, checked
        )
        write_report(verdicts.case(effects=(vague,), next_poses=poses).verdict, tmp_path)
        page = Page((tmp_path / "report.html").read_text()).words
        assert checked in page
        assert ("No pose that would tell them apart is known to be free." in page) == (count == 0)
        assert ("In the poses below" in page) == (count > 0)
        assert (checked in Page((tmp_path / "work-order.html").read_text()).words) == (count > 0)
