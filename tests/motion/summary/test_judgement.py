"""What is said where nothing has a name."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from armscope.motion.pipeline import diagnose_motion
from armscope.motion.summary.headline import headline
from armscope.motion.summary.held_out_errors import HeldOutErrors
from armscope.motion.summary.judgement import answer_of, apart_where_useless, doubted_beside
from armscope.motion.summary.lasting import LastingTorque
from armscope.motion.verdict import FoundCause, UnexplainedTorque
from armscope.verdict.effects import Parameter
from tests.motion.moving import ROBOT, moved, robot
from tests.seeds import seeds


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2))
def test_links_that_are_all_off_a_little_are_not_nothing_missing(seed: int) -> None:
    """No link stands out, so none has a name; but friction and rotors do not say the torque."""
    links: list[dict[str, Any]] = ROBOT["links"]  # type: ignore[assignment]
    off = [(0.96, (6, -8, 5)), (1.05, (12, 15, -9)), (0.97, (-14, 6, 11))]
    true = [
        {**link, "mass_kg": share * link["mass_kg"], "com_mm": [a + b for a, b in zip(link["com_mm"], by, strict=True)]}
        for link, (share, by) in zip(links, off, strict=True)
    ]
    verdict = diagnose_motion(robot(), moved(robot(links=true), seed, noise=0.005, seconds=10.0)).verdict
    assert not verdict.effects
    assert (verdict.answer, verdict.mismatch) == ("cannot tell", True)
    assert verdict.headline.startswith("Masses of the links are not as stated")
    assert verdict.waterfall[1].held_out < 0.8 * verdict.waterfall[0].held_out


def test_names_that_are_worth_nothing_do_not_stand_in_the_place_of_masses() -> None:
    """Beside links that are all off, a friction of a thousandth of what is left was the whole headline."""
    small = replace(beside(), share=0.001, minor=True)
    errors = HeldOutErrors(0.1, 0.014, 0.014, masses=0.03, by_masses=0.97)
    assert answer_of([small], UnexplainedTorque(False), errors) == ("cannot tell", True)
    assert headline([small], errors).startswith("Masses of the links are not as stated")
    large = replace(small, share=0.3, minor=False)
    assert answer_of([large], UnexplainedTorque(False), errors) == ("explained", True)
    assert "30 % of what friction and rotors leave" in headline([large], errors)
    assert "off without a name add 97 %" in headline([large], errors)


def beside() -> FoundCause:
    return FoundCause(
        effect="torque_offset",
        location="joint 1",
        family="drive",
        driver="constant",
        title="torque offset at joint 1",
        minor=False,
        parameters=(Parameter("offset", "N m", 0.3, 0.01),),
        rms=0.3,
        unit="N m",
        joint="joint 1",
        share=0.3,
        evidence_nats=50.0,
    )


def test_masses_that_help_hardly_leave_nothing_missing() -> None:
    errors = HeldOutErrors(0.02, 0.019, 0.019, masses=0.003)
    assert answer_of([], UnexplainedTorque(False), errors) == ("nothing missing", False)
    assert headline([], errors).startswith("Nothing is missing")
    assert answer_of([], UnexplainedTorque(False), replace(errors, by_masses=0.13)) == ("nothing missing", False)
    part = replace(errors, masses=0.03, by_masses=0.13)
    assert answer_of([], UnexplainedTorque(False), part) == ("cannot tell", True)
    assert headline([], part).startswith("Masses of the links are not as stated")
    much = replace(errors, named=0.01)
    assert answer_of([], UnexplainedTorque(False), much) == ("cannot tell", True)


def test_little_that_helps_nothing_is_no_mismatch() -> None:
    """On a clean arm a drive that gives way, of no known size, was the answer to "what is missing"."""
    little, useless = replace(beside(), share=0.01), HeldOutErrors(0.0050, 0.0051, 0.0050)
    apart = apart_where_useless([little], useless)
    assert [cause.minor for cause in apart] == [True]
    assert answer_of(apart, UnexplainedTorque(False), useless) == ("nothing missing", False)
    assert headline(apart, useless).startswith("Nothing that helps elsewhere is missing")
    assert answer_of(apart, UnexplainedTorque(True), useless)[0] == "cannot tell"


def test_what_lasts_beside_no_cause_is_not_met_by_causes() -> None:
    lasts = LastingTorque(2, "torque of joint 2", 0.4, 0.12, 0.2)
    told = headline([], HeldOutErrors(0.052, 0.051, 0.044), [lasts])
    assert "No cause of the library explains it. On held-out motion" in told
    assert "these causes" not in told


def test_a_cause_beside_more_that_lasts_at_its_joint_is_in_doubt() -> None:
    """An offset of 2.5 N m was told without one at a joint where 2.6 N m followed another joint's torque."""
    lasts = LastingTorque(0, "torque of joint 2", 0.4, 0.12, 0.2)
    (doubted,) = doubted_beside([beside()], [lasts])
    assert "may stand for a part of that" in doubted.doubt
    for other in (replace(lasts, rms=0.2), replace(lasts, joint=1)):
        assert not doubted_beside([beside()], [other])[0].doubt


def test_what_is_large_or_helps_is_part_of_the_story() -> None:
    useless, helps = HeldOutErrors(0.0050, 0.0051, 0.0050), HeldOutErrors(0.0060, 0.0060, 0.0058)
    (large,) = apart_where_useless([replace(beside(), share=0.3)], useless)
    assert not large.minor
    assert answer_of([large], UnexplainedTorque(False), useless) == ("cannot tell", True)
    (small,) = apart_where_useless([replace(beside(), share=0.03)], helps)
    assert answer_of([small], UnexplainedTorque(False), helps) == ("explained", True)
    much_worse = HeldOutErrors(0.0060, 0.0200, 0.0058)
    assert answer_of([small], UnexplainedTorque(False), much_worse) == ("cannot tell", True)


def test_masses_that_explain_most_come_first() -> None:
    """87 % "without a name" stood behind a friction of 3 %."""
    small, errors = replace(beside(), share=0.033), HeldOutErrors(0.033, 0.013, 0.013, masses=0.1, by_masses=0.87)
    told = headline([small], errors, likeliest="The likeliest name: link 2. ")
    assert told.startswith("Masses of the links that are off without a name add 87 % of what friction and rotors leave")
    assert told.index("The likeliest name") < told.index("3.3 %")
    large = replace(beside(), share=0.9)
    assert headline([large], errors).index("90 %") < headline([large], errors).index("add 87 %")
