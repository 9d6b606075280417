"""What is there without a name: small errors everywhere, and what nothing in the library explains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.inference.detection import Detection
from armscope.inference.edits import Edits
from armscope.inference.linear_algebra import profiled_loss
from armscope.inference.normal_equations import NormalEquations, projected_rms
from armscope.inference.problem import background_sizes
from armscope.inference.removals import savage_dickey
from armscope.measurement.constants import WEIGHTS
from armscope.physics.backgrounds import DRIFT, ELASTIC, FAMILIES, GEOMETRIC, MENDED, TRANSMISSION
from armscope.physics.elastic import UNKNOWN_MASSES
from armscope.physics.loads import STATED_MASSES
from armscope.verdict.effects import INTERVAL, FoundEffect
from armscope.verdict.remainder import ABOVE_NOISE, above_what
from armscope.verdict.schema import NOISE_EXCEEDED, Background, Notice, Unexplained
from armscope.verdict.wording import capitalised, places_in_words

WITH_A_WORST_PLACE = (GEOMETRIC, ELASTIC, TRANSMISSION, DRIFT)


def background_summaries(
    state: DiagnosisState, edits: Edits, equations: NormalEquations, of_families: Sequence[float]
) -> tuple[Background, ...]:
    """What each family's background amounts to, and whether the evidence asks for it.

    Args:
        state: the finished selection.
        edits: of the search.
        equations: sums over all rows.
        of_families: share of the variance after the frames that each family explains, 0 ... 1.

    Returns:
        One per family.
    """
    fit, best = state.fit, state.best
    sizes = background_sizes(state.problem, best.background)
    values = {t: v for part in fit.model.background for t, v in zip(part.placed.terms, part.values, strict=True)}
    told = []
    for family, members in MENDED.items():
        numbers = [FAMILIES.index(member) for member in members]
        columns = np.concatenate([fit.layout.background[number] for number in numbers])
        coefficients = np.zeros(len(fit.layout.terms))
        coefficients[columns] = [values[fit.layout.terms[column]] for column in columns]
        rms = projected_rms(equations, fit.layout.frames, coefficients)
        without = best
        for number in numbers:
            without = edits.with_background(without, number, 0)
        present = any(best.background[number] > 0 for number in numbers) and (
            best.log_posterior - without.log_posterior > TELLING.background_seen_nats
        )
        share = sum(of_families[number] for number in numbers)
        worst = _worst_place(state, equations, coefficients) if present and family in WITH_A_WORST_PLACE else ""
        told.append(Background(family, present, sizes[numbers[0]], rms, share, worst))
    return tuple(told)


def _worst_place(state: DiagnosisState, equations: NormalEquations, coefficients: Array) -> str:
    """Where the small errors of a family (p,) do clearly more at the tool than anywhere else; "" for nowhere."""
    layout = state.fit.layout
    by_place: dict[str, Array] = {}
    for part in state.fit.model.background:
        columns = layout.of(part.placed)
        by_place.setdefault(part.placed.location, np.zeros(len(coefficients)))[columns] = coefficients[columns]
    sizes = {place: projected_rms(equations, layout.frames, own) for place, own in by_place.items() if own.any()}
    worst, *others = sorted(sizes, key=lambda place: -sizes[place]) or [""]
    return worst if others and sizes[worst] > TELLING.worst_place * sizes[others[0]] else ""


def masses_in_error(
    state: DiagnosisState, equations: NormalEquations, share: float
) -> tuple[list[Background], list[Notice]]:
    """What stated masses are found to be off by, where the evidence asks for it; otherwise nothing.

    Args:
        state: the finished selection.
        equations: sums over all rows.
        share: of the mismatch that their errors explain.

    Returns:
        The background that they are and what to say of those that are told, or neither.
    """
    fit, (masses,) = state.fit, state.space.companions
    family = masses.family
    if not masses.joins(state.best.candidates, state.best.background):
        return [], []
    lost = profiled_loss(savage_dickey(state.best, family.columns), state.problem.n)
    if lost < TELLING.background_seen_nats:
        return [], []
    parts = [part for part in fit.model.background if part.placed.effect is STATED_MASSES]
    at = [int(fit.layout.of(part.placed)[0]) for part in parts]
    off, stderr = np.array([part.values[0] for part in parts]), np.sqrt(np.diag(fit.covariance)[at])
    coefficients = np.zeros(len(fit.layout.terms))
    coefficients[at] = off
    rms = projected_rms(equations, fit.layout.frames, coefficients)
    found = Background(family.name, True, family.label(family.sizes - 1), rms, share)
    known = [
        f"{part.placed.location} {100 * value:+.0f} +- {100 * INTERVAL * error:.0f} %"
        for part, value, error in zip(parts, off, stderr, strict=True)
        if error < TELLING.undetermined * part.placed.prior_scale[0] and abs(value) > INTERVAL * error
    ]
    text = "Stated masses are off, as all that gives way shows"
    return [found], [Notice("stated masses", f"{text}: {', '.join(known)}." if known else f"{text}; which, is open.")]


def load_in_question(state: DiagnosisState) -> list[Notice]:
    """That drives give way to another load than the stated masses make, and what else may be one.

    Compliances told beside it were fitted to the stated masses: a gripper of 30 kg that nobody had stated made those of
    a wrist come out fifteen times too soft.
    """
    arm, parts = state.fit.model.arm, state.fit.model.parts
    if not arm.has_masses:
        return []
    by_others = [part.placed.location for part in parts if part.placed.variant == UNKNOWN_MASSES]
    if not by_others:
        return []
    text = (
        f"{capitalised(places_in_words(by_others))} give{'s' * (len(by_others) == 1)} way to another load than the "
        "stated masses make: does something hang at the flange that nobody stated (`tool_load` in robot.yaml, "
        "`payload_kg` in the recordings), does a spring balance a joint, or are those masses off? State what is there "
        "and diagnose again, before drives are corrected one by one: stiffness told beside a wrong load is wrong, too."
    )
    if f"joint {arm.n_motors}" in by_others:
        text += (
            " Or does the target sit loosely (nest, magnet, adapter)? Gravity moves it then as if the last joint gave "
            "way: hold it and feel."
        )
    return [Notice("load in question", text)]


def together(families: Sequence[Background]) -> Background:
    """All families' backgrounds as one."""
    present = [family for family in families if family.present]
    rms = float(np.sqrt(sum(family.rms_at_tool_mm**2 for family in present)))
    return Background("all", bool(present), float("nan"), rms, sum(family.share for family in present))


def unexplained_part(effects: Sequence[FoundEffect], state: DiagnosisState) -> Unexplained:
    """The largest free curve; or noise far above what was stated, or what repeats scatter by."""
    curves = [effect for effect in effects if effect.nameless]
    if curves:
        largest = curves[0]
        words = largest.curve.description if largest.curve else largest.title
        return Unexplained(True, largest.location, largest.driver, largest.rms_at_tool_mm, words)
    for known, repeats, what in (
        (state.noise.stated_mm, np.inf, "the stated noise"),
        (state.noise.repeated_mm, state.noise.repeats, "what repeats of a pose scatter by"),
    ):
        if known and state.fit.noise > TELLING.noise_excess * known and _significant(state, known, 3 * repeats):
            extra = float(np.sqrt(state.fit.noise**2 - known**2))
            return Unexplained(True, None, None, extra, f"{ABOVE_NOISE}{what}, that follows nothing in the table")
    if not state.noise.stated_mm and state.fit.noise > TELLING.coarsest_noise * 1e3 * state.fit.model.arm.reach:
        words = "residual far above the noise of any instrument, that follows nothing in the table"
        return Unexplained(True, None, None, state.fit.noise, words)
    return Unexplained(False)


def noise_in_question(state: DiagnosisState, left: Unexplained) -> list[Notice]:
    """A question about a stated uncertainty that is exceeded by what follows nothing: it may be too small itself.

    Args:
        state: the finished selection.
        left: what is unexplained.

    Returns:
        One notice, or none.
    """
    stated = state.noise.stated_mm
    if not stated or not above_what(left):
        return []
    text = (
        f"What remains ({state.fit.noise:.3g} mm per axis) is above the stated noise ({stated:.3g} mm) and follows "
        "nothing in the table: is the `sigma_mm` of robot.yaml too small, or were positions rounded?"
    )
    return [Notice(NOISE_EXCEEDED, text)]


def rows_apart(state: DiagnosisState) -> Unexplained:
    """Rows that fit nothing, where they are too many to be bad shots: another unit, another frame, another arm."""
    apart = state.fit.weights.robust_weight < WEIGHTS.inlier_weight
    if np.mean(apart) < TELLING.most_bad_shots:
        return Unexplained(False)
    size = float(np.sqrt(np.mean(state.fit.residuals[apart] ** 2)))
    runs = np.unique(state.recordings.run[apart])
    whole = [str(run) for run in runs if run and np.mean(apart[state.recordings.run == run]) > TELLING.run_apart]
    words = f"{np.count_nonzero(apart)} of {len(apart)} rows fit neither the nominal arm nor any effect"
    return Unexplained(True, None, None, size, words + (f": most of run {', '.join(whole)}" if whole else ""))


def too_faint(found: Detection) -> Unexplained:
    """Something that is there although no single name is sure."""
    if not found.detected:
        return Unexplained(False)
    names = ", ".join(f"{candidate.kind.replace('_', ' ')} at {candidate.location}" for candidate in found.likeliest)
    words = f"something is missing, but it is too faint for a name; likeliest: {names}"
    joint = found.region is not None and found.region.isdigit()
    return Unexplained(True, f"joint {found.region}" if joint else found.region, None, found.size_mm, words)


def _significant(state: DiagnosisState, known_mm: float, numbers: float) -> bool:
    """Whether the residual's excess over a noise is beyond chance (five standard errors of a ratio of RMS).

    Args:
        state: the finished selection.
        known_mm: the noise, per axis.
        numbers: by which it is known; infinite where it was stated.
    """
    freedom = max(state.fit.equations.n - state.fit.effective_dof, 1.0)
    return bool(state.fit.noise > known_mm * (1 + 5 * np.sqrt(1 / (2 * freedom) + 1 / (2 * numbers))))
