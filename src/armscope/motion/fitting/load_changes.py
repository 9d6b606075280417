"""When the load changes within a run: a load at the last link that is there or not, row by row.

Beside friction, rotors, masses and whatever has a name already, a load is tried between any two of some cells of the
run, by sums of these cells alone. From the best on, two steps take turns until the moments rest: the load and all else
are fitted, and the likeliest sequence of with and without is found, in which each change has a price (Viterbi 1967).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from armscope.core.types import Array, Indices
from armscope.inference.constants import PRIORS
from armscope.inference.linear_algebra import lower_cholesky, solve_lower
from armscope.motion.constants import NOISE
from armscope.motion.fitting.load_cells import LOAD, Cells, JointRows
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.weights import autocorrelation_time
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.changes import Change


@dataclass(frozen=True, eq=False)
class _Fit:
    """The load's numbers (4,), in shares of `scale`; what it and all else leave (K, m); its torque (K, m), N m."""

    load: Array
    left: Array
    of_load: Array


def load_changes(selected: SelectedCauses, cutoff: float) -> list[Change]:
    """Loads that come or go within a run, of every run that shows one.

    Args:
        selected: a selection without them.
        cutoff: of the low-pass of its rows, Hz.

    Returns:
        At most one of each run, with all its moments.
    """
    if selected.rows.layout.arm.n_links < 2:
        return []
    found = (_Run(selected, str(run), cutoff).change() for run in dict.fromkeys(selected.rows.run.tolist()))
    return [change for change in found if change is not None]


class _Run:
    """One run's rows, and a load at the last link beside all else."""

    def __init__(self, selected: SelectedCauses, run: str, cutoff: float) -> None:
        rows, self.layout, self.run = selected.rows, selected.rows.layout, run
        row = selected.weights.row
        self.which = np.flatnonzero((rows.run == run) & (row > 0).any(axis=1))
        self.time, self.stretch = rows.time[self.which], rows.stretch[self.which]
        used = self._used(selected)
        self.scale = self.layout.inertial_scale[-10 : -10 + LOAD]
        place = np.full(self.layout.width, -1)
        place[used] = np.arange(len(used))
        self.joints = [self._joint(selected, j, place, row[self.which, j]) for j in range(row.shape[1])]
        self.prior = np.zeros(len(used))
        self.prior[place[self.layout.inertial]] = CHANGE.free**-2
        heavy = float(self.layout.arm.inertial[::10].sum())
        self.prior_of_load = (self.scale / (CHANGE.heaviest_load * heavy * np.r_[1.0, [self.layout.reach] * 3])) ** 2
        self.unit, self.rises = 1 / selected.weights.lasting, 2 * np.sqrt(2 * np.pi) * cutoff

    def _used(self, selected: SelectedCauses) -> Indices:
        """What is always there, and what has a law; free curves, whatever they follow, take up what changes, too."""
        layout = self.layout
        placed = {number: layout.placed[number] for number in selected.best.candidates}
        named = [layout.columns[n] for n, cause in placed.items() if not (cause.is_curve or cause.cause.nameless)]
        return np.unique(np.concatenate([layout.own, layout.inertial, layout.response, *named]))

    def _joint(self, selected: SelectedCauses, j: int, place: Indices, row: Array) -> JointRows:
        rows = selected.rows
        at, gain = rows.at[j], rows.gain_of_columns(j)
        kept, of_load = np.flatnonzero(place[at] >= 0), np.searchsorted(at, self.layout.inertial[-10 : -10 + LOAD])
        without = rows.pauses[j].without
        X = (without(rows.columns[j][:, kept])[self.which] * gain[kept]).astype(np.float64)
        L = (without(rows.columns[j][:, of_load])[self.which] * gain[of_load]).astype(np.float64)
        y = without(rows.torque[:, j] - rows.nominal[:, j])[self.which]
        weighted = row[:, None] * X
        return JointRows(place[at[kept]], X, L, y, row, X.T @ weighted, weighted.T @ y)

    def change(self) -> Change | None:
        """The load that comes or goes in this run; None where none is worth the price of its moments."""
        if len(self.which) < 3 * CHANGE.least_rows or not np.any(self.unit > 0):
            return None
        price = float(np.log(len(self.which)) + PRIORS.sure_nats)
        there = self._roughly(price)
        for eager in (True, False):  # as long as spells are missing, what is left lasts, and hides them
            for _ in range(CHANGE.rounds):
                self.unit = self._units(self._fitted(there).left, not eager)
                again = self._held(likeliest(self._worth(self._fitted(there), there), price))
                if again.all() or not again.any() or np.array_equal(again, there):
                    break
                there = again
        there = self._held(there)
        turns = np.flatnonzero(np.diff(there.astype(np.int8)))
        if not len(turns) or self._gained(there) < price * (len(turns) + 1):
            return None
        fit = self._fitted(there)
        moments, unsure = zip(*(self._moment(fit, there, int(k)) for k in turns), strict=True)
        load = fit.load * self.scale
        return Change(self.run, bool(there[0]), tuple(moments), max(unsure), load, len(self.which))

    def _roughly(self, price: float) -> NDArray[np.bool_]:
        """(K,) with a load in some cells: in one spell, and in more as long as each is worth both its moments."""
        cells = Cells(self.joints, len(self.prior))
        there = np.zeros(cells.count, dtype=np.bool_)
        for number in range(CHANGE.spells):
            A, b = self._sums()
            more, gained = cells.with_another_spell(there, self.unit, (A, b, self._ridge(A)), self.prior_of_load)
            if number and gained < 2 * price:
                break
            there = more
            self.unit = self._units(self._fitted(cells.rows(there)).left, lasting=False)
        return cells.rows(there)

    def _sums(self) -> tuple[Array, Array]:
        """(P, P) and (P,) of the columns in use, by the joints' units."""
        A, b = np.zeros((len(self.prior),) * 2), np.zeros(len(self.prior))
        for unit, own in zip(self.unit, self.joints, strict=True):
            A[np.ix_(own.at, own.at)] += unit * own.A
            b[own.at] += unit * own.b
        return A, b

    def _ridge(self, A: Array) -> Array:
        return self.prior + NOISE.ridge * np.diag(A) + np.where(np.diag(A) > 0, 0.0, 1.0)

    def _fitted(self, there: NDArray[np.bool_] | None) -> _Fit:
        """The load while it is there, and all else; without a load where that is None."""
        A, b = self._sums()
        P, count = len(b), 0 if there is None else LOAD
        G, right = np.zeros((P + count,) * 2), np.zeros(P + count)
        G[:P, :P], right[:P] = A, b
        for unit, own in zip(self.unit, self.joints, strict=True):
            if there is not None:
                weighted = unit * (own.row * there)[:, None] * own.L
                G[P:, own.at] += weighted.T @ own.X
                G[P:, P:] += weighted.T @ own.L
                right[P:] += weighted.T @ own.y
        G[:P, P:] = G[P:, :P].T
        ridge = np.r_[self._ridge(A), self.prior_of_load[:count]]
        factor = lower_cholesky(G, ridge)
        numbers = np.linalg.solve(factor.T, solve_lower(factor, right))
        load = np.zeros(LOAD)
        load[:count] = numbers[P:]
        of_load = np.column_stack([own.L @ load for own in self.joints])
        left = np.column_stack([own.y - own.X @ numbers[own.at] for own in self.joints])
        return _Fit(load, left - (0.0 if there is None else there[:, None]) * of_load, of_load)

    def _units(self, left: Array, lasting: bool = True) -> Array:
        """(m,) what a square of torque is worth at each joint, two nats; of all rows or as many as are independent."""
        found = np.zeros(left.shape[1])
        for j, own in enumerate(self.joints):
            power = float(own.row @ left[:, j] ** 2) / max(float(own.row.sum()), 1.0)
            lasts = autocorrelation_time(self.stretch, np.sqrt(own.row) * left[:, j]) if lasting else 1.0
            least = (NOISE.least_share * max(float(np.std(own.y)), 1e-9)) ** 2
            found[j] = 1 / (max(power, least) * lasts)
        return found

    def _worth(self, fit: _Fit, there: NDArray[np.bool_]) -> Array:
        """(K,) nats by which a row is likelier with the load than without."""
        without = fit.left + there[:, None] * fit.of_load
        row = np.column_stack([own.row for own in self.joints])
        return np.asarray((row * fit.of_load * (without - fit.of_load / 2)) @ self.unit)

    def _held(self, there: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Without spells, with or without the load, that are shorter than any gripper's.

        Nor at the ends of the run: in a few rows there a load fits whatever the low-pass of the positions left.
        """
        while True:
            ends = np.r_[-1, np.flatnonzero(np.diff(there.astype(np.int8))), len(there) - 1]
            long = self.time[ends[1:]] - self.time[ends[:-1].clip(0)]
            if len(long) == 1 or long.min() >= CHANGE.least_held_s:
                return there
            n = int(np.argmin(long))
            there = there.copy()
            there[ends[n] + 1 : ends[n + 1] + 1] ^= True

    def _gained(self, there: NDArray[np.bool_]) -> float:
        """Nats by which the run is likelier with the load, each joint by its own noise."""
        fit = self._fitted(there)
        self.unit = self._units(fit.left)
        with_load, without = self._fitted(there).left, self._fitted(None).left
        nats = 0.0
        for j, own in enumerate(self.joints):
            one, other = (float(own.row @ each[:, j] ** 2) for each in (with_load, without))
            rows = float(own.row.sum()) / autocorrelation_time(self.stretch, np.sqrt(own.row) * with_load[:, j])
            nats += 0.5 * rows * float(np.log(max(other, 1e-300) / max(one, 1e-300))) if own.row.any() else 0.0
        return nats

    def _moment(self, fit: _Fit, there: NDArray[np.bool_], k: int) -> tuple[float, float]:
        """When the load comes or goes between rows k and k + 1, s, and by how much that may be off.

        Rows hold the load through the low-pass, which makes of a step one that rises as fast as rows are apart. Where
        joints stood in between, nothing tells when.
        """
        apart, usual = self.time[k + 1] - self.time[k], float(np.median(np.diff(self.time)))
        if apart > CHANGE.pause * usual:
            return float(self.time[k] + apart / 2), float(apart / 2)
        some = slice(max(k + 1 - CHANGE.near, 0), k + 1 + CHANGE.near)
        row = np.column_stack([own.row[some] for own in self.joints]) * self.unit
        without, of_load = (fit.left + there[:, None] * fit.of_load)[some], fit.of_load[some]
        tried = self.time[k] + usual * np.linspace(-1, 2, 3 * CHANGE.steps + 1)
        share = ndtr((self.time[some] - tried[:, None]) * self.rises)
        share = share if there[k + 1] else 1 - share
        nats = np.sum(row * (without - share[:, :, None] * of_load) ** 2, axis=(1, 2)) / 2
        alike, at = tried[nats < nats.min() + CHANGE.as_good_nats], float(tried[np.argmin(nats)])
        first, last = as_likely(self._worth(fit, there), there, k)
        rows_away = [at - self.time[first] if first < k - 1 else 0.0, self.time[last + 1] - at if last > k + 1 else 0.0]
        return at, float(max(np.ptp(alike) / 2, usual / CHANGE.steps, *rows_away))


def likeliest(worth: Array, price: float) -> NDArray[np.bool_]:
    """The likeliest sequence of with and without (Viterbi 1967).

    Args:
        worth: (K,) nats by which a row is likelier with than without.
        price: nats of each change.

    Returns:
        (K,) whether with.
    """
    came, without, with_it = np.zeros((len(worth), 2), dtype=np.bool_), 0.0, 0.0
    for k, nats in enumerate(worth.tolist()):
        came[k] = with_it - price > without, without - price > with_it
        without, with_it = max(without, with_it - price), max(with_it, without - price) + nats
    found = np.empty(len(worth), dtype=np.bool_)
    state = int(with_it > without)
    for k in range(len(worth) - 1, -1, -1):
        found[k] = bool(state)
        state = 1 - state if came[k, state] else state
    return found


def as_likely(worth: Array, there: NDArray[np.bool_], k: int) -> tuple[int, int]:
    """After which rows the load may as well come or go as after row k, between its moments before and behind.

    Where joints stand or hardly move, the rows in between tell nothing.

    Args:
        worth: (K,) nats by which a row is likelier with the load than without.
        there: (K,) with a load, which comes or goes after row k.
        k: from 0.

    Returns:
        The first and the last such row.
    """
    turns = np.r_[-1, np.flatnonzero(np.diff(there.astype(np.int8))), len(there) - 1]
    n = int(np.searchsorted(turns, k))
    after = np.arange(turns[n - 1] + 1, turns[n + 1])
    so_far = np.cumsum(worth)[after]
    lost = (so_far - so_far[k - after[0]]) * (1 if there[k + 1] else -1)
    as_good = after[lost < CHANGE.as_good_nats]
    return int(as_good[0]), int(as_good[-1])
