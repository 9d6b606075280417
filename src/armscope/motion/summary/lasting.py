"""Torque that lasts and has no law here: what the model leaves at a joint, if other motion foretells it.

Smooth torque that follows no law of the library counts as noise that lasts (`armscope.motion.fitting.weights`), and
evidence asks for nothing. Noise does not come back where the arm comes back: what maps over one or two of the joints'
angles, speeds and torques, fitted to other paths (other parts of a single one), foretell of it, is no noise. Chance is
judged by the same residual shifted in time, which lasts as long and follows nothing.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from armscope.core.types import Array, Indices
from armscope.inference.search import Search
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.selected import SelectedCauses, coefficients_of
from armscope.motion.library.layout import NAMED_OF_OWN, OWN
from armscope.motion.summary.constants import LASTING
from armscope.verdict.schema import Notice
from armscope.verdict.wording import capitalised, percent

Driver = tuple[str, int]
"""A quantity, and the joint (from 0) that it is of."""
Map = tuple[str, Array]
"""What it follows in words, and its columns (K, c)."""

LASTS = "something lasts that has no law here"
"""How a sentence on it begins."""


@dataclass(frozen=True)
class LastingTorque:
    """Of one joint."""

    joint: int  # from 0
    driver: str  # what it follows, in words
    rms: float  # of what is foretold, N m or N
    of_torque: float  # that, as a share of the joint's RMS torque
    share: float  # its power, as a share of what friction and rotors leave at the joint


def lasting_torques(selected: SelectedCauses) -> tuple[LastingTorque, ...]:
    """Joints whose residual is foretold by other motion although no law of the library has it; largest share first."""
    rows, found = selected.rows, []
    residuals = selected.residuals
    before = left_by_friction(selected)
    for j in range(residuals.shape[1]):
        which = np.flatnonzero(selected.weights.row[:, j] > 0)
        if len(which) < LASTING.least_rows:
            continue
        every = -(-len(which) // LASTING.rows)
        which = which[::every]
        left = residuals[which, j] - np.mean(residuals[which, j])
        foretold, driver = _foretold(selected, j, which, left, max(selected.weights.correlated[j] / every, 1.0))
        power = foretold * float(np.mean(left**2))
        share = power / max(float(np.mean(before[which, j] ** 2)), 1e-300)
        if foretold > LASTING.repeats and share > LASTING.share:
            torque = max(float(np.sqrt(np.mean(rows.torque[which, j] ** 2))), 1e-300)
            rms = float(np.sqrt(power))
            found.append(LastingTorque(j, driver, rms, rms / torque, share))
    return tuple(sorted(found, key=lambda each: -each.share))


def left_by_friction(selected: SelectedCauses) -> Array:
    """(K, m) torque that friction and rotors leave, N m or N."""
    rows, ordinary = selected.rows, Search.on(selected.problem).perfect()
    modelled = rows.modelled(coefficients_of(selected.problem, ordinary))
    return rows.without_pauses(rows.torque - rows.nominal - modelled)


def _foretold(selected: SelectedCauses, joint: int, which: Indices, left: Array, lasts: float) -> tuple[float, str]:
    """(share of its power, by what) of the best map that chance hardly equals; 0 where there is none."""
    block, maps = selected.block[which], functools.partial(_maps, selected, joint, which)
    tried = [(driver, _gains(columns, left[:, None], block, lasts)[0]) for driver, columns in maps()]
    driver, best = max(tried, key=lambda each: each[1], default=("", 0.0))
    if best <= LASTING.repeats:
        return 0.0, ""
    rng = np.random.default_rng(len(which))
    low, high = (int(share * len(which)) for share in LASTING.beyond)
    shifted = np.column_stack([np.roll(left, by) for by in rng.integers(low, high, LASTING.shifts)])
    of_shifted = np.max([_gains(columns, shifted, block, lasts) for _, columns in maps()], axis=0)
    chance = float(np.quantile(of_shifted, 1 - LASTING.by_chance))
    return (best, driver) if best > chance else (0.0, "")


def _gains(columns: Array, left: Array, block: Indices, lasts: float) -> Array:
    """(S,) share of the power of each residual (K, S) that a map foretells, each block by the others.

    A coefficient is believed to be as large as the residual; ``lasts`` rows in a row say the same.
    """
    members = [np.flatnonzero(block == number) for number in np.unique(block)]
    grams = [columns[own].T @ columns[own] for own in members]
    pulls = [columns[own].T @ left[own] for own in members]
    G, b = np.sum(grams, axis=0) + lasts * np.eye(columns.shape[1]), np.sum(pulls, axis=0)
    missed = np.zeros(left.shape[1])
    for own, gram, pull in zip(members, grams, pulls, strict=True):
        missed += np.sum((left[own] - columns[own] @ np.linalg.solve(G - gram, b - pull)) ** 2, axis=0)
    return np.asarray(1 - missed / np.maximum(np.sum(left**2, axis=0), 1e-300))


def _maps(selected: SelectedCauses, joint: int, which: Indices) -> Iterator[Map]:
    """What a joint's torque may follow: one driver and the direction, or two drivers."""
    rows, side = selected.rows, np.sign(selected.rows.dq[which, joint])[:, None]
    drivers = _drivers(selected, joint, which)
    for (name, k), values in drivers.items():
        curve = hats(values, LASTING.knots)
        yield _in_words((name, k), ("direction", joint)), np.hstack([curve, side * curve])
    for one, more in (("angle", ("torque", "angle")), ("speed", ("acceleration", "angle", "speed"))):
        for driver, values in drivers.items():
            if driver != (one, joint) and driver[0] in more:
                yield _in_words((one, joint), driver), _pair(drivers[one, joint], values)
    if len(np.unique(rows.run)) > 1:
        since = rows.time.copy()
        for run in np.unique(rows.run):
            since[rows.run == run] -= since[rows.run == run].min()
        yield "time in each run", hats(since[which], LASTING.knots_of_time)


def _in_words(one: Driver, other: Driver) -> str:
    if one[1] == other[1]:
        return f"{one[0]} and {other[0]} of joint {one[1] + 1}"
    if one[0] == other[0]:
        return f"{one[0]}s of joints {min(one[1], other[1]) + 1} and {max(one[1], other[1]) + 1}"
    return f"{one[0]} of joint {one[1] + 1} and {other[0]} of joint {other[1] + 1}"


def _drivers(selected: SelectedCauses, joint: int, which: Indices) -> dict[Driver, Array]:
    """What maps are over: of the joint itself, and of the others that move."""
    rows, torque = selected.rows, selected.modelled[which]
    own = rows.columns[joint][which, np.searchsorted(rows.at[joint], OWN * joint + NAMED_OF_OWN.index("inertia"))]
    found: dict[Driver, Array] = {}
    for k in range(torque.shape[1]):
        if k == joint or np.any(selected.weights.row[:, k]):
            found |= {("angle", k): rows.q[which, k], ("speed", k): rows.dq[which, k], ("torque", k): torque[:, k]}
    found["acceleration", joint] = own.astype(np.float64)
    return found | {(f"torque of the last {s:g} s", joint): each for s, each in _remembered(rows, torque, which, joint)}


def _remembered(rows: MotionRows, torque: Array, which: Indices, joint: int) -> Iterator[tuple[float, Array]]:
    """A joint's torque, forgotten over some seconds."""
    for seconds in LASTING.seconds:
        found = np.empty(len(which))
        for number in np.unique(rows.stretch[which]):
            there = np.flatnonzero(rows.stretch[which] == number)
            step = float(np.median(np.diff(rows.time[which][there]))) if len(there) > 1 else 1.0
            kept = float(np.exp(-step / seconds))
            values = torque[there, joint]
            found[there] = lfilter([1 - kept], [1, -kept], values, zi=[kept * values[0]])[0]
        yield seconds, found


def hats(values: Array, knots: int) -> Array:
    """Hat functions that sum to one, at evenly spaced ranks: as many rows under each.

    Args:
        values: (K,).
        knots: how many.

    Returns:
        (K, knots).
    """
    ranks = np.argsort(np.argsort(values)) * ((knots - 1) / max(len(values) - 1, 1))
    return np.asarray(np.maximum(1 - np.abs(ranks[:, None] - np.arange(knots)), 0.0))


def _pair(one: Array, other: Array) -> Array:
    first, second = (hats(values, LASTING.knots_of_pairs) for values in (one, other))
    return np.asarray((first[:, :, None] * second[:, None, :]).reshape(len(one), -1))


def lasting_words(lasting: Sequence[LastingTorque]) -> str:
    """What lasts and has no law, joint by joint, in a sentence without its full stop."""
    told = [
        f"{percent(each.of_torque)} of the torque of joint {each.joint + 1}, following the {each.driver}"
        for each in lasting
    ]
    return f"{LASTS}: {'; '.join(told)}"


def told_of_lasting(lasting: Sequence[LastingTorque]) -> list[Notice]:
    """A notice on all of it, where the headline has one of several."""
    return [Notice("lasting torque", f"{capitalised(lasting_words(lasting))}.")] if len(lasting) > 1 else []
