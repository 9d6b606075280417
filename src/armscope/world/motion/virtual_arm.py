"""A virtual arm in motion: its ordinary friction, what it conceals, and how large that is beside the noise."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.world.layout import Geometry
from armscope.world.motion.kinds import Concealed, Kind
from armscope.world.motion.links import NOISE_RAD
from armscope.world.motion.mechanism import Dynamics, MovingArm
from armscope.world.motion.session import Session
from armscope.world.motion.stage import PlainArm, sign, stage_of

CLOSE = 0.01  # Sizes are reached to within this share
FIRST = 1e-4  # Sizes are found from this share of a unit on: small enough for any body
MOST_TRIES = 40  # Places and numbers that are drawn before an effect counts as impossible
TOO_SMALL = 1e-9  # What background friction absorbs has no size


class ImpossibleEffect(ValueError):
    """Nowhere on this arm can this be as large as asked for without being absurd."""


class VirtualArm(PlainArm):
    """An arm that can conceal things: what its drives and encoders then say, and how much of that stands out."""

    def torques(self, concealed: list[Concealed], session: Session | None = None) -> Array:
        """(T, n) what the drives would record without noise, N m. Raises ValueError: no body has the inertias that
        come out."""
        session = self.session if session is None else session
        geometry, dynamics = Geometry(self.description), self.dynamics
        for each in concealed:
            if each.kind.changes is not None:
                dynamics = each.kind.changes(dynamics, Location.of(each.location), each.numbers)
        stage = stage_of(geometry, dynamics, session)
        torque = MovingArm(geometry, dynamics).torques(session.angle, session.speed, session.acceleration)
        for each in concealed:
            if each.kind.pulls is not None:
                pulled = each.kind.pulls(stage, each.joint, each.numbers)
                torque[:, slice(None) if pulled.ndim == 2 else each.joint] += pulled
        for each in concealed:
            if each.kind.records is not None:
                torque = each.kind.records(session, torque, each.joint, each.numbers)
        return torque

    def beside_motors(self, concealed: list[Concealed]) -> Array:
        """(T, n) rad by which links lie beside their motors."""
        stage = stage_of(Geometry(self.description), self.dynamics, self.session)
        found = np.zeros_like(self.session.angle)
        for each in concealed:
            if each.kind.lies is not None:
                found[:, each.joint] += each.kind.lies(stage, each.joint, each.numbers)
        return found

    def background(self, joint: int) -> Array:
        """(T, k) torques that are fitted anyway at a joint (0-based): friction and rotor, where they are not stated."""
        session = self.session
        if self.stated:
            return np.zeros((len(session), 0))
        return np.column_stack([sign(session, joint), session.speed[:, joint], session.acceleration[:, joint]])

    def beyond_background(self, change: Array) -> Array:
        """(T, n) the part of a change of torque on the training runs that no ordinary friction takes up."""
        train = ~self.session.test
        left = np.array(change[train])
        for joint in range(left.shape[1]):
            columns = self.background(joint)[train]
            if columns.shape[1]:
                left[:, joint] -= columns @ np.linalg.lstsq(columns, left[:, joint], rcond=None)[0]
        return left

    def among(self, change: Array) -> VirtualArm:
        """The arm where (T, n) torques that nobody is to tell from noise are taken for noise."""
        beside = np.mean(self.beyond_background(change) ** 2, axis=0)
        return replace(self, sigma=np.sqrt(self.sigma**2 + beside))

    def sized(self, concealed: Concealed, change: Array) -> Sized:
        """How large (T, n) torques of a concealed cause are beside this arm's noise."""
        each = np.sqrt(np.mean(self.beyond_background(change) ** 2, axis=0))
        most = int(np.argmax(each / self.sigma))
        return Sized(concealed, float((each / self.sigma)[most]), float(each[most]), change)


@dataclass(frozen=True, eq=False)
class Sized:
    """What is concealed, and its strength: RMS over the noise, at the joint where that is largest.

    RMS and change, (T, n), are of torque, N m; of a link beside its motor they are of its angle, rad, (T, 1).
    """

    concealed: Concealed
    strength: float
    rms: float
    change: Array


def ordinary(dynamics: Dynamics, rng: np.random.Generator) -> Dynamics:
    """The friction and the rotors of one arm of a make: each a quarter off, as arms of a make differ."""
    rotor, coulomb, viscous = np.exp(rng.normal(0, 0.25, (3, dynamics.n_joints)))
    return replace(
        dynamics, rotor=dynamics.rotor * rotor, coulomb=dynamics.coulomb * coulomb, viscous=dynamics.viscous * viscous
    )


def place(
    arm: VirtualArm, kind: Kind, strength: float, location: str | None, rng: np.random.Generator, plain: Array
) -> Sized:
    """A kind at a place where it can have the strength.

    Args:
        arm: the arm.
        kind: what to conceal.
        strength: RMS torque over noise.
        location: where; None: anywhere.
        rng: of place and numbers.
        plain: (T, n) torques with nothing concealed.

    Returns:
        It, sized.

    Raises:
        ImpossibleEffect: there is no such place.
    """
    places = [location] if location is not None else kind.places(arm.description)
    for _ in range(MOST_TRIES if places else 0):
        where = str(rng.choice(places))
        small = Concealed(kind, where, kind.draw(rng, arm.description)).sized(FIRST)
        sized = _sized(arm, small, strength, plain)
        if sized is not None:
            return sized
    raise ImpossibleEffect(f"{kind.name} at {location or 'any place'} is never {strength:g} times the noise")


def _sized(arm: VirtualArm, concealed: Concealed, strength: float, plain: Array) -> Sized | None:
    """Numbers grown or shrunk until the strength is reached; a power law is followed from step to step."""
    power, before = 1.0, None
    for _ in range(8):
        found = _measure(arm, concealed, plain)
        if found is None or found.strength < TOO_SMALL:
            return None
        if abs(found.strength / strength - 1) < CLOSE:
            return found
        if before is not None and abs(np.log(before[0])) > 1e-3:
            slope = np.log(found.strength / before[1]) / np.log(before[0])
            power = float(np.clip(slope, 0.3, 4.0))
        factor = (strength / found.strength) ** (1 / power)
        before = factor, found.strength
        concealed = concealed.sized(factor)
        if concealed.absurd:
            return None
    return None


def _measure(arm: VirtualArm, concealed: Concealed, plain: Array) -> Sized | None:
    """How large it is with the numbers it has beside torques (T, n) without it; None where no body can be so."""
    may_be = concealed.kind.possible
    if may_be is not None and not may_be(arm, concealed.joint, concealed.numbers):
        return None
    if concealed.kind.lies is not None:
        beside = arm.beside_motors([concealed])[:, [concealed.joint]]
        rms = float(np.std(beside[~arm.session.test]))
        return Sized(concealed, rms / NOISE_RAD, rms, beside)
    try:
        change = arm.torques([concealed]) - plain
    except ValueError:
        return None
    return arm.sized(concealed, change)
