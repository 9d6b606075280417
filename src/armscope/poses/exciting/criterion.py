"""How well a motion shows what it is meant to show: D-optimality of the base parameters, or how far rivals differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr

from armscope.core.inputs import InputError
from armscope.core.location import Location
from armscope.core.types import Array
from armscope.design.fourier import Limits
from armscope.poses.exciting.columns import Motion, all_columns, cause_columns, joint_columns, link_columns, names
from armscope.poses.exciting.constants import SHOWING
from armscope.robot import Arm

Pair = tuple[tuple[str, str], tuple[str, str]]


@dataclass(frozen=True, eq=False)
class Showable:
    """What motions of an arm can show at all."""

    base: Array  # columns (of `names`) that are independent of one another; the others move nothing, or only together
    scale: Array  # (b,) RMS of the base columns over random states: the unit in which they count
    weight: Array  # (m,) 1 / (RMS torque) of the motors over random states
    nothing: tuple[str, ...]  # names of parameters that move no motor whatever the motion
    together: tuple[str, ...]  # names that show only as a sum with others


def shown_at_all(arm: Arm, limits: Limits, rng: np.random.Generator) -> Showable:
    """By columns at random states within the limits (Gautier 1991: pivoted QR of the regressor).

    Args:
        arm: the arm.
        limits: of angle, speed, acceleration.
        rng: of the states.

    Returns:
        Base parameters, their units, and what stays hidden.
    """
    low, high = limits.angle.T
    shape = (SHOWING.states, len(low))
    angle = rng.uniform(low, high, shape)
    speed, acceleration = (rng.uniform(-most, most, shape) for most in (limits.speed, limits.acceleration))
    columns = all_columns(arm, Motion(angle, speed, acceleration, 1.0))
    weight = 1 / np.maximum(np.sqrt(np.mean(np.sum(columns**2, axis=2), axis=0)), SHOWING.nothing)
    flat = (columns * weight[:, None]).reshape(-1, columns.shape[2])
    size = np.sqrt(np.mean(flat**2, axis=0))
    there = np.flatnonzero(size > SHOWING.dependent * size.max())
    _, triangle, order = qr(flat[:, there] / size[there], mode="economic", pivoting=True)
    rank = int(np.sum(np.abs(np.diag(triangle)) > SHOWING.dependent * np.abs(triangle[0, 0])))
    base = np.sort(there[order[:rank]])
    called = names(arm)
    hidden = set(range(len(called))) - set(there)
    dependent = set(there) - set(base)
    return Showable(
        base, size[base], weight, tuple(called[k] for k in sorted(hidden)), tuple(called[k] for k in sorted(dependent))
    )


@dataclass(frozen=True)
class MotionScore:
    """Of a motion."""

    value: float  # what is maximised: log det of the information per sample, or the least separation of the pairs
    condition: float  # of the base regressor, columns in their units
    weakest: str = ""  # the base parameter that shows least
    # for each pair the share of one cause's torque that the other can't imitate, 0 ... 1
    separations: tuple[float, ...] = ()


def motion_score(arm: Arm, shown: Showable, motion: Motion, pairs: tuple[Pair, ...] = ()) -> MotionScore:
    """How good a motion is.

    Args:
        arm: the arm.
        shown: what its motions can show at all.
        motion: the motion.
        pairs: causes to be told apart; none: all base parameters shall show.

    Returns:
        Its score; larger values are better.
    """
    columns = all_columns(arm, motion) * shown.weight[:, None]
    flat = columns.reshape(-1, columns.shape[2])[:, shown.base] / shown.scale / np.sqrt(len(columns))
    information = flat.T @ flat
    eigenvalues, vectors = np.linalg.eigh(information)
    condition = float(np.sqrt(eigenvalues[-1] / max(eigenvalues[0], SHOWING.nothing**2)))
    weakest = names(arm)[int(shown.base[int(np.argmax(np.abs(vectors[:, 0])))])]
    if not pairs:
        _, value = np.linalg.slogdet(information + SHOWING.nothing * np.eye(len(information)))
        return MotionScore(float(value), condition, weakest)
    separations = tuple(separation(arm, shown, motion, pair) for pair in pairs)
    return MotionScore(min(separations), condition, weakest, separations)


def separation(arm: Arm, shown: Showable, motion: Motion, pair: Pair) -> float:
    """The share of the smaller-looking cause's torque that the other, with offset and friction, can't imitate.

    Each direction of the first cause counts by its RMS torque; the share is the least of both ways round. A cause that
    is a special case of the other is told from it by what the other has beyond it.

    Args:
        arm: the arm.
        shown: what its motions can show at all.
        motion: the motion.
        pair: two (effect, location).

    Returns:
        The share, 0 ... 1.

    Raises:
        InputError: a cause without a law by which a motion could be planned.
    """
    links = link_columns(arm, motion)
    one, other = (_pattern(arm, motion, links, cause) * shown.weight[:, None] for cause in pair)
    own = {(Location.of(cause[1]).index, BACKGROUND_OF.get(cause[0])) for cause in pair}
    free = joint_columns(motion) * shown.weight[:, None]
    kept = [k for k in range(free.shape[2]) if k % 4 != 0 and (k // 4, k % 4) not in own]
    background = free[:, :, kept].reshape(-1, len(kept))
    flat = [each.reshape(-1, each.shape[2]) for each in (one, other)]
    ways = [(k, 1 - k) for k in (0, 1) if not _special_case(pair[k], pair[1 - k])]
    return min(_not_imitated(flat[target], np.hstack([flat[rival], background])) for target, rival in ways)


BACKGROUND_OF = {"torque_offset": 0, "coulomb_friction": 1, "viscous_friction": 2, "rotor_inertia": 3}
"""Causes that are themselves what is fitted at every joint: number in `JOINT_NAMES`."""
SPECIAL_CASES = {"torque_offset": ("gravity_balance", "cable_torque"), "gravity_balance": ("cable_torque",)}
"""Causes that others at the same joint hold: a constant, a line over the angle, a curve over the angle."""


def _special_case(cause: tuple[str, str], other: tuple[str, str]) -> bool:
    return cause[1] == other[1] and other[0] in SPECIAL_CASES.get(cause[0], ())


def _pattern(arm: Arm, motion: Motion, links: Array, cause: tuple[str, str]) -> Array:
    found = cause_columns(arm, motion, links, *cause)
    if found is None:
        raise InputError("--separate", "", " ".join(cause), "this cause has no torque pattern to plan a motion by")
    return found


@dataclass(frozen=True)
class Sorted:
    """Pairs of causes by what a motion can do for them."""

    apart: tuple[Pair, ...]  # those that some motion tells apart
    alike: tuple[Pair, ...]  # those that no motion tells apart
    # those of which a cause has no law, such as a free curve, so that no motion can be planned for them
    lawless: tuple[Pair, ...]


def told_apart(arm: Arm, shown: Showable, limits: Limits, pairs: tuple[Pair, ...], rng: np.random.Generator) -> Sorted:
    """Pairs that some motion tells apart, and those that none does, by random states within the limits.

    Args:
        arm: the arm.
        shown: what its motions can show at all.
        limits: of angle, speed, acceleration.
        pairs: causes to be told apart.
        rng: of the states.

    Returns:
        The three kinds of pairs.
    """
    low, high = limits.angle.T
    shape = (SHOWING.states, len(low))
    speed, acceleration = (rng.uniform(-most, most, shape) for most in (limits.speed, limits.acceleration))
    states = Motion(rng.uniform(low, high, shape), speed, acceleration, 1.0)
    links = link_columns(arm, states)
    causes = {cause for pair in pairs for cause in pair}
    known = {cause for cause in causes if cause_columns(arm, states, links, *cause) is not None}
    lawful = tuple(pair for pair in pairs if known.issuperset(pair))
    apart = tuple(pair for pair in lawful if separation(arm, shown, states, pair) > SHOWING.same)
    alike = tuple(pair for pair in lawful if pair not in apart)
    return Sorted(apart, alike, tuple(pair for pair in pairs if pair not in lawful))


def _not_imitated(target: Array, rivals: Array) -> float:
    scale = np.maximum(np.linalg.norm(rivals, axis=0), SHOWING.nothing)
    left = target - (rivals / scale) @ np.linalg.lstsq(rivals / scale, target, rcond=SHOWING.rank)[0]
    return float(np.sqrt(np.sum(left**2) / max(float(np.sum(target**2)), SHOWING.nothing)))
