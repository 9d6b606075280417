"""Search over sets of whole effects: several hypotheses kept alive, then steps to neighbours until nothing is better.

It starts from several sizes of the backgrounds, because from a large one a single wrong value is never named and from a
small one what is a little wrong everywhere needs a name for every value; the evidence then tells which of them it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from armscope.inference.additions import group_candidates
from armscope.inference.constants import BUDGET
from armscope.inference.edits import Edits, by_posterior
from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.neighbours import into_own_family, neighbours
from armscope.inference.problem import Problem


@dataclass(eq=False)
class Search(Edits):
    """A search on one problem; ``beam`` hypotheses are kept alive."""

    beam: int = BUDGET.beam

    @classmethod
    def on(cls, problem: Problem, beam: int = BUDGET.beam, branches: int = BUDGET.branches) -> Search:
        """A search on a problem.

        Args:
            problem: the normal equations and priors.
            beam: hypotheses that go on after every round.
            branches: additions tried from each.

        Returns:
            The search.
        """
        return cls(problem, group_candidates(problem), branches, beam=beam)

    def best(
        self,
        starts: Sequence[BackgroundSizes] | None = None,
        also: Hypothesis | None = None,
        local: bool = True,
    ) -> Hypothesis:
        """The most probable hypothesis found.

        Args:
            starts: backgrounds to start from; the space's where not given.
            also: one found on other rows, from which it starts, too.
            local: whether the ends of the beam search are searched around.

        Returns:
            The hypothesis.
        """
        ends = [self._beam_search(self.start(start)) for start in (self.space.starts if starts is None else starts)]
        if also is not None:
            ends.append(self.pruned(self.evaluated(also.chosen, also)))
        ends = _distinct(ends)
        if not local:
            return ends[0]
        best = max((self._local_search(end) for end in ends[: BUDGET.locally_searched]), key=by_posterior)
        # from where it ends: on the way there, a background that stands for some names hides what else does
        other = max(into_own_family(self, best), key=by_posterior, default=best)
        if other is best or other.log_posterior < best.log_posterior - BUDGET.slack_nats:
            return best
        return max(best, self._local_search(other), key=by_posterior)

    def empty(self) -> Hypothesis:
        """The best hypothesis without any named effect."""
        return self.with_best_sizes(self.perfect())

    def _beam_search(self, start: Hypothesis) -> Hypothesis:
        """Additions and removals, the best few hypotheses kept alive."""
        alive, best = [start], start
        seen = {start.candidates}
        while True:  # ends: every round betters the best by something, and what can be said is finite
            children: list[Hypothesis] = []
            for parent in alive:
                for child in self.additions(parent, self.branches, least=-BUDGET.slack_nats):
                    if child.candidates not in seen:
                        seen.add(child.candidates)
                        children.append(self.pruned(child))
            alive = _distinct(children)[: self.beam]
            if not alive or alive[0].log_posterior <= best.log_posterior + BUDGET.gain:
                return best
            best = alive[0]

    def _local_search(self, hypothesis: Hypothesis) -> Hypothesis:
        """Sizes, backgrounds and neighbours until nothing betters the hypothesis."""
        searched = None
        for _ in range(BUDGET.local_steps if len(hypothesis.columns) < BUDGET.large else BUDGET.local_steps_of_large):
            better = self.with_best_sizes(hypothesis)
            if better is searched:  # none of its neighbours was better
                break
            searched = better
            better = max([better, *neighbours(self, better)], key=by_posterior)
            better = self.pruned(better)
            if better.log_posterior <= hypothesis.log_posterior + BUDGET.gain:
                return better if better.log_posterior > hypothesis.log_posterior else hypothesis
            hypothesis = better
        return hypothesis


def _distinct(hypotheses: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The best hypothesis of every set of effects, in order."""
    best: dict[frozenset[int], Hypothesis] = {}
    for hypothesis in sorted(hypotheses, key=by_posterior, reverse=True):
        best.setdefault(hypothesis.candidates, hypothesis)
    return list(best.values())
