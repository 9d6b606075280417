"""Where links are behind their motors: by what was fitted, where they were not recorded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.motion.fitting.model_estimate import Estimate
from armscope.motion.library.causes import Moment
from armscope.motion.library.laws import derived
from armscope.motion.library.twist_catalogue import ENCODER_OFFSET
from armscope.motion.library.twist_constants import TWIST
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.samples.preparation import Signals
from armscope.robot.bodies import Bodies
from armscope.robot.dynamics import MovingArm


def moment_of_links(arm: MovingArm, signals: Signals, model: Estimate, rate: float) -> Moment:
    """What laws of a link's place are functions of: torque is that through the joints, and nothing else.

    Args:
        arm: the arm.
        signals: N samples.
        model: masses.
        rate: samples per second.

    Returns:
        The moment.
    """
    bodies = Bodies(arm, model.inertial_in(signals.run), signals.payload)
    torque = bodies.torques(*signals.of_links)
    return Moment(signals, torque, torque, rate, bodies)


def following(
    arm: MovingArm, causes: Sequence[FittedCause], signals: Signals, model: Estimate, cutoff: float
) -> Signals:
    """The same samples with their links where causes put them, unless they were recorded.

    A link's place hangs on its torque, and that on its place: each is found from the other, twice.

    Args:
        arm: the arm.
        causes: of links beside their motors.
        signals: N samples.
        model: masses.
        cutoff: Hz, where the motion ends: torque holds two derivatives of positions, and is derived twice.

    Returns:
        The samples.
    """
    moving = [cause for cause in causes if cause.placed.cause is not ENCODER_OFFSET]
    if signals.shift is not None or not moving:
        return signals
    rate = 1 / signals.period
    for _ in range(TWIST.steps):
        moment = moment_of_links(arm, signals, model, rate)
        shift = np.zeros((3, *signals.q.shape))
        for j in {cause.placed.joints[0] for cause in moving}:
            beside = sum(beside_motor(cause, moment) for cause in moving if cause.placed.joints[0] == j)
            shift[:, :, j] = derived(moment, np.asarray(beside), cutoff)
        signals = replace(signals, shift=(shift[0], shift[1], shift[2]))
    return signals


def beside_motor(cause: FittedCause, moment: Moment) -> Array:
    """(N,) link less motor by one cause, rad (m)."""
    assert cause.placed.columns is not None
    return np.asarray(cause.placed.columns(moment)[:, 0] @ cause.values)
