"""Why a cause that the evidence asks for is to be taken with care: paths that don't tell its size, a link too loose."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.words import enumerated
from armscope.motion.fitting.consistency import PARTS, PathAgreement
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.library.layout import NAMED_OF_OWN, OWN
from armscope.motion.summary.constants import NAMING, PLAUSIBLE
from armscope.motion.summary.unnamed_masses import is_of_masses, odds_of_name
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, INTERVAL, Alternative, Parameter
from armscope.verdict.wording import effect_in_words


def doubt_of(selected: SelectedCauses, number: int, agreed: PathAgreement, parameters: Sequence[Parameter]) -> str:
    """What speaks against a chosen cause, or leaves it open, in a sentence or two.

    Args:
        selected: the selection.
        number: of the cause.
        agreed: what different paths say of it.
        parameters: its numbers, as they are told.

    Returns:
        The words; empty where nothing does.
    """
    told = []
    if agreed.consistent is False:
        told.append("Its size differs from path to path: take it as one way to say what happens, not as the cause.")
    elif agreed.undetermined:
        parts = "paths" if agreed.paths else PARTS
        told.append(
            f"Undetermined: no two {parts} tell its size by themselves. It may stand for a share of something else; "
            "record another path before anything is changed for it."
        )
    if may_be_nothing(parameters):
        told.append("Its 95 % interval holds zero: which way it goes is open. Change nothing for it yet.")
    elif not determined(parameters):
        told.append("Its size is not determined: the 95 % interval is nearly as wide. Record other paths.")
    return " ".join([*told, *too_loose(swing_hz(selected, number))])


def not_told_apart(alternatives: Sequence[Alternative]) -> str:
    """What fits as well and is less likely for its number of parameters alone, in a sentence; empty where nothing."""
    priced = [each for each in alternatives if each.discriminability_nats < each.evidence_gap_nats]
    alike = [each for each in priced if each.discriminability_nats < INDISTINGUISHABLE_NATS]
    if not alike:
        return ""
    names = enumerated([effect_in_words(each.effect, each.location) for each in alike], "or")
    return f"These rows fit {names} as well: find out which it is before anything is changed."


def as_likely_without(selected: SelectedCauses, number: int) -> str:
    """That masses all over the arm fit as well as a name of masses, in a sentence; empty where the name is likelier."""
    if not is_of_masses(selected.rows.layout.placed[number]):
        return ""
    if odds_of_name(selected, number) >= INDISTINGUISHABLE_NATS:
        return ""
    return "Links that are all off a little fit about as well: weigh what it names before anything is changed."


def may_be_nothing(parameters: Sequence[Parameter]) -> bool:
    """Whether the intervals of all numbers that were fitted hold zero."""
    return _all_within(parameters, 1.0)


def determined(parameters: Sequence[Parameter]) -> bool:
    """Whether the only number that was fitted, if there is one, is clearly larger than half its interval.

    Of several, each may be open where all together are sure: powers of one curve take each other's part.
    """
    several = sum(bool(np.isfinite(each.stderr)) for each in parameters) > 1
    return several or not _all_within(parameters, NAMING.determined)


def _all_within(parameters: Sequence[Parameter], share: float) -> bool:
    """Whether of all numbers that were fitted the interval reaches beyond that share of them."""
    fitted = [each for each in parameters if np.isfinite(each.stderr)]
    return bool(fitted) and all(share * abs(each.value) < INTERVAL * each.stderr for each in fitted)


def too_loose(swing: float | None) -> list[str]:
    """What is said of a link that swings on its drive at a frequency, Hz: nothing of one that no link has."""
    if swing is None or swing >= PLAUSIBLE.slowest_swing_hz:
        return []
    return [
        f"Its link would swing on it at {swing:.2g} Hz; arms' lowest resonances lie above "
        f"{PLAUSIBLE.slowest_swing_hz:g} Hz as a rule. A belt may be so soft, a gear is not."
    ]


def swing_hz(selected: SelectedCauses, number: int) -> float | None:
    """At which frequency a link swings on a drive that gives way, motor held, in its heaviest pose.

    Args:
        selected: the selection.
        number: of the cause.

    Returns:
        Hz; None of other causes, or where it is not above zero.
    """
    placed = selected.rows.layout.placed[number]
    compliance = float(selected.coefficients[selected.rows.layout.columns[number][0]])
    if placed.cause is not catalogue.COMPLIANCE or compliance <= 0:
        return None
    return swing_of(selected.rows, placed.joints[0], compliance)


def swing_of(rows: MotionRows, joint: int, compliance: float) -> float:
    """At which frequency a link swings on a drive, motor held, in its heaviest pose, with all that it ever carried.

    Args:
        rows: in which the arm was.
        joint: from 0.
        compliance: of its drive, rad/(N m), above zero.

    Returns:
        Hz.
    """
    arm, q = rows.layout.arm, rows.q[:: max(len(rows) // PLAUSIBLE.poses, 1)]
    inertial = arm.inertial + max(rows.stated_payload((str(run),)) for run in np.unique(rows.run)) * arm.point_load()
    still, turning = np.zeros_like(q), np.zeros_like(q)
    turning[:, joint] = 1.0
    inertia = (arm.torques(q, still, turning, inertial) - arm.torques(q, still, still, inertial))[:, joint]
    return float(1 / (2 * np.pi * np.sqrt(max(compliance * inertia.max(), 1e-300))))


def motion_hz(selected: SelectedCauses, joint: int) -> float:
    """How fast a joint moves to and fro: RMS acceleration over RMS speed, as a frequency."""
    rows = selected.rows
    place = np.searchsorted(rows.at[joint], OWN * joint + NAMED_OF_OWN.index("inertia"))
    faster = np.sqrt(np.mean(rows.columns[joint][:, place].astype(np.float64) ** 2))
    speed = max(float(np.sqrt(np.mean(rows.dq[:, joint] ** 2))), 1e-300)
    return float(faster / speed / (2 * np.pi))
