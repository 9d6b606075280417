"""The verdict: what the selected hypothesis means, in words and numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.diagnosis import certainty
from armscope.diagnosis.atlas import atlas
from armscope.diagnosis.carry import carry_over
from armscope.diagnosis.curves import curve_of
from armscope.diagnosis.evidence import Chosen, Hypothesis, Problem, background_sizes
from armscope.diagnosis.headline import headline
from armscope.diagnosis.naming import worth
from armscope.diagnosis.nextposes import next_poses
from armscope.diagnosis.noise import Growth, Noise
from armscope.diagnosis.parameters import parameters
from armscope.diagnosis.presence import Presence, presence
from armscope.diagnosis.problem import Gram, accumulate, contribution
from armscope.diagnosis.refit import Refit
from armscope.diagnosis.scan import when_stderr
from armscope.diagnosis.scatter import Scattered, levers
from armscope.diagnosis.search import Search
from armscope.diagnosis.shares import shares
from armscope.diagnosis.validation import Blocks, Rows, cross_validate
from armscope.diagnosis.verdict import (
    Answer,
    Background,
    FoundEffect,
    HeldOut,
    Notice,
    Parameter,
    Residuals,
    SuspectRow,
    Unexplained,
    Verdict,
    WaterfallStep,
)
from armscope.physics.backgrounds import FAMILIES
from armscope.physics.effect import Placed
from armscope.physics.freeform import held
from armscope.physics.model import FittedModel
from armscope.physics.scene import Part, Scene
from armscope.recordings import Recordings

Array = NDArray[np.float64]
Progress = Callable[[str, float], None]

MINOR_SHARE, MINOR_SHARE_OF_PERFECT_ARM = 0.025, 0.001
"""Effects worth less of the residual variance are apart from the story: in an arm with small errors everywhere, and in
one that is perfect but for what is named."""
NOISE_EXCESS = 1.15
"""A residual this many times the stated noise is more than the noise."""
BACKGROUND_SEEN_NATS = 5.0
SUSPECT_WEIGHT = 0.5
REST_OF_A_CURVE = 2.0
NOTHING = "nothing in the table"
"""What scatter follows."""
LISTED_SUSPECTS = 200


@dataclass(frozen=True, eq=False)
class Evidence:
    """Everything that the rounds of selection leave behind.

    ``point`` is where ``blocks`` were linearised; ``best`` is ``found`` with names.
    """

    start: FittedModel
    recordings: Recordings
    first: Array
    noise: Noise
    notices: tuple[Notice, ...]
    layout: Blocks
    problem: Problem
    blocks: list[Gram]
    point: FittedModel
    found: Hypothesis
    best: Hypothesis
    fit: Refit
    scatter: tuple[Scattered, ...]
    growth: Growth | None


def judge(
    evidence: Evidence, resamples: int, cross_validation: bool, rng: np.random.Generator, tell: Progress
) -> Verdict:
    """Certainty, validation, atlas and words."""
    fit, best, problem = evidence.fit, evidence.best, evidence.problem
    search = Search.on(problem)
    tell("weighing alternatives", 0.55)
    rivals = {c.candidate: certainty.alternatives(search, best, c.candidate) for c in best.chosen}
    often = certainty.inclusion(problem, evidence.blocks, best, evidence.found, resamples, rng) if resamples else {}
    scene = fit.model.scene(evidence.recordings)
    gram = _plain_gram(evidence)
    variance = _variance_after_frames(gram, fit.pool.frames)
    shared, of_families = _shares(fit, gram)
    found = {
        c.candidate: _found(evidence, search, c, part, rivals[c.candidate], often, scene, gram, share)
        for c, part, share in zip(best.chosen, fit.model.parts, shared, strict=True)
    }
    order = sorted(found, key=lambda c: -found[c].rms_at_tool_mm)
    held_out = HeldOut(float("nan"), float("nan"))
    waterfall: tuple[WaterfallStep, ...] = ()
    if cross_validation:
        tell("validating on held-out rows", 0.75)
        rows = Rows(evidence.point, evidence.recordings, fit.weights)
        held_out, waterfall = cross_validate(problem, evidence.blocks, evidence.layout, best, order, rows)
    tell("drawing the atlas", 0.9)
    background = _backgrounds(evidence, search, gram, of_families)
    named = [_with_weight(found[c], background) for c in order]
    scattered = [s for s in _scattered(evidence, variance) if not _rest_of_a_curve(s, named)]
    over = carry_over(problem, evidence.blocks, evidence.layout, best, evidence.point, evidence.recordings, fit.weights)
    named = [replace(e, carries_over=over.get(c, "")) for c, e in zip(order, named, strict=True)]
    effects = tuple(sorted([*named, *scattered], key=lambda effect: -effect.rms_at_tool_mm))
    named_or_spread = bool(effects) or any(family.present for family in background)
    unexplained = _unexplained(effects, evidence)
    if not named_or_spread and not unexplained.present:
        unexplained = _too_faint(presence(search))
    answer, mismatch = _answer(effects, background, unexplained, evidence)
    separating = next_poses(search, best, rivals, fit, evidence.recordings, rng)
    draft = Verdict(
        arm=fit.model.arm.name,
        source=evidence.recordings.source,
        rows=len(evidence.recordings),
        runs=tuple(str(run) for run in np.unique(evidence.recordings.run)),
        answer=answer,
        headline="",
        mismatch=mismatch,
        noise_mm=fit.noise,
        noise_source=evidence.noise.source + ("; it grows with the distance" if evidence.growth else ""),
        residual_before_mm=float(np.sqrt(variance)),
        residual_after_mm=_weighted_rms(fit),
        effects=effects,
        background=_together(background),
        background_families=background,
        unexplained=unexplained,
        held_out=held_out,
        waterfall=waterfall,
        atlas=atlas(fit.pool, fit.model, evidence.recordings, fit.weights),
        residuals=_residuals(evidence),
        suspects=_suspects(evidence),
        next_poses=separating,
        notices=(*evidence.notices, *_carefully(evidence)),
        model=_held(fit.model, evidence.recordings),
    )
    return replace(draft, headline=headline(draft))


def _held(model: FittedModel, recordings: Recordings) -> FittedModel:
    """The model to predict with: its free curves go no farther than they were learned."""
    return replace(model, parts=tuple(replace(p, placed=held(p.placed, recordings)) for p in model.parts))


def _plain_gram(evidence: Evidence) -> Gram:
    """The fit's sums without the whitening of scatter."""
    fit = evidence.fit
    if fit.weights.turn is None:
        return fit.gram
    one_block = np.zeros(len(evidence.recordings), dtype=np.intp)
    return accumulate(fit.pool, fit.model, evidence.recordings, replace(fit.weights, turn=None), one_block)[0]


def _found(
    evidence: Evidence,
    search: Search,
    chosen: Chosen,
    part: Part,
    rivals: Sequence[tuple[float, Placed, Hypothesis]],
    often: dict[int, float],
    scene: Scene,
    gram: Gram,
    share: float,
) -> FoundEffect:
    """One effect with everything that is known about it."""
    fit, placed = evidence.fit, part.placed
    covariance = fit.covariance_of(placed)
    coefficients = np.zeros(len(fit.pool.terms))
    coefficients[fit.pool.of(placed)] = _sized(evidence, chosen, part.values, covariance)
    rms = contribution(gram, fit.pool.frames, coefficients)
    apart = [certainty.apart(evidence.best, other, placed, rival) for _, rival, other in rivals]
    close = [rival for nats, (_, rival, _) in zip(apart, rivals, strict=True) if nats < certainty.TELLS_APART_NATS]
    named_as, title = certainty.name(placed, close)
    return FoundEffect(
        effect=placed.name,
        location=placed.location,
        family=placed.family,
        driver=placed.driver,
        named_as=named_as,
        title=title,
        minor=False,
        parameters=_with_moment(evidence, search, chosen, placed, parameters(placed, part.values, covariance)),
        rms_at_tool_mm=rms,
        share=share,
        evidence_nats=float(_worth(evidence, search, chosen)),
        alternatives=certainty.listed(rivals),
        inclusion=often.get(chosen.candidate),
        curve=curve_of(placed, part.values, covariance, scene),
        physics=placed.effect.physics,
        confirm=placed.effect.confirm,
        cure=placed.effect.cure,
    )


def _sized(evidence: Evidence, chosen: Chosen, values: Array, covariance: Array) -> Array:
    """An effect's values for its size at the tool: what its rows leave open counts as its prior has it.

    The refit holds named values by a prior so wide that it does not pull; two of them that only show together (offsets
    along parallel axes) are then told with their wide intervals, but could stand for any size at the tool.
    """
    problem = evidence.problem
    placed = problem.pool.candidates[chosen.candidate]
    if placed.reading == "curve":
        return values  # its prior is that already
    scale = problem.sizes[chosen.size] * np.array(placed.shape) / problem.scale[problem.pool.columns[chosen.candidate]]
    # the posterior with this prior in place of a flat one
    scaled = covariance / np.outer(scale, scale)
    return np.asarray(scale * (np.linalg.solve(np.eye(len(scale)) + scaled, values / scale)))


def _rest_of_a_curve(scatter: FoundEffect, named: Sequence[FoundEffect]) -> bool:
    """Whether scatter is what a free curve at the same joint could not follow."""
    return any(
        effect.effect == "unknown"
        and effect.location == scatter.location
        and effect.rms_at_tool_mm > REST_OF_A_CURVE * scatter.rms_at_tool_mm
        for effect in named
    )


def _with_moment(
    evidence: Evidence, search: Search, chosen: Chosen, placed: Placed, told: tuple[Parameter, ...]
) -> tuple[Parameter, ...]:
    """Parameters with the standard error of a jump's moment."""
    if placed.family != "drift" or not placed.scanned:
        return told
    without = search.without(evidence.best, [chosen.candidate])
    stderr = when_stderr(placed, evidence.problem, without, evidence.point, evidence.recordings, evidence.fit.weights)
    return (*told[:-1], replace(told[-1], stderr=stderr))


def _worth(evidence: Evidence, search: Search, chosen: Chosen) -> float:
    """Evidence for a name, nats."""
    if chosen.within:
        return worth(evidence.problem, evidence.best, chosen)
    return search.worth(evidence.best, chosen.candidate)


def _scattered(evidence: Evidence, variance: float) -> Iterator[FoundEffect]:
    """Scatter that has a place but follows nothing in the table."""
    moved = levers(evidence.fit.model, evidence.recordings)
    for scattered in evidence.scatter:
        rms = scattered.size * float(np.sqrt(np.mean(moved[scattered.motor - 1] ** 2)))
        location = f"joint {scattered.motor}"
        yield FoundEffect(
            effect="unknown",
            location=location,
            family="unknown",
            driver=NOTHING,
            named_as="effect",
            title=f"scatter at {location} that follows nothing in the table",
            minor=False,
            parameters=(Parameter("scatter", "rad", scattered.size, scattered.size / np.sqrt(2 * len(moved[0]))),),
            rms_at_tool_mm=rms,
            share=min(rms**2 / variance, 1.0) if variance > 0 else 0.0,
            evidence_nats=scattered.evidence,
            alternatives=(),
            inclusion=None,
            curve=None,
            physics="The joint stands a little elsewhere each time, for a reason that the table does not record.",
            confirm="Record the side of approach, speed, load and temperature, and repeat one pose many times.",
            cure="Find what the scatter follows (play, a loose coupling or encoder) before compensating anything.",
        )


def _with_weight(found: FoundEffect, background: Sequence[Background]) -> FoundEffect:
    """Minor or not: in an arm with small errors everywhere, a small effect is one of them."""
    ordinary = any(family.present for family in background)
    small = found.share < (MINOR_SHARE if ordinary else MINOR_SHARE_OF_PERFECT_ARM)
    return replace(found, minor=small)


def _variance_after_frames(gram: Gram, frames: NDArray[np.intp]) -> float:
    """Residual variance per axis after the free frames only, mm^2."""
    G = gram.G[np.ix_(frames, frames)]
    explained = gram.b[frames] @ np.linalg.lstsq(G, gram.b[frames], rcond=1e-12)[0]
    left = float(gram.yy - explained)
    return max(left, 0.0) / max(gram.n, 1.0)


def _weighted_rms(fit: Refit) -> float:
    trusted = fit.weights.trust > SUSPECT_WEIGHT
    return float(np.sqrt(np.mean(fit.residuals[trusted] ** 2)))


def _shares(fit: Refit, gram: Gram) -> tuple[list[float], list[float]]:
    """Share of the variance after the frames of every effect, and of every family's background."""
    members = [fit.pool.of(part.placed) for part in fit.model.parts]
    families = [columns for columns in fit.pool.background if len(columns)]
    told = iter(shares(gram, fit.noise**2 * fit.precision, fit.pool.frames, [*members, *families]).tolist())
    return [next(told) for _ in members], [next(told) if len(columns) else 0.0 for columns in fit.pool.background]


def _backgrounds(
    evidence: Evidence, search: Search, gram: Gram, of_families: Sequence[float]
) -> tuple[Background, ...]:
    """What each family's background amounts to, and whether the evidence asks for it."""
    fit, best = evidence.fit, evidence.best
    sizes = background_sizes(evidence.problem, best)
    values = {t: v for part in fit.model.background for t, v in zip(part.placed.terms, part.values, strict=True)}
    told = []
    for number, (family, columns) in enumerate(zip(FAMILIES, fit.pool.background, strict=True)):
        coefficients = np.zeros(len(fit.pool.terms))
        coefficients[columns] = [values[fit.pool.terms[column]] for column in columns]
        rms = contribution(gram, fit.pool.frames, coefficients)
        without = search.resized(best, (*best.background[:number], 0, *best.background[number + 1 :]))
        present = best.background[number] > 0 and best.value - without.value > BACKGROUND_SEEN_NATS
        told.append(Background(family, present, sizes[number], rms, of_families[number]))
    return tuple(told)


def _together(families: Sequence[Background]) -> Background:
    """All families' backgrounds as one."""
    present = [family for family in families if family.present]
    rms = float(np.sqrt(sum(family.rms_at_tool_mm**2 for family in present)))
    return Background("all", bool(present), float("nan"), rms, sum(family.share for family in present))


def _unexplained(effects: Sequence[FoundEffect], evidence: Evidence) -> Unexplained:
    """The largest free curve; or noise far above what was stated."""
    curves = [effect for effect in effects if effect.effect == "unknown"]
    if curves:
        largest = curves[0]
        words = largest.curve.description if largest.curve else largest.title
        return Unexplained(True, largest.location, largest.driver, largest.rms_at_tool_mm, words)
    stated = evidence.noise.stated_mm
    if stated and evidence.fit.noise > NOISE_EXCESS * stated and _significant(evidence):
        extra = float(np.sqrt(evidence.fit.noise**2 - stated**2))
        return Unexplained(True, None, None, extra, "residual above the stated noise that follows nothing in the table")
    return Unexplained(False)


def _too_faint(found: Presence) -> Unexplained:
    """Something that is there although no single name is sure."""
    if not found.something:
        return Unexplained(False)
    names = ", ".join(f"{placed.name.replace('_', ' ')} at {placed.location}" for placed in found.likeliest)
    words = f"something is missing, but it is too faint for a name; likeliest: {names}"
    return Unexplained(True, found.location, None, found.size_mm, words)


def _significant(evidence: Evidence) -> bool:
    """Whether the residual's excess over the stated noise is beyond chance (five standard errors of an RMS)."""
    freedom = max(evidence.fit.gram.n - evidence.fit.spent, 1.0)
    return evidence.fit.noise > evidence.noise.stated_mm * (1 + 5 / np.sqrt(2 * freedom))


def _answer(
    effects: Sequence[FoundEffect], background: Sequence[Background], unexplained: Unexplained, evidence: Evidence
) -> tuple[Answer, bool | None]:
    if effects or any(family.present for family in background):
        return ("partly explained" if unexplained.present else "explained"), True
    if unexplained.present:
        return "cannot tell", True
    return "nothing missing", False


def _residuals(evidence: Evidence) -> Residuals:
    table, fit = evidence.recordings, evidence.fit
    return Residuals(
        points=fit.model.to_base(table.positions, table.run) * 1e3,
        before=evidence.first,
        after=fit.residuals,
        weight=fit.weights.trust,
        id=table.id,
        run=table.run,
    )


def _suspects(evidence: Evidence) -> tuple[SuspectRow, ...]:
    fit, table = evidence.fit, evidence.recordings
    relative = fit.weights.trust
    rows = np.flatnonzero(relative < SUSPECT_WEIGHT)
    size = np.linalg.norm(fit.residuals, axis=1)
    worst = rows[np.argsort(-size[rows])][:LISTED_SUSPECTS]
    return tuple(SuspectRow(str(table.id[r]), str(table.run[r]), float(size[r]), float(relative[r])) for r in worst)


def _carefully(evidence: Evidence) -> list[Notice]:
    """What the fit itself says against too much trust."""
    notices = []
    if evidence.growth is not None:
        away = np.linalg.norm(evidence.recordings.positions, axis=1)
        near, far = (f"{float(evidence.growth.at(d)):.2g} mm at {d:.1f} m" for d in (away.min(), away.max()))
        text = (
            f"The noise per axis grows with the distance from the instrument, from {near} to {far} "
            f"({evidence.growth.slope_mm_per_m:.2g} mm per metre): farther rows count less."
        )
        notices.append(Notice("noise by distance", text))
    stated, fitted = evidence.noise.stated_mm, evidence.fit.noise
    if stated and fitted < 0.75 * stated:
        text = f"The residual ({fitted:.3g} mm) is well below the stated noise ({stated:.3g} mm): is that number right?"
        notices.append(Notice("stated noise", text))
    return notices


def undecided(
    start: FittedModel,
    recordings: Recordings,
    residuals: Array,
    noise: Noise,
    notices: tuple[Notice, ...],
    seconds: float,
) -> Verdict:
    """The verdict where no effect can honestly be named."""
    rms = float(np.sqrt(np.mean(residuals**2)))
    points = start.to_base(recordings.positions, recordings.run) * 1e3
    count = len(recordings)
    return Verdict(
        arm=start.arm.name,
        source=recordings.source,
        rows=count,
        runs=tuple(str(run) for run in np.unique(recordings.run)),
        answer="cannot tell",
        headline="It cannot be told: " + notices[-1].text,
        mismatch=None,
        noise_mm=noise.stated_mm or float("nan"),
        noise_source=noise.source,
        residual_before_mm=rms,
        residual_after_mm=rms,
        effects=(),
        background=_together(()),
        background_families=(),
        unexplained=Unexplained(False),
        held_out=HeldOut(float("nan"), float("nan")),
        waterfall=(),
        atlas=None,
        residuals=Residuals(points, residuals, residuals, np.ones(count), recordings.id, recordings.run),
        suspects=(),
        next_poses=None,
        notices=notices,
        model=start,
        seconds=seconds,
    )
