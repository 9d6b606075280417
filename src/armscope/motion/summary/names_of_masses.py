"""Names in the place of masses that have none: which of them are likely, and which are sure enough to be told."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from armscope.inference.edits import by_posterior
from armscope.inference.evidence import Hypothesis
from armscope.inference.search import Search
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.space import OF_MASSES
from armscope.motion.summary.constants import NAMING
from armscope.motion.summary.unnamed_masses import all_held_alike, is_of_masses, odds_of_name
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


@dataclass(frozen=True)
class NameOfMasses:
    """A name in the place of masses that have none."""

    selected: SelectedCauses  # the selection with it
    number: int  # of its candidate
    nats: float  # by which it is likelier than that its links are off without a name

    @property
    def is_told(self) -> bool:
        """Whether it is sure enough: clearly likelier than none, or as likely and all that masses lack."""
        if self.nats >= INDISTINGUISHABLE_NATS:
            return True
        return self.nats > -INDISTINGUISHABLE_NATS and says_all_alone(self.selected, self.number)


def likeliest_name(selected: SelectedCauses, without: Collection[int] = ()) -> NameOfMasses | None:
    """The name of masses that says most of what has none there, where it is at least likelier than none.

    Args:
        selected: a selection.
        without: numbers of names that are not asked for.

    Returns:
        It; None where there is none.
    """
    names = _with_each_name(selected, without)
    found = max(names, key=lambda each: by_posterior(each.best), default=None)
    if found is None:
        return None
    number = found.best.chosen[-1].candidate
    nats = odds_of_name(found, number)
    return NameOfMasses(found, number, nats) if nats > 0 else None


def likely_names(selected: SelectedCauses) -> list[NameOfMasses]:
    """Names of masses that these rows don't tell from masses without one, nor from each other; the likeliest first.

    Args:
        selected: a selection.

    Returns:
        Each cause and place once; none where masses without a name are likelier than all of them.
    """
    best: dict[tuple[str, str], SelectedCauses] = {}
    for found in sorted(_with_each_name(selected), key=lambda each: by_posterior(each.best), reverse=True):
        placed = found.rows.layout.placed[found.best.chosen[-1].candidate]
        best.setdefault((placed.cause.name, placed.location), found)
    most = max((found.best.log_posterior for found in best.values()), default=-np.inf)
    numbered = [(found, found.best.chosen[-1].candidate) for found in best.values()]
    names = [
        NameOfMasses(found, number, odds_of_name(found, number))
        for found, number in numbered
        if found.best.log_posterior > most - INDISTINGUISHABLE_NATS
    ]
    return names if names and names[0].nats > -INDISTINGUISHABLE_NATS else []


def says_all_alone(selected: SelectedCauses, number: int) -> bool:
    """Whether a name is all that masses lack: beside it they are as stated, and without it they are far from it.

    Of few joints, moments of the links have few combinations, and masses all over the arm say what one name says.
    That all of them are so far off is possible; that one is, comes first.

    Args:
        selected: a selection.
        number: of a chosen cause that is made of inertial parameters.
    """
    search = Search.on(selected.problem)
    others = search.with_best_sizes(search.without(selected.best, [number]))
    return share_of_masses(selected, selected.best) <= PRIOR.inertial_shares[1] and far_off(selected, others)


def far_off(selected: SelectedCauses, best: Hypothesis) -> bool:
    """Whether masses without a name are off by more than a drawing and a scale leave."""
    return share_of_masses(selected, best) >= NAMING.far_off * PRIOR.inertial_shares[1]


def share_of_masses(selected: SelectedCauses, best: Hypothesis) -> float:
    """Share of a link's mass, and so on, within which masses are off without a name."""
    sizes = zip(selected.space.families, best.background, strict=True)
    return max(float(family.label(size)) for family, size in sizes if family.name in OF_MASSES)


def _with_each_name(selected: SelectedCauses, without: Collection[int] = ()) -> list[SelectedCauses]:
    """The selection with every name of masses, its last, by the shares from which it is looked for."""
    selected = all_held_alike(selected)
    search, placed = Search.on(selected.problem), selected.rows.layout.placed
    others = [n for n, cause in enumerate(placed) if n in without or not is_of_masses(cause)]
    families = [family.name for family in selected.space.families]
    masses, weights = families.index("masses"), families.index("link masses")
    as_stated = search.with_background(selected.best, weights, 0)
    both = (selected.best, as_stated) if selected.best.background[weights] else (selected.best,)
    smaller = [search.with_background(each, masses, n) for each in both for n in range(each.background[masses] + 1)]
    named = [search.with_best_sizes(each) for start in smaller for each in search.additions(start, 1, others)]
    return [replace(selected, best=each) for each in named]
