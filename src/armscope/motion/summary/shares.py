"""How much of what friction and rotors leave each cause explains, and masses that are off without a name."""

from __future__ import annotations

import numpy as np

from armscope.inference.shapley import shares
from armscope.motion.constants import TELLING
from armscope.motion.fitting.selected import SelectedCauses


def shares_of(selected: SelectedCauses) -> tuple[list[float], float]:
    """Shares of what friction and rotors leave.

    Masses that are off unnamed come in like a cause: what a name and they explain alike, they share. Of them is told
    what no name of the story explains: beside a body that is not on the arm they would pass for as much as it.

    Args:
        selected: a selection.

    Returns:
        Of each chosen cause; and what masses that are off without a name add to those that are told, 0 where none are.
    """
    best, problem = selected.best, selected.problem
    ridge = np.full(len(problem.scale), 1e12)
    ridge[best.columns] = best.noise**2 / best.variance
    members = [selected.space.candidates[effect.candidate].columns for effect in best.chosen]
    unnamed = np.setdiff1d(selected.rows.layout.masses, np.concatenate([np.empty(0, dtype=np.intp), *members]))
    masses = np.intersect1d(unnamed, best.columns)
    base = np.setdiff1d(best.columns, np.concatenate([masses, *members]))
    if not len(masses):
        return shares(problem.equations, ridge, base, members).tolist(), 0.0
    explained = shares(problem.equations, ridge, base, [*members, masses]).tolist()[:-1]
    told = [columns for columns, share in zip(members, explained, strict=True) if share >= TELLING.minor_share]
    first = np.concatenate([base, *told])
    return explained, float(shares(problem.equations, ridge, base, [first, masses], last=(1,))[1])
