"""The section on links beside their motors."""

from __future__ import annotations

from typing import Any

from armscope.core.numerals import size_of
from armscope.motion.library.clauses import amount
from armscope.motion.verdict import LinkSide
from armscope.report.figures.twist import TWIST
from armscope.report.motion_subject import MotionSubject
from armscope.report.sections.motion_cards import motion_card
from armscope.verdict.wording import percent


def links_of_motion(subject: MotionSubject) -> dict[str, Any]:
    """Joint by joint: how link and motor lie, and a card for each cause."""
    return {"sides": [_side(side) for side in subject.verdict.links], "keys": TWIST}


def _side(side: LinkSide) -> dict[str, Any]:
    number = side.joint.removeprefix("joint ")
    main = [cause for cause in side.causes if not cause.minor]
    return {
        "joint": side.joint,
        "figure": f"twist_{number}",
        "zero": amount(side.offset, sign=True),
        "size": size_of(side.rms, side.unit),
        "left": size_of(side.left, side.unit),
        "share_left": percent((side.left / side.rms) ** 2 if side.rms else 0.0),
        "cards": [motion_card(cause, f"link-{number}-{n}") for n, cause in enumerate(main, start=1)],
        "minor": [cause.title for cause in side.causes if cause.minor],
    }
