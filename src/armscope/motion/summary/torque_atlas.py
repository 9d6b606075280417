"""What the residual torque of each joint follows: the share that each driver explains, beyond what chance would."""

from __future__ import annotations

import numpy as np
from scipy.linalg import orth
from scipy.stats import chi2

from armscope.core.types import Array
from armscope.inference.linear_algebra import rss_reduction
from armscope.motion.constants import LIBRARY, TELLING
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.catalogue import UNEVEN
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import NAMED_OF_OWN, OWN
from armscope.motion.model.shapes import everything_is
from armscope.verdict.diagnosis import TOGETHER, Atlas

ACCELERATION, WITH_OFFSET = "acceleration", ("constant", "direction")
Block = tuple[str, float, Array]


def torque_atlas(selected: SelectedCauses) -> Atlas:
    """Joint x driver, on top of friction and rotors and on top of the fitted model.

    A cell holds what the best of the library's laws and free curves over a driver explains of the variance that
    friction and rotors leave of that joint's torque.

    Args:
        selected: the finished selection.

    Returns:
        Shares of each joint's variance, both of that which friction and rotors leave.
    """
    cells: dict[tuple[int, str], Array] = {}
    moving = [j for j, row in enumerate(selected.weights.row.T) if row.any()]
    residuals = selected.residuals
    for j in moving:
        for driver, shares in _of_joint(selected, j, residuals[:, j]):
            cells[j, driver] = np.maximum(cells.get((j, driver), 0.0), shares)
    drivers = tuple(dict.fromkeys(driver for _, driver in cells))
    values = np.full((2, len(moving), 1, len(drivers)), np.nan)
    for (j, driver), shares in cells.items():
        values[:, moving.index(j), 0, drivers.index(driver)] = shares
    return Atlas(tuple(f"joint {j + 1}" for j in moving), (TOGETHER,), drivers, values[0], values[1])


def _of_joint(selected: SelectedCauses, j: int, left: Array) -> list[tuple[str, Array]]:
    """(driver, shares before and after the model) of every law over what a joint's torque may follow."""
    rows, weights, layout = selected.rows, selected.weights, selected.rows.layout
    root = np.sqrt(weights.row[:, j])[:, None]
    # how friction changes sides and drives round off has no name: no cell may be coloured by it
    own = np.intersect1d(np.concatenate([layout.frames, layout.reversals[j], layout.response]), rows.at[j])
    # every free curve holds a constant: an offset counts in its own cell and that of its rival alone, friction by side
    free, levelled = (
        orth(root * rows.columns[j][:, np.searchsorted(rows.at[j], among)]) for among in (own, np.r_[own, OWN * j])
    )
    y = root * np.column_stack([rows.torque[:, j] - rows.nominal[:, j], left])
    whole, by_row = np.sum((y - free @ (free.T @ y))[:, 0] ** 2), weights.sigma[j] ** 2 * weights.correlated[j]
    found = []
    for driver, tried, columns in _blocks(selected, j):
        X, absorbed = root * columns, free if driver in WITH_OFFSET else levelled
        before = np.sum(X**2, axis=0)
        X -= absorbed @ (absorbed.T @ X)
        gain = np.array([rss_reduction((X.T @ X)[None], (X.T @ each)[None], before[None])[0] for each in y.T])
        chance = by_row * chi2.isf(TELLING.by_chance / tried, X.shape[1])
        found.append((driver, np.clip((gain - chance) / max(whole, 1e-300), 0.0, 1.0)))
    return found


def _blocks(selected: SelectedCauses, j: int) -> list[Block]:
    """(driver, values that were tried of a scanned number, columns (K, c)) of one joint's torque."""
    rows, layout = selected.rows, selected.rows.layout
    at, columns = rows.at[j], rows.columns[j]
    faster = columns[:, np.searchsorted(at, OWN * j + NAMED_OF_OWN.index("inertia"))].astype(np.float64)
    limits = np.percentile(faster, [1, 99])
    # the library has no curve over it: inertia is linear in it, and what is not has other names
    curve = Law("curve over speed", (0,), (*map(float, limits), LIBRARY.knots_of_others))
    blocks: list[Block] = [(ACCELERATION, 1, curve(everything_is(faster, 1))[:, 0])]
    for cause, index in zip(layout.placed, layout.columns, strict=True):
        single = cause.driver != UNEVEN  # two at once look like each alone, and like a load that follows the angle
        if single and j in cause.joints and cause.inertial is None and cause.location.startswith("joint"):
            blocks.append((cause.driver, cause.multiplicity, columns[:, np.searchsorted(at, index)].astype(np.float64)))
    return blocks
