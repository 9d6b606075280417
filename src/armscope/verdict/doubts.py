"""A cause that these rows do not tell from others, in a work order: what it could be, and how one finds out."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.words import enumerated
from armscope.physics.registry import effect_named
from armscope.verdict.constants import WORDS
from armscope.verdict.effects import Alternative, FoundEffect
from armscope.verdict.family_cures import CONFIRM_FIRST
from armscope.verdict.sentences import exact_phrase
from armscope.verdict.told_causes import kind_and_place
from armscope.verdict.wording import effect_in_words, plain

OPEN = "to be settled"  # What is changed about a cause that is not settled: nothing yet
MEANWHILE = "Until then change nothing for it: commands by the whole model (armscope compensate) hold whichever it is."
MAY_BE_READ_SO = (
    "Until then change nothing for it, and take no commands from the model (armscope compensate): this may be the "
    "instrument's own error, and such commands would move a good arm wrongly."
)
NEVER_AGAIN = "Confirm it first: of the same rows drawn anew, no table has this name."
NOT_THE_ARMS = ("instrument", "drift")
"""Families of what is read wrongly, or stood elsewhere: the instrument, its target, the set-up."""


@dataclass(frozen=True)
class Doubt:
    """A cause that is not settled, as a work order tells it."""

    # what, place: kind and region, no more
    what: str
    place: str
    confirm: str  # how each reading shows itself
    instruction: str  # what comes before the cure of the best reading
    # what to do until then: commands by the whole model hold whichever of the arm's own causes it is, but not where one
    # is none of the arm's
    meanwhile: str


def doubt_of(effect: FoundEffect, asked: bool = False) -> Doubt | None:
    """The doubt about a cause; None where its name is sure. ``asked``: whether further measurements that the verdict
    asks for settle it."""
    if effect.named_as == "effect" or effect.same_cure:
        return None
    rivals = _rivals(effect)
    readings: list[FoundEffect | Alternative] = [effect, *rivals]
    names = [_words(each) for each in readings]
    which = enumerated(names, "or") if rivals else plain(effect.title)
    how = " (measure the poses in next_poses.csv)" if asked else " (by the tests at the arm)" if rivals else ""
    places = list(dict.fromkeys(each.location for each in readings))
    _, _, region = effect.title.partition(", ")
    first = f"First find out which it is: {which}{how}."
    if not (rivals or _either(effect)):
        for_sure = f"it is the {effect.location}" if effect.location == "payload" else kind_and_place(effect)
        first = f"Confirm it first: that {for_sure} is sure, its name is not."
    unsure = CONFIRM_FIRST if effect.size_open else NEVER_AGAIN if effect.never_chosen else ""
    if unsure:
        first = f"{unsure} {first}" if rivals else unsure
    return Doubt(
        what=kind_and_place(effect),
        place=enumerated(places, "or") if _either(effect) or not region else region,
        confirm=_shown_by(effect, rivals) if rivals else effect.confirm,
        instruction=f"{first} If {exact_phrase(effect)}: ",
        meanwhile=MAY_BE_READ_SO if any(each.family in NOT_THE_ARMS for each in readings) else MEANWHILE,
    )


def unless_confirmed(effect: FoundEffect) -> str:
    """What a named cause could be, too, if the test at the arm does not show it; "" where all else is excluded."""
    if effect.named_as != "effect":
        return ""
    near = [_words(each) for each in effect.alternatives if each.excluded is False and not each.same_motion]
    near = near[: WORDS.rivals]
    if near:
        return f"If that does not show it, change nothing here: it could also be {enumerated(near, 'or')}."
    if effect.inclusion is not None and effect.rarely_chosen:
        often = f"{100 * effect.inclusion:.0f} % of the tables"
        return f"Change nothing here before that shows it: of the same rows drawn anew, only {often} have this name."
    return ""


def alike_in_words(effect: FoundEffect) -> str:
    """What moves the tool as a cause does in every pose: it need not be found out which of them it is; "" for none."""
    alike = [_words(each) for each in effect.alternatives if each.same_motion]
    if not alike:
        return ""
    undone = "that moves the tool alike in every pose, and corrected rows and zeros undo it, too"
    return f"It may be {enumerated(alike, 'or')}: {undone}."


def _rivals(effect: FoundEffect) -> list[Alternative]:
    """What an unsettled cause could be besides its best reading: those in its title, or else the nearest."""
    if not _either(effect):
        return list(effect.alternatives[: WORDS.rivals])
    return [each for each in effect.alternatives if _words(each) in plain(effect.title)]


def _either(effect: FoundEffect) -> bool:
    """Whether the title says what it could be; else it says kind and region."""
    return " or " in effect.title


def _words(each: FoundEffect | Alternative) -> str:
    return effect_in_words(each.effect, each.location)


def _shown_by(effect: FoundEffect, rivals: list[Alternative]) -> str:
    """Each reading with how it is confirmed at the arm; those that are confirmed alike together."""
    names: dict[str, list[str]] = {effect.confirm: [_words(effect)]}
    for rival in rivals:
        known = effect_named(rival.effect)
        if known:
            names.setdefault(known.confirm, []).append(_words(rival))
    return " ".join(
        f"For {enumerated(those, 'and')}: {confirm[:1].lower()}{confirm[1:]}" for confirm, those in names.items()
    )
