"""How many waves per turn a joint's gear makes, once it is known what else its torque holds.

The first look knows no cause yet: of slow waves, of which the joint's range holds two or three, it may take the bend of
friction for others. Then a curve of the angle stands for a wave and an offset at once, until the true count is tried.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.fitting.left_at_joint import LeftAtJoint, follows_angle
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law
from armscope.motion.library.linkage_constants import LINKAGE
from armscope.motion.library.waves import fewest_waves, most_waves


def recounted(selected: SelectedCauses) -> dict[int, PlacedCause]:
    """Waves at the counts that suit best, wherever a curve of the angle may stand for them.

    Args:
        selected: the selection.

    Returns:
        By its number, a wave that is not chosen with such a count; none where that competes already.
    """
    layout, best = selected.rows.layout, selected.best.candidates
    found: dict[int, PlacedCause] = {}
    for joint in sorted({layout.placed[n].joints[0] for n in best if layout.placed[n].cause is catalogue.CABLE}):
        waves = {n: p for n, p in enumerate(layout.placed) if p.cause is catalogue.RIPPLE and p.joints == (joint,)}
        if not waves or waves.keys() & best:
            continue
        rivals = [n for n in best if follows_angle(layout.placed[n], (joint,))]
        left = LeftAtJoint(selected, joint, rivals)
        counts = followed_by_a_curve(left.angle)
        if len(left.left) < LINKAGE.least_rows or not len(counts):
            continue
        count = int(counts[np.argmax(nats_of_waves(left, counts))])
        if count not in {each.scanned[0][2] for each in waves.values()}:
            now = [each.scanned[0][2] for each in waves.values()]
            least = list(waves)[int(np.argmin(nats_of_waves(left, np.array(now, dtype=int))))]
            found[least] = _counted(waves[least], count)
    return found


def followed_by_a_curve(angle: Array) -> NDArray[np.int_]:
    """Counts of waves of which the range of an angle (N,) holds enough, and no more than a free curve follows."""
    turns = float(np.ptp(angle)) / (2 * np.pi) if len(angle) else 0.0
    return np.arange(fewest_waves(turns), int(most_waves(turns, LIBRARY.knots_of_position)) + 1)


def nats_of_waves(left: LeftAtJoint, counts: NDArray[np.int_]) -> Array:
    """(C,) by which waves of each count, with an offset beside them as a curve has it, better what is left."""
    nats = np.zeros(len(counts))
    for k, count in enumerate(counts):
        turned = count * left.angle
        X = left.root[:, None] * np.column_stack([np.ones_like(turned), np.sin(turned), np.cos(turned)])
        absorbed, v = left.absorbed @ X, X.T @ left.left
        nats[k] = v @ np.linalg.solve(X.T @ X - absorbed.T @ absorbed + left.prior * np.eye(3), v) / 2
    return nats


def _counted(wave: PlacedCause, count: int) -> PlacedCause:
    """A wave with another count."""
    assert isinstance(wave.columns, Law)
    columns = replace(wave.columns, numbers=(float(count),))
    return replace(wave, columns=columns, scanned=(("per_turn", "", float(count)),), variant=str(count))
