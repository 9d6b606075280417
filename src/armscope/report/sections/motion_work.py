"""What is done about the torques of an arm in motion: per cause how to confirm and cure it, and the error after it."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from armscope.motion.export import URDF
from armscope.motion.library.catalogue import cause_named
from armscope.motion.library.layout import CAUSES_OF_OWN
from armscope.motion.summary.constants import HELD_OUT
from armscope.motion.summary.entering import Entered
from armscope.motion.summary.headline import MASSES_OFF
from armscope.motion.summary.lasting import LASTS
from armscope.motion.verdict import FoundCause
from armscope.report.html import significant
from armscope.report.motion_subject import MotionSubject
from armscope.report.sections.motion import friction_table
from armscope.report.sections.motion_cards import motion_card
from armscope.verdict.wording import capitalised

MOST_AT_A_JOINT, LEAST_TOLD = 3.0, 0.01
"""By how many times more a step betters one joint's torque than all, and at least by how much, for that to be told."""
IN_FULL = 3
"""Causes whose steps are told in full, as many as the headline tells; the others stand in a line each: one page."""


@dataclass(frozen=True)
class MotionTask:
    """One cause's line: who does what, what to do, and the error of the torque once it and all before it are done.

    ``shows`` is where that shows, if it hardly does in all torque together, and with which later step it pays.
    """

    said: str
    doubt: str
    rivals: tuple[str, ...]
    confirm: str
    cure: str
    expected: str
    shows: str


def motion_work_order(subject: MotionSubject) -> dict[str, Any]:
    """What the work order of a motion is filled with. Returns tasks of the causes, largest share first; those worth
    little in a word each; friction and rotors of the joints."""
    verdict = subject.verdict
    held_out = verdict.held_out
    to_enter = bool(np.isnan(subject.arm.stated_background[subject.moving, 1:CAUSES_OF_OWN]).any())
    background, with_masses, *after = subject.found.entered
    expected_after = {cause.title: step.whole for cause, step in zip(verdict.effects, after, strict=True)}
    steps = zip(verdict.effects, (with_masses, *after), after, strict=False)
    most_at = {cause.title: where_it_shows(before, step) for cause, before, step in steps}
    along = fitted_along_matters(subject)
    masses = along and subject.masses_fitted
    main = [each for each in verdict.effects if not each.minor]
    minor = [each for each in verdict.effects if each.minor]
    told = main + list(_paying(minor, expected_after, expected_after[main[-1].title] if main else with_masses.whole))
    apart = along and not any(_is_in_bodies(each) for each in told)
    apart = apart and bool(told or subject.gains_fitted or MASSES_OFF in verdict.headline)
    apart = apart and (not told or pays(*(step.held_out for step in verdict.waterfall[:2])))
    first = int(to_enter) + bool(apart) + 1
    reached = with_masses.whole if apart else background.whole if to_enter else held_out.stated
    later = paid_later(reached, [expected_after[cause.title] for cause in told], first)
    tasks = []
    for number, (cause, paid) in enumerate(zip(told, later, strict=True), start=1):
        card = motion_card(cause, number)
        rivals = tuple(other.name for other in card.alternatives if other.too_close)
        expected = error_in_words(expected_after[cause.title])
        too = _along_too(subject, cause) if along and not apart and number == 1 else ""
        cure = f"{card.cure} {too}".rstrip()
        tasks.append(
            MotionTask(card.said, card.doubt, rivals, card.confirm, cure, expected, most_at[cause.title] + paid)
        )
    return {
        "to_enter": to_enter,
        "first": first,
        "tasks": tasks[:IN_FULL],
        "more": tasks[IN_FULL:],
        "separate": separating_command(subject) if any(task.rivals for task in tasks) else "",
        "masses": masses,
        "along": along_in_words(subject) if along else "",
        "apart": error_in_words(with_masses.whole) if apart else "",
        "urdf": URDF,
        "gains": capitalised(subject.gains_fitted) if along else "",
        "of_gains": subject.found.selected.rows.layout.of_gains,
        "minor": [cause.title for cause in minor if cause not in told],
        "lasts": verdict.unexplained.description if LASTS in verdict.unexplained.description else "",
        "links": [motion_card(each, "") for side in verdict.links for each in side.causes if not each.minor],
        "now": error_in_words(held_out.stated),
        "background": error_in_words(background.whole),
        "model": error_in_words(held_out.model),
        **friction_table(subject),
    }


def where_it_shows(before: Entered, after: Entered) -> str:
    """The joint whose torque a step betters most, where that is far more than it does to all torque together.

    Large joints hold most of the torque: what puts a wrist right hardly shows in the error of the whole arm.

    Returns:
        Words in brackets, with a space before; nothing where the whole says it.
    """
    gains = [one - other for one, other in zip(before.by_joint, after.by_joint, strict=True)]
    joint = int(np.argmax(gains))
    if gains[joint] < MOST_AT_A_JOINT * max(before.whole - after.whole, LEAST_TOLD):
        return ""
    then, now = (error_in_words(each.by_joint[joint]) for each in (after, before))
    return f" (joint {joint + 1} alone: {now} before, {then} then)"


def paid_later(reached: float, after: Sequence[float], first: int) -> list[str]:
    """Of each step that leaves no less than was reached before it: with which later step it pays, and what is left.

    Args:
        reached: error before the first step, relative to the torque.
        after: (k,) errors once each step and all before it are done.
        first: number of the first step.

    Returns:
        Words behind each step's error; nothing where it pays by itself, or never does.
    """
    told = []
    for number, error in enumerate(after):
        then = next((n for n in range(number + 1, len(after)) if pays(reached, after[n])), None)
        alone = pays(reached, error)
        told.append(
            "" if alone or then is None else f"; it pays with step {first + then}: {error_in_words(after[then])}"
        )
        reached = min(reached, error)
    return told


def pays(before: float, after: float) -> bool:
    """Whether a step leaves less, in the figures that are told: one that does not is no step of its own."""
    return after < before and error_in_words(after) != error_in_words(before)


def fitted_along_matters(subject: MotionSubject) -> bool:
    """Whether the promised errors hold only with masses and gains as fitted: where they change them."""
    if not subject.masses_fitted and not subject.gains_fitted:
        return False
    before, with_masses = (step.held_out for step in subject.verdict.waterfall[:2])
    return error_in_words(before) != error_in_words(with_masses)


def along_in_words(subject: MotionSubject) -> str:
    """What was fitted beside the causes."""
    names = ["masses"] * subject.masses_fitted + [subject.found.selected.rows.layout.of_gains] * bool(
        subject.gains_fitted
    )
    return " and ".join(names)


def _paying(minor: Sequence[FoundCause], after: Mapping[str, float], before: float) -> Iterator[FoundCause]:
    """Those worth little beside friction fitted anew that yet pay where friction is entered as it was fitted."""
    for cause in minor:
        if cause.doubt or not after[cause.title] < HELD_OUT.clearly_better * before:
            return  # what comes later is promised on top of it
        yield cause
        before = after[cause.title]


def _is_in_bodies(cause: FoundCause) -> bool:
    """Whether the URDF of corrected masses holds what a cause changes."""
    known = cause_named(cause.effect)
    return bool(known and known.in_bodies and " in run " not in cause.title)


def _along_too(subject: MotionSubject, cause: FoundCause) -> str:
    """What is entered with the first cause, because it was fitted along."""
    there = " (where this is done already)" if _is_in_bodies(cause) else ""
    masses = f"Take the links' masses and inertias from {URDF}{there}: they were fitted along."
    told = [masses] * subject.masses_fitted + [capitalised(subject.gains_fitted)]
    return " ".join(each for each in told if each)


def separating_command(subject: MotionSubject) -> str:
    """The command that plans a motion for what these motions hardly tell apart; none for joints that slide."""
    if subject.arm.sliding.any():
        return ""
    verdict = Path(subject.folder) / "verdict.json"
    return f"armscope excite {shlex.quote(str(subject.robot))} --separate {shlex.quote(str(verdict))}"


def error_in_words(share: float) -> str:
    """An error relative to the torque, in words."""
    return f"{significant(100 * share, 2)} %" if math.isfinite(share) else "–"
