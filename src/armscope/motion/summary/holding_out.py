"""Motion that takes no part: the whole selection on the rest, and the error on what was held out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.normal_equations import total
from armscope.inference.problem import Problem
from armscope.inference.search import Search
from armscope.motion.constants import NOISE
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.selected import SelectedCauses, coefficients_of
from armscope.motion.fitting.space import of_joints
from armscope.motion.fitting.weights import noise_of, weighed
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.changes import gate_of
from armscope.motion.library.changes_catalogue import CHANGES
from armscope.motion.library.for_a_while import there
from armscope.motion.library.warmth import is_while_running
from armscope.motion.verdict import HeldOutMotion, relative


@dataclass(frozen=True, eq=False)
class Fold:
    """A part of the motion that is held out, and what was selected on the rest."""

    rows: MotionRows  # the rows that took no part
    which: Indices  # (K,) which of the rows they are
    # problem, found: on the rest
    problem: Problem
    found: Hypothesis


def folds(selected: SelectedCauses) -> list[Fold]:
    """Runs in turn; of a single run, one end of it once."""
    count = len(selected.blocks)
    single = len(set(selected.rows.run.tolist())) == 1
    parts = [_end(selected)] if single else [(k,) for k in range(count)]
    made = []
    for held in parts:
        problem = _of_all_runs(selected, _of_the_rest(selected, held), held)
        search = Search.on(problem)
        also = search.evaluated(selected.best.chosen, selected.best)
        found = search.best((selected.best.background,), also=also, local=False)
        which = np.flatnonzero(np.isin(selected.block, held))
        made.append(Fold(selected.rows, which, problem, found))
    return made


def held_out_parts(selected: SelectedCauses, test: MotionRows | None, runs: Sequence[str]) -> tuple[list[Fold], str]:
    """What takes no part.

    Args:
        selected: the selection.
        test: rows of the runs that were kept out; None holds out what was fitted, part by part.
        runs: names of those.

    Returns:
        It, and in words which motion that is.
    """
    if test is None:
        parts = folds(selected)
        return parts, held_out_in_words(parts)
    return [own_fold(selected, test)], "runs " + ", ".join(runs)


def held_out_in_words(parts: Sequence[Fold]) -> str:
    """Which motion `folds` holds out."""
    if len(parts) > 1:
        return "each run in turn"
    return f"the {'first' if parts[0].which[0] == 0 else 'last'} two fifths of the motion"


def _end(selected: SelectedCauses) -> tuple[int, ...]:
    """The last two fifths of a single run; the first two, where what changes within the run changes in the last."""
    ends = tuple(range(3, NOISE.blocks_of_time)), (0, 1)
    placed = [selected.rows.layout.placed[number] for number in selected.best.candidates]
    gates = [there(selected.rows.time, *gate_of(cause)) for cause in placed if cause.cause in CHANGES]
    told = [min((_both(gate[~np.isin(selected.block, end)]) for gate in gates), default=1.0) for end in ends]
    return ends[int(told[0] < CHANGE.known < told[1])]


def _both(there: Array) -> float:
    """Share of the rarer of there and not there."""
    return float(min(np.mean(there), 1 - np.mean(there)))


def _of_the_rest(selected: SelectedCauses, held: tuple[int, ...]) -> Problem:
    """The sums of what is not held out, by its own noise: what one path leaves is not what all of them leave."""
    rest = [number for number in range(len(selected.blocks)) if number not in held]
    problem = selected.problem.with_equations(total([selected.blocks[number] for number in rest]))
    fitted = Search.on(problem).evaluated(selected.best.chosen, selected.best)
    rows = selected.rows
    left = rows.without_pauses(rows.torque - rows.nominal - rows.modelled(coefficients_of(problem, fitted)))
    among = selected.weights.row * np.isin(selected.block, rest)[:, None]
    parts = [part for number in rest for part in selected.by_joint[number]]
    return problem.with_equations(weighed(rows, parts, noise_of(rows, left, among)))


def _of_all_runs(selected: SelectedCauses, problem: Problem, held: tuple[int, ...]) -> Problem:
    """Without what foretells nothing of the run that is held out, unless all runs together ask for it.

    What is there in the only run that is left is the same as in all. What changes while the arm runs is foretold from
    others: by far too much where friction differs for another reason. A curve over time ends with its part.
    """
    out = np.isin(selected.block, held)
    left = set(selected.rows.run[~out].tolist())
    parted = not left.isdisjoint(selected.rows.run[out].tolist())
    placed, chosen, space = selected.rows.layout.placed, selected.best.candidates, problem.space
    idle = {n for n, each in enumerate(placed) if left <= set(each.runs) or is_while_running(each.columns)}
    idle |= {n for n, each in enumerate(placed) if parted and each.is_curve and each.driver == "time"}
    candidates = tuple(
        replace(each, competes=each.competes and n not in idle - chosen) for n, each in enumerate(space.candidates)
    )
    return replace(problem, space=replace(space, candidates=candidates))


def own_fold(selected: SelectedCauses, rows: MotionRows) -> Fold:
    """Runs that were kept out of the selection altogether."""
    return Fold(rows, np.arange(len(rows)), selected.problem, selected.best)


@dataclass(frozen=True, eq=False)
class HeldOutTorque:
    """Torques of K rows that took no part; (K, m) N m or N."""

    rows: MotionRows  # the table that they are of; `which`: (K,) their numbers in it
    which: Indices
    measured: Array  # low-passed
    stated: Array  # by the arm as stated, nothing fitted
    background: Array  # with friction and rotor inertia of every joint fitted
    model: Array  # with masses held near the stated ones, and the causes

    @property
    def in_motion(self) -> Array:
        """(K, m) what was measured while a joint moves, 0 where it stands or a pause holds it."""
        return moving_torque(self.rows, self.which, self.measured)

    def missed(self, said: Array) -> Array:
        """(K, m) what torques (K, m) leave of the measured ones while a joint moves; see `missed_torque`."""
        return missed_torque(self.rows, self.which, self.measured - said)


def that_others_tell(
    selected: SelectedCauses, parts: list[Fold], held: tuple[HeldOutTorque, ...]
) -> tuple[list[Fold], tuple[HeldOutTorque, ...], list[str]]:
    """Without runs that have a cause of their own, unless all have; and these runs' names.

    Args:
        selected: the selection.
        parts: what is held out in turn.
        held: the torques of each.

    Returns:
        What is left of both, and the names.
    """
    placed = (selected.rows.layout.placed[number] for number in selected.best.candidates)
    own = {run for cause in placed for run in cause.runs}
    alone = [n for n, fold in enumerate(parts) if set(fold.rows.run[fold.which].tolist()) <= own]
    if not alone or len(alone) == len(parts):
        return parts, held, []
    kept = [n for n in range(len(parts)) if n not in alone]
    names = [str(parts[n].rows.run[parts[n].which][0]) for n in alone]
    return [parts[n] for n in kept], tuple(held[n] for n in kept), names


def held_out_torques(parts: Sequence[Fold]) -> tuple[HeldOutTorque, ...]:
    """What was measured where nothing was fitted, and what models fitted to the rest say of it."""
    made = []
    for fold in parts:
        stated = fold.rows.nominal[fold.which]
        friction = evaluate(fold.problem, (), of_joints(fold.problem.space, fold.found.background), fold.found.noise)
        background, model = (stated + modelled(fold, hypothesis) for hypothesis in (friction, fold.found))
        made.append(HeldOutTorque(fold.rows, fold.which, fold.rows.torque[fold.which], stated, background, model))
    return tuple(made)


def measure(held: Sequence[HeldOutTorque], what: str) -> HeldOutMotion:
    """Errors on all that was held out, together.

    Args:
        held: torques of what was held out.
        what: which motion that is, in words.

    Returns:
        Errors relative to the torque.
    """
    whole = np.concatenate([part.in_motion for part in held])
    stated, background, model = (
        np.concatenate([part.missed(getattr(part, name)) for part in held])
        for name in ("stated", "background", "model")
    )
    moving = np.concatenate([part.rows.moving[part.which] for part in held])
    return HeldOutMotion(
        stated=relative(stated, whole),
        background=relative(background, whole),
        model=relative(model, whole),
        by_joint=tuple(float(v) for v in np.sqrt(np.sum(model**2, axis=0) / np.maximum(moving.sum(axis=0), 1))),
        what=what,
    )


def errors_by_run(held: Sequence[HeldOutTorque]) -> dict[str, float]:
    """The model's error on each run, relative to its torque."""
    errors = {}
    for part in held:
        run = part.rows.run[part.which]
        for name in dict.fromkeys(run.tolist()):
            there = (run == name)[:, None]
            errors[name] = relative(there * part.missed(part.model), there * part.in_motion)
    return errors


def modelled(fold: Fold, hypothesis: Hypothesis) -> Array:
    """(K, m) torque beyond the stated model's that a hypothesis gives the rows of a fold."""
    return fold.rows.modelled(coefficients_of(fold.problem, hypothesis), fold.which)


def moving_torque(rows: MotionRows, which: Indices, torque: Array) -> Array:
    """Torques of some rows while joints move, 0 elsewhere.

    Args:
        rows: of the table.
        which: (K,) their numbers in it.
        torque: (K, m) N m (N).

    Returns:
        (K, m).
    """
    return np.where(rows.moving[which], torque, 0.0)


def missed_torque(rows: MotionRows, which: Indices, left: Array) -> Array:
    """What a model leaves (K, m) of some rows while joints move, without what forces that hold them make of it.

    A row beside a pause holds a share of such a force, which no model foretells: as in the fit, it tells nothing.

    Args:
        rows: of the table.
        which: (K,) their numbers in it.
        left: (K, m) what the model leaves of them, N m (N).

    Returns:
        (K, m).
    """
    whole = np.zeros(rows.torque.shape)
    whole[which] = left
    return moving_torque(rows, which, rows.without_pauses(whole)[which])
