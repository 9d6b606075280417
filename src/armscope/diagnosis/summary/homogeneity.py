"""Does it carry over? What is a cause has the same size in every run, under every payload, near and far."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from armscope.core.sampling import spread_evenly
from armscope.core.types import Indices
from armscope.diagnosis.constants import FOLDING
from armscope.diagnosis.held_out_worth import without_companions
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.parameter_layout import current_parameters
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem
from armscope.physics.freeform import REST_OF_LOAD
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


@dataclass(frozen=True)
class SameSize:
    """Whether an effect has one size: everywhere where that could be asked, and in words."""

    agrees: bool
    text: str


def subset_consistency(state: DiagnosisState) -> dict[int, SameSize]:
    """For effects with plain parameters: whether every run, payload and half of the workspace alone gives the same."""
    told: dict[int, list[tuple[bool, str]]] = {}
    plain = [
        c.candidate
        for c in state.best.chosen
        if (placed := state.space.placed[c.candidate]).parametrisation == "plain" and placed.family != "drift"
    ]
    divisions = list(_divisions(state))
    chance = (1 - TELLING.chance) / max(len(divisions) * len(plain), 1)  # one false alarm in a hundred verdicts
    for parts, kind in divisions:
        for candidate, agrees in _agreements(state.problem, state.best, plain, parts, chance).items():
            told.setdefault(candidate, []).append((agrees, _sentence(len(parts), kind, agrees)))
    return {
        candidate: SameSize(all(agrees for agrees, _ in found), " ".join(text for _, text in found))
        for candidate, found in told.items()
    }


def _divisions(state: DiagnosisState) -> Iterator[tuple[list[NormalEquations], str]]:
    """Sums over the rows of each run; of each payload; of the near and of the far half of the workspace."""
    split, recordings, point, layout = state.split, state.recordings, state.point, state.space.layout
    if split.grouped_by == "run":
        runs = [np.flatnonzero(split.fold == run) for run in np.unique(split.fold)]
        yield [total([state.blocks[int(k)] for k in inside]) for inside in runs], "runs"
    rows, asked = spread_evenly(len(recordings), TELLING.homogeneity_rows), _columns_asked(state)
    few = layout.only(asked)
    table, some = recordings.rows(rows), state.fit.weights.take(rows)
    for of_row, kind in ((_payloads(table), "payloads"), (_halves(table, point), "halves of the workspace")):
        counts = np.bincount(of_row[of_row >= 0])
        if len(counts) > 1 and counts.min() >= FOLDING.fewest_rows_per_run:
            known = np.flatnonzero(of_row >= 0)
            sums = normal_equations_by_block(few, point, table.rows(known), some.take(known), of_row[known])
            yield [each.among(asked, len(layout.terms)) for each in sums], kind


def _columns_asked(state: DiagnosisState) -> Indices:
    """Columns of the hypothesis, of what joins it, and of what the model at which columns were taken holds."""
    best, companions = state.best, state.problem.space.companions
    joined = [c.family.columns for c in companions if c.joins(best.candidates, best.background)]
    held = np.flatnonzero(current_parameters(state.space.layout, state.point))
    return np.unique(np.concatenate([best.columns, held, *joined])).astype(np.intp)


def _payloads(recordings: Recordings) -> Indices:
    """(N,) number of each row's payload; -1 where it is not recorded, everywhere where there are too many."""
    none = np.full(len(recordings), -1, dtype=np.intp)
    if recordings.payload is None:
        return none
    known = ~np.isnan(recordings.payload)
    values, which = np.unique(recordings.payload[known].round(3), return_inverse=True)
    if len(values) > TELLING.most_payloads:
        return none
    none[known] = which
    return none


def _halves(recordings: Recordings, point: FittedModel) -> Indices:
    """(N,) 0 for the half of the rows whose tool points lie near the base's axis, 1 for the far half."""
    reach = np.linalg.norm(point.to_base(recordings.positions, recordings.run)[:, :2], axis=1)
    return np.asarray((reach > np.median(reach)).astype(np.intp))


def _agreements(
    problem: Problem, best: Hypothesis, asked: Sequence[int], parts: Sequence[NormalEquations], chance: float
) -> dict[int, bool]:
    """Whether the parts' own posteriors under the chosen hypothesis scatter no more than they do by this chance, or by
    so little that it makes no difference."""
    # a line alone, without what is left of its curve: that could be another's line in each part
    lines = tuple(c for c in best.chosen if problem.space.candidates[c.candidate].variant != REST_OF_LOAD)
    shared, parts = without_companions(problem, parts, best)
    alone = [evaluate(shared.with_equations(part), lines, best.background, best.noise) for part in parts]
    agree = {}
    for candidate in asked:
        columns = problem.space.candidates[candidate].columns
        values = np.array([h.means(columns) for h in alone])
        variances = np.array([h.variances(columns) for h in alone])
        mean = np.sum(values / variances, axis=0) / np.sum(1 / variances, axis=0)
        misfit = float(np.sum((values - mean) ** 2 / variances))
        apart = np.linalg.norm(values - mean, axis=1).max()
        by_chance = misfit < chdtri(values.size - values.shape[1], chance)
        agree[candidate] = bool(by_chance or apart < TELLING.same_size * np.linalg.norm(mean))
    return agree


def _sentence(count: int, kind: str, agrees: bool) -> str:
    if agrees:
        return f"Each of the {count} {kind} alone gives the same value within its interval."
    return f"The {count} {kind} alone give different values: what is meant here may not be the cause."
