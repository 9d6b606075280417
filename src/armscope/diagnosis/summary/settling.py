"""Whether poses would settle which of two readings is right: both are fitted anew to what either would give there.

How far apart two predictions lie is no answer: they were fitted to few rows, and either follows new ones as far as it
can. Two that are one motion in other words stay alike whatever is measured.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.diagnosis.summary.constants import NEXT_POSES
from armscope.diagnosis.summary.rivals import Rival, discriminability
from armscope.inference.evidence import Hypothesis, at_noise
from armscope.inference.model_space import Candidate
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


@dataclass(frozen=True, eq=False)
class OpenQuestion:
    """Two readings, and poses that may be measured."""

    problem: Problem  # the rows so far
    # best, effect: the hypothesis with the effect, and the effect
    best: Hypothesis
    effect: Candidate
    rival: Rival  # the other reading
    columns: Array  # (K, 3, p) of all scaled columns at the poses, mm
    base: Array  # (K, 3, 6) of a base that is set up anew, mm per SI unit
    base_variance: Array  # (6,) of that base, SI units

    def times(self, rng: np.random.Generator) -> float:
        """How often each pose is to be measured until the right reading is known; infinite where never.

        Args:
            rng: draws what would be measured.

        Returns:
            A power of two up to `NEXT_POSES.most_repeats`, or infinity.
        """
        draws = rng.spawn(1)[0].integers(2**63, size=NEXT_POSES.draws)
        most = int(np.log2(NEXT_POSES.most_repeats))
        if not self._decide(2**most, draws):
            return float("inf")
        return float(next(2**k for k in range(most + 1) if self._decide(2**k, draws)))

    def _decide(self, times: int, seeds: Indices) -> bool:
        """Whether either reading, if it is right, would be told from the other by so many repeats."""
        ways = (self.best, self.rival.hypothesis)
        told = [[self.nats(truth, times, np.random.default_rng(int(seed))) for seed in seeds] for truth in ways]
        return bool((np.mean(np.array(told) >= INDISTINGUISHABLE_NATS, axis=1) >= NEXT_POSES.settled).all())

    def nats(self, truth: Hypothesis, times: int, rng: np.random.Generator) -> float:
        """By how much the right reading is ahead once the poses have been measured.

        Args:
            truth: which of the two is right.
            times: how often each pose is measured.
            rng: draws the noise.

        Returns:
            Nats; negative where the wrong one is.
        """
        noise, lying = truth.noise, self.columns.reshape(-1, self.columns.shape[2])
        values = self._as_far_as_known(truth, lying.shape[1])
        base = self.base.reshape(len(lying), -1)
        spread = np.eye(len(lying)) / times + (base * self.base_variance) @ base.T / noise**2
        white = np.linalg.inv(np.linalg.cholesky(spread))
        X = white @ lying
        y = X @ values + noise * rng.standard_normal(len(lying))
        new, old = (
            NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(len(y) - base.shape[1])),
            self.problem.equations,
        )
        together = NormalEquations(old.G + new.G, old.b + new.b, old.yy + new.yy, old.n + new.n)
        return self._ahead(truth is self.best, replace(self.problem, equations=together))

    def _as_far_as_known(self, truth: Hypothesis, count: int) -> Array:
        """(count,) values of the right reading; of the effect itself those only that stand out of their uncertainty.

        A link with a twist and two lengths that may be zero is a link with a twist: the lengths, of which nothing is
        known, would tell it from a wobble that is the same motion.
        """
        values = truth.coefficients(count)
        own = (self.effect if truth is self.best else self.rival.candidate).columns
        clear = np.abs(truth.means(own)) > NEXT_POSES.clear_deviations * np.sqrt(truth.variances(own))
        values[own[~clear]] *= not clear.any()
        return values

    def _ahead(self, best_is_right: bool, problem: Problem) -> float:
        best, other = self.best, self.rival.hypothesis
        held = problem.holding(np.array(self.rival.held, dtype=np.intp)) if self.rival.held else problem
        again = at_noise(problem, best.chosen, best.background, best.noise)
        rival = at_noise(held, other.chosen, other.background, best.noise)
        if best_is_right:
            return discriminability(again, rival, self.effect, self.rival.candidate)
        return discriminability(rival, again, self.rival.candidate, self.effect)
