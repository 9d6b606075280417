"""What is counted on rough arms in motion: causes that stand out among small errors everywhere; see `scoring`."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.proof.answers import NamedEffect
from armscope.proof.definitions import AS_LARGE
from armscope.proof.matching import Match
from armscope.proof.motion.answers import MotionAnswer
from armscope.proof.motion.truth import MotionTruth
from armscope.verdict.effects import UNKNOWN


def rough_scores(
    truth: MotionTruth, answer: MotionAnswer, matches: Sequence[Match], left: Sequence[NamedEffect]
) -> dict[str, object]:
    """How a verdict fares on an arm that has small errors everywhere; of other arms it says nothing.

    Args:
        truth: of the arm.
        answer: the verdict.
        matches: concealed causes and what is rough, with the claims that stand for them.
        left: claims that stand for nothing there is.

    Returns:
        first (None without a cause), nothing_false, major_names and right, all by the definitions.
    """
    if truth.category != "rough":
        return {}
    first = _first_is_true(answer, matches, truth) if truth.effects else None
    false = [claim for claim in left if claim.effect != UNKNOWN]
    asked = [found for found in matches if not found.truth.minor]
    return {
        "first": first,
        "nothing_false": not answer.failed and not false,
        "major_names": sum(not claim.minor and claim.effect != UNKNOWN for claim in answer.claims),
        "right": not answer.failed and not false and first is not False and all(found.right for found in asked),
    }


def _first_is_true(answer: MotionAnswer, matches: Sequence[Match], truth: MotionTruth) -> bool:
    """Whether the first name, which is the largest, is a cause's or of something as large."""
    names = [claim for claim in answer.claims if claim.effect != UNKNOWN]
    stands_for = [found.truth for found in matches if names and found.right and found.claim is names[0]]
    largest = max(cause.strength for cause in truth.effects)
    return any(not each.minor or each.strength >= AS_LARGE * largest for each in stands_for)
