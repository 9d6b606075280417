"""The estimate of the model at which columns are formed: load, delay and gain follow it from round to round."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.catalogue import DELAY, RIPPLE
from armscope.motion.library.causes import Moment, PlacedCause
from armscope.motion.library.changes_catalogue import LOAD_CHANGE
from armscope.motion.library.laws import follows_motion
from armscope.motion.samples.preparation import Signals
from armscope.robot.bodies import Bodies
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class Estimate:
    """The model as the last round left it: further columns are functions of it."""

    inertial: Array  # (10 n,) inertial parameters
    background: Array  # (m, 4) offset, dry and viscous friction, rotor inertia, with what is stated
    delay: Array  # (m,) s by which torques are late
    # (10 n,) inertial parameters that are added in some runs: a load that only these carry
    of_runs: Mapping[str, Array] = field(default_factory=dict)
    # whether masses were held near the stated ones; else they are whatever the motion tells of them
    of_bodies: bool = True
    # causes of one joint that follow the motion alone, with their numbers: a delay is theirs, too
    laws: tuple[tuple[PlacedCause, Array], ...] = ()
    loads: tuple[tuple[PlacedCause, Array], ...] = ()  # what is carried for some of a run only, with its numbers
    gain: Array | None = None  # (m,) by which recorded torque exceeds the true one; None: by nothing
    # (m,) s by which friction changes sides later than the speed, as far as columns are formed so; None: 0
    turning: Array | None = None

    def carried(self, signals: Signals, bodies: Bodies) -> Array | float:
        """(N, m) torque of what is carried for some of a run only, of N samples."""
        none = np.zeros_like(signals.q)
        moment = Moment(signals, none, none, 1 / signals.period, bodies)
        return sum((placed.columns_in(moment) @ values for placed, values in self.loads), 0.0)

    def inertial_in(self, run: str) -> Array:
        """(10 n,) inertial parameters in a run."""
        return self.inertial + self.of_runs.get(run, 0.0)

    @property
    def smooth(self) -> Estimate:
        """Without ripple, which drives round off as it is recorded: as fast as it is, its size would go with that."""
        return replace(self, laws=tuple(law for law in self.laws if law[0].cause is not RIPPLE))

    @property
    def rippled(self) -> Estimate:
        """With no law but ripple."""
        return replace(self, laws=tuple(law for law in self.laws if law[0].cause is RIPPLE))

    def with_laws(self, moment: Moment) -> Moment:
        """What is predicted, with the torque of the laws."""
        if not self.laws:
            return moment
        predicted = moment.predicted.copy()
        for placed, values in self.laws:
            assert placed.columns is not None
            predicted[:, list(placed.joints)] += placed.columns_in(moment) @ values
        return replace(moment, predicted=predicted)


def estimate_of(
    causes: Iterable[tuple[PlacedCause, Array]], inertial: Array, background: Array, gain: Array | None = None
) -> Estimate:
    """What load, delay and gain follow: masses with all that is added to them, friction and rotors.

    Args:
        causes: with their numbers, SI.
        inertial: (10 n,) inertial parameters without them.
        background: (m, 4) as in `Estimate`.
        gain: (m,) as there.

    Returns:
        The model.
    """
    delay, of_runs = np.zeros(len(background)), dict[str, Array]()
    there = [(cause, values) for cause, values in causes if np.any(values)]
    for cause, values in there:
        if cause.inertial is not None and not cause.runs:
            inertial = inertial + cause.inertial @ values
        elif cause.inertial is not None:
            of_runs |= {run: of_runs.get(run, 0.0) + cause.inertial @ values for run in cause.runs}
        if cause.cause is DELAY:
            delay[list(cause.joints)] += values[0]
    loads = tuple(each for each in there if each[0].cause is LOAD_CHANGE)
    laws = tuple(each for each in there if follows_motion(each[0].columns, each[0].joints))
    return Estimate(inertial, background, delay, of_runs, laws=laws, loads=loads, gain=gain)


def stated_model(arm: MovingArm) -> Estimate:
    """What robot.yaml states."""
    return Estimate(arm.inertial, np.nan_to_num(arm.stated_background), np.zeros(arm.n_motors))
