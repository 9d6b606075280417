"""The headline: what the causes mean in a sentence or some, most important first."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.core.words import rounded
from armscope.motion.constants import TELLING
from armscope.motion.summary.held_out_errors import ON_HELD_OUT, HeldOutErrors
from armscope.motion.summary.lasting import LastingTorque, lasting_words
from armscope.motion.summary.words import clause
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import UNKNOWN
from armscope.verdict.wording import capitalised, percent, spelled

MASSES_OFF = "Masses of the links"
"""How a headline begins to say that they are off without a name."""


def headline(
    found: Sequence[FoundCause], errors: HeldOutErrors, lasting: Sequence[LastingTorque] = (), likeliest: str = ""
) -> str:
    """The largest causes with what each has of the torque that friction and rotors leave, the others by family.

    Args:
        found: the causes, largest first.
        errors: on motion that took no part.
        lasting: what lasts and has no law, largest first.
        likeliest: the name of masses that comes next where none is sure enough.

    Returns:
        A sentence or some.
    """
    main = told_of(found)
    differs = f"{capitalised(errors.badly_words)}: something is different there. " if errors.badly else ""
    beyond = (f"{capitalised(lasting_words(lasting[:1]))}. " if lasting else "") + differs
    if not main and errors.only_unnamed and not errors.foretells_nothing:
        met, before = (f"{rounded(100 * error)} %" for error in (errors.named, errors.without))
        return (
            f"{MASSES_OFF} are not as stated, in a way that no single name says better than all of them off a "
            f"little: corrected.urdf has them as fitted. {likeliest}{beyond}"
            f"{ON_HELD_OUT} the torque is met to {met} by them instead of {before}."
        )
    if not found and lasting:
        return f"{beyond}No cause of the library explains it. {errors.words(causes=False)}"
    if not found:
        met = f"{ON_HELD_OUT} the torque is met to {rounded(100 * errors.named)} %."
        if errors.badly:
            return f"Cannot tell what is missing. {differs}What was fitted shows no cause."
        if errors.foretells_nothing:
            return (
                "Cannot tell what is missing: the model foretells these torques no better than none at all, and no "
                f"cause mends it. Are they of this motion, and of this arm? {met}"
            )
        return f"Nothing is missing beyond friction and rotors of the joints. {met}"
    if errors.no_answer and not main and not lasting:
        nothing = "Nothing that helps elsewhere is missing beyond friction and rotors of the joints"
        return f"{nothing}. {errors.words(causes=False)}"
    told, rest = (main or found)[: TELLING.in_headline], main[TELLING.in_headline :]
    of_what = (" of what friction and rotors leave", *[""] * len(told))
    if errors.no_answer:
        doubt = "Cannot tell what is missing: nothing that was found helps on motion that took no part"
        return f"{doubt}. The reading that fits best: {clause(told[0])}. {errors.words()}"
    causes = "; ".join(
        f"{clause(c)}{_worth(c.share, of_what[n])}{', in doubt' if c.doubt else ''}" for n, c in enumerate(told)
    )
    unnamed = f"{MASSES_OFF} that are off without a name add {percent(errors.by_masses)}"
    if masses_lead(found, errors):
        first = f"{unnamed}{of_what[0]}; corrected.urdf has them as fitted. {likeliest}"
        return f"{first}{capitalised(causes)}. {_further(rest)}{beyond}{errors.words()}"
    unnamed = f"{unnamed}. " if errors.by_masses >= TELLING.minor_share else ""
    return f"{capitalised(causes)}. {_further(rest)}{unnamed}{beyond}{errors.words()}"


def masses_lead(found: Sequence[FoundCause], errors: HeldOutErrors) -> bool:
    """Whether masses that are off without a name explain more than any cause that is told."""
    return errors.by_masses > max((cause.share for cause in told_of(found)), default=0.0)


def told_of(found: Sequence[FoundCause]) -> list[FoundCause]:
    """Those that are part of the story."""
    return [cause for cause in found if not cause.minor]


def _further(causes: Sequence[FoundCause]) -> str:
    """What a headline doesn't name, by family: where there is more of it."""
    if not causes:
        return ""
    places: dict[str, list[str]] = {}
    for cause in causes:
        places.setdefault(cause.family, []).append(cause.location)
    kinds = {UNKNOWN: "torque without a known law"}
    told = [f"{kinds.get(family, family)} ({', '.join(dict.fromkeys(where))})" for family, where in places.items()]
    count = f"{spelled(len(causes))} more cause{'s' if len(causes) > 1 else ''}"
    return f"{capitalised(count)}: {', '.join(told)}{_worth(sum(c.share for c in causes))}. "


def _worth(share: float, of_what: str = "") -> str:
    """A share in a sentence; of what only hides part of what others do, nothing."""
    return f" – {percent(share)}{of_what}" if share > 0 else ""
