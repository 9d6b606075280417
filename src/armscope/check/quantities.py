"""What was recorded beside angles and points, and looks as if it stood in another unit or had another sign."""

from __future__ import annotations

import numpy as np

from armscope.check.constants import QUANTITIES, TRIALS
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.recordings.resolution import angle_steps, step_in_words
from armscope.robot import Arm, chain
from armscope.robot.gravity import gravity_torques


def of_quantities(recordings: Recordings, arm: Arm | None) -> list[Suspicion]:
    """Look at temperature, payload, stated uncertainty, time and torques."""
    found = [_temperature(recordings), _payload(recordings, arm), _sigma(recordings), _time(recordings)]
    of_arm = [_torque(recordings, arm), None if arm is None else _coarse_angles(recordings, arm)]
    return [each for each in [*found, *of_arm] if each is not None]


def _coarse_angles(recordings: Recordings, arm: Arm) -> Suspicion | None:
    step = float(angle_steps(recordings.motor_angles).max())
    if (most := step / 2 * arm.reach) < QUANTITIES.seen:
        return None
    cure = (
        f"If poses were commanded in such steps, all is well; if they were rounded when they were written down, that "
        f"moves the tool by up to {most * 1e3:.2g} mm: record more digits."
    )
    return Suspicion("hint", f"the angles stand in steps of {step_in_words(step)}", cure)


def _temperature(recordings: Recordings) -> Suspicion | None:
    known = _known(recordings.temperature)
    if not len(known):
        return None
    statement = f"the temperature reads {known.min():.4g} ... {known.max():.4g} degrees Celsius"
    if known.min() > QUANTITIES.warmest_room and known.max() < QUANTITIES.temperature[1]:
        cure = "No workshop is that warm: is it in Fahrenheit, or of a motor? The structure's is needed."
        return Suspicion("hint", statement, cure)
    if known.min() > QUANTITIES.temperature[0] and known.max() < QUANTITIES.temperature[1]:
        return None
    return Suspicion("problem", statement, "Is it in kelvin, or does a number stand for no value?")


def _payload(recordings: Recordings, arm: Arm | None) -> Suspicion | None:
    known = _known(recordings.payload)
    own = arm.masses.sum() if arm is not None and arm.has_masses else QUANTITIES.heaviest
    most = min(QUANTITIES.heaviest, float(own))
    if not len(known) or known.max() <= most:
        return None
    of_what = "the arm weighs" if most < QUANTITIES.heaviest else "any arm carries"
    statement = f"the payload is up to {known.max():.4g} kg, more than {of_what} ({most:.4g} kg)"
    return Suspicion("problem", statement, "Is it in grams, or a force?")


def _sigma(recordings: Recordings) -> Suspicion | None:
    known = _known(recordings.sigma)
    if recordings.sigma is None or not len(known):
        return None
    usual = float(np.median(known))
    if not QUANTITIES.uncertainty[0] <= usual <= QUANTITIES.uncertainty[1] and usual > 0:
        return Suspicion("problem", f"the stated uncertainty is usually {usual * 1e3:.3g} mm", "Is its unit right?")
    if (known == 0).any():
        rows = int((recordings.sigma == 0).any(axis=1).sum())
        return Suspicion("hint", f"the stated uncertainty is zero in {rows} rows", "No instrument is that good.")
    return None


def _time(recordings: Recordings) -> Suspicion | None:
    if recordings.time is None:
        return None
    runs = [recordings.time[recordings.run == run] for run in np.unique(recordings.run)]
    steps = np.concatenate([np.diff(times[np.isfinite(times)]) for times in runs])
    usual = float(np.median(np.abs(steps))) if len(steps) else 0.0
    if usual > QUANTITIES.between_rows:
        statement = f"a row usually comes {usual / 3600:.3g} hours after the one before"
        return Suspicion("hint", statement, "time_s is in seconds: are these milliseconds?")
    known, (low, high) = _known(recordings.time), QUANTITIES.day_numbers
    if QUANTITIES.days_apart[0] < usual < QUANTITIES.days_apart[1] and low < known.min() and known.max() < high:
        statement = f"time_s reads {known.min():.7g} ... {known.max():.7g}, a row usually {usual:.2g} after another"
        return Suspicion("hint", statement, "A spreadsheet counts days so: time_s is in seconds, 86,400 a day.")
    back = int((steps < 0).sum())
    if not back:
        return None
    statement = f"time goes back between rows {back} times" if back > 1 else "time goes back between two rows once"
    return Suspicion("hint", statement, "Rows are taken in the order of the table where no time is meant.")


def _torque(recordings: Recordings, arm: Arm | None) -> Suspicion | None:
    """Recorded torques beside those of gravity by the mass table."""
    if recordings.torque is None or arm is None or not arm.has_masses:
        return None
    rows = np.flatnonzero(np.isfinite(recordings.torque).all(axis=1))
    rows = rows[spread_evenly(len(rows), TRIALS.rows)] if len(rows) else rows
    payload = None if recordings.payload is None else np.nan_to_num(recordings.payload[rows])
    pull, torque = gravity_torques(arm, chain(arm, recordings.motor_angles[rows]), payload), recordings.torque[rows]
    both, pulled, seen = np.sum(pull * torque), np.sum(pull**2), np.sum(torque**2)
    if not len(rows) or pulled == 0 or seen == 0 or abs(both) < QUANTITIES.follows * np.sqrt(pulled * seen):
        return None
    times = both / pulled
    if not 1 / QUANTITIES.many_times < abs(times) < QUANTITIES.many_times:
        statement = f"the recorded torques are {abs(times):.3g} times what gravity asks for by the arm's masses"
        return Suspicion("problem", statement, "tau1_nm ... are in N m.")
    if times < 0:
        statement = "the recorded torques have the other sign than gravity's pull by the arm's masses"
        return Suspicion("problem", statement, "tau1_nm ... are positive along gravity's pull: change their sign.")
    return None


def _known(values: Array | None) -> Array:
    return np.empty(0) if values is None else values[np.isfinite(values)]
