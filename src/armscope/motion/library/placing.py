"""The library placed on an arm: every cause at every joint or link where the table can show it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.library import catalogue
from armscope.motion.library.causes import Cause, PlacedCause, Seen
from armscope.motion.library.clauses import ALL_JOINTS
from armscope.motion.library.laws import Law
from armscope.motion.library.linkage import BETWEEN_LINKS
from armscope.motion.library.linkage_constants import LINKAGE
from armscope.motion.library.masses import place_masses
from armscope.motion.library.powers import with_power
from armscope.motion.library.sides import coulomb_width, sharp_width
from armscope.motion.library.stands import place_stand
from armscope.motion.library.warmth import RUNNING
from armscope.robot.dynamics import MovingArm


def place_causes(seen: Seen) -> list[PlacedCause]:
    """Every cause that the table can show, at every place."""
    moving = [int(j) for j in np.flatnonzero(seen.moving)]
    placed = [cause for joint in moving for cause in _background(seen, joint)]
    placed += [cause for joint in moving for cause in _at_joint(seen, joint)]
    placed += _one_clock(moving)
    inertias = _torque_of_inertias(seen.arm)
    placed += [cause for one, other in itertools.pairwise(moving) for cause in _coupled(seen, one, other, inertias)]
    return [*placed, *place_masses(seen), *place_stand(seen)]


def _background(seen: Seen, j: int) -> Iterator[PlacedCause]:
    """The joint's offset, and what of its friction and rotor robot.yaml states: departures from that are catalogue."""
    torque, unit = seen.torque(j), seen.unit(j)
    units = (torque, torque, f"{torque} s/{unit}", "kg" if seen.arm.sliding[j] else "kg m^2")
    names = ("offset", "coulomb", "viscous", "inertia")
    for number, cause in enumerate(catalogue.BACKGROUND):
        if number == 0 or np.isfinite(seen.arm.stated_background[j, number]):
            yield PlacedCause(
                cause,
                f"joint {j + 1}",
                ("constant", "direction", "speed", "acceleration")[number],
                ((names[number], units[number]),),
                (j,),
                of_background=(j, number),
            )


def _at_joint(seen: Seen, j: int) -> Iterator[PlacedCause]:
    at = _Joint(seen, j)
    if at.both_ways:
        yield from _friction(at)
        yield from _warming(at)
    yield at.cause(catalogue.GAIN, "torque", (("gain", ""),), "torque")
    yield at.cause(catalogue.DELAY, "torque", (("delay", "s"),), "delayed torque", LIBRARY.delay_s)
    if seen.both_sides is None or not seen.both_sides[j]:
        yield _drive(at)  # where the link is recorded, its bodies move as it does
    yield from _outside(at)
    yield from _springs(at)
    yield at.curve(catalogue.CURVE, "time", seen.time, LIBRARY.knots_of_time, variant="time")
    for driver, limits in (("speed", seen.dq[j]), ("load", np.array([-1.0, 1.0]) * seen.load[j])):
        if np.ptp(limits) > (LIBRARY.least_shown * seen.effort[j] if driver == "load" else 0):
            yield at.curve(catalogue.CURVE, driver, limits, LIBRARY.knots_of_others, variant=driver)


def _one_clock(moving: list[int]) -> list[PlacedCause]:
    """One delay of all torques: they are read by another clock than the motion, or through one filter."""
    if len(moving) < LIBRARY.joints_of_a_clock:
        return []
    joints = tuple(moving)
    law = Law("delayed torque", joints, (LIBRARY.delay_s,))
    return [PlacedCause(catalogue.DELAY, ALL_JOINTS, "torque", (("delay", "s"),), joints, law)]


def _sides(seen: Seen) -> Array:
    """(m,) speed within which each joint's friction changes sides."""
    return sharp_width(seen.arm) if seen.width_of_sides is None else seen.width_of_sides


@dataclass(frozen=True, eq=False)
class _Joint:
    """A joint at which causes are placed."""

    seen: Seen
    number: int

    @property
    def unit(self) -> str:
        return self.seen.unit(self.number)

    @property
    def torque(self) -> str:
        return self.seen.torque(self.number)

    @property
    def width(self) -> float:
        """Speed within which friction changes sides."""
        return float(coulomb_width(self.seen.arm)[self.number])

    @property
    def sharp(self) -> float:
        """The least of it, or that within which it does so here."""
        return float(_sides(self.seen)[self.number])

    @property
    def both_ways(self) -> bool:
        """Whether it moves fast enough either way to show friction."""
        slow = LIBRARY.slow * self.width
        return bool(self.seen.dq[self.number, 0] < -slow and self.seen.dq[self.number, 1] > slow)

    def cause(
        self, cause: Cause, driver: str, parameters: tuple[tuple[str, str], ...], *law: Any, **more: Any
    ) -> PlacedCause:
        """A cause here by its law: the law's name, then its numbers."""
        kind, *numbers = law
        columns = Law(kind, (self.number,), tuple(map(float, numbers)))
        return PlacedCause(cause, f"joint {self.number + 1}", driver, parameters, (self.number,), columns, **more)

    def curve(self, cause: Cause, driver: str, limits: Array, knots: int, **more: Any) -> PlacedCause:
        """A free curve between limits."""
        names = tuple((f"knot {k + 1}", self.torque) for k in range(knots))
        return self.cause(cause, driver, names, f"curve over {driver}", *limits, knots, is_curve=True, **more)


def _friction(at: _Joint) -> Iterator[PlacedCause]:
    torque, unit = at.torque, at.unit
    by_side = (("viscous_difference", f"{torque} s/{unit}"),)
    yield at.cause(catalogue.ASYMMETRY, "direction", by_side, "absolute speed")
    fastest, slowest = float(np.abs(at.seen.dq[at.number]).max()), LIBRARY.slow * max(at.width, at.sharp)
    widths = np.geomspace(slowest, max(fastest / 2, 2 * slowest), LIBRARY.stribeck_widths)
    parameters, multiplicity = (("stribeck", torque), ("wider", torque)), len(widths) * len(LIBRARY.falls)
    for v, fall in itertools.product(map(float, widths), LIBRARY.falls):
        form, law = (f"{v:.3g}", (v,)) if fall == LIBRARY.falls[0] else (f"{v:.3g} by {fall:g}", (fall, v))
        more: dict[str, Any] = {"variant": form, "scanned": (("speed", f"{unit}/s", v),)}
        more |= {"expected": (1.0, LIBRARY.between_speeds), "multiplicity": multiplicity}
        yield at.cause(catalogue.STRIBECK, "speed", parameters, "stribeck", at.sharp, *law, **more)
    yield at.cause(catalogue.LOAD_FRICTION, "load", (("per_load", ""),), "load friction", at.sharp)
    yield from _curved(at)


def _curved(at: _Joint) -> Iterator[PlacedCause]:
    """Friction that grows with a power of the speed, and not with the speed itself."""
    dry, viscous = np.isnan(at.seen.arm.stated_background[at.number, 1:3])
    speeds = np.maximum(np.percentile(at.seen.speeds[at.number], LIBRARY.usual_speeds), at.width)
    parameters = (("bent", at.torque), ("viscous", f"{at.torque} s/{at.unit}"))[: 1 + (not viscous)]
    law = ("power of speed", at.sharp, 1.0, viscous, dry, *speeds)
    any_power = at.cause(
        catalogue.VISCOUS_CURVE, "speed", parameters, *law, multiplicity=len(LIBRARY.powers), variant="power"
    )
    yield from (with_power(any_power, power, at.seen.arm.sliding[at.number]) for power in LIBRARY.powers)


def _warming(at: _Joint) -> Iterator[PlacedCause]:
    """Friction that changes with the temperature, or while the arm runs where nobody recorded how warm it was.

    Not within one run: what its first part tells of time, its last part is the farther from the longer it goes on.
    """
    seen = at.seen
    stated = np.isfinite(seen.arm.stated_background[at.number, 1:3])
    limits = None if seen.temperature is None else seen.temperature[at.number]
    if limits is not None and np.ptp(limits) > LIBRARY.least_warming_k:
        middle, driver, per, laws = float(np.mean(limits)), "temperature", ("kelvin", "K"), ("warm speed", "warm side")
    elif len(seen.runs) > 1 and seen.running_min > LIBRARY.least_running_min:
        middle, driver, per, laws = seen.running_min / 2, "running time", ("minute", "min"), RUNNING
    else:
        return
    speed = f"{at.torque} s/{at.unit}"
    viscous = ((f"per_{per[0]}", f"{at.torque} s/({at.unit} {per[1]})"), ("viscous", speed))
    dry = ((f"dry_per_{per[0]}", f"{at.torque}/{per[1]}"), ("dry", at.torque))
    for variant, names, off, law in (
        ("viscous", viscous, stated[1], (laws[0],)),
        ("dry", dry, stated[0], (laws[1], at.sharp)),
    ):
        cause = catalogue.TEMPERATURE_FRICTION
        yield at.cause(cause, driver, names[: 1 + off], *law, middle, off, variant=variant)
    if driver == "temperature" and limits is not None:
        yield at.curve(catalogue.CURVE, driver, limits, LIBRARY.knots_of_others, variant=driver)


def _drive(at: _Joint) -> PlacedCause:
    """A drive that gives way: the torque of every joint changes with where the link is."""
    j, seen = at.number, at.seen
    every = (j, *(k for k in range(seen.arm.n_motors) if k != j))
    law = Law("behind a drive", every, (seen.motion_hz, 0.0))
    names = (("compliance", f"{at.unit}/({at.torque})"),)
    return PlacedCause(catalogue.COMPLIANCE, f"joint {j + 1}", "load", names, every, law)


def _springs(at: _Joint) -> Iterator[PlacedCause]:
    driver, q, held = "joint angle", at.seen.q[at.number], LINKAGE.built_in * float(at.seen.effort[at.number])
    stiffness, usual = (("stiffness", f"{at.torque}/{at.unit}"), ("torque", at.torque)), (2 * held / np.ptp(q), held)
    yield at.cause(catalogue.BALANCER, driver, stiffness, "spring", float(np.mean(q)), usual=usual)
    if not at.seen.arm.sliding[at.number]:
        waves = (("sine", at.torque), ("cosine", at.torque))
        yield at.cause(catalogue.BALANCER, driver, waves, "wave", 1, variant="counterweight", usual=(held, held))
        yield _between_links(at, held)
        found, tried = at.seen.waves.get(at.number, ((), 1))
        for n in found:
            more: dict[str, Any] = {"variant": str(n), "scanned": (("per_turn", "", float(n)),)}
            yield at.cause(catalogue.RIPPLE, driver, waves, "wave", n, multiplicity=tried, **more)
    for knots in (LIBRARY.knots_of_position, LIBRARY.knots_of_bend):
        yield at.curve(catalogue.CABLE, driver, q, knots, variant=str(knots), multiplicity=2)


def _between_links(at: _Joint, held: float) -> PlacedCause:
    """A gas spring, or another between two links; how it is mounted is scanned once something follows the angle."""
    middle = float(np.mean(at.seen.q[at.number]))
    phase, ratio = np.pi / 2 - middle, LINKAGE.ratios[len(LINKAGE.ratios) // 2]
    names = (("force_lever", at.torque), ("growth", at.torque))
    scanned = (("phase", "rad", phase), ("ratio", "", ratio))
    how: dict[str, Any] = {"variant": BETWEEN_LINKS, "scanned": scanned, "multiplicity": LINKAGE.tried}
    how["expected"], how["usual"] = (1.0, LINKAGE.growth), (held, held * LINKAGE.growth)
    return at.cause(catalogue.BALANCER, "joint angle", names, "spring between links", phase, ratio, middle, **how)


def _outside(at: _Joint) -> Iterator[PlacedCause]:
    """Laws that no cause has, so that what follows them is located and not called something else."""
    ways = np.array(LIBRARY.ways) * float(np.ptp(at.seen.q[at.number]))
    names = tuple((f"over way {k + 1}", at.torque) for k in range(len(ways)))
    yield at.cause(catalogue.CURVE, catalogue.WAY, names, "clinging over ways", *ways, variant="way")
    if at.both_ways and not at.seen.arm.sliding[at.number]:
        names = (("sine", at.torque), ("cosine", at.torque))
        yield at.cause(catalogue.CURVE, catalogue.UNEVEN, names, "uneven friction", at.sharp, variant="uneven")
    usual = float(at.seen.effort[at.number])
    widths = np.array(LIBRARY.plays) * usual
    names = tuple((f"over torque {k + 1}", at.torque) for k in range(len(widths)))
    law = ("clinging over smooth torques", at.seen.motion_hz, *widths)
    yield at.cause(catalogue.CURVE, catalogue.PLAY, names, *law, variant="play")
    names = (("linear", ""), ("square", ""), ("cube", ""))
    yield at.cause(catalogue.CURVE, catalogue.SCALE, names, "powers of torque", usual, variant="scale")


Columns = tuple[Array, Array]
"""Accelerations (N, m), and the torques (N m, 6 n) that each number of the links' inertias asks for."""


def _torque_of_inertias(arm: MovingArm) -> Columns:
    """At some motion: any that is not special will do."""
    rng, size = np.random.default_rng(0), (LIBRARY.any_motion, arm.n_motors)
    q, dq, ddq = (rng.uniform(-1, 1, size) for _ in range(3))
    columns = arm.regressor(q, dq, ddq).reshape(size[0] * size[1], -1)
    return ddq, columns[:, np.arange(columns.shape[1]) % 10 >= 4]


def _is_a_link(inertias: Columns, j: int, k: int, sign: float) -> bool:
    """Whether what turns with the sum or the difference of two joints is a link: between parallel axes the next one."""
    acceleration, of_links = inertias
    turning = np.zeros_like(acceleration)
    turning[:, j] = acceleration[:, j] + sign * acceleration[:, k]
    turning[:, k] = sign * turning[:, j]
    target = turning.reshape(-1)
    left = target - of_links @ np.linalg.lstsq(of_links, target, rcond=None)[0]
    return bool(np.linalg.norm(left) < LIBRARY.redundant * np.linalg.norm(target))


def _coupled(seen: Seen, j: int, k: int, inertias: Columns) -> Iterator[PlacedCause]:
    """What turns with the sum or the difference of two neighbours' motions, and acts on both of them."""
    width, place = _sides(seen), f"joint {k + 1} from joint {j + 1}"
    if seen.arm.sliding[j] != seen.arm.sliding[k]:
        return
    torque, unit = seen.torque(k), seen.unit(k)
    rubbing = (("coulomb", torque), ("viscous", f"{torque} s/{unit}"))
    for sign, variant in ((1.0, ""), (-1.0, "difference")):
        yield PlacedCause(
            catalogue.COUPLED_FRICTION,
            place,
            "the neighbour's speed",
            rubbing,
            (j, k),
            Law("rubbing of two", (j, k), (sign, float(min(width[j], width[k])))),
            variant=variant,
        )
        if _is_a_link(inertias, j, k, sign):
            continue
        yield PlacedCause(
            catalogue.COUPLED_INERTIA,
            place,
            "the neighbour's acceleration",
            (("inertia", "kg" if seen.arm.sliding[j] else "kg m^2"),),
            (j, k),
            Law("inertia of two", (j, k), (sign,)),
            variant=variant,
        )
