"""Free curves told as the line or wave that they are for the most part, and a rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.model_space import EffectSpace
from armscope.inference.conditioning import condition_on
from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.linear_algebra import schur_complement
from armscope.inference.model_space import Candidate
from armscope.inference.normal_equations import as_response
from armscope.inference.problem import Problem, SelectedEffect
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.freeform import OF_LOAD, REST_OF_LOAD
from armscope.physics.geometric import JOINT_OFFSET

DRIVE = JOINT_COMPLIANCE.name


def straightened(problem: Problem, space: EffectSpace, hypothesis: Hypothesis) -> Hypothesis:
    """With curves of load that are lines for the most part told as compliances, and what is left of them as curves.

    Args:
        problem: the sums, priors and costs.
        space: which effect each candidate is.
        hypothesis: that holds curves.

    Returns:
        The hypothesis, lines in place of curves.
    """
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


def with_main_shapes(edits: Edits, hypothesis: Hypothesis) -> Hypothesis:
    """With curves, but for those of load, that are one line, wave or play for the most part told as that and a rest."""
    problem = edits.problem
    for curve in hypothesis.chosen:
        candidate = edits.candidate(curve.candidate)
        if not candidate.is_curve or candidate.variant in OF_LOAD:
            continue
        # what every arm has anyway gets its name by standing out there, where it is there
        held = [n for n in _within(problem, candidate) if problem.is_free(n) and edits.in_background(hypothesis, n)]
        asked = _within(problem, candidate) - hypothesis.candidates - set(held)
        shapes = _shares_of_shapes(edits, hypothesis, curve, sorted(asked))
        shape = max(shapes, key=lambda n: shapes[n][0], default=None)
        if shape is None or shapes[shape][0] < NAMING.main_share:
            continue
        name = SelectedEffect(shape, problem.nearest_size(shapes[shape][1]), nested=True)
        hypothesis = evaluate(problem, (*hypothesis.chosen, name), hypothesis.background, hypothesis.noise)
    return hypothesis


def _shares_of_shapes(
    edits: Edits, hypothesis: Hypothesis, curve: SelectedEffect, shapes: Sequence[int]
) -> dict[int, tuple[float, float]]:
    """Share of a curve, of what only it explains, that each shape is; and the shape's RMS, mm.

    Backgrounds of such shapes are left out: what they could explain is what is asked for.
    """
    own = edits.candidate(curve.candidate).columns
    kept, found = edits.kept(hypothesis, [curve.candidate]), {}
    for background, members in _by_background_without(edits, hypothesis, shapes).items():
        columns = np.unique(np.concatenate([own, *(edits.candidate(n).columns for n in members)]))
        without = edits.evaluated(kept, hypothesis, background)
        M = condition_on(edits.problem, columns, without).own(edits.problem, np.arange(len(columns))[None])[0]
        mean = np.zeros(len(columns))
        mean[np.searchsorted(columns, own)] = hypothesis.means(own)
        response = as_response(M, mean, edits.problem.n)
        for n in members:
            left = response.least_rss(np.searchsorted(columns, edits.candidate(n).columns))
            main = max(response.yy - left, 0.0)
            found[n] = (main / response.yy if response.yy > 0 else 0.0, float(np.sqrt(main / response.n)))
    return found


def _by_background_without(
    edits: Edits, hypothesis: Hypothesis, shapes: Sequence[int]
) -> dict[tuple[int, ...], list[int]]:
    """Shapes by what remains of a hypothesis's background without the families that hold any of their columns."""
    families = [(size, set(f.columns)) for size, f in zip(hypothesis.background, edits.space.families, strict=True)]
    groups: dict[tuple[int, ...], list[int]] = {}
    for n in shapes:
        columns = set(edits.candidate(n).columns)
        groups.setdefault(tuple(0 if held & columns else size for size, held in families), []).append(n)
    return groups


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


def zero_without_load(problem: Problem, hypothesis: Hypothesis, zero: int) -> tuple[float, float] | None:
    """A joint's zero, mm at the tool, by what turns it where its load is least, with its standard error.

    A curve of load holds a constant in its bumps, too: what is a zero and what is the curve's, its coefficients do not
    tell. But nothing that follows the load is left without it.

    Args:
        problem: the sums, priors and costs.
        hypothesis: that holds its column.
        zero: the candidate's number.

    Returns:
        Zero and error; None of what is no zero, or has no curve of load beside it.
    """
    candidates, scale = problem.space.candidates, problem.scale
    own = candidates[zero]
    curves = [c for c in (candidates[n] for n in hypothesis.candidates) if c.location == own.location]
    at_rest = [(c.columns, c.at_rest) for c in curves if c.at_rest is not None]
    if own.kind != JOINT_OFFSET.name or not at_rest:
        return None
    ((columns, does),) = at_rest
    every = np.union1d(columns, own.columns)
    weights = np.isin(every, own.columns).astype(float)
    weights[np.searchsorted(every, columns)] = does * scale[own.columns] / scale[columns]
    error = np.sqrt(weights @ hypothesis.covariance(every) @ weights)
    return float(weights @ hypothesis.means(every)), float(error)


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
    return [n for n, c in others if nested and c.is_curve and c.variant not in OF_LOAD and line in _within(problem, c)]


def _within(problem: Problem, curve: Candidate) -> frozenset[int]:
    """The special cases of a curve, or of the coarser one that it refines."""
    return (curve if curve.refines is None else problem.space.candidates[curve.refines]).special_cases
