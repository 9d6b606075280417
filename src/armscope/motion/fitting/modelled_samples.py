"""Samples with what a model says of them: fits form their columns of it, and a fitted model its torque, alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array
from armscope.motion.fitting.model_estimate import Estimate
from armscope.motion.library.causes import Moment
from armscope.motion.library.dry_friction import ChangeOfSides, DryFriction, own_columns
from armscope.motion.library.layout import CAUSES_OF_OWN
from armscope.motion.samples.preparation import Preparation, Signals
from armscope.robot.bodies import Bodies
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class StatedSamples:
    """Samples with what the model asks of them before anything is fitted."""

    signals: Signals  # N samples
    torque: Array  # (N, m) that the stated masses ask for
    carried: Array | float  # (N, m) that the stated payload asks for


@dataclass(frozen=True, eq=False)
class ModelledSamples:
    """What a model says of samples."""

    moment: Moment  # what columns are functions of
    own: Array  # (N, m, 7) what every joint has, per unit of each: `layout.OWN_NAMES`
    links: Array  # (N, m) torque of links with what they carry all along a run
    rounded: Array  # (N, m) what drives round off, per unit of it


def stated_samples(arm: MovingArm, signals: Signals) -> tuple[StatedSamples, Array]:
    """Samples with their stated torque, and (N, m, 10 n) torque per inertial parameter."""
    regressor = arm.regressor(*signals.of_links)
    carried = 0.0 if signals.payload is None else signals.payload[:, None] * (regressor @ arm.point_load())
    return StatedSamples(signals, regressor @ arm.inertial, carried), regressor


def friction(own: Array, numbers: Array) -> Array:
    """(N, m) torque of offset, friction and rotor (m, 4) of each joint, of what every joint has (N, m, 7)."""
    return np.asarray(np.einsum("nmk,mk->nm", own[:, :, :CAUSES_OF_OWN], numbers))


def modelled_samples(
    arm: MovingArm,
    samples: StatedSamples,
    model: Estimate,
    turning: ChangeOfSides,
    how: Preparation,
    regressor: Array | None = None,
) -> ModelledSamples:
    """What a model says of samples.

    Args:
        arm: the arm as stated.
        samples: N samples.
        model: masses, friction and laws, SI.
        turning: how friction changes sides.
        how: filters.
        regressor: (N, m, 10 n) torque per inertial parameter, where it is at hand.

    Returns:
        It.
    """
    signals, inertial = samples.signals, model.inertial_in(samples.signals.run)
    own = own_columns(signals, turning)
    rigid = arm.torques(*signals.of_links, inertial) if regressor is None else regressor @ inertial
    bodies = Bodies(arm, inertial if model.of_bodies else arm.inertial, signals.payload)
    changing = model.carried(signals, bodies)
    links, stated = rigid + samples.carried, samples.torque + samples.carried
    rubbing, dry = friction(own, model.background), DryFriction(model.background[:, 1], turning)
    moment = Moment(
        signals=signals,
        rigid=links + changing,
        predicted=links + changing + rubbing,
        rate=1 / signals.period,
        bodies=bodies,
        dry=dry,
        stated=stated,
        bare=stated + rubbing,
        read=stated + friction(own, np.nan_to_num(arm.stated_background)),
    )
    smooth = model.smooth.with_laws(moment)
    rounded = dry.rounded(signals, smooth.predicted - changing, model.delay, how.motion_hz)
    return ModelledSamples(model.rippled.with_laws(smooth), own, links, rounded)
