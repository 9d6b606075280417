"""The verdict: what the selected hypothesis means, in words and numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Progress
from armscope.diagnosis.held_out import cross_validate
from armscope.diagnosis.linearised_rows import LinearisedRows
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.alternatives import alternatives, inclusion_frequency, judged_elsewhere
from armscope.diagnosis.summary.another_payload import beside_another_payload
from armscope.diagnosis.summary.causes import causes
from armscope.diagnosis.summary.constants import TELLING
from armscope.diagnosis.summary.effects import (
    SummaryBasis,
    as_far_as_it_carries,
    summarise_effect,
    with_weight,
)
from armscope.diagnosis.summary.homogeneity import subset_consistency
from armscope.diagnosis.summary.laws_of_one_joint import doubts_of_laws
from armscope.diagnosis.summary.leaning_gravity import told_by_gravity
from armscope.diagnosis.summary.mislabelled import told_of_labels
from armscope.diagnosis.summary.next_poses import next_poses
from armscope.diagnosis.summary.other_backgrounds import doubts
from armscope.diagnosis.summary.parameters import beyond_plausible, tool_as_stated
from armscope.diagnosis.summary.rounded_angles import rounding_mm, told_of_rounding
from armscope.diagnosis.summary.rows import rows_left_out, told_of_rows
from armscope.diagnosis.summary.scatter import rest_of_a_curve, scattered_effects, told_as_scatter
from armscope.diagnosis.summary.soft_drives import told_by_drives
from armscope.diagnosis.summary.stated_load import beside_the_stated_load
from armscope.diagnosis.summary.unexplained import (
    background_summaries,
    load_in_question,
    masses_in_error,
    noise_in_question,
    rows_apart,
    together,
    too_faint,
    unexplained_part,
)
from armscope.diagnosis.summary.untold_sides import columns_of_untold, untold_plays
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.discrepancy import model_error
from armscope.fitting.refit import Refit
from armscope.inference.detection import averaged_log_odds
from armscope.inference.normal_equations import NormalEquations, steadied
from armscope.inference.search import Search
from armscope.inference.shapley import shares
from armscope.physics.drift import BASE_SHIFT
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import FoundEffect
from armscope.verdict.importance import with_importance
from armscope.verdict.not_yet import curing_only_what_helps
from armscope.verdict.schema import (
    Answer,
    Background,
    HeldOut,
    Notice,
    Unexplained,
    WaterfallStep,
)

UNTESTED = HeldOut(float("nan"), float("nan"))
"""Where nothing was held out."""


def judge(
    state: DiagnosisState, resamples: int, cross_validation: bool, rng: np.random.Generator, progress: Progress
) -> Diagnosis:
    """Certainty, validation, atlas and words.

    Args:
        state: the finished selection.
        resamples: how often rows are drawn anew; 0 never.
        cross_validation: whether the procedure is validated on held-out rows.
        rng: draws the resamples.
        progress: hears what is being done.

    Returns:
        The verdict.
    """
    fit = state.fit
    progress("weighing alternatives", 0.55)
    basis = _basis(state, resamples, rng)
    variance = basis.equations.least_rss(fit.layout.frames) / max(basis.equations.n, 1.0)
    found, of_families = _summarised(basis)
    untold = untold_plays(state)
    order = [c for c in sorted(found, key=lambda c: -found[c].share) if c not in untold]
    held_out, waterfall = _validated(state, untold, order, progress) if cross_validation else (UNTESTED, ())
    progress("drawing the atlas", 0.9)
    background = background_summaries(state, basis.search, basis.equations, of_families)
    masses, weights_told = masses_in_error(state, basis.equations, of_families[-1])
    named = [with_weight(found[c], background) for c in order]
    background = (*background, *masses)
    left = max(1.0 - sum(effect.share for effect in found.values()) - sum(family.share for family in background), 0.0)
    by_order = [told_as_scatter(found[c], state.fit.model.arm.n_motors) for c in untold]
    scattered = [s for s in scattered_effects(state, variance, left) if not rest_of_a_curve(s, [*named, *by_order])]
    scattered += by_order
    over, candidate = subset_consistency(state), basis.search.candidate
    named = [as_far_as_it_carries(e, candidate(c), over.get(c)) for c, e in zip(order, named, strict=True)]
    effects = tuple(sorted([*named, *scattered], key=lambda effect: -effect.share))
    unexplained = _unexplained(state, basis.search, effects, background)
    left_over = basis.model_error.notices() if found else []
    answer, mismatch = _answer(effects, background, unexplained, bool(left_over))
    tool_mm = rounding_mm(state)
    carefully = [*weights_told, *told_of_rounding(state, tool_mm), *left_over, *rows_left_out(state, held_out)]
    draft = Diagnosis(
        **(of_rows := told_of_rows(state)),
        answer=answer,
        headline="",
        mismatch=mismatch,
        noise_mm=float(np.hypot(fit.noise, tool_mm)),
        noise_source=_noise_source(state, tool_mm > 0),
        residual_before_mm=float(np.sqrt(variance)),
        causes=causes(state, basis.search, dict(zip(order, named, strict=True)), scattered, background),
        effects=effects,
        background=together(background),
        background_families=background,
        unexplained=unexplained,
        held_out=held_out,
        waterfall=waterfall,
        next_poses=next_poses(state, basis.rivals, rng),
        notices=(*state.notices, *_carefully(state, unexplained), *carefully, *told_of_labels(of_rows["suspects"])),
    )
    verdict = with_importance(draft, with_weight)
    verdict = replace(verdict, waterfall=_with_weights(waterfall, named, verdict.effects))
    return curing_only_what_helps(verdict)


def _basis(state: DiagnosisState, resamples: int, rng: np.random.Generator) -> SummaryBasis:
    """What every effect is told from."""
    fit, best, search = state.fit, state.best, Search.on(state.problem)
    rivals = judged_elsewhere(state, alternatives(search, best), rng.spawn(1)[0])
    of_backgrounds, of_laws = doubts(search, best), doubts_of_laws(search, best, rivals)
    return SummaryBasis(
        state,
        search,
        rivals,
        inclusion_frequency(state, resamples, rng),
        fit.model.scene(state.recordings.rows(spread_evenly(len(state.recordings), TELLING.curve_rows))),
        _plain_equations(state),
        model_error(fit, state.recordings, state.noise.least_mm),
        {number: extra + of_backgrounds.get(number, 0.0) for number, extra in of_laws.items()},
        {**told_by_drives(state), **told_by_gravity(state)},
    )


def _summarised(basis: SummaryBasis) -> tuple[dict[int, FoundEffect], list[float]]:
    """Every chosen effect by its candidate, and the shares of the families' backgrounds."""
    fit, chosen = basis.state.fit, basis.state.best.chosen
    shared, of_families = _shares(fit, basis.equations)
    found = {
        c.candidate: summarise_effect(basis, c, part, share)
        for c, part, share in zip(chosen, fit.model.parts, shared, strict=True)
    }
    beside = beside_the_stated_load(basis.state, basis.search, found)
    return beside_another_payload(basis.state, basis.search, beside), of_families


def _validated(
    state: DiagnosisState, untold: Sequence[int], order: Sequence[int], progress: Progress
) -> tuple[HeldOut, tuple[WaterfallStep, ...]]:
    """Errors on held-out rows, and the waterfall in the order of the shares.

    Play of which nobody wrote down the side is fitted beside all else from the first step on, and foretells nothing.
    Where a base is told to have jumped, runs are not held out whole: their bases would be placed anew on their rows,
    and the error without any cure would be one without the jump.
    """
    progress("validating on held-out rows", 0.75)
    jumped = any(part.placed.effect is BASE_SHIFT for part in state.fit.model.parts)
    split = state.split.within_runs() if jumped else state.split
    rows = LinearisedRows(state.point, state.table, state.fit.weights, state.space.layout, columns_of_untold(state))
    told, (nothing, *steps) = cross_validate(state.problem, state.blocks, split, state.best, [*untold, *order], rows)
    return told, (nothing, *steps[len(untold) :])


def _noise_source(state: DiagnosisState, with_rounding: bool) -> str:
    grows = "; it grows with the distance" if state.growth else ""
    return state.noise.source + grows + ("; rounded angles are part of it" if with_rounding else "")


def _unexplained(
    state: DiagnosisState, search: Search, effects: Sequence[FoundEffect], background: Sequence[Background]
) -> Unexplained:
    """Structure without a name: beside the effects, in rows that stand apart, or too faint to be named."""
    unexplained = unexplained_part(effects, state)
    if not unexplained.present:
        unexplained = rows_apart(state)
    if effects or unexplained.present or any(family.present for family in background):
        return unexplained
    return too_faint(averaged_log_odds(search))


def _with_weights(
    waterfall: Sequence[WaterfallStep], order: Sequence[FoundEffect], told: Sequence[FoundEffect]
) -> tuple[WaterfallStep, ...]:
    """The steps, which start with no effect and add one each, in this order, with those of minor effects told."""
    weight = {(e.effect, e.location, e.driver, e.evidence_nats): e.minor for e in told}
    minor = [False, *(weight[e.effect, e.location, e.driver, e.evidence_nats] for e in order)]
    return tuple(replace(step, minor=n < len(minor) and minor[n]) for n, step in enumerate(waterfall))


def _plain_equations(state: DiagnosisState) -> NormalEquations:
    """The fit's sums over the points as they were measured: without whitening and orientations."""
    fit = state.fit
    if fit.weights.is_plain:
        return steadied(fit.equations, fit.layout.frames)
    one_block = np.zeros(len(state.recordings), dtype=np.intp)
    (plain,) = normal_equations_by_block(
        fit.layout, fit.model, state.table, fit.weights.of_reference.unwhitened, one_block
    )
    return steadied(plain, fit.layout.frames)


def _shares(fit: Refit, equations: NormalEquations) -> tuple[list[float], list[float]]:
    """Share of the variance after the frames of every effect, and of every family's background.

    Free curves come last in every order: they count for what nothing else explains. Behind them stand stated masses,
    whose errors do nothing but through what gives way.
    """
    members = [fit.layout.of(part.placed) for part in fit.model.parts]
    *backgrounds, loads = fit.layout.background
    families = [columns for columns in backgrounds if len(columns)]
    curves = {n for n, part in enumerate(fit.model.parts) if part.placed.parametrisation == "curve"}
    ridge, frames = fit.noise**2 * fit.precision, fit.layout.frames
    told = shares(equations, ridge, frames, [*members, *families], last=curves)
    before = np.concatenate([frames, *members, *families])
    of_loads = (1 - told.sum()) * shares(equations, ridge, before, [loads])[0] if len(loads) else 0.0
    each = iter(told.tolist())
    of_members = [next(each) for _ in members]
    return of_members, [*(next(each) if len(columns) else 0.0 for columns in backgrounds), float(of_loads)]


def _answer(
    effects: Sequence[FoundEffect], background: Sequence[Background], unexplained: Unexplained, left_over: bool
) -> tuple[Answer, bool | None]:
    if effects or any(family.present for family in background):
        return ("partly explained" if unexplained.present or left_over else "explained"), True
    if unexplained.present:
        return "cannot tell", True
    return "nothing missing", False


def _carefully(state: DiagnosisState, unexplained: Unexplained) -> list[Notice]:
    """What the fit itself says against too much trust."""
    implausible = beyond_plausible(state.fit.model.parts)
    notices = [*([implausible] if implausible else []), *noise_in_question(state, unexplained)]
    notices += tool_as_stated(state.fit.model)
    if state.growth is not None:
        away = np.linalg.norm(state.recordings.positions, axis=1)
        near, far = (f"{float(state.growth.at(d)):.2g} mm at {d:.1f} m" for d in (away.min(), away.max()))
        text = (
            f"The noise per axis grows with the distance from the instrument, from {near} to {far} "
            f"({state.growth.slope_mm_per_m:.2g} mm per metre): farther rows count less."
        )
        notices.append(Notice("noise by distance", text))
    notices += load_in_question(state)
    stated, fitted = state.noise.stated_mm, state.fit.noise
    if stated and fitted < TELLING.noise_shortfall * stated:
        text = f"The residual ({fitted:.3g} mm) is well below the stated noise ({stated:.3g} mm): is that number right?"
        notices.append(Notice("stated noise", text))
    return notices
