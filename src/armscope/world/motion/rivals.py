"""Which other causes could stand in place of a concealed one: decided before anybody diagnoses anything.

To first order a cause is a few patterns of torque. A rival is a cause at a place whose patterns, with whatever is
fitted anyway, reproduce the concealed change of torque up to what the noise hides. Patterns of links come from the
same engine as the world: two compiled arms that differ by a little. What the names of the other concealed causes can
say as well, with numbers of their own (a spring beside a cable of the same joint: both are curves of its angle),
nobody can ask for.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.world.judge import ALTERNATIVE_NATS, Alternative
from armscope.world.kinds import joints
from armscope.world.layout import Geometry
from armscope.world.motion.links import NOISE_RAD, link_rivals
from armscope.world.motion.mechanism import Dynamics, MovingArm
from armscope.world.motion.recording import independent_share
from armscope.world.motion.session import COLD_C, GRID_HZ, Session
from armscope.world.motion.stage import Stage, sign, stage_of
from armscope.world.motion.virtual_arm import Sized, VirtualArm
from armscope.world.rivals import Rival

MOST_SAMPLES = 600
SMALL = 1e-4
STRIBECK_SPEEDS = (0.05, 0.15, 0.4)
CURVE_DEGREE = 5
SEEN_NATS = 20.0  # From which there is something that another name could be as good for


@dataclass(frozen=True)
class Standing:
    """What is to be asked for of a concealed cause, the others being as they are."""

    alternatives: list[Alternative]  # acceptable names in its place, nearest first
    beside_nats: float  # what is left of it where each other cause's name says as much of it as it can

    @property
    def is_said_by_others(self) -> bool:
        """Whether the others' names leave nothing that could be told."""
        return self.beside_nats < ALTERNATIVE_NATS


def standings(arm: VirtualArm, concealed: list[Sized], rate: int, plain: Array) -> list[Standing]:
    """Of each concealed cause what else could stand in its place, and what of it is its own.

    Args:
        arm: the arm.
        concealed: all of it.
        rate: Hz at which the torques are recorded.
        plain: (T, n) torques with nothing concealed.

    Returns:
        One for each cause.
    """
    rows, worth = _sample(arm, rate)
    others = list(rivals(arm, plain, rows))
    weights = np.tile(np.sqrt(worth) / arm.sigma, len(rows))
    free = _background(arm, rows)
    found = []
    for each in concealed:
        if each.concealed.kind.lies is not None:
            of_link = _of_link(arm, each, rows, worth / independent_share(rate))
            found.append(Standing(of_link, float("inf")))
            continue
        rest = [other for other in concealed if other is not each and other.concealed.kind.lies is None]
        equal = _equal(each, rest, others, rows, weights, free)
        found.append(Standing(equal, _beside(each, rest, others, rows, weights, free)))
    return found


def small_standings(arm: VirtualArm, small: list[Sized], rate: int, plain: Array) -> list[Standing]:
    """Of what a rough arm has in its joints, each by itself: what else at that joint could be meant.

    Args:
        arm: the arm.
        small: with their changes of torque.
        rate: Hz at which the torques are recorded.
        plain: (T, n) torques with nothing concealed.

    Returns:
        One for each; nothing is as good as what nobody could see.
    """
    rows, worth = _sample(arm, rate)
    slope = -arm.session.differentiated(plain)[rows]
    stage = stage_of(Geometry(arm.description), arm.dynamics, arm.session.taken(rows))
    found = []
    for each in small:
        j = each.concealed.joint
        weights = np.full(len(rows), np.sqrt(worth) / arm.sigma[j])
        alone = replace(each, change=each.change[:, [j]])
        seen = 0.5 * float(np.sum((weights * alone.change[rows, 0]) ** 2))
        place = each.concealed.location
        others = [
            Rival(name, place, columns) for name, columns in _joint_patterns(stage, j, plain[rows, j], slope[:, j])
        ]
        equal = _equal(alone, [], others, rows, weights, arm.background(j)[rows]) if seen > SEEN_NATS else []
        found.append(Standing(equal, seen))
    return found


def _sample(arm: VirtualArm, rate: int) -> tuple[Indices, float]:
    """Samples of the training runs, and how many independent readings each is worth."""
    train = np.flatnonzero(~arm.session.test)
    rows = train[:: max(len(train) // MOST_SAMPLES, 1)]
    return rows, len(train) / GRID_HZ * rate * independent_share(rate) / len(rows)


def _beside(one: Sized, rest: list[Sized], others: list[Rival], rows: Indices, weights: Array, free: Array) -> float:
    """Nats that are left of a cause where the others, and all that their names can say, are fitted."""
    names = {(each.concealed.kind.effect, each.concealed.location) for each in rest}
    names.discard((one.concealed.kind.effect, one.concealed.location))
    said = [other.columns for other in others if (other.effect, other.location) in names]
    fixed = [free, *(each.change[rows].reshape(-1, 1) for each in rest), *said]
    basis = _orthonormal(weights[:, None] * np.hstack(fixed))
    target = weights * one.change[rows].reshape(-1)
    left = target - basis @ (basis.T @ target)
    return 0.5 * float(left @ left)


def _of_link(arm: VirtualArm, one: Sized, rows: Indices, worth: float) -> list[Alternative]:
    """What else would lay a link beside its motor so, whatever their zeros."""
    stage = stage_of(Geometry(arm.description), arm.dynamics, arm.session.taken(rows))
    weights = np.full(len(rows), np.sqrt(worth) / NOISE_RAD)
    others = list(link_rivals(stage, one.concealed.joint))
    return _equal(one, [], others, rows, weights, np.ones((len(rows), 1)))


def _equal(
    one: Sized, rest: list[Sized], others: list[Rival], rows: Indices, weights: Array, free: Array
) -> list[Alternative]:
    target = weights * one.change[rows].reshape(-1)
    fixed = [free] + [each.change[rows].reshape(-1, 1) for each in rest]
    basis = _orthonormal(weights[:, None] * np.hstack(fixed))
    target = target - basis @ (basis.T @ target)
    own = (one.concealed.kind.effect, one.concealed.location)
    numbers = len(one.concealed.kind.scaled)
    numbers = max([numbers, *(each.columns.shape[1] for each in others if (each.effect, each.location) == own)])
    found = []
    for rival in others:
        if (rival.effect, rival.location) == own:
            continue
        columns = weights[:, None] * rival.columns
        span = _orthonormal(columns - basis @ (basis.T @ columns))
        left = target - span @ (span.T @ target)
        # numbers more than the truth's own need evidence of their own (Schwarz 1978)
        price = 0.5 * np.log(len(rows)) * max(span.shape[1] - numbers, 0)
        gap = 0.5 * float(left @ left) + float(price)
        if gap < ALTERNATIVE_NATS:
            found.append(Alternative(rival.effect, rival.location, round(gap, 3)))
    return sorted(found, key=lambda each: each.gap_nats)


def _orthonormal(columns: Array) -> Array:
    scale = np.linalg.norm(columns, axis=0)
    kept = columns[:, scale > 0] / scale[scale > 0]
    if not kept.shape[1]:
        return np.zeros((len(columns), 0))
    left, singular, _ = np.linalg.svd(kept, full_matrices=False)
    return left[:, singular > 1e-9]


def _background(arm: VirtualArm, rows: Indices) -> Array:
    n = len(arm.sigma)
    blocks = [_at(arm.background(j)[rows], j, n) for j in range(n)]
    return np.hstack(blocks)


def _at(values: Array, joint: int, count: int) -> Array:
    """(N n, k) patterns that act on one joint, from (N, k)."""
    found = np.zeros((len(values), count, values.shape[1]))
    found[:, joint] = values
    return found.reshape(len(values) * count, values.shape[1])


def rivals(arm: VirtualArm, torque: Array, rows: Indices) -> Iterator[Rival]:
    """Every cause of the vocabulary at every place (ripples of many waves are left out).

    Args:
        arm: the arm.
        torque: (T, n) its torques with nothing concealed.
        rows: samples at which the patterns are wanted.

    Yields:
        One at a time.
    """
    plain, slope = torque[rows], -arm.session.differentiated(torque)[rows]
    session = arm.session.taken(rows)
    geometry = Geometry(arm.description)
    links = MovingArm(geometry, arm.dynamics.without_friction())
    stage = stage_of(geometry, arm.dynamics, session)
    places = joints(arm.description)
    for j, place in enumerate(places):
        for effect, columns in _joint_patterns(stage, j, plain[:, j], slope[:, j]):
            yield Rival(effect, place, _at(columns, j, len(places)))
    yield from _drive_rivals(arm, links, rows)
    yield from _mechanism_rivals(arm, session, plain)


def _joint_patterns(stage: Stage, j: int, torque: Array, slope: Array) -> Iterator[tuple[str, Array]]:
    session = stage.session
    speed, angle, side = session.speed[:, j], session.angle[:, j], sign(session, j)
    yield "coulomb_friction", side[:, None]
    yield "viscous_friction", speed[:, None]
    yield "viscous_curve", np.column_stack([speed * np.abs(speed), speed**3])
    yield "asymmetric_friction", np.abs(speed)[:, None]
    yield "load_friction", (np.abs(stage.load[:, j]) * side)[:, None]
    for slow in STRIBECK_SPEEDS:
        yield "stribeck_friction", (np.exp(-((speed / slow) ** 2)) * side)[:, None]
    yield "thermal_friction", ((session.temperature - COLD_C) * speed)[:, None]
    yield "rotor_inertia", session.acceleration[:, [j]]
    yield "torque_offset", np.ones((len(session), 1))
    yield "motor_constant", torque[:, None]
    yield "torque_delay", slope[:, None]
    yield "gravity_balance", np.column_stack([np.ones_like(angle), angle])
    middle, half = (angle.max() + angle.min()) / 2, max(np.ptp(angle) / 2, 1e-9)
    yield "cable_torque", np.polynomial.chebyshev.chebvander((angle - middle) / half, CURVE_DEGREE)


def _drive_rivals(arm: VirtualArm, links: MovingArm, rows: Indices) -> Iterator[Rival]:
    """Each drive gives way by a little: torques of all joints where its link lags behind."""

    def torques(motion: Session) -> Array:
        return links.torques(motion.angle, motion.speed, motion.acceleration)

    load = torques(arm.session)
    for j, place in enumerate(joints(arm.description)):
        little = SMALL / np.abs(load[:, j]).max()
        shift = np.zeros_like(load)
        shift[:, j] = -little * load[:, j]
        moved = torques(arm.session.moved(shift).taken(rows))
        yield Rival("joint_compliance", place, (moved - load[rows]).reshape(-1, 1) / little)


def _mechanism_rivals(arm: VirtualArm, session: Session, plain: Array) -> Iterator[Rival]:
    n = arm.dynamics.n_joints

    def pattern(changed: Dynamics) -> Array:
        moved = replace(arm, dynamics=changed).torques([], session)
        return (moved - plain).reshape(-1) / SMALL

    for j in range(n):
        place = f"link {j + 1}"
        mass = arm.dynamics.mass[j]
        heavier = arm.dynamics.changed("mass", j, SMALL).changed("inertia", j, SMALL / mass * arm.dynamics.inertia[j])
        yield Rival("link_mass", place, pattern(heavier)[:, None])
        moments = [pattern(arm.dynamics.changed("centre", j, SMALL * axis)) for axis in np.eye(3)]
        yield Rival("link_first_moment", place, np.column_stack(moments))
        inertias = [pattern(arm.dynamics.changed("inertia", j, SMALL * axis)) for axis in np.eye(6)[:3]]
        yield Rival("link_inertia", place, np.column_stack(inertias))
    yield Rival("payload_error", "payload", pattern(replace(arm.dynamics, load=SMALL))[:, None])
    turns = []
    for axis in np.eye(3)[:2]:
        turned = arm.dynamics.gravity - SMALL * np.cross(axis, arm.dynamics.gravity)
        turns.append(pattern(replace(arm.dynamics, gravity=turned)))
    yield Rival("gravity_direction", "base", np.column_stack(turns))
    if n >= 6:
        both = np.zeros((len(session), n, 3))
        for k, values in enumerate(_together(session, n)):
            both[:, n - 2 : n, k] = values[:, None]
        last = f"joint {n} from joint {n - 1}"
        yield Rival("coupled_friction", last, both[:, :, :2].reshape(-1, 2))
        yield Rival("coupled_inertia", last, both[:, :, 2:].reshape(-1, 1))


def _together(session: Session, n: int) -> tuple[Array, Array, Array]:
    speed = session.speed[:, n - 2] + session.speed[:, n - 1]
    return np.tanh(speed / 2e-3), speed, session.acceleration[:, n - 2] + session.acceleration[:, n - 1]
