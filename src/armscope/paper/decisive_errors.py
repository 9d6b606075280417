"""Why a claim depends on the robot: which of its geometric errors decide the number that the claim turns on.

The number (its logarithm where it is a ratio) is regressed on the known geometric errors of the drawn robots, each as
it is and by its size, since residuals grow with errors of either sign. Errors enter one by one, the one first that
predicts left-out robots best (leave-one-out), at most three. The share explained is that of robots which took no part
in choosing or fitting: the whole selection is repeated in ten folds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.types import Array

MOST_ERRORS = 3
FOLDS = 10
WORTH = 0.02  # An error enters if the share explained grows by this
SPEAKS_FROM = 0.1  # Below this share, nothing is said to decide

MEANINGS = {
    "a": "length a", "alpha": "twist α", "d": "offset d", "theta": "zero of joint", "beta": "tilt of axis",
    "base x": "base along x", "base y": "base along y", "base z": "base along z",
    "base rx": "base about x", "base ry": "base about y", "base rz": "base about z",
}  # fmt: skip


@dataclass(frozen=True)
class Reason:
    """What decides a claim."""

    errors: tuple[str, ...]  # names, the strongest first
    share: float  # of the number's variance over the robots, explained on robots held out


def reasons(per_robot: pd.DataFrame, geometric: pd.DataFrame) -> pd.DataFrame:
    """For each claim that some robots bear out and others don't, what decides.

    Args:
        per_robot: columns key, method, robot, true, number (see `armscope.paper.claims.judge_claims`).
        geometric: one row per drawn robot, columns robot and each geometric error in tolerances.

    Returns:
        Columns key, method, robots, errors (names, the strongest first, with commas; empty where nothing speaks), share
        (explained on held-out robots), sentence.
    """
    rows: list[dict[str, object]] = []
    errors = geometric.set_index("robot")
    for (key, method), outcome in per_robot.groupby(["key", "method"], sort=False):
        mine = outcome[outcome["robot"].isin(errors.index)]
        if mine["true"].nunique() < 2:
            continue
        values = errors.reindex(mine["robot"]).to_numpy(dtype=float)
        found = explain(values, target(mine), list(errors.columns))
        rows.append(
            {
                "key": key,
                "method": method,
                "robots": len(mine),
                "errors": ", ".join(found.errors),
                "share": found.share,
                "sentence": sentence(found),
            }
        )
    return pd.DataFrame(rows, columns=["key", "method", "robots", "errors", "share", "sentence"])


def target(outcome: pd.DataFrame) -> Array:
    """What is explained: the logarithm of a positive number, else whether the claim is true (0 or 1)."""
    numbers = outcome["number"].to_numpy(dtype=float)
    if np.isfinite(numbers).all() and (numbers > 0).all():
        return np.asarray(np.log(numbers))
    return outcome["true"].to_numpy(dtype=float)


def explain(errors: Array, number: Array, names: list[str]) -> Reason:
    """Which few errors explain a number, and how well on robots held out.

    Args:
        errors: (R, K) in tolerances.
        number: (R,).
        names: of the K errors.

    Returns:
        The errors, and how much of the number they explain on robots held out.
    """
    chosen = _chosen(errors, number)
    folds = np.arange(len(number)) % FOLDS
    left = np.empty_like(number)
    for fold in range(min(FOLDS, len(number))):
        out = folds == fold
        picked = _chosen(errors[~out], number[~out])
        fitted = np.linalg.lstsq(_columns(errors[~out], picked), number[~out], rcond=None)[0]
        left[out] = number[out] - _columns(errors[out], picked) @ fitted
    spread = float(np.sum((number - number.mean()) ** 2))
    share = 1 - float(np.sum(left**2)) / spread if spread > 0 else 0.0
    return Reason(tuple(names[k] for k in chosen), max(0.0, share))


def sentence(reason: Reason) -> str:
    """The reason in words."""
    if reason.share < SPEAKS_FROM or not reason.errors:
        return "No few geometric errors decide it; it takes most of them together."
    names = [meaning(name) for name in reason.errors]
    listed = names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
    return (
        f"Decided most by the error of {listed}: {100 * reason.share:.0f} % of the variation between robots held out."
    )


def meaning(name: str) -> str:
    """A geometric error in words: "length a2", "zero of joint 3"."""
    if name in MEANINGS:
        return MEANINGS[name]
    kind = name.rstrip("0123456789")
    number = name[len(kind) :]
    word = MEANINGS.get(kind, kind)
    return f"{word} {number}" if kind in ("theta", "beta") else f"{word}{number}"


def _columns(errors: Array, chosen: list[int]) -> Array:
    mine = errors[:, chosen]
    return np.column_stack([np.ones(len(errors)), mine, np.abs(mine)])


def _chosen(errors: Array, number: Array) -> list[int]:
    """Forward selection by the share explained in leave-one-out."""
    chosen: list[int] = []
    best = 0.0
    for _ in range(MOST_ERRORS):
        candidates = [k for k in range(errors.shape[1]) if k not in chosen and np.ptp(errors[:, k]) > 0]
        if len(number) <= 2 * (len(chosen) + 1) + 2 or not candidates:
            break
        shares = _left_out_shares(np.stack([_columns(errors, [*chosen, k]) for k in candidates]), number)
        top = int(np.argmax(shares))
        if shares[top] < best + WORTH:
            break
        chosen, best = [*chosen, candidates[top]], float(shares[top])
    return chosen


def _left_out_shares(columns: Array, number: Array) -> Array:
    """(K,) shares of the variance that linear fits (K, R, n) explain in leave-one-out, by their hat matrices."""
    turned = columns.swapaxes(1, 2)
    inverse = np.linalg.pinv(turned @ columns, hermitian=True) @ turned
    leverage = np.einsum("krn,knr->kr", columns, inverse)
    fitted = np.squeeze(columns @ (inverse @ number[:, None]), axis=2)
    left = (number - fitted) / np.maximum(1e-12, 1 - leverage)
    return np.asarray(1 - np.sum(left**2, axis=1) / np.sum((number - number.mean()) ** 2))
