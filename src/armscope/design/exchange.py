"""Exchange algorithms: the n of N candidate poses that tell most about p parameters.

D-optimality by Fedorov's exchange (1972) in the form of Mitchell's DETMAX (1974) without longer excursions and of
Cook & Nachtsheim's modified exchange (1980): each chosen pose in turn, the one that is missed least first, makes room
for the candidate that then adds most. A pose has three rows, so a swap changes the information matrix by rank
three, and with the candidates' predicted variances D_c = J_c M^-1 J_c' (3 x 3) at hand,

    det(M - J_o'J_o + J_c'J_c) / det M = det(1 - D_o) det(1 + D_c + C_c (1 - D_o)^-1 C_c'),    C_c = J_c M^-1 J_o'.

Several starts: greedy growth, then random sets. Other indices start from the D-optimal set and exchange by the exact
index among the swaps that promise most by its first-order slope.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.design.indices import observability, observability_slopes

Rows = Indices

WORTHWHILE = 1e-6  # A swap that gains less than this share is not made: it would only follow rounding
SHORTLIST = (6, 30)  # Poses that may leave, and candidates that may enter, in a round of the exchange for O2 to O5
ROUNDS = 200


def d_optimal(jacobian: Array, count: int, rng: np.random.Generator, starts: int = 3) -> Rows:
    """(count,) rows of the candidates (N, 3, p) with the largest determinant found of their information, ascending.

    Args:
        jacobian: of N candidates, of full column rank.
        count: how many to choose.
        rng: draws the starts after the first.
        starts: local optima to compare.

    Returns:
        (count,) row numbers, ascending.

    Raises:
        ValueError: fewer candidates than poses, or too few poses for the parameters.
    """
    _check(jacobian, count)
    whitened = _whitened(jacobian)
    best, best_volume = np.arange(count), -np.inf
    for start in range(starts):
        rows = _grown(whitened, count) if start == 0 else rng.choice(len(jacobian), count, replace=False)
        rows = _exchanged(whitened, rows)
        volume = _log_volume(whitened, rows)
        if volume > best_volume + WORTHWHILE:
            best, best_volume = rows, volume
    return np.sort(best)


def optimal(index: str, jacobian: Array, count: int, rng: np.random.Generator, starts: int = 3) -> Rows:
    """(count,) rows of the candidates (N, 3, p) with the largest observability index found; see `d_optimal`.

    Args:
        index: one of `indices.SOURCES`.
        jacobian: (N, 3, p) of N candidates, of full column rank.
        count: how many to choose.
        rng: draws the starts after the first.
        starts: local optima to compare.

    Returns:
        (count,) row numbers, ascending.
    """
    rows = d_optimal(jacobian, count, rng, starts)
    return rows if index == "O1" else np.sort(_improved(index, jacobian, rows))


def _check(jacobian: Array, count: int) -> None:
    if count > len(jacobian):
        raise ValueError(f"{count} poses from {len(jacobian)} candidates: there must be at least as many candidates")
    if 3 * count < jacobian.shape[2]:
        needed = -(-jacobian.shape[2] // 3)
        raise ValueError(f"{count} poses for {jacobian.shape[2]} parameters: a pose gives 3 numbers, {needed} at least")


def _whitened(jacobian: Array) -> Array:
    """Parameters combined such that all candidates together show each alike: the determinants' order stays."""
    stacked = jacobian.reshape(-1, jacobian.shape[2])
    triangular = np.linalg.qr(stacked, mode="r") / np.sqrt(len(jacobian))
    whitened: Array = np.linalg.solve(triangular.T, stacked.T).T.reshape(jacobian.shape)
    return np.ascontiguousarray(np.moveaxis(whitened, 1, 0))


def _log_volume(whitened: Array, rows: Rows) -> float:
    chosen = whitened[:, rows].reshape(-1, whitened.shape[2])
    sign, value = np.linalg.slogdet(chosen.T @ chosen)
    return float(value) if sign > 0 else -np.inf


@dataclass(eq=False)
class _Information:
    """Inverse information of some poses, and what each of N candidates varies by under it."""

    whitened: Array  # (3, N, p)
    inverse: Array  # (p, p)
    variance: Array  # (6, N) upper triangle of D_c: xx, xy, xz, yy, yz, zz

    @staticmethod
    def of(whitened: Array, information: Array) -> _Information:
        inverse = np.asarray(np.linalg.inv(information), dtype=float)
        return _Information(whitened, inverse, _inner(whitened @ np.linalg.cholesky(inverse)))

    def variance_of(self, row: int) -> Array:
        """(3, 3) D of one candidate."""
        pose = self.whitened[:, row]
        return pose @ self.inverse @ pose.T

    def changed(self, row: int, sign: float) -> _Information:
        """With one pose more (sign 1) or less (-1): rank three (Sherman, Morrison & Woodbury)."""
        pose = self.whitened[:, row]
        toward = self.inverse @ pose.T
        # by the factor of the sum, not of its inverse: a pose that shows new and known at once has both large and small
        root = np.linalg.cholesky(np.eye(3) + sign * pose @ toward)
        step = np.linalg.solve(root, toward.T).T
        change = _inner(self.whitened @ step)
        return _Information(self.whitened, self.inverse - sign * step @ step.T, self.variance - sign * change)

    def gains(self) -> Array:
        """(N,) by what factor one more pose multiplies the determinant."""
        xx, xy, xz, yy, yz, zz = self.variance
        a, b, c = 1 + xx, 1 + yy, 1 + zz
        gains: Array = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
        return gains


def _inner(columns: Array) -> Array:
    """(6, N) upper triangle of X_c X_c' for X_c = columns[:, c] (3, k)."""
    pairs = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
    return np.array([np.einsum("nk,nk->n", columns[i], columns[j]) for i, j in pairs])


def _grown(whitened: Array, count: int) -> Rows:
    """Greedy: at each step the candidate that multiplies the determinant most."""
    weak = 1e-6 * np.eye(whitened.shape[2])  # lets the first poses be compared; without weight later
    information, chosen = _Information.of(whitened, weak), list[int]()
    for number in range(count):
        if number == 2 * whitened.shape[2]:  # the weak start costs digits
            information = _Information.of(whitened, weak + _gram(whitened, np.array(chosen)))
        gains = information.gains()
        gains[chosen] = -np.inf
        chosen.append(int(np.argmax(gains)))
        information = information.changed(chosen[-1], 1.0)
    return np.array(chosen)


def _gram(whitened: Array, rows: Rows) -> Array:
    stacked = whitened[:, rows].reshape(-1, whitened.shape[2])
    return stacked.T @ stacked


def _exchanged(whitened: Array, rows: Rows) -> Rows:
    """Exchanges until no single swap gains: every chosen pose has then been tried against every candidate."""
    rows = rows.copy()
    floor = 1e-9 * np.eye(whitened.shape[2])  # a random start may not show every parameter yet
    for _ in range(ROUNDS):
        information, gained = _Information.of(whitened, floor + _gram(whitened, rows)), False
        losses = [float(np.linalg.det(np.eye(3) - information.variance_of(row))) for row in rows]
        for place in np.argsort(losses)[::-1]:
            row = int(rows[place])
            kept = float(np.linalg.det(np.eye(3) - information.variance_of(row)))
            if kept < 1e-9:
                continue  # without this pose some parameter could not be told any more
            without = information.changed(row, -1.0)
            gains = without.gains()
            gains[np.delete(rows, place)] = -np.inf
            best = int(np.argmax(gains))
            if best != row and kept * gains[best] > 1 + WORTHWHILE:
                rows[place], gained = best, True
                information = without.changed(best, 1.0)
        if not gained:
            break
    return rows


def _improved(index: str, jacobian: Array, rows: Rows) -> Rows:
    """Exchanges by the exact index among the most promising swaps, until none of these gains."""
    rows = rows.copy()
    leave, enter = SHORTLIST
    grams = np.einsum("nij,nik->njk", jacobian, jacobian)
    for _ in range(ROUNDS):
        information = grams[rows].sum(axis=0)
        values, vectors = np.linalg.eigh(information)
        singular = np.sqrt(np.maximum(values[::-1], 0))
        now = float(observability(index, singular, len(rows)))
        if now <= 0:
            break
        promise = np.sum((jacobian @ vectors[:, ::-1]) ** 2, axis=1) @ observability_slopes(index, singular)
        places = np.argsort(promise[rows], kind="stable")[:leave]
        free = np.setdiff1d(np.arange(len(jacobian)), rows)
        entering = free[np.argsort(-promise[free], kind="stable")[:enter]]
        tried = information - grams[rows[places]][:, None] + grams[entering][None]
        exact = observability(index, np.sqrt(np.maximum(np.linalg.eigvalsh(tried), 0)), len(rows))
        place, new = np.unravel_index(int(np.argmax(exact)), exact.shape)
        if exact[place, new] <= now * (1 + WORTHWHILE):
            break
        rows[places[place]] = entering[new]
    return rows
