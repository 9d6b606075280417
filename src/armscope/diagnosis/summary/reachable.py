"""Poses that may be asked for: as far as the recordings show that they are free, with loads that were carried."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.summary.constants import NEXT_POSES
from armscope.poses.constants import UP
from armscope.poses.obstacles import Surroundings, body_in_words, lowest, refusals
from armscope.recordings import Recordings
from armscope.robot import Arm


def reachable(
    arm: Arm, recordings: Recordings, around: Surroundings, by_load: bool, rng: np.random.Generator
) -> Recordings:
    """Random poses within the joint limits (where none are stated: the recorded range) that are possible.

    Where too few of them lie within the limits, those within the recorded range compete, too.

    Args:
        arm: the nominal arm.
        recordings: what was recorded.
        around: what refuses a pose.
        by_load: whether poses with different payloads compete, none above what was recorded.
        rng: draws the poses.

    Returns:
        Rows without positions: at most `NEXT_POSES.tried`, fewer (or none) where hardly any pose is possible.
    """
    recorded = recordings.motor_angles.min(axis=0), recordings.motor_angles.max(axis=0)
    stated = np.isfinite(arm.limits).all(axis=1)
    low, high = (np.where(stated, limit, range_) for limit, range_ in zip(arm.limits.T, recorded, strict=True))
    angles = _possible(arm, around, low, high, rng)
    if len(angles) < NEXT_POSES.tried:
        angles = np.concatenate([angles, _possible(arm, around, *recorded, rng)])[: NEXT_POSES.tried]
    return _rows(recordings, angles, _payloads(recordings, len(angles), by_load, rng), rng)


def free_space(arm: Arm, recordings: Recordings, floor: float | None = None) -> Surroundings:
    """The arm's own body above a floor; where none is known, above the lowest that any part of it was, against gravity.

    Args:
        arm: the nominal arm.
        recordings: what was recorded.
        floor: its height in the base frame, m.

    Returns:
        What refuses a pose.
    """
    if floor is not None:
        return Surroundings(floor=floor)
    size = float(np.linalg.norm(arm.gravity))
    anywhere = Surroundings(up=-arm.gravity / size if size > 0 else UP)
    return replace(anywhere, floor=float(lowest(arm, recordings.motor_angles, anywhere).min()))


def checked_in_words(arm: Arm, around: Surroundings, by_recordings: bool, count: int) -> str:
    """What poses to measure next were and were not checked against.

    Args:
        arm: the nominal arm.
        around: what refused poses.
        by_recordings: whether the floor is the lowest point of the recordings, in place of one that was stated.
        count: how many poses are asked for.

    Returns:
        Sentences.
    """
    height = 0.0 if around.floor is None else 1e3 * around.floor
    where = f"z = {height:.0f} mm in the base frame"
    if not np.allclose(around.up, UP):
        where = f"{height:.0f} mm above the base frame's origin, against gravity"
    floor = (
        f"your recordings' lowest point ({where}; --floor-mm states another)" if by_recordings else f"{where}, stated"
    )
    told = f"Checked: joint limits; the arm against itself ({body_in_words(arm, around)}); floor: no part that moves "
    told += f"comes lower than {floor}. Obstacles unknown: run slowly."
    if count < NEXT_POSES.asked:
        told += f" Only {count} of {NEXT_POSES.asked} poses are asked for: hardly any other is possible by these rules."
    return told


def _possible(arm: Arm, around: Surroundings, low: Array, high: Array, rng: np.random.Generator) -> Array:
    found = np.empty((0, arm.n_motors))
    for _ in range(NEXT_POSES.rounds):
        angles = rng.uniform(low, high, (NEXT_POSES.tried, arm.n_motors))
        found = np.concatenate([found, angles[refusals(arm, angles, around) == ""]])
        if len(found) >= NEXT_POSES.tried:
            break
    return found[: NEXT_POSES.tried]


def _payloads(recordings: Recordings, count: int, by_load: bool, rng: np.random.Generator) -> Array | None:
    """None and the heaviest that was carried; where loads tell nothing, the lightest; None without that column."""
    if recordings.payload is None:
        return None
    carried = recordings.payload[np.isfinite(recordings.payload)]
    if not len(carried):
        return np.zeros(count)
    return rng.choice([0.0, carried.max()], count) if by_load else np.full(count, carried.min())


def _rows(recordings: Recordings, angles: Array, payload: Array | None, rng: np.random.Generator) -> Recordings:
    count = len(angles)
    return replace(
        recordings,
        motor_angles=angles,
        positions=np.full((count, 3), np.nan),
        run=np.full(count, "next"),
        target=np.full(count, recordings.target[-1]),
        id=np.arange(1, count + 1).astype(str),
        orientation=None,
        sigma=None,
        extra=None,
        torque=None,
        payload=payload,
        approach=None if recordings.approach is None else rng.choice([-1.0, 1.0], angles.shape),
        speed=None if recordings.speed is None else np.zeros(angles.shape),
        time=None if recordings.time is None else np.full(count, np.nanmax(recordings.time)),
        temperature=None if recordings.temperature is None else np.full(count, np.nanmedian(recordings.temperature)),
    )
