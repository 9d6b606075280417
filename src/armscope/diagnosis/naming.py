"""What a found hypothesis is called: names out of its backgrounds, and lines out of its curves.

Naming changes neither the fit nor the search: a background explains its members with or without their names, and a
curve contains its line. So names given here pay no price of the library.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.curve_shapes import DRIVE, rest_of, straightened, with_main_shapes, zero_without_load
from armscope.diagnosis.drives_first import drives_first
from armscope.diagnosis.model_space import EffectSpace
from armscope.diagnosis.plain_geometry import as_plain_geometry
from armscope.inference.constants import PRIORS
from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.linear_algebra import profiled_loss
from armscope.inference.problem import Problem, SelectedEffect
from armscope.inference.removals import savage_dickey
from armscope.physics.soft_start import SOFT_START

GIVES_NATS, GIVES = PRIORS.sure_nats, 0.1
"""A joint's drive in an elastic background is named at odds of 20 to 1, if it is worth this share of the RMS at all: of
what gives way, drives do first and most."""


def named(edits: Edits, space: EffectSpace, hypothesis: Hypothesis) -> Hypothesis:
    """The hypothesis with lines told as compliances, with the members of backgrounds named that stand out.

    What then is not worth its name any more is left to the background, in which others may stand out.

    Args:
        edits: of the search.
        space: which effect each candidate is.
        hypothesis: that the search found.

    Returns:
        The hypothesis with those names.
    """
    hypothesis = drives_first(edits, hypothesis)
    while True:
        told = with_main_shapes(edits, straightened(edits.problem, space, hypothesis))
        promoted = _better_placed(edits, _promoted(edits.problem, told))
        weakest = edits.weakest(promoted)
        if weakest is None:
            return as_plain_geometry(edits, promoted)
        hypothesis = _without(edits, hypothesis, promoted, weakest)


def _without(edits: Edits, hypothesis: Hypothesis, promoted: Hypothesis, weakest: SelectedEffect) -> Hypothesis:
    """The hypothesis without an effect; what it was for the most part, and was named as, takes a curve's place.

    A background need not hold it: it may be a hundred times what the others are.
    """
    others = [c for c in hypothesis.chosen if c.candidate != weakest.candidate]
    laws = [
        replace(c, nested=False)
        for c in promoted.chosen
        if c.nested and weakest.candidate in rest_of(edits.problem, promoted, c.candidate)
    ]
    if not laws:
        return edits.without(hypothesis, [weakest.candidate])
    return edits.evaluated((*others, *laws), hypothesis)


def _promoted(problem: Problem, hypothesis: Hypothesis) -> Hypothesis:
    """With the members of a background named that stand out by themselves.

    In an arm that is a little wrong everywhere, the place that is so most deserves its name, although the background
    explains it, too: its evidence is what is lost when it alone is held right. Drives are weighed as they will be
    fitted: as large as they come, not held small by the background.
    """
    unnamed = [n for n in _unnamed(problem, hypothesis) if problem.space.candidates[n].variant != SOFT_START]
    left, beside = _left_by_free_backgrounds(problem, hypothesis), _left_by_names(problem, hypothesis)
    unnamed = [n for n in unnamed if not _is_of_its_curve(problem, hypothesis, n, beside)]
    drives = [number for number in unnamed if problem.space.candidates[number].kind == DRIVE]
    worth = {n: beside if problem.is_free(n) else left for n in unnamed if n not in drives}
    added = _standing_out(problem, hypothesis, worth)
    if drives:
        free = _with_names(problem, hypothesis, drives, [problem.mismatch] * len(drives))
        added += [d for d in drives if _size(problem, free, d) > GIVES * left and _lost(problem, free, d) > GIVES_NATS]
    while True:
        sizes = [_size(problem, hypothesis, number) for number in added]
        promoted = _with_names(problem, hypothesis, added, sizes)
        # several that stand in for each other stand out only as long as the others are held small
        lost = {d: _lost(problem, promoted, d) for d in added if d in drives}
        weakest = min(lost, key=lambda d: lost[d], default=None)
        if weakest is None or lost[weakest] > GIVES_NATS:
            return _with_soft_starts(problem, promoted, left)
        added.remove(weakest)


def _is_of_its_curve(problem: Problem, hypothesis: Hypothesis, number: int, left: float) -> bool:
    """Whether a zero may be a part of the curve of its joint's load: without a load it does not stand out."""
    at_rest = zero_without_load(problem, hypothesis, number)
    if at_rest is None:
        return False
    zero, error = np.abs(at_rest)
    return bool(zero < NAMING.stands_out * left or (zero / error) ** 2 / 2 < NAMING.stands_out_nats)


def _with_soft_starts(problem: Problem, hypothesis: Hypothesis, left: float) -> Hypothesis:
    """With the drives named that give way most of all under small loads, where they have no name yet."""
    unnamed = (n for n in _unnamed(problem, hypothesis) if problem.space.candidates[n].variant == SOFT_START)
    soft = _standing_out(problem, hypothesis, dict.fromkeys(unnamed, left))
    return _with_names(problem, hypothesis, soft, [_size(problem, hypothesis, n) for n in soft]) if soft else hypothesis


def _standing_out(problem: Problem, hypothesis: Hypothesis, left: Mapping[int, float]) -> list[int]:
    """Members of backgrounds that are worth a name, where the RMS without each is ``left``, mm.

    Each is measured by those that have no name: beside one that is off by far, a second would look usual.
    """
    asked = [
        number
        for number, rms in left.items()
        if _size(problem, hypothesis, number) > NAMING.stands_out * rms
        and _lost(problem, hypothesis, number) > NAMING.stands_out_nats
    ]
    named = {column for c in hypothesis.chosen for column in problem.space.candidates[c.candidate].columns}
    found: list[int] = []
    while True:
        times = {n: _beyond_family(problem, hypothesis, n, named) for n in asked if n not in found}
        farthest = max(times, key=lambda n: times[n], default=None)
        if farthest is None or times[farthest] <= NAMING.beyond_family:
            return sorted(found)
        found.append(farthest)
        named |= set(problem.space.candidates[farthest].columns)


def _better_placed(edits: Edits, hypothesis: Hypothesis) -> Hypothesis:
    """With what else gives way named instead of a drive, where it alone explains the rows better at odds of 20 to 1."""
    for drive in [c for c in hypothesis.chosen if c.nested and edits.candidate(c.candidate).kind == DRIVE]:
        if not edits.in_background(hypothesis, drive.candidate):
            continue
        instead = _instead(edits, hypothesis, drive.candidate)
        if instead is not None:
            others = tuple(c for c in hypothesis.chosen if c is not drive)
            hypothesis = edits.evaluated((*others, instead), hypothesis)
    return hypothesis


def _instead(edits: Edits, hypothesis: Hypothesis, number: int) -> SelectedEffect | None:
    """The member of a name's family that explains the rows better if it stands out and the name is held right."""
    columns = edits.candidate(number).columns
    family = next(f for f in edits.space.families if set(columns) <= set(f.columns))
    members = {n for n in _unnamed(edits.problem, hypothesis) if set(edits.candidate(n).columns) <= set(family.columns)}
    held = edits.holding(columns)
    base = held.without(hypothesis, [number])
    others = set(range(len(edits.space.candidates))) - members
    for added in held.additions(base, 1, others):
        other = held.unpaid(added)
        if other.log_posterior > hypothesis.log_posterior + GIVES_NATS:
            return other.chosen[-1]
    return None


def _with_names(problem: Problem, hypothesis: Hypothesis, names: Sequence[int], rms: Sequence[float]) -> Hypothesis:
    added = [SelectedEffect(n, problem.nearest_size(size), nested=True) for n, size in zip(names, rms, strict=True)]
    return evaluate(problem, (*hypothesis.chosen, *added), hypothesis.background, hypothesis.noise, hypothesis)


def _size(problem: Problem, hypothesis: Hypothesis, number: int) -> float:
    """RMS at the tool of a candidate's columns, one by one, mm."""
    return float(np.linalg.norm(hypothesis.means(problem.space.candidates[number].columns)))


def _left_by_free_backgrounds(problem: Problem, hypothesis: Hypothesis) -> float:
    """RMS, mm, of what a calibration of the geometry would leave: springs and gears are measured by it."""
    families = zip(hypothesis.background, problem.space.families, strict=True)
    background = tuple(0 if family.is_priced else size for size, family in families)
    return evaluate(problem, (), background, problem.mismatch).noise


def _left_by_names(problem: Problem, hypothesis: Hypothesis) -> float:
    """RMS, mm, of what the names by themselves leave: geometry is measured by it, lest one cause hide another."""
    return evaluate(problem, hypothesis.chosen, problem.space.no_background, problem.mismatch).noise


def _beyond_family(problem: Problem, hypothesis: Hypothesis, number: int, named: Collection[int]) -> float:
    """How many times larger a candidate's largest value is than the usual one of its family's columns without a name.

    Values are measured in their tolerances, and those that pay for being there also by what they do at the tool: how
    a gear's waves fall with their number is a guess. What the rows leave open of the others says nothing of their
    size, however many of them do: it counts as one value as large as the family, which the one in question has made so.
    """
    own = problem.space.candidates[number].columns
    times = [0.0]
    for family, size in zip(problem.space.families, hypothesis.background, strict=True):
        others = np.setdiff1d(family.columns, [*own, *named])
        if not size or not len(others) or not set(own) <= set(family.columns):
            continue
        variance = np.zeros(len(problem.scale))
        variance[family.columns] = family.prior_variance(size, problem.scale)
        uncertain = np.minimum(hypothesis.variances(others), variance[others])
        left_open = float(np.sum(uncertain / variance[others]))
        counted = min(1.0, 1 / left_open)
        for unit in (variance, np.ones_like(variance)) if family.is_priced else (variance,):
            squares = np.sum((hypothesis.means(others) ** 2 + counted * uncertain) / unit[others])
            usual = squares / (len(others) - (1 - counted) * left_open)
            times.append(float(np.max(np.abs(hypothesis.means(own)) / np.sqrt(usual * unit[own]))))
    return max(times)


def _unnamed(problem: Problem, hypothesis: Hypothesis) -> Iterator[int]:
    """Candidates whose columns a background holds, none of which has a name yet nor another form of it.

    What every arm has anyway, a zero, may stand out of a free curve, too, which holds its column.
    """
    space = problem.space
    named = [space.candidates[c.candidate] for c in hypothesis.chosen]
    taken = {column for candidate in named for column in candidate.columns.tolist()}
    laws = {column for candidate in named if not candidate.is_curve for column in candidate.columns.tolist()}
    taken_keys = {candidate.key for candidate in named}
    for family, size in zip(space.families, hypothesis.background, strict=True):
        if not size:
            continue
        inside = set(family.columns.tolist())
        for number, candidate in enumerate(space.candidates):
            columns = set(candidate.columns.tolist())
            has_name = columns & (taken if family.is_priced else laws) or candidate.key in taken_keys
            if columns <= inside and not has_name:
                yield number


def _lost(problem: Problem, hypothesis: Hypothesis, number: int) -> float:
    """Nats lost when a candidate's columns are held at zero; all, where a value that can't be negative is."""
    candidate = problem.space.candidates[number]
    if candidate.nonnegative and hypothesis.means(candidate.columns)[0] <= 0:
        return -np.inf
    return savage_dickey(hypothesis, candidate.columns)


def nested_log_odds(problem: Problem, hypothesis: Hypothesis, name: SelectedEffect) -> float:
    """Evidence for a name within a background or a curve, nats: lost when it is held at zero, the noise growing.

    Args:
        problem: the normal equations and priors.
        hypothesis: that holds the name.
        name: the effect.

    Returns:
        Nats.
    """
    members = [name.candidate, *rest_of(problem, hypothesis, name.candidate)]
    columns = np.unique(np.concatenate([problem.space.candidates[c].columns for c in members]))
    return profiled_loss(savage_dickey(hypothesis, columns), problem.n)
