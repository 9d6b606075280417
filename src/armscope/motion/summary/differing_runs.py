"""Torque that is not the same in all runs: a drive or sensor set to zero anew, another gain, something that drifts.

It foretells no other run, and counts as noise that lasts (`armscope.motion.fitting.weights`): evidence asks for
nothing, and nothing would be missing. But beside what a run leaves about its own line, it is plain to see.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.core.words import enumerated, rounded
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses, coefficients_of
from armscope.motion.fitting.weights import autocorrelation_time
from armscope.motion.library.clauses import run_in_words
from armscope.motion.summary.constants import DIFFERING, LASTING
from armscope.motion.summary.lasting import LastingTorque, hats

_REASONS = (("a zero set anew",), ("another drive gain", "other friction"))


def differing_runs(selected: SelectedCauses) -> tuple[LastingTorque, ...]:
    """Joints whose torque reads otherwise from run to run, or drifts or jumps within one; largest share first.

    Args:
        selected: the selection.

    Returns:
        What of each joint's torque that is, and by how much it differs in which run.
    """
    rows, found = selected.rows, []
    if len(set(rows.run.tolist())) < 2:
        return ()
    ordinary = Search.on(selected.problem).perfect()
    before = rows.without_pauses(
        rows.torque - rows.nominal - rows.modelled(coefficients_of(selected.problem, ordinary))
    )
    for j in range(rows.torque.shape[1]):
        which = selected.weights.row[:, j] > 0
        if np.sum(which) < LASTING.least_rows:
            continue
        unit = "N" if rows.layout.arm.sliding[j] else "N m"
        runs = _Runs(selected.residuals[which, j], rows.torque[which, j], rows.run[which], rows.time[which], unit)
        told = max(runs.told(), key=lambda each: each.power, default=None)
        if told is None:
            continue
        share = told.power / max(float(np.mean(before[which, j] ** 2)), 1e-300)
        if share > LASTING.share:
            rms, torque = float(np.sqrt(told.power)), float(np.sqrt(np.mean(rows.torque[which, j] ** 2)))
            found.append(LastingTorque(j, told.words, rms, rms / max(torque, 1e-300), share))
    return tuple(sorted(found, key=lambda each: -each.share))


@dataclass(frozen=True)
class _Difference:
    words: str
    power: float


class _Runs:
    """What a model leaves of a joint's torque, run by run."""

    def __init__(self, left: Array, torque: Array, run: NDArray[np.str_], time: Array, unit: str) -> None:
        names, self.of_run = np.unique(run, return_inverse=True)
        self.names = [run_in_words(str(name)) for name in names]
        self.left, self.torque, self.time, self.unit = left, torque, time, unit
        self.there = [self.of_run == n for n in range(len(names))]

    def told(self) -> list[_Difference]:
        """What differs clearly: a reading without torque or one of it, whichever leaves less; and what drifts."""
        zero, gain = (self._by_run(follows) for follows in (np.ones_like(self.torque), self.torque))
        powers = [float(np.sum(left**2)) for _, left in (zero, gain)]
        by_zero, alike = powers[0] <= powers[1], max(powers) < DIFFERING.alike * min(powers)
        follows = np.ones_like(self.torque) if by_zero else self.torque
        number, left = zero if by_zero else gain
        more = number - np.median(number)
        clear = self._clear(more, follows, left)
        slow = self._over_time(left)
        found = [self._difference(more, follows, clear, (by_zero, alike), slow)] if clear.any() else []
        return [*found, *slow.values()]

    def _by_run(self, follows: Array) -> tuple[Array, Array]:
        """(R,) how much of what follows something (N,) each run holds, and (N,) what is left then."""
        number = np.array(
            [self.left[own] @ follows[own] / max(follows[own] @ follows[own], 1e-300) for own in self.there]
        )
        return number, self.left - number[self.of_run] * follows

    def _clear(self, more: Array, follows: Array, left: Array) -> NDArray[np.bool_]:
        """(R,) runs that differ by much, and by more than chance."""
        order = np.argsort(self.of_run, kind="stable")
        lasts = autocorrelation_time(self.of_run[order], left[order])
        noise = float(np.sqrt(np.mean(left**2)))
        rms = np.array([np.sqrt(np.mean(follows[own] ** 2)) for own in self.there])
        rows = np.array([np.count_nonzero(own) for own in self.there])
        least = noise * np.maximum(DIFFERING.clear, DIFFERING.widths * np.sqrt(lasts / rows))
        return np.asarray(np.abs(more) * rms > least)

    def _difference(
        self,
        more: Array,
        follows: Array,
        clear: NDArray[np.bool_],
        how: tuple[bool, bool],
        slow: Mapping[int, _Difference],
    ) -> _Difference:
        by_zero, alike = how
        factor, unit, sides = (
            (1, f" {self.unit}", ("higher", "lower")) if by_zero else (100, " %", ("larger", "smaller"))
        )
        told = [f"{rounded(factor * abs(by))}{unit} {sides[int(by < 0)]}" for by in more]
        where = enumerated(
            [f"{told[n]} in {self.names[n]}{', not all the time' * (n in slow)}" for n in np.flatnonzero(clear)], "and"
        )
        why = enumerated([*_REASONS[0], *_REASONS[1]] if alike else list(_REASONS[int(not by_zero)]), "or")
        power = float(np.mean((more[self.of_run] * follows) ** 2))
        return _Difference(f"run: it reads {where}, against their median (as by {why})", power)

    def _over_time(self, left: Array) -> dict[int, _Difference]:
        """Runs most of whose own residual is slow, by their numbers; not where that of the others lasts as long."""
        found, lasts = {}, [autocorrelation_time(self.of_run[own], left[own]) for own in self.there]
        for n, own in enumerate(self.there):
            of_others = float(np.median(lasts[:n] + lasts[n + 1 :]))
            if np.count_nonzero(own) < DIFFERING.independent * DIFFERING.knots * of_others:
                continue
            curve = hats(self.time[own], DIFFERING.knots)
            slow = curve @ np.linalg.lstsq(curve, left[own], rcond=None)[0]
            if np.mean(slow**2) > DIFFERING.slow * np.mean(left[own] ** 2):
                most = f"{rounded(float(np.abs(slow).max()))} {self.unit}"
                power = float(np.sum(slow**2)) / len(left)
                found[n] = _Difference(f"time in {self.names[n]}, by up to {most} (a drift or a jump)", power)
        return found
