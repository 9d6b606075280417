"""A model's laws over what they follow alone: friction over speed, free curves over their driver."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import Moment
from armscope.motion.library.dry_friction import ChangeOfSides, own_columns
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import BLUNTER, DRY, VISCOUS
from armscope.motion.model.fitted import MotionModel
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.samples.preparation import Signals

OF_SPEED = ("absolute speed", "stribeck", "power of speed", "curve over speed")
"""Laws that follow nothing but a joint's own speed."""


def friction_over_speed(model: MotionModel, joint: int, speed: Array) -> Array:
    """Friction of a joint at speeds: dry, viscous, and what else of the model follows its speed alone.

    Args:
        model: the model.
        joint: from 0.
        speed: (N,) rad/s or m/s.

    Returns:
        (N,) N m or N.
    """
    moment = everything_is(speed, model.arm.n_motors)
    own = own_columns(moment.signals, ChangeOfSides.of(model.arm, width=model.width_of_sides))[:, joint]
    of_speed = [DRY, VISCOUS, BLUNTER]
    total = own[:, of_speed] @ model.joints[joint, of_speed]
    for cause in model.causes:
        law = cause.placed.columns
        if isinstance(law, Law) and law.kind in OF_SPEED and law.joints == (joint,):
            total = total + law(moment)[:, 0] @ cause.values
    return np.asarray(total)


def free_curve(cause: FittedCause, at: Array) -> tuple[Array, Array]:
    """A free curve's torque and its standard error at values (N,) of what it follows."""
    law = cause.placed.columns
    assert isinstance(law, Law)
    columns = law(everything_is(at, max(law.joints) + 1))[:, 0]
    errors = np.sqrt(np.einsum("nc,cd,nd->n", columns, cause.covariance, columns))
    return columns @ cause.values, np.asarray(errors)


def since_reversal(cause: FittedCause, way: Array) -> tuple[Array, Array]:
    """Torque (N,), and its standard error, of what clings over ways after a long motion backward turned forward.

    Args:
        cause: of such a law.
        way: (N,) since the reversal, rad (m of a joint that slides).

    Returns:
        N m (N).
    """
    law = cause.placed.columns
    assert isinstance(law, Law)
    taken = np.minimum(way[:, None] / np.array(law.numbers[-cause.placed.width :]) - 1, 1)
    errors = np.sqrt(np.einsum("nc,cd,nd->n", taken, cause.covariance, taken))
    return taken @ cause.values, np.asarray(errors)


def limits_of(cause: FittedCause) -> tuple[float, float]:
    """Between which values of its driver a free curve was fitted."""
    law = cause.placed.columns
    assert isinstance(law, Law)
    return law.numbers[0], law.numbers[1]


def everything_is(values: Array, joints: int) -> Moment:
    """Samples in which whatever a law follows takes the given values; nothing accelerates."""
    same, none = np.repeat(values[:, None], joints, axis=1), np.zeros((len(values), joints))
    signals = Signals("", 0, values, same, same, none, none, None, same, np.arange(len(values)))
    return Moment(signals, same, same, 1.0)
