"""What is told of links beside their motors."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.inference.search import Search
from armscope.motion.links.judgement import JudgedTwist, with_links
from armscope.motion.pipeline import MotionDiagnosis
from armscope.motion.summary.rivals import listed_rivals
from tests.motion.two_inertias import wound_up


@pytest.fixture(scope="module")
def found() -> MotionDiagnosis:
    return wound_up()


@pytest.mark.long
def test_a_stiffness_is_known_no_better_than_the_torque(found: MotionDiagnosis) -> None:
    (twist,) = found.twists
    sure, unsure = (JudgedTwist(twist.selected, share, twist.side).fitted[1] for share in (0.0, 0.1))
    assert unsure.stderr[0] == pytest.approx(np.hypot(sure.stderr[0], 0.1 * sure.values[0]), rel=1e-6)


@pytest.mark.long
def test_what_a_link_does_counts_in_the_answer(found: MotionDiagnosis) -> None:
    side, torques = found.verdict.links[0], replace(found.verdict, answer="nothing missing", mismatch=False, links=())
    assert with_links(torques, [side]).answer == "explained"
    assert with_links(torques, [side]).mismatch
    nameless = replace(side, causes=(replace(side.causes[0], family="unknown", effect="unknown_twist"),))
    assert with_links(torques, [nameless]).answer == "cannot tell"
    silent = replace(side, causes=(replace(side.causes[0], minor=True),))
    assert with_links(torques, [silent]).answer == "nothing missing"
    assert with_links(torques, [silent]).headline == torques.headline


@pytest.mark.long
def test_rivals_that_fall_far_short_are_not_listed(found: MotionDiagnosis) -> None:
    selected = found.twists[0].selected
    search, (effect, *_) = Search.on(selected.problem), selected.best.chosen
    empty = search.without(selected.best, [effect.candidate])
    rivals = search.additions(empty, 40, [effect.candidate])
    listed = listed_rivals(search, selected.best, effect.candidate, rivals)
    assert all(each.effect != "joint_elasticity" for each in listed)
    gaps = [each.evidence_gap_nats for each in listed]
    assert gaps == sorted(gaps)
