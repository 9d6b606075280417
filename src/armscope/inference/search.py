"""Search over sets of whole effects: several hypotheses kept alive, additions, removals, swaps and merges.

It starts from several sizes of the geometric background, because from a large one a single wrong link is never named
and from a small one an ordinary arm needs a name for every link; the evidence then tells which of them it is.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.fitting.model_space import Pool
from armscope.inference.evidence import (
    BACKGROUND_SIZES,
    FAMILY_SIZES,
    PERFECT,
    SURE_NATS,
    Background,
    Hypothesis,
    Problem,
    SelectedEffect,
    evaluate,
    removal_log_bayes_factors,
    savage_dickey,
)
from armscope.inference.moves import block_removals
from armscope.inference.updates import (
    CandidateGroups,
    ConditionedColumns,
    LowRankUpdate,
    addition_scores,
    approximate_removal_loss,
    best_additions,
    condition_on,
    group_candidates,
    joint_addition_scores,
    low_rank_update,
)
from armscope.physics.backgrounds import FAMILIES
from armscope.physics.effect import Placed
from armscope.physics.elastic import JOINT_COMPLIANCE, UNKNOWN_MASSES

BEAM = 3
BRANCHES = 3
MOST_EFFECTS = 16
STARTS: tuple[Background, ...] = (PERFECT, (2, 0, 0), (4, 0, 0), (3, 2, 2))
"""Backgrounds to start from: a perfect arm, two with geometric tolerances, one with a little of everything."""
WORTH_TRYING_NATS = 2.0
"""A removal that loses more than this at the present noise can't pay when the noise is re-estimated."""
SPECIAL_CASES = 7
"""How many of a curve's special cases are tried in its place."""
SLACK_NATS = 3.0
"""A predicted value that falls short by more than this is not computed."""
LOCALLY_SEARCHED = 2
"""How many ends of the search are polished."""
NAMED_AT_ONCE = 3
LARGE = 150
"""A hypothesis of more columns than this (several free curves) is polished less."""
LOCAL_STEPS, LOCAL_STEPS_OF_LARGE = 6, 2
DRIVE = JOINT_COMPLIANCE.name
GAIN = 1e-3
"""Nats by which a move must better a hypothesis."""


@dataclass(eq=False)
class Search:
    """A search with its settings and the problem it runs on."""

    problem: Problem
    groups: CandidateGroups
    beam: int = BEAM
    branches: int = BRANCHES

    @classmethod
    def on(cls, problem: Problem, beam: int = BEAM, branches: int = BRANCHES) -> Search:
        """A search on a problem."""
        return cls(problem, group_candidates(problem.pool), beam, branches)

    def best(
        self, starts: Sequence[Background] = STARTS, also: Hypothesis | None = None, polished: bool = True
    ) -> Hypothesis:
        """The most probable hypothesis found from all starts, and from one found on other rows."""
        ends = [self._beam_search(self._empty(start)) for start in starts]
        if also is not None:
            ends.append(self._pruned(evaluate(self.problem, also.chosen, also.background, also.noise)))
        ends = _distinct(sorted(ends, key=_value, reverse=True))
        if not polished:
            return ends[0]
        ends = ends[:LOCALLY_SEARCHED]
        return max((self._local_search(end) for end in ends), key=_value)

    def transferred(self, hypothesis: Hypothesis, pool: Pool) -> Hypothesis:
        """A hypothesis on another pool, with the effects that this search's pool has, too."""
        index = {
            (p.key, p.driver, p.variant): n for n, p in enumerate(self.problem.pool.candidates) if not p.refinement
        }
        chosen = []
        for c in hypothesis.chosen:
            placed = pool.candidates[c.candidate]
            if (placed.key, placed.driver, placed.variant) in index:
                chosen.append(SelectedEffect(index[(placed.key, placed.driver, placed.variant)], c.size))
        return evaluate(self.problem, tuple(chosen), hypothesis.background, hypothesis.noise)

    def empty(self) -> Hypothesis:
        """The best hypothesis without any named effect."""
        return self._with_best_sizes(self.perfect())

    def perfect(self) -> Hypothesis:
        """Nothing but frames and noise."""
        return self._empty(PERFECT)

    def _empty(self, background: Background) -> Hypothesis:
        start = max(self.problem.least_noise, float(np.sqrt(self.problem.equations.yy / self.problem.n)) * 1e-2)
        return evaluate(self.problem, (), background, max(start, 1e-4))

    def _beam_search(self, start: Hypothesis) -> Hypothesis:
        """Beam search by additions and removals."""
        alive, best = [start], start
        seen = {start.candidates}
        for _ in range(MOST_EFFECTS):
            children: list[Hypothesis] = []
            for parent in alive:
                for child in self.additions(parent, self.branches, least=-SLACK_NATS):
                    if child.candidates not in seen:
                        seen.add(child.candidates)
                        children.append(self._pruned(child))
            children = _distinct(sorted(children, key=_value, reverse=True))[: self.beam]
            if not children or children[0].log_posterior <= best.log_posterior + GAIN:
                break
            best, alive = children[0], children
        return best

    def additions(
        self,
        parent: Hypothesis | LowRankUpdate,
        count: int,
        without: Iterable[int] = (),
        least: float = -np.inf,
        remaining: ConditionedColumns | None = None,
    ) -> list[Hypothesis]:
        """The ``count`` most promising hypotheses with one effect more, not ``without``, that gain more than ``least``.

        A curve takes its special cases' place. ``remaining`` is what the parent leaves of the columns that compete.
        """
        asked = np.ones(len(self.problem.prior_costs), dtype=np.bool_)
        excludes = self.problem.pool.excludes
        for member in parent.candidates:
            asked[member] = False
            asked[[c for c in excludes[member] if not self._generalises(c, member)]] = False
        asked[list(without)] = False
        asked[[n for n, needed in self.problem.pool.requires.items() if not needed & parent.candidates]] = False
        by_size = addition_scores(self.problem, self.groups, parent, asked, remaining)
        gain, size = by_size.max(axis=0), by_size.argmax(axis=0)
        order = np.argsort(-gain)[:count]
        return [self._with(parent, SelectedEffect(int(c), int(size[c]))) for c in order if gain[c] > least]

    def _generalises(self, candidate: int, member: int) -> bool:
        """Whether a candidate is a free curve that contains a member."""
        return self.placed(candidate).parametrisation == "curve" and self.placed(member).parametrisation != "curve"

    def _with(self, parent: Hypothesis | LowRankUpdate, added: SelectedEffect) -> Hypothesis:
        excluded = self.problem.pool.excludes[added.candidate]
        kept = tuple(c for c in parent.chosen if c.candidate not in excluded)
        return evaluate(self.problem, (*kept, added), parent.background, parent.noise)

    def with_background(self, hypothesis: Hypothesis, background: Background) -> Hypothesis:
        """The hypothesis with another background."""
        return evaluate(self.problem, hypothesis.chosen, background, hypothesis.noise)

    def without(self, hypothesis: Hypothesis, removed: Iterable[int]) -> Hypothesis:
        """The hypothesis without some candidates."""
        return evaluate(self.problem, self._kept(hypothesis, removed), hypothesis.background, hypothesis.noise)

    def _kept(self, hypothesis: Hypothesis, removed: Iterable[int]) -> tuple[SelectedEffect, ...]:
        """The effects without some candidates, and without what rested on them."""
        left = hypothesis.candidates - set(removed)
        left = frozenset(c for c in left if self.problem.pool.requirements_met(left & {c} | (left - self._dependent())))
        return tuple(c for c in hypothesis.chosen if c.candidate in left)

    def _dependent(self) -> frozenset[int]:
        return frozenset(self.problem.pool.requires)

    def _pruned(self, hypothesis: Hypothesis) -> Hypothesis:
        """With every effect removed that has stopped paying for itself."""
        while len(hypothesis.chosen) > 1:
            lost = removal_log_bayes_factors(self.problem, hypothesis)
            weakest = int(np.argmin(lost))
            if lost[weakest] > WORTH_TRYING_NATS:
                break
            shorter = self.without(hypothesis, [hypothesis.chosen[weakest].candidate])
            if shorter.log_posterior <= hypothesis.log_posterior:
                break
            hypothesis = shorter
        return hypothesis

    def _local_search(self, hypothesis: Hypothesis) -> Hypothesis:
        """Sizes, background, swaps and merges until nothing betters the hypothesis."""
        for _ in range(LOCAL_STEPS if len(hypothesis.columns) < LARGE else LOCAL_STEPS_OF_LARGE):
            better = self._with_best_sizes(hypothesis)
            better = max([better, *self._neighbours(better)], key=_value)
            better = self._pruned(better)
            if better.log_posterior <= hypothesis.log_posterior + GAIN:
                return better if better.log_posterior > hypothesis.log_posterior else hypothesis
            hypothesis = better
        return hypothesis

    def _with_best_sizes(self, hypothesis: Hypothesis) -> Hypothesis:
        """Each effect's and each background's size set to the best one, in turn."""
        best = hypothesis
        for family, columns in enumerate(self.problem.pool.background):
            for size in range(len(BACKGROUND_SIZES) if family == 0 else FAMILY_SIZES):
                background = (*best.background[:family], size, *best.background[family + 1 :])
                if len(columns) and background != best.background:
                    best = self._better(best, best.chosen, background)
        for number, chosen in enumerate(best.chosen):
            for size in range(len(self.problem.sizes)):
                if abs(size - chosen.size) == 1:
                    other = (*best.chosen[:number], SelectedEffect(chosen.candidate, size), *best.chosen[number + 1 :])
                    best = self._better(best, other, best.background)
        return best

    def _better(self, best: Hypothesis, chosen: tuple[SelectedEffect, ...], background: Background) -> Hypothesis:
        """The better of a hypothesis and another one; a large one is weighed only if it promises to be."""
        promised = low_rank_update(self.problem, best, chosen, background) if len(best.columns) > LARGE else None
        if promised is not None and promised.log_posterior < best.log_posterior - SLACK_NATS:
            return best
        return max(best, evaluate(self.problem, chosen, background, best.noise), key=_value)

    def _neighbours(self, hypothesis: Hypothesis) -> list[Hypothesis]:
        """Additions; swaps of one effect for another; merges of all effects in one region; splits of curves."""
        whole = condition_on(self.problem, self.groups.competing, hypothesis)
        moves = self.additions(hypothesis, self.branches, least=-SLACK_NATS, remaining=whole)
        for c in hypothesis.chosen:
            if self.placed(c.candidate).parametrisation == "curve":
                moves += self._split(hypothesis, c)
        for removed in block_removals(self.problem.pool, [c.candidate for c in hypothesis.chosen]):
            # at the noise as it is: without what is taken out the noise would be larger, and fine detail worth nothing
            rest = low_rank_update(self.problem, hypothesis, self._kept(hypothesis, removed), hypothesis.background)
            assert rest is not None
            least = hypothesis.log_posterior - rest.log_posterior - SLACK_NATS
            moves += self.additions(rest, self.branches, removed, least, rest.conditioned(whole))
        return [
            *moves,
            *self._from_background(hypothesis),
            *self._into_background(hypothesis),
            *self._trusting(hypothesis),
        ]

    def _trusting(self, hypothesis: Hypothesis) -> list[Hypothesis]:
        """Stated masses and one wrong payload in place of masses that are unknown to every joint by itself."""
        doubting = [c for c in hypothesis.chosen if self.placed(c.candidate).variant == UNKNOWN_MASSES]
        resting = self.problem.pool.requires
        if not doubting or not resting:
            return []
        stated = {p.key: n for n, p in enumerate(self.problem.pool.candidates) if p.name == DRIVE and not p.variant}
        trusting = [
            SelectedEffect(stated[key], c.size) for c in doubting if (key := self.placed(c.candidate).key) in stated
        ]
        kept = [c for c in hypothesis.chosen if c not in doubting and c.candidate not in resting]
        return [
            evaluate(
                self.problem,
                (*kept, *trusting, SelectedEffect(payload, size)),
                hypothesis.background,
                hypothesis.noise,
            )
            for payload in resting
            for size in range(1, len(self.problem.sizes) - 1)
        ]

    def _from_background(self, hypothesis: Hypothesis) -> list[Hypothesis]:
        """Smaller geometric tolerances everywhere, and names for what then stands out."""
        moves = []
        for size in range(hypothesis.background[0]):
            smaller = evaluate(self.problem, hypothesis.chosen, (size, *hypothesis.background[1:]), hypothesis.noise)
            for _ in range(NAMED_AT_ONCE):
                larger = self.additions(smaller, 1, least=0.0)
                if not larger:
                    break
                smaller = larger[0]
            moves.append(smaller)
        return moves

    def _into_background(self, hypothesis: Hypothesis) -> list[Hypothesis]:
        """A family's background in place of all its names: one tilt may pass for what gives way everywhere."""
        moves = []
        for number, family in enumerate(FAMILIES[1:], start=1):
            members = [c.candidate for c in hypothesis.chosen if self.placed(c.candidate).family == family]
            if len(members) > 1 and len(self.problem.pool.background[number]):
                rest = self.without(hypothesis, members)
                for size in range(1, FAMILY_SIZES):
                    background = (*rest.background[:number], size, *rest.background[number + 1 :])
                    moves.append(self.with_background(rest, background))
        return moves

    def _split(self, hypothesis: Hypothesis, curve: SelectedEffect) -> list[Hypothesis]:
        """A curve taken apart into two or three of the special cases that it contains, each as large as the curve."""
        rest = self.without(hypothesis, [curve.candidate])
        special = [c for c in self.problem.pool.excludes[curve.candidate] if self.placed(c).parametrisation != "curve"]
        if len(special) < 2:
            return []
        gain, _ = best_additions(self.problem, self.groups, rest)
        likely = sorted(special, key=lambda c: -gain[c])[:SPECIAL_CASES]
        sets = [
            tuple(SelectedEffect(c, curve.size) for c in members)
            for count in (2, 3)
            for members in itertools.combinations(likely, count)
            if not any(b in self.problem.pool.excludes[a] for a, b in itertools.combinations(members, 2))
        ]
        if not sets:
            return []
        promised = joint_addition_scores(self.problem, rest, sets)
        best = int(np.argmax(promised))
        if rest.log_posterior + promised[best] < hypothesis.log_posterior - SLACK_NATS:
            return []
        return [self._pruned(evaluate(self.problem, (*rest.chosen, *sets[best]), rest.background, rest.noise))]

    def refined(self, hypothesis: Hypothesis) -> Hypothesis:
        """With the finer form of a curve in its place wherever the evidence is for it."""
        candidates = enumerate(self.problem.pool.candidates)
        fine = {p.key: n for n, p in candidates if p.refinement and p.variant == "angle"}
        for number, c in enumerate(hypothesis.chosen):
            placed = self.placed(c.candidate)
            if placed.key in fine and placed.variant == "angle" and not placed.refinement:
                finer = SelectedEffect(fine[placed.key], c.size)
                chosen = (*hypothesis.chosen[:number], finer, *hypothesis.chosen[number + 1 :])
                other = evaluate(self.problem, chosen, hypothesis.background, hypothesis.noise)
                hypothesis = max(hypothesis, other, key=_value)
        return self._pruned(hypothesis)

    def coarsened(self, hypothesis: Hypothesis) -> Hypothesis:
        """With the coarse form of every fine curve in its place."""
        coarse = {
            p.key: n for n, p in enumerate(self.problem.pool.candidates) if p.variant == "angle" and not p.refinement
        }
        chosen = tuple(
            SelectedEffect(coarse[self.placed(c.candidate).key], c.size) if self.placed(c.candidate).refinement else c
            for c in hypothesis.chosen
        )
        return (
            hypothesis
            if chosen == hypothesis.chosen
            else evaluate(self.problem, chosen, hypothesis.background, hypothesis.noise)
        )

    def in_background(self, hypothesis: Hypothesis, candidate: int) -> bool:
        """Whether a background of the hypothesis holds an effect, too."""
        columns = set(self.problem.pool.columns[candidate])
        return any(
            size and columns <= set(family)
            for family, size in zip(self.problem.pool.background, hypothesis.background, strict=True)
        )

    def log_odds(self, hypothesis: Hypothesis, candidate: int) -> float:
        """Log odds, nats, of an effect against nothing in its place; a background that holds it too goes with it."""
        if not self.in_background(hypothesis, candidate):
            return hypothesis.log_posterior - self.without(hypothesis, [candidate]).log_posterior + SURE_NATS
        columns = self.problem.pool.columns[candidate]
        lost = float(savage_dickey(self.problem, hypothesis, [columns])[0])
        # the noise would grow to take it up
        n = self.problem.n
        return n / 2 * float(np.log1p(2 * max(lost, 0.0) / n)) - float(self.problem.prior_costs[candidate]) + SURE_NATS

    def weakest(self, hypothesis: Hypothesis) -> SelectedEffect | None:
        """The chosen effect that is least worth its price, if one is not."""
        own = [(n, c.candidate) for n, c in enumerate(hypothesis.chosen) if not c.nested]
        worths = [(self.log_odds(hypothesis, c), n) for n, c in own if self._doubtful(hypothesis, c)]
        worth, weakest = min(worths, default=(np.inf, 0))
        return hypothesis.chosen[weakest] if worth < SURE_NATS else None

    def _doubtful(self, hypothesis: Hypothesis, candidate: int) -> bool:
        """Whether an effect may not be worth its price; of small hypotheses that is weighed anyway."""
        if len(hypothesis.columns) <= LARGE:
            return True
        kept = self._kept(hypothesis, [candidate])
        return (
            self.in_background(hypothesis, candidate)
            or approximate_removal_loss(self.problem, hypothesis, kept) < SLACK_NATS
        )

    def pruned_to_worthwhile(self, hypothesis: Hypothesis) -> Hypothesis:
        """Without the names that are not worth their price, the weakest first."""
        while (weakest := self.weakest(hypothesis)) is not None:
            hypothesis = self.without(hypothesis, [weakest.candidate])
        return hypothesis

    def placed(self, candidate: int) -> Placed:
        """The effect behind a candidate's number."""
        return self.problem.pool.candidates[candidate]


def _value(hypothesis: Hypothesis) -> float:
    return hypothesis.log_posterior


def _distinct(hypotheses: list[Hypothesis]) -> list[Hypothesis]:
    seen: set[frozenset[int]] = set()
    kept = []
    for hypothesis in hypotheses:
        if hypothesis.candidates not in seen:
            seen.add(hypothesis.candidates)
            kept.append(hypothesis)
    return kept
