"""Joints of a moving arm that are counted the other way round, or from elsewhere, as the masses say.

Counted so throughout, a joint's own gravity, inertia and friction mostly look as they should: what tells is how its
motion and gravity couple with the other joints. Each torque may have either sign for that: then it is the direction of
positions that is judged, and of the torque's sign only which of its own motion and masses explain it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from armscope.check.motion_constants import MOTION
from armscope.check.motion_readings import OtherReading, Samples, beyond_friction, explained, left_along
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.robot.dynamics import MovingArm
from armscope.verdict.wording import times


@dataclass(frozen=True)
class _Found:
    """Joints that are counted the other way round."""

    joints: Sequence[int]  # in the order in which they say most
    alone: Sequence[int]  # of these, whose torque is counted as it should be
    either: Sequence[int]  # any of which may be it in the place of the only one
    gained: float  # logarithm of how many times less of all torques they leave


def left_of_either_sign(samples: Samples, arm: MovingArm) -> float:
    """Logarithm of the share that joints' motion leaves of their torques, summed, each with the better sign."""
    return float(np.log(left_along(samples, arm)).min(axis=0).sum())


def other_way_round(samples: Samples, arm: MovingArm, names: Sequence[str]) -> OtherReading | None:
    """Joints that are counted the other way round than the arm's description has them.

    One after the other, as long as the next leaves clearly less. Of the last joint it takes more and is a hint: a load
    that is not stated, or a centre of mass on the other side, looks alike there.

    Args:
        samples: differenced over a twentieth of a second.
        arm: as stated.
        names: of the columns of torque or current.

    Returns:
        The table with these joints put right; None where masses do not tell of any.
    """
    if len(samples.q) < MOTION.reading_samples or arm.n_motors < 2 or not np.any(arm.inertial):
        return None
    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    least = np.log(np.where(np.arange(arm.n_motors) < arm.n_motors - 1, MOTION.other_way, MOTION.no_other_zero))
    found, gained = _one_by_one(few, arm, [], least)
    # two may hide each other: each by itself leaves more, then, or a third passes for them
    pairs = {pair: _gain(few, arm, pair) for pair in combinations(range(arm.n_motors), 2)}
    best = max(pairs, key=pairs.__getitem__)
    if pairs[best] > max(gained + np.log(MOTION.clearly), least[list(best)].sum()):
        found, gained = _one_by_one(few, arm, best, least)
    right, alone = _put_right(few, arm, found)
    if not found or explained(right, arm) <= MOTION.explained:
        return None
    near = [j for j in range(arm.n_motors) if _gain(few, arm, [j]) > gained - np.log(MOTION.other_way)]
    either = [j for j in near if len(found) == 1 and j != found[0] and _as_simple(few, arm, j, right)]
    whole = samples.turned_round(found).turned([j for j in found if j not in alone])
    told = _told(_Found(found, alone, either, gained), arm.n_motors - 1, names)
    return OtherReading((told,), whole)


def _one_by_one(samples: Samples, arm: MovingArm, turned: Sequence[int], least: Array) -> tuple[list[int], float]:
    """Joints that are counted the other way round, one more as long as it leaves less by enough; and the gain.

    Args:
        least: (m,) logarithm of how many times less each must leave.

    Returns:
        The joints, and what they gain together, see `_gain`.
    """
    found, gained = list(turned), _gain(samples, arm, turned)
    while others := [j for j in range(arm.n_motors) if j not in found]:
        gains = {j: _gain(samples, arm, [*found, j]) - gained for j in others}
        clearly = [j for j in others if gains[j] > least[j]]
        if not clearly:
            break
        best = max(clearly, key=gains.__getitem__)
        found, gained = [*found, best], gained + gains[best]
    return found, gained


def _gain(samples: Samples, arm: MovingArm, joints: Sequence[int]) -> float:
    """Logarithm of how many times less of all torques is left with joints counted the other way round."""
    return left_of_either_sign(samples, arm) - left_of_either_sign(samples.turned_round(joints), arm)


def told_by_masses(samples: Samples, arm: MovingArm, joint: int) -> bool:
    """Whether masses leave clearly more, or less, of the torques with a joint counted the other way round.

    Args:
        samples: differenced over a twentieth of a second.
        arm: as stated.
        joint: which.

    Returns:
        False where there are too few samples, too.
    """
    if len(samples.q) < MOTION.reading_samples:
        return False
    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    return bool(abs(_gain(few, arm, [joint])) > np.log(MOTION.other_way))


def _put_right(samples: Samples, arm: MovingArm, joints: Sequence[int]) -> tuple[Samples, list[int]]:
    """The samples with joints counted the other way round, and of which of them the torque is right as it is."""
    moved = samples.turned_round(joints)
    as_it_is, turned = left_along(moved, arm)
    alone = [j for j in joints if as_it_is[j] <= turned[j]]
    return moved.turned([j for j in joints if j not in alone]), alone


def _as_simple(samples: Samples, arm: MovingArm, joint: int, best: Samples) -> bool:
    """Whether another joint in the place of the best leaves as little with no more torques turned than its own."""
    left, least = (
        float(np.log(left_along(each, arm)[0]).sum()) for each in (_put_right(samples, arm, [joint])[0], best)
    )
    return bool(left < least + np.log(MOTION.other_way))


def _told(found: _Found, last: int, names: Sequence[str]) -> Suspicion:
    """In words; of the last joint it is no more than a hint."""
    joints, both = sorted(found.joints), [j for j in sorted(found.joints) if j not in found.alone]
    what = [_of_joints(both)] if both else []
    what += [f"the position of joint {j + 1} alone" for j in sorted(found.alone)]
    instead = f" (or {_of_joints(found.either, 'or')} in its place)" if found.either else ""
    statement = (
        f"with {enumerated(what)}{instead} counted the other way round the stated masses leave "
        f"{times(float(np.exp(found.gained)))} times less of all joints' torques"
    )
    columns = [f"q{j + 1} and its speeds" for j in joints] + [names[j] for j in both]
    cure = f"Negate {enumerated(columns)}"
    if found.alone:
        cure += f", and leave {enumerated([names[j] for j in sorted(found.alone)])}"
    if both:
        cure += f"; or turn the axis of {_of_joints(both)} in the robot's description (`actuation` with -1)"
    cure += f". Jog {_of_joints(joints[:1])}: does its angle grow as the model has it?"
    if last in joints:
        cure += " A last link whose centre of mass is stated on the other side looks alike."
    # no mass on the other side turns the sign of friction
    sure = found.gained > np.log(MOTION.clearly) and (joints != [last] or last in found.alone)
    return Suspicion("problem" if sure else "hint", statement, cure)


def _of_joints(joints: Sequence[int], last: str = "and") -> str:
    return f"joint{'s' if len(joints) > 1 else ''} {enumerated([str(j + 1) for j in joints], last)}"


def moved_zeros(samples: Samples, arm: MovingArm) -> Iterator[tuple[int, float, Samples]]:
    """Every joint but the last, each turn by which its zero may be elsewhere, and the samples as they are then.

    Not the last joint: there, a load that is not stated looks like a zero.
    """
    for j in np.flatnonzero(~arm.sliding[:-1]).tolist():
        for turn in MOTION.turned:
            yield j, turn, replace(samples, q=samples.q + turn * (np.arange(arm.n_motors) == j))


def zeros_elsewhere(samples: Samples, arm: MovingArm) -> Iterator[Suspicion]:
    """Joints whose angles the masses' torque takes to be a quarter or half turn from where robot.yaml has them.

    As recorded, every torque may have either sign, or gravity point the other way: a zero elsewhere says more than
    these.

    Yields:
        The joint and the turn that say most, a problem where they say so much that nothing else would hold.
    """
    if len(samples.q) < MOTION.reading_samples or not np.any(arm.inertial):
        return
    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    gravity = arm.gravity_torques(few.q, arm.model.gravity.linear)
    turned = [_left_by_masses(few, arm, -2 * gravity), _left_by_masses(few, arm, either_sign=True)]
    stated, tried = min(turned, key=lambda left: float(np.log(left).sum())), []
    for j, turn, moved in moved_zeros(few, arm):
        told = float(np.log(stated / _left_by_masses(moved, arm)).sum())
        tried.append((told, j, float(np.degrees(turn))))
    told, j, turn = max(tried, default=(0.0, 0, 0.0))
    if told > np.log(MOTION.other_zero):
        less = f"{times(float(np.exp(told)))} times less of all joints' torques"
        statement = f"with q{j + 1} {turn:+.0f} deg the stated masses leave {less}"
        cure = (
            f"Is the zero of joint {j + 1} that of robot.yaml (theta_offset_deg)? A load that is not stated, or an arm "
            "that stands otherwise, can look alike."
        )
        yield Suspicion("problem" if told > np.log(MOTION.no_other_zero) else "hint", statement, cure)


def _left_by_masses(samples: Samples, arm: MovingArm, more: Array | float = 0.0, either_sign: bool = False) -> Array:
    """(m,) share of each torque beyond friction that the stated masses leave.

    Args:
        more: (N, m) torque beside that of the masses.
        either_sign: whether a torque may have the sign opposite to theirs.
    """
    rigid = arm.torques(samples.q, samples.dq, samples.ddq, arm.inertial) + more
    left = []
    for recorded, asked in beyond_friction(samples, rigid):
        whole, along = max(float(recorded @ recorded), 1e-300), float(asked @ recorded)
        along = along if either_sign else max(along, 0.0)
        left.append(max(1 - along**2 / max(float(asked @ asked), 1e-300) / whole, MOTION.least_left))
    return np.array(left)
