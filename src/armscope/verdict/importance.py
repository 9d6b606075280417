"""How much each cause matters: the one measure by which headline, lists, pictures and work order are in order.

What a cause is worth is how much of the squared error goes when it is cured as it was found, averaged over the orders
in which everything can be cured (Shapley 1953). With each cause's contribution at the tool known (`contributions`) this
needs no orders: the error before is their sum with what is left, and a cause's share is the product of its contribution
with the error before and with what is left, over the squared error. The shares add up to what the model explains. One
below zero hides part of what others do: its cure pays only once theirs are done.

What is told as major is worth its place by that measure or, where it hides what others do, by its own squared size: it
is off by as much, though its cure waits for theirs. So is what makes up much of what a calibration of the geometry
leaves (`calibrated`), however little that is beside the geometry. What base and tool take up whenever they are placed
anew (an arm that was set up anew between runs) has no share to lose; a base that jumped while it was one has its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.physics.backgrounds import GEOMETRIC
from armscope.verdict.calibrated import mended_by_calibration, once_calibrated, share_beside_its_like, stands_out
from armscope.verdict.constants import REPAIRS, WORDS
from armscope.verdict.contributions import Contributions, ground_of, parts_of
from armscope.verdict.diagnosis import Diagnosis, promised
from armscope.verdict.effects import Cause, FoundEffect
from armscope.verdict.family_cures import cure_of_family, growth_in_words
from armscope.verdict.schema import Background, Verdict
from armscope.verdict.sentences import cause_in_words, headline

Weigh = Callable[[FoundEffect, Sequence[Background]], FoundEffect]
"""An effect and the small errors everywhere, with their shares: the effect, minor where it is one of them."""


def as_it_is(found: FoundEffect, background: Sequence[Background]) -> FoundEffect:
    """An effect whose share makes it neither major nor minor."""
    return found


def with_importance(draft: Diagnosis, weigh: Weigh = as_it_is) -> Diagnosis:
    """A diagnosis whose effects, small errors and causes have shares, stand in their order, and are told in words.

    Returns:
        The same with `share` everywhere, the largest first, `minor` where an effect is not worth its place, and the
        headline.
    """
    ground, parts = ground_of(draft), parts_of(draft)
    _, before = ground.left_and_before()
    squared = float(np.sum(before**2))
    if not squared:
        return replace(draft, headline=headline(draft))

    moved = [ground.moved_by(parts[id(effect)]) for effect in draft.effects]
    left, small = ground.left_and_small(sum(moved, np.zeros_like(before)))

    def share(moved: Array) -> float:
        return float(np.sum(moved * (before + left))) / squared

    calibrated = once_calibrated(ground, left, zip(draft.effects, moved, strict=True), small)
    families = tuple(
        replace(each, share=share(small[each.family]) if each.family in small else 0.0)
        for each in draft.background_families
    )

    def placed(effect: FoundEffect, its: Array) -> FoundEffect:
        of_rest = calibrated.share(its) if calibrated and not mended_by_calibration(effect) else math.nan
        told = replace(effect, share=share(its), share_after_calibration=of_rest)
        if stands_out(told) and not (told.rarely_chosen or told.size_open):
            return replace(told, minor=False)
        if effect.minor or rms(its) < REPAIRS.switch_seen * rms(before):
            return told
        worth = max(told.share, float(np.sum(its**2)) / squared)
        return replace(told, minor=weigh(replace(told, share=worth), families).minor)

    named = [placed(effect, its) for effect, its in zip(draft.effects, moved, strict=True) if parts[id(effect)]]
    modelled = sum(effect.share for effect in named) + sum(family.share for family in families)
    left_over = max(1 - modelled, 0.0)
    # what scatters is in no model: it has no more than nothing else explains, less the noise
    left_over = max(left_over - draft.noise_mm**2 / rms(before) ** 2, 0.0)
    scattered = [replace(e, share=min(e.share, left_over)) for e in draft.effects if not parts[id(e)]]
    if calibrated:
        scattered = [replace(e, share_after_calibration=calibrated.of_scatter(e.share)) for e in scattered]
    present = sum(each.share for each in families if each.present)
    told = replace(
        draft,
        effects=tuple(sorted([*named, *scattered], key=lambda effect: -effect.share)),
        background=replace(draft.background, share=present),
        background_families=families,
    )
    rest = {f: calibrated.share(its) for f, its in small.items() if f != GEOMETRIC} if calibrated else {}
    told = replace(told, causes=_causes(told, rest))
    return replace(told, headline=headline(told))


def _causes(verdict: Diagnosis, of_rest: Mapping[str, float]) -> tuple[Cause, ...]:
    """The causes with their members in order, the largest share first; of_rest: of small errors, after calibration."""
    small = {each.family: each for each in verdict.background_families}
    growth = growth_in_words(verdict.model.background)
    causes = [
        _retold(cause, verdict.effects, small.get(cause.family), of_rest.get(cause.family, math.nan), growth)
        for cause in verdict.causes
    ]
    return tuple(sorted(causes, key=lambda cause: -cause.share))


def _retold(
    cause: Cause, effects: Sequence[FoundEffect], small: Background | None, of_rest: float, growth: str
) -> Cause:
    members = [effect for effect in effects if effect.as_member in cause.members]
    members.sort(key=lambda effect: -share_beside_its_like(effect))
    everywhere = small if cause.everywhere else None
    sure = any(not (effect.size_open or effect.rarely_chosen) for effect in members) or everywhere is not None
    after = sum(e.share_after_calibration for e in members) + (of_rest if everywhere else 0.0) if sure else math.nan
    as_left = [replace(effect, share=share_beside_its_like(effect)) for effect in members]
    beside = replace(everywhere, share=of_rest) if everywhere and math.isfinite(after) else everywhere
    return replace(
        cause,
        members=tuple(effect.as_member for effect in members),
        minor=all(effect.minor for effect in members) and not cause.everywhere,
        share=sum(effect.share for effect in members) + (everywhere.share if everywhere else 0.0),
        share_after_calibration=after,
        text=cause_in_words(cause.family, as_left, beside),
        cure=cure_of_family(cause.family, members, cause.everywhere, everywhere.worst if everywhere else "", growth),
    )


def minor_and_told(causes: Sequence[Cause]) -> list[Cause]:
    """Causes that a headline tells though each member by itself is minor: curves at several joints, say."""
    together = [cause for cause in causes if cause.minor and cause.members]
    return [cause for cause in together if cause.share > WORDS.told_first or stands_out(cause)]


def expected(verdict: Diagnosis, worth: Contributions, mm: float) -> float:
    """What RMS to expect on poses that took no part, where one on the recorded rows is known.

    A fit is a little better on its own rows. Both ends are known, the nominal arm's and the whole model's, from
    cross-validation; between them squared errors are taken to go straight. Where many rows fit nothing, both are those
    of all rows: an order that told the others' error promised 0.08 mm of play, and 0.4 mm were got.

    Args:
        verdict: the diagnosis.
        worth: its contributions.
        mm: RMS per axis on the recorded rows.

    Returns:
        RMS per axis, mm; the same where nothing was held out.
    """
    fitted = rms(worth.before) ** 2, rms(worth.left) ** 2
    promise = promised(verdict)
    held = promise.before**2, promise.after**2
    if not (np.isfinite(held).all() and fitted[0] > fitted[1] and (held[0] > held[1] or promise.of_all)):
        return mm
    slope = (held[0] - held[1]) / (fitted[0] - fitted[1])
    return float(np.sqrt(max(held[1] + slope * (mm**2 - fitted[1]), 0.0)))


def from_part_to_part(verdict: Verdict) -> str:
    """How far what is expected on other poses may be off, as a standard deviation: "± 24 %"; "" without held-out rows.

    The level of the error itself depends on the poses: on an IRB 120, 18 of whose poses were fitted, a single zero set
    as worded left 0.74 to 1.53 times what was promised on the other 18, and with nothing cured it was 0.77 to 1.50.
    """
    uncured = next(iter(verdict.waterfall), None)
    if uncured is None or not (uncured.spread_mm > 0 and uncured.held_out_mm > 0):
        return ""
    return f"± {100 * uncured.spread_mm / uncured.held_out_mm:.2g} %"
