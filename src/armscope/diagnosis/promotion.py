"""What a found hypothesis is called: names out of its backgrounds, and lines out of its curves.

Naming changes neither the fit nor the search: a background explains its members with or without their names, and a
curve contains its line. So names given here pay no price of the library.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.model_space import EffectSpace
from armscope.inference.conditioning import condition_on
from armscope.inference.constants import PRIORS
from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis, evaluate, savage_dickey
from armscope.inference.linear_algebra import profiled_loss, schur_complement
from armscope.inference.model_space import Candidate
from armscope.inference.normal_equations import as_response
from armscope.inference.problem import Problem, SelectedEffect
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.freeform import REST_OF_LOAD

GIVES_NATS, GIVES = PRIORS.sure_nats, 0.1
"""A joint's drive in an elastic background is named at odds of 20 to 1, if it is worth this share of the RMS at all: of
what gives way, drives do first and most."""
DRIVE = JOINT_COMPLIANCE.name


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
    while True:
        promoted = _promoted(edits.problem, _with_main_shapes(edits, _straightened(edits.problem, space, hypothesis)))
        weakest = edits.weakest(promoted)
        if weakest is None:
            return promoted
        hypothesis = edits.without(hypothesis, [weakest.candidate])


def _promoted(problem: Problem, hypothesis: Hypothesis) -> Hypothesis:
    """With the members of a background named that stand out by themselves.

    In an arm that is a little wrong everywhere, the place that is so most deserves its name, although the background
    explains it, too: its evidence is what is lost when it alone is held right. Drives are weighed as they will be
    fitted: as large as they come, not held small by the background.
    """
    unnamed = list(_unnamed(problem, hypothesis))
    drives = [number for number in unnamed if problem.space.candidates[number].kind == DRIVE]
    added = [
        number
        for number in unnamed
        if number not in drives
        and _stands_out(problem, hypothesis, number, NAMING.stands_out_nats, NAMING.stands_out)
        and _beyond_family(problem, hypothesis, number) > NAMING.beyond_family
    ]
    if drives:
        free = _with_names(problem, hypothesis, drives, [problem.mismatch] * len(drives))
        added += [d for d in drives if _stands_out(problem, free, d, GIVES_NATS, GIVES)]
    while True:
        sizes = [_size(problem, hypothesis, number) for number in added]
        promoted = _with_names(problem, hypothesis, added, sizes)
        # several that stand in for each other stand out only as long as the others are held small
        lost = {d: _lost(problem, promoted, d) for d in added if d in drives}
        weakest = min(lost, key=lambda d: lost[d], default=None)
        if weakest is None or lost[weakest] > GIVES_NATS:
            return promoted
        added.remove(weakest)


def _with_names(problem: Problem, hypothesis: Hypothesis, names: Sequence[int], rms: Sequence[float]) -> Hypothesis:
    added = [SelectedEffect(n, problem.nearest_size(size), nested=True) for n, size in zip(names, rms, strict=True)]
    return evaluate(problem, (*hypothesis.chosen, *added), hypothesis.background, hypothesis.noise)


def _size(problem: Problem, hypothesis: Hypothesis, number: int) -> float:
    """RMS at the tool of a candidate's columns, one by one, mm."""
    return float(np.linalg.norm(hypothesis.means(problem.space.candidates[number].columns)))


def _stands_out(problem: Problem, hypothesis: Hypothesis, number: int, least: float, share: float) -> bool:
    large = _size(problem, hypothesis, number) > share * _left_by_the_others(problem, hypothesis, number)
    return large and _lost(problem, hypothesis, number) > least


def _left_by_the_others(problem: Problem, hypothesis: Hypothesis, number: int) -> float:
    """RMS, mm, that a candidate's size is measured by: all of it, or what the free backgrounds leave for the others.

    What every arm has anyway (its geometry) is large; a spring or a gear must stand out of what a calibration leaves.
    """
    columns = set(problem.space.candidates[number].columns)
    free = [not family.is_priced for family in problem.space.families]
    if any(columns <= set(f.columns) for f, is_free in zip(problem.space.families, free, strict=True) if is_free):
        return problem.mismatch
    background = tuple(s if is_free else 0 for s, is_free in zip(hypothesis.background, free, strict=True))
    return evaluate(problem, (), background, problem.mismatch).noise


def _beyond_family(problem: Problem, hypothesis: Hypothesis, number: int) -> float:
    """How many times larger a candidate's largest value is than the usual one of the rest of its family.

    Values are measured in their tolerances, and those that pay for being there also by what they do at the tool: how
    a gear's waves fall with their number is a guess. What is uncertain of the others counts as theirs.
    """
    own = problem.space.candidates[number].columns
    times = [0.0]
    for family, size in zip(problem.space.families, hypothesis.background, strict=True):
        others = np.setdiff1d(family.columns, own)
        if not size or not len(others) or not set(own) <= set(family.columns):
            continue
        variance = np.zeros(len(problem.scale))
        variance[family.columns] = family.prior_variance(size, problem.scale)
        for unit in (variance, np.ones_like(variance)) if family.is_priced else (variance,):
            usual = np.mean((hypothesis.means(others) ** 2 + hypothesis.variances(others)) / unit[others])
            times.append(float(np.max(np.abs(hypothesis.means(own)) / np.sqrt(usual * unit[own]))))
    return max(times)


def _unnamed(problem: Problem, hypothesis: Hypothesis) -> Iterator[int]:
    """Candidates whose columns a background holds, none of which has a name yet nor another form of it."""
    space = problem.space
    named = [space.candidates[c.candidate] for c in hypothesis.chosen]
    taken = {column for candidate in named for column in candidate.columns}
    taken_keys = {candidate.key for candidate in named}
    for family, size in zip(space.families, hypothesis.background, strict=True):
        inside = set(family.columns) if size else set()
        for number, candidate in enumerate(space.candidates):
            columns = set(candidate.columns)
            if columns <= inside and not taken & columns and candidate.key not in taken_keys:
                yield number


def _lost(problem: Problem, hypothesis: Hypothesis, number: int) -> float:
    """Nats lost when a candidate's columns are held at zero; all, where a value that can't be negative is."""
    candidate = problem.space.candidates[number]
    if candidate.nonnegative and hypothesis.means(candidate.columns)[0] <= 0:
        return -np.inf
    return savage_dickey(hypothesis, candidate.columns)


def _straightened(problem: Problem, space: EffectSpace, hypothesis: Hypothesis) -> Hypothesis:
    """With curves of load that are lines for the most part told as compliances, and what is left of them as curves."""
    stated = {c.location: n for n, c in enumerate(space.candidates) if c.kind == DRIVE and not c.variant}
    rests = {c.location: n for n, c in enumerate(space.candidates) if c.variant == REST_OF_LOAD}
    for curve in hypothesis.chosen:
        candidate = space.candidates[curve.candidate]
        if not candidate.is_curve or candidate.variant != "load" or candidate.location not in stated:
            continue
        straight, bent = _line(problem, space, hypothesis, curve.candidate)
        if straight**2 < NAMING.line_share * (straight**2 + bent**2):
            continue
        others = tuple(c for c in hypothesis.chosen if c is not curve)
        line = SelectedEffect(stated[candidate.location], problem.nearest_size(straight), nested=True)
        rest = SelectedEffect(rests[candidate.location], problem.nearest_size(bent), nested=True)
        hypothesis = evaluate(problem, (*others, line, rest), hypothesis.background, hypothesis.noise)
    return hypothesis


def _with_main_shapes(edits: Edits, hypothesis: Hypothesis) -> Hypothesis:
    """With curves of a joint's own angle that are one line or wave for the most part told as that and a rest."""
    problem = edits.problem
    free = [set(family.columns) for family in edits.space.families if not family.is_priced]
    # what every arm has anyway gets its name by standing out there
    ordinary = {n for n, c in enumerate(edits.space.candidates) if any(set(c.columns) <= columns for columns in free)}
    for curve in hypothesis.chosen:
        candidate = edits.candidate(curve.candidate)
        if not candidate.is_curve or not candidate.variant.startswith("angle"):
            continue
        asked = _within(problem, candidate) - hypothesis.candidates - ordinary
        shapes = {n: _main_shape(edits, hypothesis, curve, n) for n in asked}
        shape = max(shapes, key=lambda n: shapes[n][0], default=None)
        if shape is None or shapes[shape][0] < NAMING.main_share:
            continue
        name = SelectedEffect(shape, problem.nearest_size(shapes[shape][1]), nested=True)
        hypothesis = evaluate(problem, (*hypothesis.chosen, name), hypothesis.background, hypothesis.noise)
    return hypothesis


def _main_shape(edits: Edits, hypothesis: Hypothesis, curve: SelectedEffect, shape: int) -> tuple[float, float]:
    """Share of a curve, of what only it explains, that one shape is; and the shape's RMS, mm.

    A background of such shapes is left out: what it could explain is what is asked for.
    """
    own, within = edits.candidate(curve.candidate).columns, edits.candidate(shape).columns
    columns = np.union1d(own, within)
    families = zip(hypothesis.background, edits.space.families, strict=True)
    background = tuple(0 if set(family.columns) & set(within) else size for size, family in families)
    without = edits.evaluated(edits.kept(hypothesis, [curve.candidate]), hypothesis, background)
    M = condition_on(edits.problem, columns, without).own(edits.problem, np.arange(len(columns))[None])[0]
    mean = np.zeros(len(columns))
    mean[np.searchsorted(columns, own)] = hypothesis.means(own)
    response = as_response(M, mean, edits.problem.n)
    left = response.least_rss(np.searchsorted(columns, within))
    main = max(response.yy - left, 0.0)
    share = main / response.yy if response.yy > 0 else 0.0
    return share, float(np.sqrt(main / response.n))


def _line(problem: Problem, space: EffectSpace, hypothesis: Hypothesis, curve: int) -> tuple[float, float]:
    """RMS, mm, of a load curve's line beyond a constant (0 for a line against the load), and of what is left of it."""
    columns = space.candidates[curve].columns
    at = {term.name: n for n, term in enumerate(space.placed[curve].terms)}
    mean = hypothesis.means(columns)
    M = schur_complement(problem.equations.G, space.frames, columns)
    shape = as_response(M, mean, problem.n)
    constant = [at["offset"]] if "offset" in at else []
    whole = shape.least_rss(np.array(constant, dtype=np.intp))
    rest = shape.least_rss(np.array([*constant, at["compliance"]]))
    straight = max(whole - rest, 0.0) if _along_load(M, mean, at["compliance"], constant) else 0.0
    return float(np.sqrt(straight / problem.n)), float(np.sqrt(max(rest, 1e-12) / problem.n))


def _along_load(M: Array, mean: Array, line: int, constant: Sequence[int]) -> bool:
    """Whether a curve with products M of its columns rises along one of them, beyond a constant."""
    along = M[line] @ mean
    for n in constant:
        if M[n, n] > 0:  # else the frames are the constant
            along = along - M[line, n] / M[n, n] * (M[n] @ mean)
    return bool(along > 0)


def rest_of(problem: Problem, hypothesis: Hypothesis, line: int) -> list[int]:
    """What is left, in a hypothesis, of the curve that a named line or wave was taken from.

    Args:
        problem: the sums, priors and costs.
        hypothesis: that holds the line.
        line: the candidate's number.

    Returns:
        Numbers of candidates.
    """
    candidates = problem.space.candidates
    named = candidates[line]
    nested = any(c.nested for c in hypothesis.chosen if c.candidate == line)
    others = [(c, candidates[c]) for c in hypothesis.candidates if candidates[c].location == named.location]
    if named.kind == DRIVE:
        return [n for n, c in others if c.variant == REST_OF_LOAD]
    return [
        n for n, c in others if nested and c.is_curve and c.variant.startswith("angle") and line in _within(problem, c)
    ]


def _within(problem: Problem, curve: Candidate) -> frozenset[int]:
    """The special cases of a curve, or of the coarser one that it refines."""
    return (curve if curve.refines is None else problem.space.candidates[curve.refines]).special_cases


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
