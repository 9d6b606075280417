"""What drives record of a motion: filtered, sampled, noisy and in steps, as a motions.csv."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.signal import butter, lfilter, sosfiltfilt

from armscope.core.types import Array, Indices
from armscope.world.motion.constants import ROUGH_MOTION as ROUGH
from armscope.world.motion.session import GRID_HZ, Session

ENCODER_STEPS = 2**19  # Of a turn of the joint, as good industrial arms resolve it
TORQUE_STEPS = 2**13  # From the largest torque to its opposite
ANTI_ALIAS = 0.4  # Cut-off of the drives' filter as a share of the recorded rate
MEMORY_S = 0.02  # Half of a torque's noise is white; the other half is ripple and control noise that lasts this long
SPEED_FILTER_S = 0.004  # Drives filter the speed that they report, which is late by as much


@dataclass(frozen=True, eq=False)
class Recorded:
    """The recorded rows of a session."""

    rows: Indices  # (N,) which samples of the fine grid
    torque: Array  # (N, n) read, N m
    noise: Array  # (N, n) noise and steps in it, N m
    left: Array  # (N, n) what the true torque of that moment leaves: the noise, and what the drives' filter rounds off
    links: Array | None = None  # (N, n) rad, of the links' own encoders; None where they have none


def record(
    session: Session, torque: Array, sigma: Array, rate: int, rng: np.random.Generator, rough: bool = False
) -> Recorded:
    """Filter, sample and spoil torques.

    Args:
        session: the motion on the fine grid.
        torque: (T, n) N m.
        sigma: (n,) standard deviation of the noise, N m.
        rate: Hz, a divisor of `GRID_HZ`.
        rng: of the noise.
        rough: its noise is a rough arm's.

    Returns:
        The recorded rows.
    """
    every = GRID_HZ // rate
    filtered = np.array(torque)
    if every > 1:
        low_pass = butter(1, ANTI_ALIAS * rate, fs=GRID_HZ, output="sos")
        for run in session.runs():
            filtered[run] = sosfiltfilt(low_pass, torque[run], axis=0)
    rows = np.concatenate([np.arange(run.start, run.stop, every) for run in session.runs()])
    unit = _noise(len(rows), torque.shape[1], rate, rng)
    noise = sigma * (rough_noise(unit, session.speed[rows], rng) if rough else unit)
    step = 2 * np.abs(filtered).max(axis=0) / TORQUE_STEPS
    read = np.round((filtered[rows] + noise) / step) * step
    return Recorded(rows, read, read - filtered[rows], read - torque[rows])


def _noise(count: int, joints: int, rate: int, rng: np.random.Generator) -> Array:
    """(N, n) of unit variance: white and, with as much power, of first order."""
    kept = np.exp(-1 / (MEMORY_S * rate))
    white, driving = rng.normal(size=(2, count, joints))
    lasting = lfilter([np.sqrt(1 - kept**2)], [1.0, -kept], driving, axis=0)
    found: Array = (white + lasting) / np.sqrt(2)
    return found


def rough_noise(noise: Array, speed: Array, rng: np.random.Generator) -> Array:
    """Noise with Student's tails that is larger where a joint moves, as strong as before in all.

    Args:
        noise: (N, n) Gaussian, of unit variance.
        speed: (N, n) rad/s of the joints.
        rng: of the tails.

    Returns:
        (N, n) of unit variance.
    """
    tails = np.sqrt(ROUGH.noise_freedom / rng.chisquare(ROUGH.noise_freedom, noise.shape))
    usual = np.sqrt(np.mean(speed**2, axis=0))
    spoiled = noise * tails * (1 + ROUGH.noise_moving * np.abs(speed) / usual)
    return np.asarray(spoiled / np.sqrt(np.mean(spoiled**2, axis=0)))


def independent_share(rate: int) -> float:
    """How many independent readings a recorded one is worth: 1 / (1 + 2 sum of autocorrelations)."""
    kept = np.exp(-1 / (MEMORY_S * rate))
    return float(1 / (1 + kept / (1 - kept)))


def table(session: Session, recorded: Recorded, columns: tuple[str, ...], gains: Array | None) -> pd.DataFrame:
    """motions.csv: run, time, angles in the encoder's steps, torques or currents, and the context asked for.

    Args:
        session: the motion.
        recorded: what was read.
        columns: of `temperature_c` and `speed`.
        gains: (n,) N m/A of the drives that record currents; None for torques.

    Returns:
        The table with training and test rows, in the session's order.
    """
    rows = recorded.rows
    names = range(1, session.angle.shape[1] + 1)
    step = 2 * np.pi / ENCODER_STEPS
    angle = (np.round(session.angle[rows] / step) * step).round(8)
    content: dict[str, object] = {"run": session.run[rows], "time_s": session.time[rows].round(6)}
    content |= {f"q{j}_rad": angle[:, j - 1] for j in names}
    if recorded.links is not None:
        content |= {f"q{j}_link_rad": recorded.links[:, j - 1] for j in names}
    if "speed" in columns:
        speed = _reported_speed(session)[rows].round(6)
        content |= {f"dq{j}_rad_s": speed[:, j - 1] for j in names}
    if gains is None:
        content |= {f"tau{j}_nm": recorded.torque[:, j - 1] for j in names}
    else:
        content |= {f"current{j}_a": recorded.torque[:, j - 1] / gains[j - 1] for j in names}
    if "temperature_c" in columns:
        content["temperature_c"] = session.temperature[rows].round(2)
    return pd.DataFrame(content)


def _reported_speed(session: Session) -> Array:
    kept = np.exp(-1 / (SPEED_FILTER_S * GRID_HZ))
    found = np.empty_like(session.speed)
    for run in session.runs():
        found[run] = lfilter([1 - kept], [1.0, -kept], session.speed[run], axis=0)
    return found
