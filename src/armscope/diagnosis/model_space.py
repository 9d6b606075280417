"""The library as the inference sees it: effects as sets of columns, and what excludes, requires or contains what.

All that is known of physics when names compete is decided here, once.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.diagnosis.constants import BACKGROUNDS
from armscope.fitting.parameter_layout import ParameterLayout, parameter_layout
from armscope.inference.model_space import (
    BackgroundFamily,
    Candidate,
    Companion,
    Exchange,
    ModelSpace,
    ToleranceFamily,
)
from armscope.physics.backgrounds import (
    DRIFT,
    ELASTIC,
    FAMILIES,
    GEOMETRIC,
    MASSES,
    ORIENTATION,
    SOFT,
    STRUCTURE,
    THERMAL,
    TRANSMISSION,
    UNEVEN,
)
from armscope.physics.drift import BASE_DRIFT
from armscope.physics.effect import Placed, clash, region
from armscope.physics.elastic import JOINT_COMPLIANCE, LINK_BENDING, UNKNOWN_MASSES
from armscope.physics.freeform import OF_LOAD, follows_own_angle, spans_half_a_turn
from armscope.physics.geometric import JOINT_OFFSET
from armscope.physics.least_load import at_least_load
from armscope.physics.soft_start import SOFT_START
from armscope.physics.tilting import BASE_COMPLIANCE
from armscope.physics.transmission import BACKLASH, GEAR_ECCENTRICITY

SHARES = {
    GEOMETRIC: BACKGROUNDS.tolerance_shares,
    ELASTIC: BACKGROUNDS.elastic_shares,
    TRANSMISSION: BACKGROUNDS.gear_shares,
    DRIFT: BACKGROUNDS.wander_shares,
    SOFT: BACKGROUNDS.elastic_shares,
    ORIENTATION: BACKGROUNDS.wander_shares,
    THERMAL: BACKGROUNDS.wander_shares,
    STRUCTURE: BACKGROUNDS.structure_shares,
    UNEVEN: BACKGROUNDS.structure_shares,
}
"""Sizes that the background of a family may have, against its tolerances."""


@dataclass(frozen=True, eq=False, kw_only=True)
class EffectSpace(ModelSpace):
    """A model space of which it is known what the candidates are."""

    placed: tuple[Placed, ...]  # the effect behind each candidate
    layout: ParameterLayout  # the terms behind the columns


def build_model_space(
    frames: Sequence[Placed],
    backgrounds: Sequence[Sequence[Placed]],
    placed: Sequence[Placed],
    loads: Sequence[Placed] = (),
) -> EffectSpace:
    """What may take part in a diagnosis.

    Args:
        frames: always free.
        backgrounds: of each family, in the order of `armscope.physics.backgrounds.FAMILIES`.
        placed: effects that compete.
        loads: errors of stated masses, in wherever something gives way under them.

    Returns:
        The columns, priors and requirements, and which effect each candidate is.
    """
    layout = parameter_layout(frames, [*backgrounds, loads], placed)
    return EffectSpace(
        frames=layout.frames,
        families=_families(layout),
        companions=(_masses(layout, backgrounds, placed, loads),),
        candidates=_candidates(layout, placed, backgrounds),
        starts=_starts(layout),
        exchanges=_trusting_stated_masses(placed),
        placed=tuple(placed),
        layout=layout,
    )


def _families(layout: ParameterLayout) -> tuple[BackgroundFamily, ...]:
    """Every family is measured against its tolerances; geometric errors are free, since every arm has them."""
    shares = [SHARES[family] for family in FAMILIES]
    families = zip(FAMILIES, layout.background[:-1], layout.background_scale[:-1], shares, strict=True)
    return tuple(
        ToleranceFamily(*family, is_priced=family[0] != GEOMETRIC, takes_one=family[0] == DRIFT) for family in families
    )


def _starts(layout: ParameterLayout) -> tuple[tuple[int, ...], ...]:
    """From which searches start; a family without members is in none of them, and pays nothing."""
    there = [bool(len(columns)) for columns in layout.background[:-1]]
    starts = (tuple(size * known for size, known in zip(s, there, strict=True)) for s in BACKGROUNDS.starts)
    return tuple(dict.fromkeys(starts))


def _masses(
    layout: ParameterLayout,
    backgrounds: Sequence[Sequence[Placed]],
    placed: Sequence[Placed],
    loads: Sequence[Placed],
) -> Companion:
    """Errors of stated masses come with what gives way, in the model around which they are linearised."""
    within = [product for each in loads for term in each.terms for product in term.products]
    gives = {(product.direction, product.driver.arguments[0]) for product in within}

    def acted_on(p: Placed) -> bool:
        return any((product.direction, product.driver) in gives for term in p.terms for product in term.products)

    return Companion(
        ToleranceFamily(MASSES, layout.background[-1], layout.background_scale[-1], (1.0,)),
        frozenset(n for n, p in enumerate(placed) if acted_on(p)),
        frozenset(n for n, family in enumerate(backgrounds) if any(acted_on(p) for p in family)),
    )


def _candidates(
    layout: ParameterLayout, placed: Sequence[Placed], backgrounds: Sequence[Sequence[Placed]]
) -> tuple[Candidate, ...]:
    by_location: dict[str, list[int]] = {}
    forms: dict[tuple[str, str], list[Placed]] = {}
    for form in itertools.chain.from_iterable(backgrounds):
        forms.setdefault(form.key, []).append(form)
    for number, effect in enumerate(placed):
        by_location.setdefault(effect.location, []).append(number)
    coarse = {p.key: n for n, p in enumerate(placed) if p.variant == "angle" and not p.refinement}
    removed_with = _removed_with_drifts(placed, frozenset(by_location.get("base", ())))
    candidates = []
    for number, p in enumerate(placed):
        beside_it = [other for other in by_location[p.location] if other != number]
        excludes = frozenset(other for other in beside_it if clash(p, placed[other]))
        curve = p.parametrisation == "curve"
        candidates.append(
            Candidate(
                kind=p.name,
                location=p.location,
                columns=layout.columns[number],
                prior_scale=np.array(p.prior_scale),
                plausible=np.array([term.prior_size for term in p.terms]),
                variant=p.variant,
                driver=p.driver,
                label=str(p),
                family=DRIFT if curve and p.location == "base" and p.variant == "time" else p.family,
                looks_like=_looks_like(p),
                region=region(p),
                multiplicity=p.multiplicity,
                nonnegative=p.effect.nonnegative and len(p.terms) == 1,
                is_curve=curve,
                competes=_competes(p),
                excludes=excludes,
                requires=_requires(p, placed),
                special_cases=frozenset(
                    n for n in excludes if curve and placed[n].parametrisation != "curve" and _competes(placed[n])
                ),
                # what follows a joint's own angle is one, as a rule, beside its zero; of its load, two
                side_by_side=1 if p.variant == "angle" else 2,
                common=frozenset(n for n in beside_it if p.variant == "angle" and placed[n].effect is JOINT_OFFSET),
                as_one=frozenset(n for n in beside_it if curve and _of_one_gear(p, placed[n])),
                refines=coarse.get(p.key) if p.refinement and p.variant == "angle" else None,
                removed_with=removed_with.get(number, frozenset()),
                summed=_adding_up(layout, p, forms.get(p.key, ())),
                at_rest=at_least_load(p) if curve and p.variant in OF_LOAD else None,
            )
        )
    return tuple(candidates)


def _of_one_gear(curve: Placed, p: Placed) -> bool:
    """Whether a wave is one of those that a gear makes that sits off its centre and is oval, and rows show it so."""
    return p.effect is GEAR_ECCENTRICITY and follows_own_angle(curve) and spans_half_a_turn(curve)


def _adding_up(layout: ParameterLayout, p: Placed, forms: Sequence[Placed]) -> frozenset[int]:
    """Columns of a background that add up to an effect's one column, where the background has another form of it.

    A base that is as soft about x as about y is one that is soft about x and one that is so about y.
    """
    for form in forms if len(p.terms) == 1 else ():
        parts = [term for term in form.terms if set(term.products) < set(p.terms[0].products)]
        if sum(len(term.products) for term in parts) == len(p.terms[0].products):
            return frozenset(layout.index[term] for term in parts)
    return frozenset()


def _looks_like(p: Placed) -> str:
    """The background that does what an effect does, where it is not its own family's."""
    if p.variant == "load" and (p.parametrisation == "curve" or p.effect == BACKLASH):
        return SOFT
    return STRUCTURE if p.effect in (BASE_COMPLIANCE, LINK_BENDING) else ""


def _competes(p: Placed) -> bool:
    """Whether an effect enters by itself, not in another's place or as what stands out of a background."""
    return not p.refinement and p.variant != SOFT_START


def _requires(p: Placed, placed: Sequence[Placed]) -> frozenset[int] | None:
    """What an effect shows through: a wrong payload does nothing to an arm that does not give way."""
    if not p.effect.requires:
        return None
    through = (n for n, other in enumerate(placed) if other.family == p.effect.requires and not other.effect.requires)
    return frozenset(through)


def _removed_with_drifts(placed: Sequence[Placed], base: frozenset[int]) -> dict[int, frozenset[int]]:
    """A drift goes with one more effect of the base, which a drift with other pauses may hold, where there are such."""
    drifts = [n for n, p in enumerate(placed) if p.effect is BASE_DRIFT]
    if not any(placed[n].multiplicity > 1 for n in drifts):
        return {}
    return {n: base - {n} for n in drifts}


def _trusting_stated_masses(placed: Sequence[Placed]) -> tuple[Exchange, ...]:
    """Stated masses and one wrong payload in place of masses that are unknown to every joint by itself."""
    stated = {p.key: n for n, p in enumerate(placed) if p.effect is JOINT_COMPLIANCE and not p.variant}
    twins = {n: stated.get(p.key) for n, p in enumerate(placed) if p.variant == UNKNOWN_MASSES}
    payloads = tuple(n for n, p in enumerate(placed) if p.effect.requires)
    return (Exchange(twins, payloads),) if twins and payloads else ()
