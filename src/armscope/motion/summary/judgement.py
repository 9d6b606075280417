"""The verdict: what the selected causes mean, in words and numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.motion.fitting.consistency import PathAgreement, agreement
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.torque_delay import values_of
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.clauses import run_in_words
from armscope.motion.library.layout import OWN
from armscope.motion.summary.confounding import gains_instead
from armscope.motion.summary.constants import HELD_OUT
from armscope.motion.summary.doubts import as_likely_without, doubt_of, not_told_apart
from armscope.motion.summary.headline import told_of
from armscope.motion.summary.held_out_errors import HeldOutErrors
from armscope.motion.summary.intervals import Sureness, errors_of
from armscope.motion.summary.lasting import LastingTorque, lasting_words
from armscope.motion.summary.rivals import listed_rivals
from armscope.motion.summary.shares import Worth
from armscope.motion.summary.words import cure
from armscope.motion.verdict import FoundCause, JointBackground, UnexplainedTorque
from armscope.verdict.effects import Alternative, Parameter
from armscope.verdict.schema import Answer


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


def unexplained(
    found: Sequence[FoundCause], lasting: Sequence[LastingTorque], errors: HeldOutErrors
) -> UnexplainedTorque:
    """The largest free curve, if one is not minor; else what lasts and has no law at all, or a run that is met badly.

    Args:
        found: the causes, largest first.
        lasting: what lasts and has no law, largest first.
        errors: on motion that took no part.

    Returns:
        It, where there is any.
    """
    curves = [cause for cause in found if cause.nameless and not cause.minor]
    if curves:
        return UnexplainedTorque(True, curves[0].location, curves[0].driver, curves[0].title)
    if lasting:
        return UnexplainedTorque(True, f"joint {lasting[0].joint + 1}", lasting[0].driver, lasting_words(lasting[:1]))
    if errors.badly:
        run, _ = errors.badly[0]
        return UnexplainedTorque(True, f"run {run}", f"run: {run}", errors.badly_words)
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
    if not found or (errors.only_unnamed and not told_of(found)):
        missing = left.present or errors.foretells_nothing or errors.only_unnamed
        return ("cannot tell", True) if missing else ("nothing missing", False)
    if errors.no_answer:
        return ("cannot tell", True) if left.present or told_of(found) else ("nothing missing", False)
    named = [cause for cause in found if not cause.nameless and not cause.minor]
    if left.present:
        return ("partly explained" if named else "cannot tell"), True
    return "explained", True


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
