"""Whether masses have a name: that a link is otherwise than stated in a way without a name always competes with it.

Masses that have no name are held near the stated ones by one share for all links. Where one link of a drawing is far
off in some other way, in the place of its centre say, that share is too small for it, and any name at that link takes
the place of what it forbids: not for what the name says, but for where it is. So a name must be worth more than a share
of its links' own does, of which evidence chooses the size as it does of the others'.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.core.types import Indices
from armscope.inference.evidence import evaluate
from armscope.inference.model_space import ToleranceFamily
from armscope.inference.problem import Problem, SelectedEffect
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary.constants import NAMING

SHARES = (*PRIOR.inertial_shares, *NAMING.another_link)


def odds_of_name(selected: SelectedCauses, number: int) -> float:
    """How much more likely a name of masses is than that its links are off without a name.

    Args:
        selected: a selection.
        number: of a chosen cause that is made of inertial parameters.

    Returns:
        Nats; both sides with the shares of all other links and of the name's own that suit them best.
    """
    best = selected.best
    freed = _with_own_share(selected, _own(selected, number))
    kept = tuple(effect for effect in best.chosen if effect.candidate != number)
    named, unnamed = (_at_best_shares(selected, freed, effects) for effects in (best.chosen, kept))
    return named - unnamed


def _own(selected: SelectedCauses, number: int) -> Indices:
    """Inertial parameters of the links that a name speaks of."""
    layout = selected.rows.layout
    inertial = layout.placed[number].inertial
    assert inertial is not None
    links = np.unique(np.flatnonzero(np.any(inertial != 0, axis=1)) // 10)
    return layout.inertial[np.isin(np.arange(len(layout.inertial)) // 10, links)]


def _with_own_share(selected: SelectedCauses, own: Indices) -> Problem:
    """The problem with some inertial parameters in a family of their own, the last of all."""
    space, problem = selected.space, selected.problem
    others = tuple(family.without(own) if family.name == "masses" else family for family in space.families)
    family = ToleranceFamily("own masses", own, np.ones(len(own)), SHARES)
    families = (*others, family)
    return replace(problem, space=replace(space, families=families), family_costs=np.append(problem.family_costs, 0.0))


def _at_best_shares(selected: SelectedCauses, freed: Problem, effects: tuple[SelectedEffect, ...]) -> float:
    """Log posterior of some effects by the shares that suit them."""
    background, noise = selected.best.background, selected.best.noise
    masses = next(n for n, family in enumerate(selected.space.families) if family.name == "masses")
    found = -np.inf
    for size in range(selected.space.families[masses].sizes):
        for own in range(len(SHARES)):
            sizes = (*background[:masses], size, *background[masses + 1 :], own)
            found = max(found, evaluate(freed, effects, sizes, noise).log_posterior)
    return float(found)
