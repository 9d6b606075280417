"""An unsettled cause as a clause: what it is for sure, and its most likely reading."""

from __future__ import annotations

from armscope.verdict.effects import FoundEffect
from armscope.verdict.wording import effect_in_words, plain


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
