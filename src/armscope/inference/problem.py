"""Normal equations made ready for evaluating hypotheses: scaled columns, sizes that compete, and what each name costs.

A hypothesis is a set of candidates with a size each (mm at the tool), a size of each background, and the noise. Columns
are scaled to 1 mm RMS at the tool.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.constants import PRIORS
from armscope.inference.model_space import BackgroundSizes, ModelSpace
from armscope.inference.normal_equations import NormalEquations, column_scales, steadied


@dataclass(frozen=True)
class SelectedEffect:
    """An effect in a hypothesis: which candidate, with which size (index into the problem's sizes).

    One that is ``nested`` in a background or a curve is a name for a part of it, and pays nothing for itself.
    """

    candidate: int
    size: int
    nested: bool = False


@dataclass(frozen=True, eq=False)
class Problem:
    """Normal equations with the priors under which hypotheses are evaluated."""

    space: ModelSpace  # what the columns are
    equations: NormalEquations  # with columns scaled to 1 mm RMS at the tool
    scale: Array  # (p,) what they were divided by, mm per SI unit
    least_noise: float  # mm; the noise is never taken to be below (stated, or seen in repeats)
    sizes: Array  # (SIZES,) effect sizes that compete, mm at the tool
    prior_costs: Array  # (candidates,) log prior odds against each candidate, nats
    family_costs: Array  # (families,) of each background: one kind of error among the others, of some size; nats
    mismatch: float  # RMS per axis after the free frames, mm

    @property
    def n(self) -> float:
        """Number of residuals."""
        return self.equations.n

    def with_equations(self, equations: NormalEquations) -> Problem:
        """The same problem on other rows; ``equations`` is unscaled."""
        return replace(self, equations=steadied(equations, self.space.frames).scaled(self.scale))

    def holding(self, columns: Indices) -> Problem:
        """The same problem with some columns at zero in every background."""
        families = tuple(family.without(columns) for family in self.space.families)
        return replace(self, space=replace(self.space, families=families))

    def is_free(self, candidate: int) -> bool:
        """Whether a background that does not pay for being there holds a candidate: what every arm has anyway."""
        columns = set(self.space.candidates[candidate].columns)
        return any(columns <= set(family.columns) for family in self.space.families if not family.is_priced)

    def cost(self, candidate: int) -> float:
        """What a candidate of any one size pays, nats."""
        return float(self.prior_costs[candidate]) + math.log(len(self.sizes))

    def prior_scale(self, effect: SelectedEffect) -> Array:
        """(c,) prior standard deviations of an effect's scaled coefficients, mm."""
        candidate = self.space.candidates[effect.candidate]
        expected, scale = self.sizes[effect.size] * candidate.prior_scale, self.scale[candidate.columns]
        return within(expected, candidate.plausible, scale, candidate.usual)

    @functools.cached_property
    def _in_backgrounds(self) -> dict[BackgroundSizes, Array]:
        """What `variances_in` found so far."""
        return {}

    def variances_in(self, background: BackgroundSizes) -> Array:
        """(p,) prior variances of the scaled columns by a background alone, mm^2; computed once."""
        known = self._in_backgrounds.get(background)
        if known is None:
            known = np.zeros(len(self.scale))
            for family, size in zip(self.space.families, background, strict=True):
                if size:
                    known[family.columns] += family.prior_variance(size, self.scale)
            self._in_backgrounds[background] = known
        return known

    def nearest_size(self, rms: float) -> int:
        """Index of the size nearest to an RMS at the tool; the smallest for what is held at zero."""
        within = np.clip(rms, self.sizes.min(), self.sizes.max())
        return int(np.argmin(np.abs(np.log(self.sizes / within))))


def build_problem(space: ModelSpace, equations: NormalEquations, least_noise: float) -> Problem:
    """Scale normal equations and set prior sizes and costs.

    Args:
        space: what the columns are.
        equations: mm per SI unit.
        least_noise: mm; the noise is never taken to be below.

    Returns:
        The problem, its columns scaled to the size that they have at the tool.
    """
    equations = steadied(equations, space.frames)
    scale = column_scales(equations, space.frames)
    scaled = equations.scaled(scale)
    freedom = max(equations.n - len(space.frames), 1.0)
    mismatch = float(np.sqrt(scaled.least_rss(space.frames) / freedom))
    low = max(least_noise * min(PRIORS.barely_seen / np.sqrt(max(equations.n, 1.0)), 0.5), 0.01 * mismatch)
    sizes = np.geomspace(low, max(2 * mismatch, 4 * low), PRIORS.sizes)
    family_costs = [
        np.log(space.kinds) + np.log(family.sizes - 1) if family.is_priced else 0.0 for family in space.families
    ]
    costs = prior_costs(space)
    return Problem(space, scaled, scale, least_noise, sizes, costs, np.array(family_costs), mismatch)


def prior_costs(space: ModelSpace) -> Array:
    """(candidates,) nats: each kind is as likely as any other, each of its locations, each scanned number, too."""
    locations: dict[str, set[str]] = {}
    variants: dict[tuple[str, str], int] = {}
    for candidate in space.candidates:
        locations.setdefault(candidate.kind, set()).add(candidate.location)
        if candidate.multiplicity == 1 and candidate.competes:
            variants[candidate.key] = variants.get(candidate.key, 0) + 1
    return np.array(
        [
            PRIORS.sure_nats
            + np.log(space.kinds)
            + np.log(len(locations[candidate.kind]))
            + math.log(candidate.multiplicity if candidate.multiplicity > 1 else variants.get(candidate.key, 1))
            for candidate in space.candidates
        ]
    )


def prior_variances(problem: Problem, chosen: Sequence[SelectedEffect], background: BackgroundSizes) -> Array:
    """(p,) prior variances of the scaled columns, mm^2; zero where a column takes no part.

    Args:
        problem: the priors.
        chosen: the effects, with their sizes.
        background: size of each family's background.

    Returns:
        (p,) mm^2.
    """
    prior, space = problem.variances_in(background).copy(), problem.space
    for companion in space.companions:
        if companion.joins((effect.candidate for effect in chosen), background):
            family = companion.family
            prior[family.columns] += family.prior_variance(family.sizes - 1, problem.scale)
    prior[space.frames] = PRIORS.frame_mm**2
    for effect in chosen:
        prior[space.candidates[effect.candidate].columns] += problem.prior_scale(effect) ** 2
    return prior


def background_sizes(problem: Problem, background: BackgroundSizes) -> tuple[float, ...]:
    """Size of each family's background as a number: share of its tolerance."""
    return tuple(family.label(size) for family, size in zip(problem.space.families, background, strict=True))


def within(expected: Array, plausible: Array | None, scale: Array, usual: Array | None = None) -> Array:
    """(..., c) prior sizes, mm, of scaled coefficients: as expected, not below the usual nor beyond the plausible.

    Args:
        expected: (..., c) mm.
        plausible: (..., c) in the columns' own units; None: anything is.
        scale: (..., c) mm per unit.
        usual: (..., c) as ``plausible``.

    Returns:
        The sizes.
    """
    expected = expected if usual is None else np.maximum(expected, usual * scale)
    return expected if plausible is None else np.minimum(expected, plausible * scale)
