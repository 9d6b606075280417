"""Torque that is read late: at another moment than it acted, or through a low-pass, which is a delay
to the second order and a part of `layout.response`.

But for dry friction: when and how that changes sides is each joint's own (`layout.OWN_NAMES`). Friction clings, for 10
to 20 ms as a rule, and its steps are most of what changes fast: by them, a low-pass was told where there was a delay,
and a delay where there was none.
"""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import Moment
from armscope.motion.library.dry_friction import seen_later


def delayed(m: Moment, joints: tuple[int, ...], delay: float = 0.0) -> Array:
    """What a delay that joints have in common changes, per second of it: exactly at the delay, for none by the slope.

    Args:
        m: N samples.
        joints: from 0.
        delay: s.

    Returns:
        (N, joints, 1) N m/s (N/s).
    """
    return np.stack([_delayed_at(m, joint, delay) for joint in joints], axis=1)[:, :, None]


def _delayed_at(m: Moment, joint: int, delay: float) -> Array:
    torque = m.without_dry[:, joint]
    if delay == 0:
        return np.asarray(-np.gradient(torque, 1 / m.rate))
    return (seen_later(m.signals.time, m.path, joint, delay) - torque) / delay
