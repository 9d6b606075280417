"""What a joint's torque leaves for what follows its angle, beside everything else that is chosen.

A curve of the angle stands for a spring, or for waves, until one is tried that is as the true one is.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np

from armscope.inference.linear_algebra import lower_cholesky, solve_lower, solve_upper
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.torque_delay import columns_of
from armscope.motion.fitting.weights import weighed
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.linkage_constants import LINKAGE


def follows_angle(placed: PlacedCause, joints: tuple[int, ...]) -> bool:
    """Whether a cause is a spring or a cable of one joint."""
    return placed.joints == joints and placed.cause in (catalogue.BALANCER, catalogue.CABLE)


class LeftAtJoint:
    """One joint's torque without what follows its angle, in some rows.

    These rows stand for all of the joint's, also where they say what everything else is worth: beside a spring hundreds
    of times the noise, sums over other rows would differ from theirs by more than the noise is.

    Attributes:
        root: (N,) root of each row's weight.
        left: (N,) weighed torque that is left.
        absorbed: (C, N) what everything else says of these rows.
        angle: (N,) of the joint, rad.
        prior: of a number that is torque, 1 / (N m)^2.
    """

    def __init__(self, selected: SelectedCauses, joint: int, without: Sequence[int]) -> None:
        rows, best, scale = selected.rows, selected.best, selected.problem.scale
        left_out = np.concatenate([rows.layout.columns[number] for number in without])
        others = np.setdiff1d(best.columns, left_out)
        held = rows.pauses[joint].holding(len(rows), LINKAGE.held)
        among = np.flatnonzero((selected.weights.row[:, joint] > 0) & ~held)
        every = -(-len(among) // LINKAGE.rows)
        among = among[::every]
        unit = (PRIOR.unit / selected.weights.sigma[joint] / best.noise) ** 2 / selected.weights.correlated[joint]
        self.root = np.sqrt(every * unit * selected.weights.row[among, joint])
        beyond = self.root * (rows.torque[:, joint] - rows.nominal[:, joint])[among]
        columns = self.root[:, None] * columns_of(selected.rows, joint, others)[among] / scale[others]
        elsewhere = weighed(rows, (each for each in chain(*selected.by_joint) if each.joint != joint), selected.weights)
        in_units = np.outer(scale[others], scale[others]) * best.noise**2
        prior = np.diag(1 / best.variance[best.at(others)])
        factor = lower_cholesky(
            elsewhere.G[np.ix_(others, others)] / in_units + columns.T @ columns + prior, np.zeros(len(others))
        )
        worth = elsewhere.b[others] / scale[others] / best.noise**2 + columns.T @ beyond
        self.left = beyond - columns @ solve_upper(factor, solve_lower(factor, worth))
        self.absorbed, self.angle = solve_lower(factor, columns.T), rows.q[among, joint]
        self.prior = LINKAGE.usual_torque**-2 / max(float(np.mean(rows.torque[among, joint] ** 2)), 1e-300)
