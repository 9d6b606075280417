"""Search over sets of whole effects: several hypotheses kept alive, additions, removals, swaps and merges.

It starts from several sizes of the geometric background, because from a large one a single wrong link is never named
and from a small one an ordinary arm needs a name for every link; the evidence then tells which of them it is.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.diagnosis.evidence import (
    BACKGROUND_SIZES,
    Chosen,
    Groups,
    Hypothesis,
    Problem,
    gains,
    group,
    losses,
    weigh,
)
from armscope.physics.effect import Placed, region

BEAM = 3
BRANCHES = 3
MOST_EFFECTS = 16
STARTS = (0, 2, 4)
"""Background sizes to start from."""
WORTH_TRYING_NATS = 2.0
"""A removal that loses more than this at the present noise can't pay when the noise is re-estimated."""
GAIN = 1e-3
"""Nats by which a move must better a hypothesis."""


@dataclass(eq=False)
class Search:
    """A search with its settings and the problem it runs on."""

    problem: Problem
    groups: Groups
    beam: int = BEAM
    branches: int = BRANCHES

    @classmethod
    def on(cls, problem: Problem, beam: int = BEAM, branches: int = BRANCHES) -> Search:
        """A search on a problem."""
        return cls(problem, group(problem.pool), beam, branches)

    def best(self, starts: Sequence[int] = STARTS) -> Hypothesis:
        """The most probable hypothesis found from all starts."""
        ends = [self._climb(self._empty(start)) for start in starts]
        return self._polish(max(ends, key=_value))

    def empty(self) -> Hypothesis:
        """The best hypothesis without any named effect."""
        return max((self._empty(size) for size in range(len(BACKGROUND_SIZES))), key=_value)

    def _empty(self, background: int) -> Hypothesis:
        start = max(self.problem.least_noise, float(np.sqrt(self.problem.gram.yy / self.problem.n)) * 1e-2)
        return weigh(self.problem, (), background, max(start, 1e-4))

    def _climb(self, start: Hypothesis) -> Hypothesis:
        """Beam search by additions and removals."""
        alive, best = [start], start
        seen = {start.candidates}
        for _ in range(MOST_EFFECTS):
            children: list[Hypothesis] = []
            for parent in alive:
                for child in self.additions(parent, self.branches):
                    if child.candidates not in seen:
                        seen.add(child.candidates)
                        children.append(self._pruned(child))
            children = _distinct(sorted(children, key=_value, reverse=True))[: self.beam]
            if not children or children[0].value <= best.value + GAIN:
                break
            best, alive = children[0], children
        return best

    def additions(self, parent: Hypothesis, count: int, without: Iterable[int] = ()) -> list[Hypothesis]:
        """The ``count`` most promising hypotheses with one effect more."""
        gain, size = gains(self.problem, self.groups, parent)
        gain[self._taken(parent)] = -np.inf
        gain[list(without)] = -np.inf
        order = np.argsort(-gain)[:count]
        return [
            weigh(
                self.problem,
                (*parent.chosen, Chosen(int(c), int(size[c]))),
                parent.background,
                parent.noise,
            )
            for c in order
            if np.isfinite(gain[c])
        ]

    def _taken(self, parent: Hypothesis) -> list[int]:
        """Candidates that are in already, and other variants of the same effect there (but further mesh lines)."""
        candidates = self.problem.pool.candidates
        keys = {(candidates[c].key, candidates[c].driver) for c in parent.candidates if candidates[c].tried < 3}
        return [
            number
            for number, placed in enumerate(candidates)
            if number in parent.candidates or (placed.key, placed.driver) in keys
        ]

    def resized(self, hypothesis: Hypothesis, background: int) -> Hypothesis:
        """The hypothesis with another size of the geometric background."""
        return weigh(self.problem, hypothesis.chosen, background, hypothesis.noise)

    def without(self, hypothesis: Hypothesis, removed: Iterable[int]) -> Hypothesis:
        """The hypothesis without some candidates."""
        gone = set(removed)
        kept = tuple(c for c in hypothesis.chosen if c.candidate not in gone)
        return weigh(self.problem, kept, hypothesis.background, hypothesis.noise)

    def _pruned(self, hypothesis: Hypothesis) -> Hypothesis:
        """With every effect removed that has stopped paying for itself."""
        while len(hypothesis.chosen) > 1:
            lost = losses(self.problem, hypothesis)
            weakest = int(np.argmin(lost))
            if lost[weakest] > WORTH_TRYING_NATS:
                break
            shorter = self.without(hypothesis, [hypothesis.chosen[weakest].candidate])
            if shorter.value <= hypothesis.value:
                break
            hypothesis = shorter
        return hypothesis

    def _polish(self, hypothesis: Hypothesis) -> Hypothesis:
        """Sizes, background, swaps and merges until nothing betters the hypothesis."""
        for _ in range(6):
            better = self._resized(hypothesis)
            better = max([better, *self._moves(better)], key=_value)
            better = self._pruned(better)
            if better.value <= hypothesis.value + GAIN:
                return better if better.value > hypothesis.value else hypothesis
            hypothesis = better
        return hypothesis

    def _resized(self, hypothesis: Hypothesis) -> Hypothesis:
        """Each effect's and the background's size set to the best one, in turn."""
        best = hypothesis
        for background in range(len(BACKGROUND_SIZES)):
            best = max(best, weigh(self.problem, best.chosen, background, best.noise), key=_value)
        for number, chosen in enumerate(best.chosen):
            for size in range(len(self.problem.sizes)):
                if abs(size - chosen.size) == 1:
                    other = (*best.chosen[:number], Chosen(chosen.candidate, size), *best.chosen[number + 1 :])
                    best = max(best, weigh(self.problem, other, best.background, best.noise), key=_value)
        return best

    def _moves(self, hypothesis: Hypothesis) -> list[Hypothesis]:
        """Swaps of one effect, merges of all effects in one region into one, and additions."""
        moves = self.additions(hypothesis, self.branches)
        groups = [(c.candidate,) for c in hypothesis.chosen] + self._regions(hypothesis)
        for removed in groups:
            moves += self.additions(self.without(hypothesis, removed), self.branches, without=removed)
        return moves

    def _regions(self, hypothesis: Hypothesis) -> list[tuple[int, ...]]:
        by_region: dict[str, list[int]] = {}
        for c in hypothesis.chosen:
            by_region.setdefault(region(self.placed(c.candidate)), []).append(c.candidate)
        return [tuple(members) for members in by_region.values() if len(members) > 1]

    def placed(self, candidate: int) -> Placed:
        """The effect behind a candidate's number."""
        return self.problem.pool.candidates[candidate]


def _value(hypothesis: Hypothesis) -> float:
    return hypothesis.value


def _distinct(hypotheses: list[Hypothesis]) -> list[Hypothesis]:
    seen: set[frozenset[int]] = set()
    kept = []
    for hypothesis in hypotheses:
        if hypothesis.candidates not in seen:
            seen.add(hypothesis.candidates)
            kept.append(hypothesis)
    return kept
