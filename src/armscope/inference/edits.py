"""A hypothesis with something added, taken out or resized: the steps of which a search is made."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Self, TypeVar

import numpy as np

from armscope.core.types import Indices
from armscope.inference.additions import AskedAdditions, CandidateGroups, addition_scores, background_scores
from armscope.inference.conditioning import ConditionedColumns, LowRankUpdate, approximate_removal_loss, low_rank_update
from armscope.inference.constants import BUDGET, PRIORS
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.linear_algebra import profiled_loss
from armscope.inference.model_space import BackgroundSizes, Candidate, ModelSpace
from armscope.inference.problem import Problem, SelectedEffect
from armscope.inference.removals import removal_log_bayes_factors, savage_dickey

T = TypeVar("T")


@dataclass(eq=False)
class Edits:
    """Steps from one hypothesis to others on one problem."""

    problem: Problem  # the normal equations and priors
    groups: CandidateGroups  # the candidates that compete
    branches: int = BUDGET.branches  # how many of the most promising additions are evaluated
    # log posteriors of the hypotheses whose sizes were varied, by effects and background
    resized: dict[tuple[frozenset[SelectedEffect], BackgroundSizes], float] = field(default_factory=dict)

    @property
    def space(self) -> ModelSpace:
        """What may take part."""
        return self.problem.space

    def candidate(self, number: int) -> Candidate:
        """The candidate behind a number."""
        return self.space.candidates[number]

    def evaluated(
        self,
        chosen: Iterable[SelectedEffect],
        like: Hypothesis | LowRankUpdate,
        background: BackgroundSizes | None = None,
    ) -> Hypothesis:
        """Effects with a hypothesis' background, or another one, from its noise on.

        Args:
            chosen: the effects, with their sizes.
            like: whose background and noise are taken.
            background: size of each family's background; None takes that of ``like``.

        Returns:
            The hypothesis.
        """
        whole = like if isinstance(like, Hypothesis) else like.whole
        background = like.background if background is None else background
        return evaluate(self.problem, tuple(chosen), background, like.noise, whole)

    def holding(self, columns: Indices) -> Self:
        """The same steps where no background holds some columns."""
        return replace(self, problem=self.problem.holding(columns), resized={})

    def perfect(self) -> Hypothesis:
        """Nothing but frames and noise."""
        return self.start(self.space.no_background)

    def start(self, background: BackgroundSizes) -> Hypothesis:
        """A background and no effect."""
        noise = max(self.problem.least_noise, float(np.sqrt(self.problem.equations.yy / self.problem.n)) * 1e-2)
        return evaluate(self.problem, (), background, max(noise, 1e-4))

    def additions(
        self,
        parent: Hypothesis | LowRankUpdate,
        count: int,
        without: Iterable[int] = (),
        least: float = -np.inf,
        remaining: ConditionedColumns | None = None,
    ) -> list[Hypothesis]:
        """The most promising hypotheses with one effect more; a curve takes its special cases' place.

        Args:
            parent: to which effects are added.
            count: how many.
            without: candidates that are not asked for.
            least: they must promise to gain more than this.
            remaining: what the parent leaves of the columns that compete.

        Returns:
            Hypotheses, the most promising first.
        """
        asked = np.ones(len(self.space.candidates), dtype=np.bool_)
        for member in parent.candidates:
            asked[member] = False
            asked[[c for c in self.candidate(member).excludes if not self._generalises(c, member)]] = False
        asked[list(without)] = False
        asked[[n for n, needed in self.space.requires.items() if not needed & parent.candidates]] = False
        wanted = AskedAdditions(asked, count, least)
        by_size = addition_scores(self.problem, self.groups, parent, wanted, remaining)
        gain, size = by_size.max(axis=0), by_size.argmax(axis=0)
        order = np.argsort(-gain)[:count]
        return [self._with(parent, SelectedEffect(int(c), int(size[c]))) for c in order if gain[c] > least]

    def unpaid(self, hypothesis: Hypothesis) -> Hypothesis:
        """The hypothesis with its last name as one out of a background, which pays nothing."""
        *kept, last = hypothesis.chosen
        return self.evaluated((*kept, replace(last, nested=True)), hypothesis)

    def _generalises(self, candidate: int, member: int) -> bool:
        """Whether a candidate is a free curve that contains a member."""
        return self.candidate(candidate).is_curve and not self.candidate(member).is_curve

    def _with(self, parent: Hypothesis | LowRankUpdate, added: SelectedEffect) -> Hypothesis:
        excluded = self.candidate(added.candidate).excludes
        return self.evaluated((*(c for c in parent.chosen if c.candidate not in excluded), added), parent)

    def with_background(self, hypothesis: Hypothesis, family: int, size: int) -> Hypothesis:
        """The hypothesis with another size of one family's background.

        Args:
            hypothesis: from which it departs.
            family: number of the family.
            size: index of its size.

        Returns:
            The hypothesis.
        """
        return self.evaluated(hypothesis.chosen, hypothesis, replaced(hypothesis.background, family, size))

    def without(self, hypothesis: Hypothesis, removed: Iterable[int]) -> Hypothesis:
        """The hypothesis without some candidates."""
        return self.evaluated(self.kept(hypothesis, removed), hypothesis)

    def kept(self, hypothesis: Hypothesis, removed: Iterable[int]) -> tuple[SelectedEffect, ...]:
        """The effects without some candidates, and without what required them."""
        left = hypothesis.candidates - set(removed)
        independent = left - self.space.requires.keys()
        left = frozenset(c for c in left if self.space.requirements_met(left & {c} | independent))
        return tuple(c for c in hypothesis.chosen if c.candidate in left)

    def pruned(self, hypothesis: Hypothesis) -> Hypothesis:
        """With every effect removed that has stopped paying for itself."""
        while len(hypothesis.chosen) > 1:
            lost = removal_log_bayes_factors(self.problem, hypothesis)
            weakest = int(np.argmin(lost))
            if lost[weakest] > BUDGET.slack_nats:
                break
            shorter = self.without(hypothesis, [hypothesis.chosen[weakest].candidate])
            if shorter.log_posterior <= hypothesis.log_posterior:
                break
            hypothesis = shorter
        return hypothesis

    def with_best_sizes(self, hypothesis: Hypothesis) -> Hypothesis:
        """Each effect's and each background's size set to the best one, in turn."""
        best = hypothesis
        for number, family in enumerate(self.space.families):
            for size in self._other_sizes(best, number) if len(family.columns) else ():
                best = self._better(best, best.chosen, replaced(best.background, number, size))
        for number, chosen in enumerate(best.chosen):
            for size in range(len(self.problem.sizes)):
                if abs(size - chosen.size) == 1:
                    other = replaced(best.chosen, number, SelectedEffect(chosen.candidate, size))
                    best = self._better(best, other, best.background)
        return best

    def _other_sizes(self, hypothesis: Hypothesis, number: int) -> Iterable[int]:
        """Sizes of a background that may be better: from none those that promise to be, else the next ones.

        The next ones are enough, since evidence has one summit over the sizes.
        """
        now, most = hypothesis.background[number], self.space.families[number].sizes - 1
        if now:
            return {0, now - 1, min(now + 1, most)} - {now}
        promised = background_scores(self.problem, hypothesis, number)
        return (1 + np.flatnonzero(promised > -BUDGET.slack_nats)).tolist()

    def _better(self, best: Hypothesis, chosen: tuple[SelectedEffect, ...], background: BackgroundSizes) -> Hypothesis:
        """The better of a hypothesis and another one; a large one is evaluated only if it promises to be."""
        form = frozenset(chosen), background
        if self.resized.get(form, np.inf) <= best.log_posterior:
            return best
        promised = low_rank_update(self.problem, best, chosen, background) if len(best.columns) > BUDGET.large else None
        if promised is not None and promised.log_posterior < best.log_posterior - BUDGET.slack_nats:
            return best
        other = self.evaluated(chosen, best, background)
        self.resized[form] = other.log_posterior
        return max(best, other, key=by_posterior)

    def transferred(self, hypothesis: Hypothesis, space: ModelSpace) -> Hypothesis:
        """A hypothesis on another space, with the effects that this problem's space has, too."""
        numbers = ((self.space.by_identity.get(space.candidates[c.candidate].identity), c) for c in hypothesis.chosen)
        return self.evaluated((SelectedEffect(n, c.size) for n, c in numbers if n is not None), hypothesis)

    def refined(self, hypothesis: Hypothesis) -> Hypothesis:
        """With the finer form of a candidate in its place wherever the evidence is for it."""
        for number, c in enumerate(hypothesis.chosen):
            if c.candidate in self.space.finer:
                chosen = replaced(hypothesis.chosen, number, SelectedEffect(self.space.finer[c.candidate], c.size))
                hypothesis = max(hypothesis, self.evaluated(chosen, hypothesis), key=by_posterior)
        return self.pruned(hypothesis)

    def coarsened(self, hypothesis: Hypothesis) -> Hypothesis:
        """With the coarse form of every finer one in its place."""
        coarse = [(self.candidate(c.candidate).refines, c) for c in hypothesis.chosen]
        chosen = tuple(c if number is None else SelectedEffect(number, c.size) for number, c in coarse)
        return hypothesis if chosen == hypothesis.chosen else self.evaluated(chosen, hypothesis)

    def in_background(self, hypothesis: Hypothesis, candidate: int) -> bool:
        """Whether a background of the hypothesis holds a candidate, too."""
        families = zip(self.space.families, hypothesis.background, strict=True)
        return any(size and self.candidate(candidate).is_in(family.columns) for family, size in families)

    def log_odds(self, hypothesis: Hypothesis, candidate: int) -> float:
        """Log odds, nats, of an effect against nothing in its place; a background that holds it too goes with it."""
        if not self.in_background(hypothesis, candidate):
            return hypothesis.log_posterior - self.without(hypothesis, [candidate]).log_posterior + PRIORS.sure_nats
        lost = savage_dickey(hypothesis, self.candidate(candidate).held)
        return profiled_loss(lost, self.problem.n) - float(self.problem.prior_costs[candidate]) + PRIORS.sure_nats

    def weakest(self, hypothesis: Hypothesis) -> SelectedEffect | None:
        """The chosen effect that is least worth its price, if one is not."""
        own = [(n, c.candidate) for n, c in enumerate(hypothesis.chosen) if not c.nested]
        odds = [(self.log_odds(hypothesis, c), n) for n, c in own if self._doubtful(hypothesis, c)]
        least, weakest = min(odds, default=(np.inf, 0))
        return hypothesis.chosen[weakest] if least < PRIORS.sure_nats else None

    def _doubtful(self, hypothesis: Hypothesis, candidate: int) -> bool:
        """Whether an effect may not be worth its price; of small hypotheses that is evaluated anyway."""
        if len(hypothesis.columns) <= BUDGET.large or self.in_background(hypothesis, candidate):
            return True
        return (
            approximate_removal_loss(self.problem, hypothesis, self.kept(hypothesis, [candidate])) < BUDGET.slack_nats
        )


def replaced(members: tuple[T, ...], number: int, member: T) -> tuple[T, ...]:
    """A tuple with another member in one place.

    Args:
        members: the tuple.
        number: of the place, from 0.
        member: what comes there.

    Returns:
        The new tuple.
    """
    return (*members[:number], member, *members[number + 1 :])


def by_posterior(hypothesis: Hypothesis) -> float:
    """What hypotheses are ordered by."""
    return hypothesis.log_posterior
