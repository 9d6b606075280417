"""The fitted model of a moving arm: friction, masses, gains, causes with their numbers; the torque they predict."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from armscope.core.types import Array, Indices
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.model_estimate import Estimate, estimate_of
from armscope.motion.fitting.modelled_samples import modelled_samples, stated_samples
from armscope.motion.library.causes import Moment
from armscope.motion.library.dry_friction import ChangeOfSides, rounded_off
from armscope.motion.library.laws import is_of_a_gain
from armscope.motion.library.layout import CAUSES_OF_OWN, DRY, LATER, OWN, ROUNDER, TorqueLayout
from armscope.motion.library.sides import sharp_width
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.model.link_motion import beside_motor, following, moment_of_links
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Preparation, Signals, parts
from armscope.motion.samples.timing import Stretch
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class MotionModel:
    """What a diagnosis of a motion fitted; SI units, N m (N of a sliding joint).

    Attributes:
        arm: the arm as stated.
        how: filters and decimation of the rows that it was fitted to.
        kind: whether they held torques or currents; what it predicts is torque by the stated gains in either case.
        joints: (m, 6) of every joint, `layout.OWN`: stated and fitted together.
        inertial: (10 n,) inertial parameters: stated ones, and by how much the fit moved them unnamed.
        gains: (m,) shares by which recorded torque exceeds the true one.
        causes: the named ones.
        response: by how much of its second derivative drives round a torque off, s^2.
        width_of_sides: (m,) rad/s (m/s) within which friction changes sides; None: as sharply as fits take it to.
        order_of_sides: (m,) of the low-pass by which it does so late; None or 0: it is shifted.
        positions: (m, 2) rad (m), least and largest of the motion that it was fitted to; None: not known.
        links: why links lie beside their motors, rad (m): of joints where both were recorded.
    """

    arm: MovingArm
    how: Preparation
    kind: Literal["torque", "current"]
    joints: Array
    inertial: Array
    gains: Array
    causes: tuple[FittedCause, ...]
    response: float = 0.0
    links: tuple[FittedCause, ...] = ()
    width_of_sides: Array | None = None
    order_of_sides: Indices | None = None
    positions: Array | None = None

    def followed(self) -> Estimate:
        """What load, delay and gain follow: masses with all that is added to them, friction and rotors."""
        causes = ((each.placed, each.values) for each in self.causes)
        return estimate_of(causes, self.inertial, self.joints[:, :CAUSES_OF_OWN])

    def torque(self, signals: Signals) -> Array:
        """(N, m) torque at filtered samples, as it would be recorded."""
        signals = self.with_links(signals)
        samples, regressor = stated_samples(self.arm, signals)
        joints, late, over = self._turning()
        turning = ChangeOfSides.of(self.arm, late, self._width(), self.order_of_sides)
        at = modelled_samples(self.arm, samples, self.followed(), turning, self.how, regressor)
        own, moment = at.own, at.moment
        own[:, :, ROUNDER] = rounded_off(own[:, :, DRY], over, signals.period) - own[:, :, DRY]
        total = at.links + np.einsum("nmk,mk->nm", own, joints) + self.response * at.rounded
        true = [cause for cause in self.causes if not is_of_a_gain(cause.placed.columns)]
        _add(total, true, moment)
        moment = replace(moment, read=total.copy())
        total *= 1 + self.gains
        _add(total, [cause for cause in self.causes if is_of_a_gain(cause.placed.columns)], moment)
        return np.asarray(total)

    def with_links(self, signals: Signals) -> Signals:
        """Samples with links where the model puts them, unless they were recorded."""
        return following(self.arm, self.links, signals, self.followed(), self.how.motion_hz)

    def link_positions(self, signals: Signals) -> Array:
        """(N, m) where encoders of links stand, rad (m); NaN of joints of which the model knows nothing."""
        moment = moment_of_links(self.arm, self.with_links(signals), self.followed(), 1 / signals.period)
        found = np.full(signals.q.shape, np.nan)
        for j in {cause.placed.joints[0] for cause in self.links}:
            beside = sum(beside_motor(cause, moment) for cause in self.links if cause.placed.joints[0] == j)
            found[:, j] = signals.q[:, j] + beside
        return found

    def _turning(self) -> tuple[Array, Array, Array]:
        """(m, 7) the joints' numbers; (m,) s by how much later than speed dry friction changes sides; over how long.

        Fits hold these as derivatives of friction over time, which is the same only as long as the low-pass rounds more
        off: not low-passed, they are spikes at each reversal. Here friction is shifted and rounded off itself, by no
        more than is believed; where it would be sharper than sharp, it is not.
        """
        joints, most = self.joints.copy(), PRIOR.longest_turning_s
        dry = joints[:, DRY]
        per_dry = np.where(dry > 0, 1 / np.where(dry > 0, dry, 1.0), 0.0)
        turning = np.clip(joints[:, LATER] * per_dry, -most, most)
        over = np.minimum(np.sqrt(np.maximum(2 * joints[:, ROUNDER] * per_dry, 0.0)), most)
        joints[:, ROUNDER], joints[:, LATER] = dry, 0.0
        return joints, turning, over

    def _width(self) -> Array:
        """(m,) rad/s (m/s) within which friction changes sides: from rest on sharply, but where the motion says how."""
        sharp = sharp_width(self.arm)
        own = sharp if self.width_of_sides is None else self.width_of_sides
        return np.where(own > sharp, own, sharp / FILTER.sharper_at_rest)


def _add(total: Array, causes: Sequence[FittedCause], moment: Moment) -> None:
    for cause in causes:
        if cause.placed.columns is not None:
            total[:, list(cause.placed.joints)] += cause.placed.columns_in(moment) @ cause.values


def fitted_model(
    layout: TorqueLayout,
    coefficients: Array,
    chosen: Sequence[tuple[int, Array, Array]],
    how: Preparation,
    links: tuple[FittedCause, ...] = (),
) -> MotionModel:
    """The model that coefficients of a selection make.

    Args:
        layout: of the columns.
        coefficients: (p,) of all columns, SI.
        chosen: number of each chosen cause, its parameters, and their covariance.
        how: filters and decimation.
        links: what was found of links beside their motors.

    Returns:
        The model.
    """
    arm = layout.arm
    stated = np.column_stack([np.nan_to_num(arm.stated_background), np.zeros((arm.n_motors, OWN - CAUSES_OF_OWN))])
    named = {int(column) for number, *_ in chosen for column in layout.columns[number]}
    heavier = [int(column) for column in layout.link_masses[0] if int(column) not in named]
    made, shares = layout.made_of_masses
    in_proportion = shares @ np.where(np.isin(made, heavier), coefficients[made], 0.0)
    return MotionModel(
        arm=arm,
        how=how,
        kind="current" if layout.with_gains else "torque",
        joints=stated + coefficients[layout.own].reshape(-1, OWN),
        inertial=arm.inertial + layout.inertial_scale * (coefficients[layout.inertial] + in_proportion),
        gains=coefficients[layout.gains] if len(layout.gains) else np.zeros(arm.n_motors),
        causes=tuple(FittedCause(layout.placed[number], values, covariance) for number, values, covariance in chosen),
        response=float(coefficients[layout.response][0]),
        links=links,
        width_of_sides=layout.width_of_sides,
        order_of_sides=layout.order_of_sides,
    )


def predicted_torque(model: MotionModel, stretches: Sequence[Stretch]) -> list[Array]:
    """The torque at every sample of stretches, neither low-passed nor thinned.

    Args:
        model: the model.
        stretches: even samples; ``effort`` is not looked at.

    Returns:
        (N, m) of each stretch.
    """
    return _at_samples(model, stretches, model.torque)


def predicted_links(model: MotionModel, stretches: Sequence[Stretch]) -> list[Array]:
    """Where encoders of links stand at every sample, by the motors' positions.

    Args:
        model: the model.
        stretches: even samples; neither ``effort`` nor ``link`` is looked at.

    Returns:
        (N, m) of each stretch, rad (m); NaN of joints of which the model knows nothing.
    """
    return _at_samples(model, [replace(stretch, link=None) for stretch in stretches], model.link_positions)


def _at_samples(model: MotionModel, stretches: Sequence[Stretch], says: Callable[[Signals], Array]) -> list[Array]:
    found = [np.full(stretch.q.shape, np.nan) for stretch in stretches]
    for number, stretch in enumerate(stretches):
        how = replace(model.how, rate=stretch.rate)
        for signals in parts([stretch], how, every_sample=True):
            start = int(np.searchsorted(stretch.time, signals.time[0]))
            found[number][start + signals.kept] = says(signals)[signals.kept]
    return found
