"""Which causes a headline tells, in which order, each with its shares, and an unsettled one as a clause."""

from __future__ import annotations

import math
from collections.abc import Sequence

from armscope.verdict.calibrated import stands_out
from armscope.verdict.constants import WORDS
from armscope.verdict.effects import Cause, FoundEffect
from armscope.verdict.wording import SPREAD, effect_in_words, percent, plain

WORST = ", most at "
MOST_OF_ALL = ", most of all: "


def with_share(cause: Cause, first: bool, alone: float = math.nan) -> str:
    """A cause and its shares; those of a whole family stand before its largest member, which has only a part.

    Args:
        cause: to be told.
        first: whether it is the first of a headline, which says what the shares are of.
        alone: the share of the member that stands before the brackets (0 ... 1), where others belong to the cause.

    Returns:
        The clause.
    """
    family, worst, member = cause.text.partition(MOST_OF_ALL)
    share = f"{percent(cause.share)}{' of the squared error' * first}"
    if cause.share > WORDS.more_than_all:
        share = "more than the whole squared error, as others cancel a part of it"
    elif not worst and 0 < alone < cause.share - WORDS.told_first:
        share = f"{percent(alone)}{' of the squared error' * first}, {percent(cause.share)} with the others"
    if of_rest := of_what_calibration_leaves(cause):
        share = of_rest if cause.share < WORDS.told_at_all else f"{share} ({of_rest})"
    return f"{family} – {share}{worst}{member}"


def of_what_calibration_leaves(told: FoundEffect | Cause) -> str:
    """ "60 % of what calibration leaves"; "" where that is little, or the share of the whole says enough."""
    after = told.share_after_calibration
    seen = told.share >= WORDS.large_anyway or after <= WORDS.hidden_by_geometry * told.share
    return f"{percent(after)} of what calibration leaves" if stands_out(told) and not seen else ""


def told_and_rest(causes: Sequence[Cause]) -> tuple[list[Cause], list[Cause]]:
    """The causes that a headline tells, and those that it counts."""

    def has_a_name(cause: Cause) -> bool:
        seen = stands_out(cause) or (cause.share > WORDS.told_though_unsure and not cause.minor)
        return bool(cause.members) and seen and not is_spread(cause)

    def is_large(cause: Cause) -> bool:
        return cause.share > (WORDS.spread_told_first if is_spread(cause) else WORDS.told_first)

    found = [cause for cause in causes if is_large(cause) or has_a_name(cause)]
    first = [cause for cause in found if cause.share > WORDS.told_first]
    then = sorted((cause for cause in found if cause not in first), key=lambda c: -c.share_after_calibration)
    told = [*first, *then][: WORDS.causes] or list(causes[:1])
    return told, [cause for cause in causes if cause not in told and abs(cause.share) >= WORDS.told_at_all]


def is_spread(cause: Cause) -> bool:
    """Whether a cause is small errors in the whole arm of which none stands out."""
    return cause.everywhere and cause.text.partition(WORST)[0] == SPREAD.get(cause.family)


def vague(effect: FoundEffect) -> str:
    """A region or a family, with the best single reading."""
    if " or " in effect.title:
        return kind_and_place(effect)
    open_size = ", of a size that these rows do not determine" if effect.size_open else ""
    return f"{kind_and_place(effect)}, most likely {effect_in_words(effect.effect, effect.location)}{open_size}"


def kind_and_place(effect: FoundEffect) -> str:
    """What an unsettled cause is for sure, as a clause: one of two, or a kind of error in a region."""
    if " or " in effect.title:
        return f"either {plain(effect.title)}"
    if effect.location == "payload":
        return "the payload may not be as stated"
    kinds = {
        "elastic": "something gives way under load",
        "instrument": "something is measured wrong",
        "geometric": "the geometry differs from what was stated",
        "transmission": "a drive does not turn as commanded",
        "thermal": "something grows with temperature",
        "drift": "something moves during the recording",
        "unknown": "something follows no known physics",
    }
    _, _, where = effect.title.partition(", ")
    return f"{kinds.get(effect.family, f'something {effect.family}')} {where or 'in the arm'}"
