"""Names of what acts at all times that only a joint's turning back tells: friction there clings, as nobody knows how.

A late torque and a soft drive are there far from every reversal as well. Within some way and time of one, friction
changes sides by a law of its own (presliding: Dahl 1968; Armstrong-Hélouvry 1991), and whatever moves or rounds its
step a little fits that.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.motion.fitting.consistency import factor_in
from armscope.motion.fitting.constants import SETTLED
from armscope.motion.fitting.modelled_samples import StatedSamples
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.sums import sums_by_joint
from armscope.motion.fitting.weights import weighed
from armscope.motion.library import catalogue
from armscope.verdict.effects import INDISTINGUISHABLE_NATS

AT_ALL_TIMES = (catalogue.DELAY, catalogue.COMPLIANCE)


def told_by_reversals_alone(selected: SelectedCauses) -> frozenset[int]:
    """Names that act at all times and are not worth their price where no joint has just turned back.

    Args:
        selected: the selection.

    Returns:
        Their numbers, and those of the same at the same joints by another law.
    """
    placed = selected.rows.layout.placed
    numbers = [n for n in selected.best.candidates if placed[n].cause in AT_ALL_TIMES]
    if not numbers:
        return frozenset()
    away = settled_rows(selected.rows)
    row, one_block = selected.weights.row * away, np.zeros(len(selected.rows), dtype=np.intp)
    sums = weighed(selected.rows, sums_by_joint(selected.rows, row, one_block)[0], selected.weights)
    found = {number: factor_in(selected, number, sums) for number in numbers}
    wrong = [n for n, each in found.items() if not _told(*each)]
    places = {(placed[n].cause.name, placed[n].joints) for n in wrong}
    return frozenset(n for n, each in enumerate(placed) if (each.cause.name, each.joints) in places)


def _told(size: float, error: float) -> bool:
    return size > 0 and (size / error) ** 2 / 2 >= INDISTINGUISHABLE_NATS


def settled_rows(rows: MotionRows) -> NDArray[np.bool_]:
    """(K, m) whether each joint has turned back some time and way ago, and won't so soon."""
    settled = np.ones(rows.dq.shape, dtype=np.bool_)
    done = 0
    for samples in rows.samples:
        own = slice(done, done + len(samples.signals.kept))
        done += len(samples.signals.kept)
        for j in range(rows.layout.arm.n_motors):
            settled[own, j] = ~_turning(samples, j, float(np.ptp(rows.q[:, j])))
    return settled


def _turning(samples: StatedSamples, joint: int, travel: float) -> NDArray[np.bool_]:
    """(K,) whether the reversal before a row, or the one after it, is near."""
    signals = samples.signals
    time, q = signals.time[signals.kept], signals.q[signals.kept, joint]
    at = np.flatnonzero(np.diff(np.sign(signals.dq[:, joint])))
    near = np.zeros(len(time), dtype=np.bool_)
    if not len(at):
        return near
    after = np.searchsorted(signals.time[at], time)
    for each in (np.maximum(after - 1, 0), np.minimum(after, len(at) - 1)):
        apart, way = np.abs(time - signals.time[at][each]), np.abs(q - signals.q[at, joint][each])
        near |= (apart < SETTLED.seconds) | (way < SETTLED.way * travel)
    return near
