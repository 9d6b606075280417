"""What clings over a way, or over a torque, since its last reversal: hysteresis that depends on no time."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import Moment
from armscope.motion.samples.low_pass import without_lag


def taken_along(values: Array, ways: tuple[float, ...]) -> Array:
    """(N, c) how far something that clings over each way is taken along, -1 ... 1: Prandtl's stop operator.

    Sums of it approach any hysteresis that depends on the way since the last turn and not on time (Visintin 1994).
    """
    steps = np.diff(values)
    turning = steps[np.flatnonzero(steps)[:1]]
    size = int(np.ceil(np.sqrt(len(values))))
    moved = np.zeros((size * size, len(ways)))
    moved[1 : len(values)] = steps[:, None] / np.array(ways)
    blocks = moved.reshape(size, size, -1)
    # each step cuts off what lies beyond -1 ... 1, and so does any number of them in a row: within all blocks at once,
    # then from block to block
    shift, low, high = np.zeros_like(blocks), np.full_like(blocks, -1.0), np.ones_like(blocks)
    shift[:, 0] = blocks[:, 0]
    for k in range(1, size):
        shift[:, k] = shift[:, k - 1] + blocks[:, k]
        low[:, k] = np.clip(low[:, k - 1] + blocks[:, k], -1, 1)
        high[:, k] = np.clip(high[:, k - 1] + blocks[:, k], -1, 1)
    entered = np.empty((size, 1, len(ways)))
    state = np.full(len(ways), np.sign(turning[0]) if len(turning) else 0.0)
    for k in range(size):
        entered[k] = state
        state = np.clip(state + shift[k, -1], low[k, -1], high[k, -1])
    return np.clip(entered + shift, low, high).reshape(size * size, -1)[: len(values)]


def smooth_torque(m: Moment, joint: int, cutoff: float) -> Array:
    """(N,) predicted torque of a joint, low-passed where the motion ends, but for its dry friction, which stays sharp.

    Noise of the positions is noise of the predicted torque, by the inertia times its second derivative, and none of
    the measured one. Whatever clings over a small torque follows that noise and little else: by some of it, taken off
    again, any model would fit better, and a hysteresis was named where there was none.

    Args:
        m: N samples.
        joint: from 0.
        cutoff: Hz.

    Returns:
        Torque, N m (N).
    """
    torque = m.predicted[:, joint]
    dry = m.dry.of_joint(m.signals, joint) if m.dry is not None else 0.0
    return without_lag(torque - dry, cutoff, m.rate, int(np.ceil(m.rate / cutoff))) + dry
