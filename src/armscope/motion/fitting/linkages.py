"""How a spring between two links is mounted: what suits a joint best beside all else, as free as that is.

A curve of the joint's angle stands for a spring until one is tried that is mounted as the true one is; so wherever such
a curve, or a spring, has a name, its mount is looked for from coarse to fine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from armscope.core.types import Array
from armscope.motion.constants import NOISE
from armscope.motion.fitting.left_at_joint import LeftAtJoint, follows_angle
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law
from armscope.motion.library.linkage import pull, pushes_one_way
from armscope.motion.library.linkage_constants import LINKAGE
from armscope.verdict.effects import INTERVAL

Mount = tuple[float, float]
"""Phase, rad, and ratio, as `spring_between_links` takes them."""


def remounted(selected: SelectedCauses, number: int) -> tuple[PlacedCause, bool]:
    """A spring between links where it suits best, and whether the one that there is suits as well.

    Args:
        selected: the selection.
        number: of the spring among the placed causes, whether it is chosen or not.

    Returns:
        The spring as it is and true where nothing that follows the joint's angle is chosen there.
    """
    layout = selected.rows.layout
    placed = layout.placed[number]
    rivals = [n for n in selected.best.candidates if follows_angle(layout.placed[n], placed.joints)]
    if not rivals or not isinstance(placed.columns, Law):
        return placed, True
    judged, (phase, ratio, middle) = _Judged(selected, placed.joints[0], rivals), placed.columns.numbers
    if len(judged.left) < LINKAGE.least_rows:
        return placed, True
    (so_far,) = judged.nats([(phase, ratio)], middle)
    best, nats = max((_finest(judged, start, middle) for start in _starts(judged, middle)), key=lambda found: found[1])
    rests = NOISE.settled if number in selected.best.candidates else min(LINKAGE.much * nats, LINKAGE.moved_nats)
    if nats < so_far + rests:
        return placed, True
    law = replace(placed.columns, numbers=(*best, middle))
    return replace(placed, columns=law, scanned=(("phase", "rad", best[0]), ("ratio", "", best[1]))), False


def mount_unsure(selected: SelectedCauses, number: int) -> tuple[Array, Array]:
    """How far a chosen spring's numbers and its mount are known, each with the other free.

    By Gauss-Newton at the mount, since a spring that is mounted a little otherwise and pushes more hardly pulls
    otherwise; and by the farthest of the mounts all over that suit as well: a curve without a bend has many.

    Args:
        selected: the selection.
        number: of the spring.

    Returns:
        (2,) variances that the mount adds to those of force and growth; (2,) of phase, rad^2, and ratio.
    """
    placed, columns = selected.rows.layout.placed[number], selected.rows.layout.columns[number]
    assert isinstance(placed.columns, Law)
    *mount, middle = placed.columns.numbers
    judged, numbers = _Judged(selected, placed.joints[0], [number]), selected.coefficients[columns]

    def lever(phase: float, ratio: float) -> Array:
        return np.asarray(judged.root[:, None] * pull(judged.angle + phase, ratio, middle + phase))

    steps = LINKAGE.settled * np.eye(2)
    by_mount = [(lever(*(mount + h)) - lever(*(mount - h))) @ numbers / (2 * LINKAGE.settled) for h in steps]
    X = np.column_stack([lever(*mount), *by_mount])
    absorbed = judged.absorbed @ X
    anywhere = np.array([np.pi, LINKAGE.largest_ratio]) ** -2.0
    S = X.T @ X - absorbed.T @ absorbed + np.diag(np.r_[judged.prior, judged.prior, anywhere])
    of_mount, follow = np.linalg.inv(S)[2:, 2:], np.linalg.solve(S[:2, :2], S[:2, 2:])
    near = np.r_[np.diag(follow @ of_mount @ follow.T), np.diag(of_mount)]
    mounts = [*_all_over(), (mount[0], mount[1])]
    fitted, nats = judged.fitted(mounts, middle)
    as_good = np.column_stack([fitted, mounts])[nats > nats[-1] - LINKAGE.as_good_nats]
    far = np.max(np.abs(as_good - as_good[-1]), axis=0) / INTERVAL
    variance = np.maximum(near, far**2)
    return variance[:2], variance[2:]


def _starts(judged: _Judged, middle: float) -> list[Mount]:
    """The best of a coarse scan in each sector of the turn: what suits nearly as well may lie far from what suits."""
    tried = _all_over()
    found = judged.nats(tried, middle).reshape(LINKAGE.sectors, -1)
    order = np.argsort(-found.max(axis=1))[: LINKAGE.starts]
    return [tried[int(sector * found.shape[1] + np.argmax(found[sector]))] for sector in order]


def _all_over() -> list[Mount]:
    step = 2 * np.pi / LINKAGE.phases
    return [(number * step - np.pi, ratio) for number in range(LINKAGE.phases) for ratio in LINKAGE.ratios]


def _finest(judged: _Judged, start: Mount, middle: float) -> tuple[Mount, float]:
    """The best about a start (Nelder & Mead 1965), and by how many nats it betters what is left.

    Where the spring is all that its joint feels, a fifth of a degree is far more than the rows bear.
    """

    def worse(mount: Array) -> float:
        return -float(judged.nats([(mount[0], _possible(mount[1]))], middle)[0])

    step = np.array([[0.0, 0.0], [np.pi / LINKAGE.phases, 0.0], [0.0, LINKAGE.between / 2]])
    found = minimize(
        worse,
        np.array(start),
        method="Nelder-Mead",
        options={"initial_simplex": start + step, "xatol": LINKAGE.settled, "fatol": LINKAGE.settled},
    )
    return (float(found.x[0]), _possible(float(found.x[1]))), -float(found.fun)


def _possible(ratio: float) -> float:
    return float(np.clip(ratio, LINKAGE.least_ratio, LINKAGE.largest_ratio))


class _Judged(LeftAtJoint):
    """What is left at a joint where mounts of a spring are tried."""

    def nats(self, mounts: Sequence[Mount], middle: float) -> Array:
        """(T,) by which a spring of each mount betters what is left, all else fitted anew."""
        return self.fitted(mounts, middle)[1]

    def fitted(self, mounts: Sequence[Mount], middle: float) -> tuple[Array, Array]:
        """Force and growth (T, 2) that suit each mount best, and the nats (T,) that they are worth.

        Where the force would have to change its sign within the joint's range, of a constant one.
        """
        phase, ratio = np.transpose(mounts)
        turned = self.angle[:, None] + phase
        lever = self.root[:, None, None] * pull(turned, ratio, middle + phase)
        absorbed = np.tensordot(self.absorbed, lever, axes=1)
        S = np.einsum("ntk,ntl->tkl", lever, lever) - np.einsum("ctk,ctl->tkl", absorbed, absorbed)
        S = S + self.prior * np.eye(2)
        v = np.einsum("ntk,n->tk", lever, self.left)
        fitted = np.linalg.solve(S, v[:, :, None])[:, :, 0]
        constant = np.column_stack([v[:, 0] / S[:, 0, 0], np.zeros(len(mounts))])
        sound = pushes_one_way(fitted, turned, ratio, middle + phase)
        fitted = np.where(sound[:, None], fitted, constant)
        return fitted, np.sum(v * fitted, axis=1) / 2
