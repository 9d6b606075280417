"""The velocity update of a particle swarm, as a pure function, and the rules that give its coefficients."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from armscope.core.types import Array


class Coefficients(NamedTuple):
    """The three weights of one velocity update (any constriction factor is multiplied in)."""

    inertia: float
    cognitive: float
    social: float


# so many parameters: the symbols of the equation, as the paper has them
def velocity_update(
    positions: Array,
    velocities: Array,
    personal_bests: Array,
    neighbourhood_bests: Array,
    r1: Array,
    r2: Array,
    coefficients: Coefficients,
    speed_limit: Array | float | None = None,
    out: Array | None = None,
) -> Array:
    """The velocities of the next iteration, for each particle and each dimension by itself.

    v(t+1) = w v(t) + c1 r1 (p - x(t)) + c2 r2 (g - x(t)),   then   x(t+1) = x(t) + v(t+1)

    with the particle's position x, the best position p that it has seen, and the best position g that its
    neighbourhood has seen. With w = 1 and c1 = c2 = 2.05 this is the formula of Alici et al. (2006), section 5, as
    printed. All arrays broadcast against ``positions`` (... x particles x dimensions); nothing is changed but ``out``.

    Args:
        positions: x(t).
        velocities: v(t).
        personal_bests: p, per particle.
        neighbourhood_bests: g, per particle or one for all of a swarm.
        r1, r2: uniform random numbers in [0, 1), one for each particle and dimension.
        coefficients: w, c1 and c2.
        speed_limit: the largest |v(t+1)| allowed in each dimension; None allows any.
        out: where to put the result, which saves memory traffic; it may be ``velocities``.

    Returns:
        v(t+1), shaped as ``positions``; it is ``out`` where that was given.
    """
    updated = np.multiply(velocities, coefficients.inertia, out=out)
    pull = personal_bests - positions
    pull *= r1
    pull *= coefficients.cognitive
    updated += pull
    np.subtract(neighbourhood_bests, positions, out=pull)
    pull *= r2
    pull *= coefficients.social
    updated += pull
    if speed_limit is not None:
        np.clip(updated, -np.asarray(speed_limit), speed_limit, out=updated)
    return updated


def clerc_constriction(cognitive: float, social: float) -> float:
    """The constriction factor 2 / |2 - phi - sqrt(phi^2 - 4 phi)|, phi = c1 + c2 > 4 (Clerc & Kennedy 2002, Eq.
    4.14). Raises ValueError: phi is 4 or less; the factor is defined above it only."""
    phi = cognitive + social
    if not phi > 4:
        raise ValueError(f"c1 + c2 = {phi!r}: Clerc's constriction factor needs a sum above 4")
    return 2.0 / abs(2.0 - phi - math.sqrt(phi * phi - 4.0 * phi))


@dataclass(frozen=True)
class UpdateRule:
    """How the weights of the velocity update follow from the iteration.

    Args:
        inertia: weight of the old velocity in the first iteration.
        cognitive: c1, the pull towards a particle's own best.
        social: c2, the pull towards its neighbourhood's best.
        constriction: a factor on all three.
        final_inertia: the inertia of the last iteration, reached in equal steps; None keeps it constant.
    """

    inertia: float
    cognitive: float
    social: float
    constriction: float = 1.0
    final_inertia: float | None = None

    def __post_init__(self) -> None:
        for name in ("inertia", "cognitive", "social", "constriction", "final_inertia"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value >= 0):
                raise ValueError(f"{name} = {value!r}: must be a finite number, zero or more")

    def coefficients(self, iteration: int, iterations: int) -> Coefficients:
        """The weights in ``iteration`` (counted from 0) of ``iterations``."""
        inertia = self.inertia
        if self.final_inertia is not None and iterations > 1:
            inertia += (self.final_inertia - self.inertia) * iteration / (iterations - 1)
        return Coefficients(
            self.constriction * inertia, self.constriction * self.cognitive, self.constriction * self.social
        )


PRESETS: dict[str, UpdateRule] = {
    # as printed in Alici et al. (2006): neither inertia nor constriction, although c = 2.05 was made for the latter
    "original": UpdateRule(inertia=1.0, cognitive=2.05, social=2.05),
    # Clerc & Kennedy (2002); the same as a constant inertia of 0.7298 with c1 = c2 = 1.4962
    "constriction": UpdateRule(inertia=1.0, cognitive=2.05, social=2.05, constriction=clerc_constriction(2.05, 2.05)),
    # Shi & Eberhart (1999), "Empirical study of particle swarm optimization": inertia falling from 0.9 to 0.4
    "inertia": UpdateRule(inertia=0.9, cognitive=2.0, social=2.0, final_inertia=0.4),
}
