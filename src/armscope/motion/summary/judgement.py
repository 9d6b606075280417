"""The verdict: what the selected causes mean, in words and numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.numerals import rounded
from armscope.core.types import Array
from armscope.motion.constants import TELLING
from armscope.motion.fitting.consistency import PathAgreement, agreement
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.torque_delay import values_of
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.clauses import run_in_words
from armscope.motion.library.layout import OWN
from armscope.motion.summary.confounding import gains_instead
from armscope.motion.summary.constants import HELD_OUT
from armscope.motion.summary.doubts import as_likely_without, doubt_of, not_told_apart
from armscope.motion.summary.held_out_errors import ON_HELD_OUT, HeldOutErrors
from armscope.motion.summary.intervals import Sureness, errors_of
from armscope.motion.summary.lasting import LastingTorque, lasting_words
from armscope.motion.summary.rivals import listed_rivals
from armscope.motion.summary.shares import Worth
from armscope.motion.summary.words import clause, cure
from armscope.motion.verdict import FoundCause, JointBackground, UnexplainedTorque
from armscope.verdict.effects import UNKNOWN, Alternative, Parameter
from armscope.verdict.schema import Answer
from armscope.verdict.wording import capitalised, percent, spelled

MASSES_OFF = "Masses of the links"
"""How a headline begins to say that they are off without a name."""


def found_causes(selected: SelectedCauses, sure: Sureness, worth: Sequence[Worth]) -> list[tuple[int, FoundCause]]:
    """Every chosen cause with what is known about it, largest share first, beside its candidate's number.

    Args:
        selected: the selection.
        sure: what else would do, and how wide intervals are.
        worth: of each chosen cause.

    Returns:
        The causes.
    """
    best = selected.best
    found = []
    for number, effect in enumerate(best.chosen):
        placed = selected.rows.layout.placed[effect.candidate]
        agreed = agreement(selected, effect.candidate)
        found.append((effect.candidate, _found(selected, sure, effect.candidate, placed, (worth[number], agreed))))
    return sorted(found, key=lambda each: -each[1].share)


def _found(
    selected: SelectedCauses, sure: Sureness, number: int, placed: PlacedCause, known: tuple[Worth, PathAgreement]
) -> FoundCause:
    worth, agreed = known
    layout = selected.rows.layout
    columns = layout.columns[number]
    coefficients = np.zeros(layout.width)
    coefficients[columns] = selected.coefficients[columns]
    rms = np.sqrt(np.mean(selected.rows.modelled(coefficients) ** 2, axis=0))
    relative = rms / selected.weights.sigma
    joint = int(np.argmax(relative))
    parameters = cause_parameters(selected, number, sure.factor)
    alternatives = _alternatives(selected, sure, number)
    doubts = (
        doubt_of(selected, number, agreed, parameters),
        not_told_apart(alternatives),
        as_likely_without(selected, number),
    )
    return FoundCause(
        effect=placed.cause.name,
        location=placed.location,
        family=placed.cause.family,
        driver=placed.driver,
        title=title(placed),
        minor=worth.minor,
        parameters=parameters,
        rms=float(rms[joint]),
        unit="N" if layout.arm.sliding[joint] else "N m",
        joint=f"joint {joint + 1}",
        share=worth.share,
        evidence_nats=float(sure.search.log_odds(selected.best, number)),
        alternatives=alternatives,
        carries_over=agreed.words,
        consistent=agreed.consistent,
        physics=placed.cause.physics,
        confirm=(placed.common and placed.cause.confirm_common) or placed.cause.confirm,
        cure=cure(placed, parameters, layout.arm, layout.with_gains),
        doubt=" ".join(filter(None, doubts)),
    )


def title(placed: PlacedCause) -> str:
    """The name in words."""
    where = f" in {run_in_words(placed.runs[0])}" if placed.runs and placed.runs[0] else ""
    if placed.cause.nameless:
        return f"an unknown torque at {placed.location} that follows the {placed.driver}"
    form = f"{placed.variant} " if placed.cause.each_form else ""
    name = form + placed.cause.name.replace("_", " ")
    place = "" if placed.location == "payload" else f" at {placed.location}"
    return f"{name}{place}{where}"


def cause_parameters(selected: SelectedCauses, number: int, factor: Array) -> tuple[Parameter, ...]:
    """A cause's numbers with standard errors.

    Args:
        selected: the selection.
        number: of the cause.
        factor: (p,) on the standard error of every column.

    Returns:
        Those that were fitted, then those that were scanned, in the units of files.
    """
    placed = selected.rows.layout.placed[number]
    values, (stderr, of_scanned) = values_of(selected, number), errors_of(selected, number, factor)
    told = [
        Parameter(name, unit, float(value), float(error))
        for (name, unit), value, error in zip(placed.parameters, values, stderr, strict=True)
    ]
    scanned = zip(placed.scanned, of_scanned, strict=True)
    return (*told, *(Parameter(name, unit, value, float(error)) for (name, unit, value), error in scanned))


def _alternatives(selected: SelectedCauses, sure: Sureness, number: int) -> tuple[Alternative, ...]:
    """What could stand in a cause's place, nearest first, each name once."""
    gains = gains_instead(selected, number)
    return listed_rivals(sure.search, selected.best, number, sure.rivals[number], () if gains is None else (gains,))


def joint_backgrounds(selected: SelectedCauses, sure: Sureness) -> tuple[JointBackground, ...]:
    """Friction and rotor inertia of every joint."""
    layout, best, problem = selected.rows.layout, selected.best, selected.problem
    told = []
    stated = np.nan_to_num(layout.arm.stated_background)
    for j in range(layout.arm.n_motors):
        slides = layout.arm.sliding[j]
        torque, unit = ("N", "m") if slides else ("N m", "rad")
        units = (torque, torque, f"{torque} s/{unit}", "kg" if slides else "kg m^2")
        moving = ~selected.rows.still[:, j]
        made = []
        for k, what in enumerate(("offset", "coulomb", "viscous", "inertia")):
            column = OWN * j + k
            if column in best.columns and moving.any():
                error = sure.factor[column] * np.sqrt(best.variances(np.array([column]))[0]) / problem.scale[column]
                made.append(
                    Parameter(what, units[k], float(selected.coefficients[column] + stated[j, k]), float(error))
                )
        rows = float(moving.sum() / selected.weights.correlated[j])
        left = selected.residuals[moving, j]
        noise = float(np.sqrt(np.mean(left**2))) if len(left) else float("nan")
        told.append(JointBackground(f"joint {j + 1}", tuple(made), noise, torque, int(rows)))
    return tuple(told)


def unexplained(found: Sequence[FoundCause], lasting: Sequence[LastingTorque]) -> UnexplainedTorque:
    """The largest free curve, if one is not minor; else the largest torque that lasts and has no law at all."""
    curves = [cause for cause in found if cause.nameless and not cause.minor]
    if curves:
        return UnexplainedTorque(True, curves[0].location, curves[0].driver, curves[0].title)
    if lasting:
        return UnexplainedTorque(True, f"joint {lasting[0].joint + 1}", lasting[0].driver, lasting_words(lasting[:1]))
    return UnexplainedTorque(False)


def answer_of(found: Sequence[FoundCause], left: UnexplainedTorque, errors: HeldOutErrors) -> tuple[Answer, bool]:
    """The answer in two words, and whether there is a mismatch.

    Args:
        found: the causes.
        left: what has none.
        errors: on motion that took no part; names that don't help there are no answer.

    Returns:
        Both.
    """
    if not found or (errors.only_unnamed and not _told(found)):
        missing = left.present or errors.foretells_nothing or errors.only_unnamed
        return ("cannot tell", True) if missing else ("nothing missing", False)
    if errors.no_answer:
        return ("cannot tell", True) if left.present or _told(found) else ("nothing missing", False)
    named = [cause for cause in found if not cause.nameless and not cause.minor]
    if left.present:
        return ("partly explained" if named else "cannot tell"), True
    return "explained", True


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
    main = _told(found)
    beyond = f"{capitalised(lasting_words(lasting[:1]))}. " if lasting else ""
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
    return errors.by_masses > max((cause.share for cause in _told(found)), default=0.0)


def apart_where_useless(found: Sequence[FoundCause], errors: HeldOutErrors) -> list[FoundCause]:
    """Causes that all together are hardly worth anything and foretell nothing are apart from the story."""
    little = sum(cause.share for cause in found if not cause.minor) < HELD_OUT.little_share
    return [replace(cause, minor=True) if little and errors.useless else cause for cause in found]


def doubted_beside(found: Sequence[FoundCause], lasting: Sequence[LastingTorque]) -> list[FoundCause]:
    """Causes with a doubt on each at whose joint more lasts without a law than it says itself."""
    rms = {f"joint {each.joint + 1}": each.rms for each in lasting}
    told = "More than it says lasts at this joint and has no law: it may stand for a part of that."
    return [
        replace(cause, doubt=f"{cause.doubt} {told}".lstrip()) if rms.get(cause.joint, 0.0) > cause.rms else cause
        for cause in found
    ]


def _told(found: Sequence[FoundCause]) -> list[FoundCause]:
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
