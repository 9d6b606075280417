"""Whether different paths say the same of a cause: a size that holds on one path only is no physics."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.evidence import Hypothesis
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem
from armscope.motion.fitting.constants import CONSISTENCY
from armscope.motion.fitting.selected import SelectedCauses, coefficients_of
from armscope.motion.library.clauses import run_in_words

PARTS = "fifths of the motion"
"""What blocks of a single run are; `NOISE.blocks_of_time` of them."""


@dataclass(frozen=True, eq=False)
class PathAgreement:
    """What the blocks say of one cause."""

    size: Array  # of each block that tells it, as a share of the size from all
    stderr: Array  # of these
    paths: bool = True  # whether blocks are runs; else they are parts of one run
    runs: tuple[str, ...] = ()  # the only runs in which the cause is there; empty for all

    @property
    def tested(self) -> bool:
        """Whether two blocks or more tell its size."""
        return int(np.sum(self.stderr < CONSISTENCY.telling)) >= 2

    @property
    def consistent(self) -> bool | None:
        """Whether the telling blocks agree in sign and, roughly, in size; None where they don't tell."""
        if not self.tested:
            return None
        telling = self.stderr < CONSISTENCY.telling
        size, spread = self.size[telling], np.maximum(self.stderr[telling], CONSISTENCY.tolerance)
        return bool(np.all(np.abs(size - 1) < CONSISTENCY.widths * spread))

    @property
    def undetermined(self) -> bool:
        """Whether nothing but all of the motion together tells a size that every part of it should have."""
        return not self.tested and not (self.runs and self.paths)

    @property
    def words(self) -> str:
        """In a sentence."""
        if self.runs and self.paths:
            return f"it is there in {run_in_words(', '.join(self.runs))} only: no other path tells its size"
        if not self.tested:
            return f"by themselves, no two {'paths' if self.paths else PARTS} tell its size"
        telling = self.stderr < CONSISTENCY.telling
        shares = ", ".join(f"{100 * share:.0f}" for share in self.size[telling])
        if self.paths:
            return f"by itself, each path gives {shares} % of the size from all"
        return f"by themselves, {PARTS} give {shares} % of the size from all; no other path was recorded"


def agreement(selected: SelectedCauses, candidate: int) -> PathAgreement:
    """A cause's size from each block by itself: the factor on its fitted columns, all else fitted anew there.

    Args:
        selected: the selection.
        candidate: number of the cause's candidate.

    Returns:
        The factors with their standard errors.
    """
    paths = len(set(selected.rows.run.tolist())) > 1
    return replace(agreement_of(selected, paths, candidate), runs=selected.rows.layout.placed[candidate].runs)


class Weighed(Protocol):
    """A selection, of torques or of positions: sums by block, what competed, and what won."""

    @property
    def blocks(self) -> list[NormalEquations]:
        """Sums of each block."""

    @property
    def problem(self) -> Problem:
        """What competed, on their total."""

    @property
    def best(self) -> Hypothesis:
        """What won."""


def agreement_of(selected: Weighed, paths: bool, candidate: int) -> PathAgreement:
    """A candidate's size from each block by itself.

    Args:
        selected: a selection.
        paths: whether blocks are runs; else they are parts of one.
        candidate: its number.

    Returns:
        The factors with their standard errors.
    """
    columns = selected.problem.space.candidates[candidate].columns
    own = coefficients_of(selected.problem, selected.best)[columns] * selected.problem.scale[columns]
    return PathAgreement(*sizes_by_block(selected, columns, own), paths)


def sizes_by_block(selected: Weighed, columns: Indices, own: Array) -> tuple[Array, Array]:
    """How large the numbers of some columns are in each block by itself.

    Args:
        selected: a selection.
        columns: (c,) of them.
        own: (c,) numbers that count as one, in units of the problem's scale.

    Returns:
        (blocks,) as shares of these, and their standard errors.
    """
    found = [_factor_of(selected, columns, own, block) for block in selected.blocks]
    return np.array([size for size, _ in found]), np.array([error for _, error in found])


def combination_by_block(selected: Weighed, columns: Indices, weights: Array, free: Indices) -> tuple[Array, Array]:
    """How large a combination of numbers is in each block by itself, all others held near what all blocks say of them.

    Args:
        selected: a selection.
        columns: (c,) that it is of.
        weights: (c,) of their numbers, SI, in it.
        free: columns that no prior holds.

    Returns:
        (blocks,) and their standard errors.
    """
    best, at, scale = selected.best, selected.best.columns, selected.problem.scale
    precision = best.noise**2 / best.variance
    precision[best.at(free)] = 0.0
    own = np.zeros(len(at))
    own[best.at(columns)] = weights / scale[columns]
    found = []
    for block in selected.blocks:
        sums = block.scaled(scale)
        G = sums.G[np.ix_(at, at)] + np.diag(precision)
        G += 1e-12 * np.diag(np.maximum(np.diag(G), 1e-12 * np.diag(G).max()))
        solved = np.linalg.solve(G, np.column_stack([own, sums.b[at] + precision * best.mean]))
        found.append((own @ solved[:, 1], best.noise * np.sqrt(own @ solved[:, 0])))
    return np.array([value for value, _ in found]), np.array([error for _, error in found])


def factor_in(selected: Weighed, candidate: int, rows: NormalEquations) -> tuple[float, float]:
    """How large a candidate is by some rows alone.

    Args:
        selected: a selection.
        candidate: its number.
        rows: sums over these rows.

    Returns:
        Its size as a share of the size from all, and the standard error of that.
    """
    columns = selected.problem.space.candidates[candidate].columns
    own = coefficients_of(selected.problem, selected.best)[columns] * selected.problem.scale[columns]
    return _factor_of(selected, columns, own, rows)


def _factor_of(selected: Weighed, columns: Indices, own: Array, rows: NormalEquations) -> tuple[float, float]:
    best, scale = selected.best, selected.problem.scale
    others = np.setdiff1d(best.columns, columns)
    held = (best.noise**2 / best.variance[best.at(others)], best.means(others))
    return _factor(rows.scaled(scale), columns, own, others, held, best.noise)


def _factor(
    block: NormalEquations, columns: Indices, own: Array, others: Indices, held: tuple[Array, Array], noise: float
) -> tuple[float, float]:
    """Of one block; what else is in the model is held near what all blocks together say of it, by its prior."""
    precision, mean = held
    G = block.G[np.ix_(others, others)] + np.diag(precision)
    cross = block.G[np.ix_(others, columns)] @ own
    right = block.b[others] + precision * mean
    solved = np.linalg.solve(G + 1e-12 * np.diag(np.diag(G)), np.column_stack([cross, right]))
    power = own @ block.G[np.ix_(columns, columns)] @ own - cross @ solved[:, 0]
    pull = own @ block.b[columns] - cross @ solved[:, 1]
    if power <= 1e-12 * max(float(own @ block.G[np.ix_(columns, columns)] @ own), 1e-300):
        return 0.0, np.inf
    return float(pull / power), float(noise / np.sqrt(power))
