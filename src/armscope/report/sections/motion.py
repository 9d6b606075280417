"""The sections of the page of an arm in motion, in their order, and what their templates are filled with."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pandas as pd

from armscope.core.inputs import InputError
from armscope.core.location import Location
from armscope.core.words import size_of
from armscope.motion.library.clauses import ALL_JOINTS, amount
from armscope.motion.summary.left_over import left_over, shares_left_over
from armscope.motion.verdict import JointBackground, LinkSide
from armscope.report.figures.arm_picture import draw_arm
from armscope.report.figures.atlas import atlas_map
from armscope.report.figures.motion import (
    FRICTION,
    LEFT,
    TRACE,
    curve_figures,
    friction_figures,
    left_figures,
    trace_figures,
)
from armscope.report.figures.twist import TWIST, twist_figures
from armscope.report.figures.waterfall import STEPS, Quantity, draw_waterfall
from armscope.report.motion_subject import MotionSubject
from armscope.report.sectioning import Drawn, Section
from armscope.report.sections.motion_cards import motion_card
from armscope.robot.arm import build_arm
from armscope.verdict.effects import Parameter
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


RELATIVE = Quantity("error on held-out motion, relative to its torque (%)", lambda value: f"{value:.3g} %")
SEEN = 0.005  # Share from which what no cause explains has a line of its own
NOT_SEEN = "not seen"


def _cards(subject: MotionSubject) -> dict[str, Any]:
    number = {id(cause): n for n, cause in enumerate(subject.verdict.effects, start=1)}
    main, minor = ([motion_card(c, number[id(c)]) for c in each] for each in (subject.main, subject.minor))
    return {"cards": main, "minor": minor, "minor_share": percent(sum(cause.share for cause in subject.minor))}


def _where(subject: MotionSubject) -> dict[str, Any]:
    rest = 1 - sum(cause.share for cause in subject.verdict.effects)
    return {**_cards(subject), "joints": subject.arm.n_motors, "rest": percent(rest) if rest > SEEN else ""}


def arm_of_motion(subject: MotionSubject) -> Iterator[Drawn]:
    """The arm coloured by share; none of an arm whose joints slide, which the picture does not know."""
    try:
        arm = build_arm(subject.arm.description)
    except (InputError, ValueError):
        return
    shares, nameless = places_of_motion(subject)
    rows = subject.found.selected.rows
    yield Drawn("arm", draw_arm(arm, rows.q, {place: min(share, 1.0) for place, share in shares.items()}, nameless))


def places_of_motion(subject: MotionSubject) -> tuple[dict[str, float], set[str]]:
    """Share of each place, torque that lasts without a law among it, and the joints where some has no known law.

    What all joints have in common is spread evenly over those that move.
    """
    shares: dict[str, float] = {}
    nameless = {cause.location for cause in subject.verdict.effects if cause.nameless and not cause.minor}
    every = [f"joint {joint + 1}" for joint in subject.moving]
    for cause in subject.verdict.effects:
        place = cause.location if _has_a_place(cause.location) else "payload"
        places = every if cause.location == ALL_JOINTS else [place]
        for each in places:
            shares[each] = shares.get(each, 0.0) + min(max(cause.share, 0.0), 1.0) / len(places)
    if subject.verdict.unexplained.present:
        selected = subject.found.selected
        for joint, share in shares_left_over(selected, left_over(selected)).items():
            place = f"joint {joint + 1}"
            shares[place] = shares.get(place, 0.0) + share
            nameless.add(place)
    return shares, nameless


def _has_a_place(location: str) -> bool:
    try:
        return Location.of(location).kind in ("joint", "link", "base", "payload", "tool")
    except ValueError:
        return False


def waterfall_of_motion(subject: MotionSubject) -> Iterator[Drawn]:
    """The relative error on held-out motion as causes enter."""
    steps = [(name, error) for name, error, _ in relative_steps(subject)]
    yield Drawn("waterfall", draw_waterfall(steps, None, quantity=RELATIVE, narrow=True))


def relative_steps(subject: MotionSubject) -> list[tuple[str, float, float]]:
    """(what entered, error on held-out motion, error on fitted motion), %; the arm as stated first."""
    steps = [("as stated, nothing fitted", 100 * subject.verdict.held_out.stated, float("nan"))]
    small = {cause.title for cause in subject.minor}
    known = enumerate(subject.verdict.waterfall)
    for minor, group in itertools.groupby(known, lambda each: each[1].label in small):
        members = list(group)
        if minor and len(members) > 1:  # one by one they are hardly to be seen
            members = [(members[-1][0], replace(members[-1][1], label=f"{len(members)} minor causes"))]
        for number, step in members:
            label = step.label.replace("an unknown torque at", "unknown torque,").replace("that follows the", "over")
            steps.append((f"+ {label}" if number else label, 100 * step.held_out, 100 * step.fitted))
    return steps


def _better(subject: MotionSubject) -> dict[str, Any]:
    names = ["model", "error on held-out motion (%)", "on fitted motion (%)"]
    model = RELATIVE.words(100 * subject.verdict.held_out.model)
    return {"steps": pd.DataFrame(relative_steps(subject), columns=names), "model": model, "keys": STEPS}


def friction_table(subject: MotionSubject) -> dict[str, Any]:
    """Friction and rotor of every joint in words."""
    names = ("offset", "coulomb", "viscous", "inertia")
    joints = subject.verdict.background
    below = [
        joint.joint
        for joint in joints
        if any(each.name == "inertia" and each.interval[1] < 0 for each in joint.parameters)
    ]
    told = [(each, _told(each, names)) for each in joints]
    said = {each for _, row in told for each in row}
    return {
        "joints": told,
        "below_zero": below,
        "not_seen": NOT_SEEN in said,
        "entered_as_0": any(each.startswith("0 (") for each in said),
        "n": len(joints),
        "keys": FRICTION,
    }


def _told(joint: JointBackground, names: tuple[str, ...]) -> list[str]:
    known = {each.name: value_to_enter(each) for each in joint.parameters}
    return [known.get(name, "–") for name in names]


def value_to_enter(parameter: Parameter) -> str:
    """Friction, a rotor or an offset of a joint, as a value that can be entered into a model.

    Friction and rotors are not below zero: what comes out so within its error was not seen. Friction further below
    holds something else, and 0 is entered; a rotor further below takes away from what the joint moves.

    Args:
        parameter: of a joint's background.

    Returns:
        Its value, or that there is none to enter.
    """
    signed_amount = f"{'−' if parameter.value < 0 else ''}{amount(parameter)}"
    if parameter.name == "offset" or parameter.value >= 0:
        return signed_amount
    if not parameter.interval[1] < 0:  # also where its error is not known
        return NOT_SEEN
    return signed_amount if parameter.name == "inertia" else f"0 (fitted {signed_amount})"


def _torque(subject: MotionSubject) -> dict[str, Any]:
    return {"n": subject.arm.n_motors, "keys": TRACE}


def _left(subject: MotionSubject) -> dict[str, Any]:
    return {"moving": [joint + 1 for joint in subject.moving], "by_joint": subject.verdict.held_out.by_joint,
            "keys": LEFT, "units": [subject.unit(joint) for joint in range(subject.arm.n_motors)]}  # fmt: skip


def _prepared(subject: MotionSubject) -> dict[str, Any]:
    return {"how": subject.found.how, "masses": percent(subject.verdict.masses_share)}


def _atlas(subject: MotionSubject) -> dict[str, Any]:
    return {"map": atlas_map(subject.found.atlas, subject.verdict.effects, lambda cause: (cause.joint, cause.driver))}


Motion = Section[MotionSubject]
MOTION_SECTIONS: tuple[Motion, ...] = (
    Motion("locations", "Where", "Where the torque goes", _where, (arm_of_motion,)),
    Motion("causes", "Causes", "What was found", _cards, (curve_figures,)),
    Motion(
        "links",
        "Links",
        "Links beside their motors",
        links_of_motion,
        (twist_figures,),
        applies=lambda verdict: bool(verdict.links),
    ),
    Motion("torque", "Torque", "Torque on motion that took no part", _torque, (trace_figures,)),
    Motion("friction", "Friction", "Friction and rotors of every joint", friction_table, (friction_figures,)),
    Motion("validation", "Validation", "How much better the model predicts", _better, (waterfall_of_motion,)),
    Motion(
        "unexplained", "What is left", "What is left, over angle, speed and time", _left, (left_figures,), folded=True
    ),
    Motion("atlas", "Atlas", "The atlas: what each joint's torque follows", _atlas, folded=True),
    Motion("prepared", "Preparation", "How samples became rows", _prepared, folded=True),
)
"""What a person acts on comes first."""
