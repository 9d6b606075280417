"""What a load and the drives' gains say alike: a load that seems wrong by a share, or every torque wrong by it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.inference.evidence import evaluate
from armscope.inference.model_space import Candidate, ToleranceFamily
from armscope.inference.problem import SelectedEffect
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.verdict.effects import Alternative

EVERY_JOINT = "every joint"


def gains_instead(selected: SelectedCauses, number: int) -> Alternative | None:
    """The drives' gains in the place of a load's mass: the load weighs what is stated, and all torques are off.

    Gains and masses of the arm then are as free as they ever are, for a factor of all torques is one of all masses;
    where the load has its centre stays free.

    Args:
        selected: the selection.
        number: of the cause's candidate.

    Returns:
        The alternative; None where torques were recorded, or it is no load.
    """
    layout, best, space = selected.rows.layout, selected.best, selected.space
    placed = layout.placed[number]
    if not layout.with_gains or placed.cause is not catalogue.PAYLOAD:
        return None
    without = _without_mass(space.candidates[number], placed)
    chosen = tuple(effect for effect in best.chosen if effect.candidate != number)
    if without is not None:
        size = next(effect.size for effect in best.chosen if effect.candidate == number)
        chosen = (*chosen, SelectedEffect(number, size))
    families = tuple(
        replace(family, tolerance=np.maximum(family.tolerance, PRIOR.unsure_gain))
        if isinstance(family, ToleranceFamily) and family.name == "gains"
        else family
        for family in space.families
    )
    candidates = tuple(without if n == number and without else each for n, each in enumerate(space.candidates))
    problem = replace(selected.problem, space=replace(space, families=families, candidates=candidates))
    masses = next(n for n, family in enumerate(families) if family.name == "masses")
    background = [
        (*best.background[:masses], size, *best.background[masses + 1 :]) for size in range(families[masses].sizes)
    ]
    found = max(evaluate(problem, chosen, sizes, best.noise).log_posterior for sizes in background)
    gap = float(best.log_posterior - found)
    return Alternative(catalogue.GAIN.name, EVERY_JOINT, catalogue.GAIN.family, gap, "torque", gap)


def _without_mass(candidate: Candidate, placed: PlacedCause) -> Candidate | None:
    """The same load with its mass as stated; None where nothing is left of it."""
    kept = np.array([n for n, (name, _) in enumerate(placed.parameters) if name != "mass"], dtype=np.intp)
    if not len(kept):
        return None
    return replace(candidate, columns=candidate.columns[kept], prior_scale=candidate.prior_scale[kept])
