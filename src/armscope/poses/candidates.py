"""Poses to choose from: spread evenly over the joints' ranges, possible and visible, with the context they have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.poses.constants import DRAWING
from armscope.poses.obstacles import REASONS, Surroundings, ranges, refusals
from armscope.recordings import Recordings
from armscope.recordings.table import unmeasured
from armscope.robot import Arm


@dataclass(frozen=True, eq=False)
class Candidates:
    """Possible poses."""

    table: Recordings  # N rows: motor angles, side of approach, payload
    drawn: int  # how many poses were drawn
    refused: Mapping[str, int]  # how many of those for each of `REASONS`

    def __len__(self) -> int:
        return len(self.table)


def candidates(arm: Arm, count: int, around: Surroundings, seed: int, payload_kg: float = 0.0) -> Candidates:
    """``count`` possible poses: a scrambled Halton sequence over the ranges, without those that are refused.

    Each is tried from a random side of every joint, and every other one (at random) with the payload.

    Args:
        arm: the arm; its joint limits bound the poses.
        count: how many.
        around: floor, tracker, body: what refuses a pose.
        seed: of the sequence and of the context.
        payload_kg: carried in every other row.

    Returns:
        The poses with their context, how many were drawn for them, and how many each reason refused.

    Raises:
        InputError: hardly any pose is possible.
    """
    from scipy.stats import qmc  # takes long to import: only where poses are chosen

    low, high = ranges(arm)
    sequence = qmc.Halton(arm.n_motors, rng=np.random.default_rng(seed))
    kept: list[Array] = []
    refused, drawn, found = dict.fromkeys(REASONS, 0), 0, 0
    while found < count and drawn < DRAWING.drawn * count:
        angles = low + sequence.random(count) * (high - low)
        reasons = refusals(arm, angles, around)
        possible = angles[reasons == ""]
        for reason in REASONS:
            refused[reason] += int(np.sum(reasons == reason))
        kept, drawn, found = [*kept, possible], drawn + count, found + len(possible)
    poses = np.concatenate(kept)[:count]
    if len(poses) < count:
        told = f"{len(poses)} possible poses of {drawn} drawn, and {count} are wanted"
        raise _too_few(arm, told, max(refused, key=lambda reason: refused[reason]), angles, around)
    return Candidates(_pose_rows(poses, np.random.default_rng(seed + 1), payload_kg), drawn, refused)


def _too_few(arm: Arm, told: str, most: str, last: Array, around: Surroundings) -> InputError:
    """That hardly any pose is possible, at the option without which many of them would be.

    Args:
        most: which of `REASONS` refused most; a pose that hits itself may stand below the floor, too.
        last: (N, m) some of those drawn, rad.
    """
    best, option, value, why = 0.0, "", np.empty(0), most
    if around.floor is not None:
        best, option = _possible(arm, last, replace(around, floor=None)), "--floor-mm"
        value, why = np.array([around.floor]), REASONS[1]
    if around.tracker is not None and (share := _possible(arm, last, replace(around, tracker=None))) > best:
        best, option, value, why = share, "--tracker", around.tracker, REASONS[2]
    if best < DRAWING.worth_freeing:
        cure = "Check the joint limits, --radius-mm, --floor-mm and --tracker (mm in the arm's base frame)."
        return InputError(arm.name, "", told, f"most: {most}", cure)
    found = ",".join(f"{each * 1e3:g}" for each in value.tolist())
    rule = f"{told}; most: {why}; without this option {best:.0%} of them would be possible"
    return InputError(option, "", found, rule, "It is in mm, in the arm's base frame.")


def _possible(arm: Arm, angles: Array, around: Surroundings) -> float:
    return float(np.mean(refusals(arm, angles, around) == ""))


def _pose_rows(angles: Array, rng: np.random.Generator, payload_kg: float = 0.0) -> Recordings:
    """Poses (N, m), rad, to be measured, with side of approach and, in every other row on average, payload."""
    approach = rng.choice([-1.0, 1.0], angles.shape)
    payload = np.where(rng.random(len(angles)) < DRAWING.loaded, payload_kg, 0.0) if payload_kg > 0 else None
    return replace(unmeasured(angles), approach=approach, payload=payload, source="poses")


def grid(arm: Arm, count: int, around: Surroundings, rng: np.random.Generator, payload_kg: float = 0.0) -> Recordings:
    """``count`` possible poses of a regular grid over the ranges, the coarsest that has so many, drawn from it.

    Three steps per joint at least: two cannot tell a turn from a shift of the link beyond.

    Args:
        arm: the arm; its joint limits bound the grid.
        count: how many.
        around: what refuses a pose.
        rng: draws ``count`` of the grid's possible poses, and their context.
        payload_kg: carried in every other row, on average.

    Returns:
        The rows, without positions.

    Raises:
        InputError: no grid of reasonable size has so many possible poses.
    """
    low, high = ranges(arm)
    levels = DRAWING.levels
    while levels**arm.n_motors <= DRAWING.grid:
        steps = np.indices((levels,) * arm.n_motors).reshape(arm.n_motors, -1).T
        angles = low + (steps + 0.5) / levels * (high - low)
        possible = angles[refusals(arm, angles, around) == ""]
        if len(possible) >= count:
            order = rng.permutation(len(possible))[:count]
            return _pose_rows(possible[np.sort(order)], rng, payload_kg)
        levels += 1
    raise InputError("--poses", "", count, f"a grid of {levels - 1} steps per joint has fewer possible poses")


def subset(table: Recordings, rows: Indices) -> Recordings:
    """Some rows, numbered anew from 1."""
    return replace(table.rows(rows), id=np.arange(1, len(rows) + 1).astype(str))
