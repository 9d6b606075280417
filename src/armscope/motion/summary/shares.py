"""How much of what friction and rotors leave each cause explains, and masses that are off without a name."""

from __future__ import annotations

import numpy as np

from armscope.inference.shapley import shares
from armscope.motion.fitting.selected import SelectedCauses


def shares_of(selected: SelectedCauses) -> tuple[list[float], float]:
    """Shares of what friction and rotors leave.

    Masses that are off unnamed come in like a cause: what a name and they explain alike, they share.

    Args:
        selected: a selection.

    Returns:
        Of each chosen cause; and of masses that are off without a name, 0 where none are.
    """
    best, problem = selected.best, selected.problem
    ridge = np.full(len(problem.scale), 1e12)
    ridge[best.columns] = best.noise**2 / best.variance
    members = [selected.space.candidates[effect.candidate].columns for effect in best.chosen]
    inertial = selected.rows.layout.inertial
    masses = np.intersect1d(inertial, best.columns)
    base = np.setdiff1d(best.columns, np.concatenate([masses, *members]))
    both = [*members, masses] if len(masses) else members
    found = [float(share) for share in shares(problem.equations, ridge, base, both)]
    return found[: len(members)], sum(found[len(members) :])
