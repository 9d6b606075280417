"""Whether masses have a name: that a link is otherwise than stated in a way without a name always competes with it.

Masses that have no name are held near the stated ones by one share for all links. Where one link of a drawing is far
off in some other way, in the place of its centre say, that share is too small for it, and any name at that link takes
the place of what it forbids: not for what the name says, but for where it is. So a name must be worth more than a share
of its links' own does, of which evidence chooses the size as it does of the others'.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Indices
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import BackgroundSizes, ToleranceFamily
from armscope.inference.problem import Problem, SelectedEffect
from armscope.motion.constants import LIBRARY, PRIOR
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.causes import PlacedCause
from armscope.motion.summary.constants import NAMING

SHARES = (*PRIOR.inertial_shares, *NAMING.another_link)


def odds_of_name(selected: SelectedCauses, number: int) -> float:
    """How much more likely a name of masses is than that its links are off without a name.

    Args:
        selected: a selection.
        number: of a chosen cause that is made of inertial parameters.

    Returns:
        Nats; both sides with the shares of all other links and of the name's own that suit them best. What links weigh
        is off by as much as suits the name: a share that only the name's own link asks for is that link's alone.
    """
    best, own = selected.best, _own(selected, number)
    freed, apart = _with_own_share(selected, own), not _says_all(selected, number, own)
    kept = tuple(effect for effect in best.chosen if effect.candidate != number)
    named, sizes = _at_best_shares(selected, freed, best.chosen, apart)
    weights = [family.name for family in selected.space.families].index("link masses")
    unnamed, _ = _at_best_shares(selected, freed, kept, apart, (sizes[weights],))
    return named - unnamed


def off_without_a_name(selected: SelectedCauses, number: int) -> SelectedCauses:
    """The selection without a name of masses, whose links are off by as much as the rows say without it.

    Held by the share of all links, what the name said would be left to gains and friction, which take it on the paths
    that were recorded, and on no other.

    Args:
        selected: a selection.
        number: of a chosen cause that is made of inertial parameters.

    Returns:
        The same with a share of their own for its links, where they ask for a larger one.
    """
    best, own = selected.best, _own(selected, number)
    kept = tuple(effect for effect in best.chosen if effect.candidate != number)
    _, sizes = _at_best_shares(selected, _with_own_share(selected, own), kept, not _says_all(selected, number, own))
    masses = [family.name for family in selected.space.families].index("masses")
    larger = SHARES[sizes[-1]] > SHARES[sizes[masses]]
    problem = _with_larger_share(selected, masses, own, (sizes[masses], sizes[-1])) if larger else selected.problem
    background = (*sizes[:masses], max(sizes[masses], 1 if larger else 0), *sizes[masses + 1 : -1])
    found = evaluate(problem, kept, background, best.noise)
    return replace(selected, space=problem.space, problem=problem, best=found)


def _with_larger_share(selected: SelectedCauses, masses: int, own: Indices, sizes: tuple[int, int]) -> Problem:
    """The problem in which links of a name have a larger share in the family of masses than all others; these, none."""
    space, (of_all, of_own) = selected.problem.space, sizes
    family = space.families[masses]
    assert isinstance(family, ToleranceFamily)
    its = np.isin(family.columns, own)
    if of_all == 0:
        family, its = family.without(family.columns[~its]), its[its]
    tolerance = np.where(its, SHARES[of_own] / SHARES[max(of_all, 1)], 1.0) * family.tolerance
    families = (*space.families[:masses], replace(family, tolerance=tolerance), *space.families[masses + 1 :])
    return replace(selected.problem, space=replace(space, families=families))


def is_of_masses(placed: PlacedCause) -> bool:
    """Whether a cause is masses that are other than stated in all runs, as the background of masses has them, too."""
    return placed.inertial is not None and not placed.runs


def all_held_alike(selected: SelectedCauses) -> SelectedCauses:
    """The selection with one share for all links; itself where it has one."""
    space, masses = selected.problem.space, [f.name for f in selected.space.families].index("masses")
    family = space.families[masses]
    assert isinstance(family, ToleranceFamily)
    inertial = selected.rows.layout.inertial
    if len(family.columns) == len(inertial) and np.all(family.tolerance == family.tolerance[0]):
        return selected
    alike = replace(family, columns=inertial, tolerance=np.ones(len(inertial)))
    space = replace(space, families=(*space.families[:masses], alike, *space.families[masses + 1 :]))
    return replace(selected, space=space, problem=replace(selected.problem, space=space))


def odds_of_weight(selected: SelectedCauses, number: int) -> float:
    """How much more likely it is that a link is heavier in proportion than that it is off in some other way alone.

    Args:
        selected: a selection in which links may be heavier without a name.
        number: of a link's mass, which has no name there.

    Returns:
        Nats; both sides as in `odds_of_name`.
    """
    freed = _with_own_share(selected, _own(selected, number))
    otherwise = freed.holding(selected.rows.layout.columns[number])
    heavier, not_so = (_at_best_shares(selected, each, selected.best.chosen, True)[0] for each in (freed, otherwise))
    return heavier - not_so


def by_own_share(selected: SelectedCauses, number: int) -> list[Hypothesis]:
    """The selection by every share of which the links of one of its names may be off otherwise than it says.

    Where a link's centre lies elsewhere by 2 % of its reach, the same torque says another mass of it, and a share that
    suits all links alike hides that.

    Args:
        selected: a selection.
        number: of a chosen cause that is made of inertial parameters.

    Returns:
        Hypotheses with the same names.
    """
    best, freed = selected.best, _with_own_share(selected, _own(selected, number))
    return [evaluate(freed, best.chosen, (*best.background, own), best.noise) for own in range(len(SHARES))]


def _own(selected: SelectedCauses, number: int) -> Indices:
    """Inertial parameters of the links that a name speaks of."""
    layout = selected.rows.layout
    inertial = layout.placed[number].inertial
    assert inertial is not None
    links = np.unique(np.flatnonzero(np.any(inertial != 0, axis=1)) // 10)
    return layout.inertial[np.isin(np.arange(len(layout.inertial)) // 10, links)]


def _says_all(selected: SelectedCauses, number: int, own: Indices) -> bool:
    """Whether a name is all that its links' numbers can say: of a first link that stands upright, its inertia is."""
    columns, k = np.concatenate([own, selected.rows.layout.columns[number]]), len(own)
    scale = selected.problem.scale[columns]
    G = selected.problem.equations.G[np.ix_(columns, columns)] * np.outer(scale, scale)
    said = G[:k, k:] @ np.linalg.pinv(G[k:, k:], rcond=LIBRARY.redundant, hermitian=True) @ G[k:, :k]
    whole = np.diag(G)[:k]
    return bool(np.max(whole - np.diag(said)) < LIBRARY.redundant_columns**2 * np.max(whole))


def _with_own_share(selected: SelectedCauses, own: Indices) -> Problem:
    """The problem with some inertial parameters in a family of their own, the last of all."""
    space, problem = selected.space, selected.problem
    others = tuple(family.without(own) if family.name == "masses" else family for family in space.families)
    family = ToleranceFamily("own masses", own, np.ones(len(own)), SHARES)
    families = (*others, family)
    return replace(problem, space=replace(space, families=families), family_costs=np.append(problem.family_costs, 0.0))


def _at_best_shares(
    selected: SelectedCauses,
    freed: Problem,
    effects: tuple[SelectedEffect, ...],
    apart: bool,
    of_weights: Sequence[int] = (),
) -> tuple[float, BackgroundSizes]:
    """Log posterior of some effects by the shares that suit them: of all links, of the name's own, of links' weights.

    The last is looked for at the best of the first two, and these once more at it. The name's own links have the share
    of all where they are not set ``apart``.
    """
    names = [family.name for family in selected.space.families]
    masses, weights = names.index("masses"), names.index("link masses")
    sizes, found = (*selected.best.background, 0), -np.inf
    of_all = range(freed.space.families[masses].sizes)
    shares = list(itertools.product(of_all, range(len(SHARES)))) if apart else [(size, size) for size in of_all]
    of_weights = of_weights or range(freed.space.families[weights].sizes)
    for _ in range(2):
        before = found
        tried = [(*sizes[:masses], size, *sizes[masses + 1 : -1], own) for size, own in shares]
        found, sizes = max((_posterior(selected, freed, effects, each), each) for each in tried)
        tried = [(*sizes[:weights], size, *sizes[weights + 1 :]) for size in of_weights]
        found, sizes = max((_posterior(selected, freed, effects, each), each) for each in tried)
        if found <= before:
            break
    return found, sizes


def _posterior(
    selected: SelectedCauses, freed: Problem, effects: tuple[SelectedEffect, ...], sizes: BackgroundSizes
) -> float:
    """Log posterior, nats; that of all links just these have another share has the price of a name.

    It is one kind of cause more, at one of the links, of some size: for nothing, a link that is singled out without a
    name would have been preferred to one whose name says all of it. That it pays for its kind, too, was decided with
    two cases in view, whose names had odds of 2.5 and 2.6 nats by its place and size alone.
    """
    found = float(evaluate(freed, effects, sizes, selected.best.noise).log_posterior)
    of_all = sizes[[family.name for family in freed.space.families].index("masses")]
    apart = np.log(freed.space.kinds) + np.log(selected.rows.layout.arm.n_links) + np.log(len(SHARES) - 1)
    return found if sizes[-1] == of_all else found - float(apart)
