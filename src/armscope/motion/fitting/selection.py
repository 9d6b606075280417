"""Rounds of rows, noise and selection, until the names rest."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices, Progress
from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import ModelSpace
from armscope.inference.problem import Problem, SelectedEffect, build_problem
from armscope.inference.search import Search
from armscope.motion.constants import NOISE, PRIOR
from armscope.motion.fitting.clocks import parted_where_they_differ
from armscope.motion.fitting.gains import gain_of, meeting_gain
from armscope.motion.fitting.hoses import offsets_for_cables
from armscope.motion.fitting.model_estimate import Estimate, estimate_of, stated_model
from armscope.motion.fitting.near_reversals import told_by_reversals_alone
from armscope.motion.fitting.preferred import named_first, plain_first
from armscope.motion.fitting.refining import refined, sits_nowhere
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.space import build_space
from armscope.motion.fitting.sums import Earlier, JointSums, sums_by_joint, together
from armscope.motion.fitting.torque_delay import Between
from armscope.motion.fitting.weights import TorqueWeights, estimate_weights, left_inside_and_apart, weighed
from armscope.motion.library.layout import CAUSES_OF_OWN, OWN, TorqueLayout
from armscope.motion.library.masses import has_its_own_inertia
from armscope.motion.samples.preparation import Preparation
from armscope.motion.samples.timing import Stretch


def estimated_model(layout: TorqueLayout, coefficients: Array) -> Estimate:
    """What load, delay and gain follow: inertial parameters with all that was added to them, and the background."""
    inertial = layout.arm.inertial + layout.inertial_scale * coefficients[layout.inertial]
    numbers = [coefficients[columns] for columns in layout.columns]
    own = coefficients[layout.own].reshape(-1, OWN)[:, :CAUSES_OF_OWN]
    background = np.nan_to_num(layout.arm.stated_background) + own
    causes = zip(layout.placed, numbers, strict=True)
    return estimate_of(causes, inertial, background, gain_of(layout, coefficients))


def model_of(selected: SelectedCauses) -> Estimate:
    """What columns of a selection's rows, and of others like them, are functions of."""
    return replace(
        estimated_model(selected.rows.layout, selected.coefficients),
        turning=selected.rows.turning,
    )


def turning_of(selected: SelectedCauses) -> Array:
    """(m,) s by which friction changes sides later than the speed, where that is told; else as columns have it.

    Its slope over time is a shift only as long as the low-pass rounds more off: friction that clings for 12 ms is far
    from it at 25 Hz, and a delay of all torque fits better.
    """
    best, scale = selected.best, selected.problem.scale
    turning, dry = selected.rows.turning.copy(), selected.dry
    for j, column in enumerate(selected.rows.layout.reversals[:, -1]):
        if column not in best.columns or dry[j] <= 0:
            continue
        error = float(np.sqrt(best.variances(np.array([column]))[0])) / scale[column]
        if error < PRIOR.turning_s * dry[j]:
            turning[j] += selected.coefficients[column] / dry[j]
    return np.clip(turning, -PRIOR.longest_turning_s, PRIOR.longest_turning_s)


def select_causes(
    layout: TorqueLayout,
    stretches: Sequence[Stretch],
    how: Preparation,
    block_of: Sequence[str],
    progress: Progress,
    model: Estimate | None = None,
) -> SelectedCauses:
    """The causes that the evidence asks for.

    Args:
        layout: of the columns.
        stretches: even samples, ``effort`` in N m.
        how: filters and decimation.
        block_of: what rows are blocked by: names of the runs; one name or none for blocks of time.
        progress: hears what is being done.
        model: what load, delay and gain follow at first; the stated one where there is none.

    Returns:
        The selection; the numbers in its layout that were scanned are those at which they rest.
    """
    model = model or stated_model(layout.arm)
    selected: SelectedCauses | None = None
    most, between = NOISE.rounds + NOISE.refinings, Between()
    calm: TorqueWeights | None = None  # of each joint the round that left least of it
    named: list[frozenset[int]] = []
    for number in range(most):
        share = number / most
        before = None if selected is None else selected.rows
        rows = build_rows(layout, stretches, how, model, functools.partial(_within, progress, share), before)
        block = blocks_of(rows.run, block_of)
        progress("weighing causes", share + 0.15)
        if selected is None:
            space = build_space(layout, np.sqrt(np.mean(rows.torque**2, axis=0)), how.rate)
            selected = chosen(rows, starting_weights(rows), block, space)
        space = selected.space  # a scanned number that moves changes columns, and nothing of what competes
        last = selected.best, selected.best.chosen
        noise = selected.noise
        noise, calm = noise.not_far_above(calm), noise if calm is None else calm.where_better(noise)
        selected = _that_can_be(at_own_gain(chosen(rows, noise, block, space, last, selected)), how.rate)
        finer = refined(selected, between)
        named.append(selected.best.candidates)
        if finer is None and (_at_rest(named) or number + 1 >= NOISE.rounds):
            break
        model = replace(model_of(selected), turning=turning_of(selected))
        layout = finer or layout
    assert selected is not None
    return selected


def _that_can_be(selected: SelectedCauses, rate: float) -> SelectedCauses:
    """The selection without loads that are no body and drives that only reversals tell: what they are competes instead.

    A load of ten free numbers says all that its link can, at once. Struck out after all rounds, the link's own columns
    would not have moved to where its centre is, and friction would turn as late as torque did.
    """
    layout, best, competes = selected.rows.layout, selected.best, selected.space.candidates
    loads = [n for n in best.candidates if has_its_own_inertia(layout.placed[n])]
    barred = frozenset(n for n in loads if sits_nowhere(selected, n)) | told_by_reversals_alone(selected)
    if not barred:
        return selected
    barred |= {n for n, each in enumerate(competes) if not each.competes}
    space = build_space(layout, np.sqrt(np.mean(selected.rows.torque**2, axis=0)), rate, barred)
    before = best, tuple(effect for effect in best.chosen if effect.candidate not in barred)
    return at_own_gain(chosen(selected.rows, selected.weights, selected.block, space, before, selected))


def _at_rest(named: Sequence[frozenset[int]]) -> bool:
    """Whether names stay as they are, or go to and fro and are those of the smaller of two sets now.

    What takes more noise away the more of it has a name, and less the less, has no evidence that a round more would
    not take back.
    """
    if len(named) > 2 and named[-1] == named[-3]:
        return named[-1] <= named[-2]
    return len(named) > 1 and named[-1] == named[-2]


def at_own_gain(selected: SelectedCauses) -> SelectedCauses:
    """The same causes, with what is true torque recorded by the gains that are fitted."""
    for _ in range(NOISE.refinings):
        gain = meeting_gain(selected)
        if np.allclose(gain, selected.rows.gain, rtol=0.0, atol=NOISE.same_gain):
            break
        selected = weighed_anew(replace(selected.rows, gain=gain), selected)
    return selected


def _within(progress: Progress, start: float, text: str, done: float) -> None:
    progress(text, start + 0.1 * done)


def chosen(
    rows: MotionRows,
    weights: TorqueWeights,
    block: Indices,
    space: ModelSpace,
    before: tuple[Hypothesis, Sequence[SelectedEffect]] | None = None,
    earlier: SelectedCauses | None = None,
) -> SelectedCauses:
    """The selection at given weights.

    Args:
        rows: K rows.
        weights: how much they count.
        block: (K,) number of each row's block.
        space: what competes.
        before: a hypothesis found on much the same sums, and those of its effects to start from.
        earlier: a selection on the same rows and blocks, whose columns may be other functions.

    Returns:
        What won.
    """
    known = None if earlier is None else Earlier(earlier.rows, earlier.weights.row, earlier.by_joint)
    by_joint = sums_by_joint(rows, weights.row, block, known)
    problem = _problem(rows, weights, space, by_joint)
    search = Search.on(problem)
    if before is None:
        best = search.best()
    else:
        found, effects = before
        best = search.best((), also=search.evaluated(effects, found))
    best = plain_first(search, settled(search, named_first(search, best)))
    best = offsets_for_cables(search, best, rows.layout.placed)
    best = parted_where_they_differ(search, best, rows.layout.placed)
    return SelectedCauses(rows, weights, block, by_joint, space, problem, best)


def weighed_anew(rows: MotionRows, earlier: SelectedCauses) -> SelectedCauses:
    """A selection's effects, none else, on the same rows and columns, recorded by other gains."""
    problem = _problem(rows, earlier.weights, earlier.space, earlier.by_joint)
    best = Search.on(problem).evaluated(earlier.best.chosen, earlier.best)
    return SelectedCauses(rows, earlier.weights, earlier.block, earlier.by_joint, earlier.space, problem, best)


def _problem(
    rows: MotionRows, weights: TorqueWeights, space: ModelSpace, by_joint: Sequence[Sequence[JointSums]]
) -> Problem:
    sums = weighed(rows, together([part for block in by_joint for part in block]), weights)
    return build_problem(space, sums, least_noise=0.5 * PRIOR.unit)


def starting_weights(rows: MotionRows) -> TorqueWeights:
    """Weights from what friction, rotors and masses leave, or they and all causes at once.

    With all causes a short motion would have no noise left, and without them a slow cause would count as noise that
    lasts, of which nothing then asks for a cause. So it is told from what each leaves of motion that it was fitted to
    and that it was not, together (`noise_of`): all causes at once foretell other motion badly, and what they miss there
    looks like a slow cause, too. At each joint the one counts of which less lasts. What all joints have in common
    is there once more at each of them.
    """
    layout = rows.layout
    common = [columns for cause, columns in zip(layout.placed, layout.columns, strict=True) if cause.common]
    all_but_common = np.delete(np.arange(layout.width), np.concatenate([np.empty(0, dtype=np.intp), *common]))
    choices = (np.concatenate([layout.own, layout.inertial, layout.response]), all_but_common)
    ordinary, all_causes = (estimate_weights(rows, *left) for left in left_inside_and_apart(rows, choices))
    return ordinary.where_better(all_causes)


def blocks_of(rows: NDArray[np.str_], runs: Sequence[str]) -> Indices:
    """Numbers of blocks: runs, or parts of the time where there is one run only.

    Args:
        rows: (K,) name of each row's run.
        runs: their names, in the order of their numbers.

    Returns:
        (K,) of each row.
    """
    if len(runs) > 1:
        names, which = np.unique(rows, return_inverse=True)
        return np.asarray([list(runs).index(str(name)) for name in names], dtype=np.intp)[which]
    return np.minimum(np.arange(len(rows)) * NOISE.blocks_of_time // len(rows), NOISE.blocks_of_time - 1)


def settled(search: Search, best: Hypothesis) -> Hypothesis:
    """A hypothesis without what is not worth its price beside the others."""
    while (weak := search.weakest(best)) is not None:
        best = search.without(best, [weak.candidate])
    return best
