"""Cures that add a law to the model, executed as printed: the torque that was missing is gone on another path."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.library import remedies_of_laws
from armscope.motion.library.catalogue import cause_named
from armscope.motion.library.remedies import Fitted
from armscope.verdict.effects import Parameter
from tests.motion.cured import (
    JOINT,
    STATED,
    Motion,
    Torque,
    as_it_is,
    at_joint,
    diagnosed,
    left,
    moved,
    simulated,
    told,
)
from tests.motion.moving import robot
from tests.seeds import seeds


@dataclass(frozen=True)
class Case:
    """What is planted, under which name at which place, and what a reader adds who has read the cure."""

    name: str
    place: str
    planted: Torque
    read: Callable[[str], Torque]
    warm: bool = False


def near_rest(cure: str) -> Torque:
    if "× 2 x" in cure:
        height, wider, speed = [*told(cure.replace("2 x", ""), "model: ")[:2], *told(cure, "x is (speed / (")[:1]]
    else:
        (height, speed, *_), wider = told(cure, "model: "), 0.0
        assert "× exp(-(speed / (" in cure
        assert cure.endswith("× sign of the speed.")
    x = lambda v: (v / speed) ** 2
    return at_joint(lambda q, v, a, T: (height + wider * 2 * x(v)) * np.exp(-x(v)) * np.sign(v))


def curve(cure: str) -> Torque:
    written = re.search(r" × \|speed\|\^([\d.]+) × sign of the speed", cure)
    assert written
    power = float(written[1])
    bent, viscous, dry = [*told(cure, "friction "), 0.0, 0.0][:3]
    return at_joint(lambda q, v, a, T: np.sign(v) * bent * np.abs(v) ** power + viscous * v + dry * np.sign(v))


def with_warmth(cure: str) -> Torque:
    per_kelvin, beside, more = told(cure, "stated and ")[:3]
    assert "× (temperature −" in cure
    if "times the sign of the speed" in cure:
        return at_joint(lambda q, v, a, T: (per_kelvin * (T + beside) + more) * np.sign(v))
    return at_joint(lambda q, v, a, T: (per_kelvin * (T + beside) + more) * v)


def between(of: str, law: Callable[[list[float], Array], Array], last: int = 3) -> Callable[[str], Torque]:
    """Torque on two neighbours, joints 2 and 3, by the sum or the difference of what they do, as the sentence says."""
    j, k = last - 2, last - 1

    def read(cure: str) -> Torque:
        alike = f"plus that of joint {last}" in cure
        assert alike or f"less that of joint {last}" in cure
        other = 1 if alike else -1
        assert (f"as much the other way at joint {last}" in cure) is not alike
        numbers = told(cure, f"at joint {last}, by ")

        def more(motion: Motion, torque: Array) -> Array:
            found, values = torque.copy(), motion.dq if of == "speed" else motion.ddq
            added = law(numbers, values[:, j] + other * values[:, k])
            found[:, j] += added
            found[:, k] += other * added
            return found

        return more

    return read


def rubbing(sign: int) -> Torque:
    def more(motion: Motion, torque: Array) -> Array:
        found, speed = torque.copy(), motion.dq[:, 1] + sign * motion.dq[:, 2]
        found[:, [1, 2]] += ((1.5 * np.sign(speed) + speed)[:, None]) * [1, sign]
        return found

    return more


def turning(sign: int, j: int) -> Torque:
    def more(motion: Motion, torque: Array) -> Array:
        found, faster = torque.copy(), motion.ddq[:, j] + sign * motion.ddq[:, j + 1]
        found[:, [j, j + 1]] += 0.15 * faster[:, None] * [1, sign]
        return found

    return more


def spring(cure: str) -> Torque:
    stiffness, beside, torque = told(cure, "model: ")
    assert "× (position" in cure
    return at_joint(lambda q, v, a, T: stiffness * (q + beside) + torque)


def mounted(q: Array) -> Array:
    """A gas spring of 800 N between points 0.2 and 0.12 m from the axis: force times the slope of its length, N m."""
    near, far, x, step = 0.12, 0.2, q + 1.9, 1e-6
    long = lambda at: np.sqrt(near**2 + far**2 - 2 * near * far * np.cos(at))
    return 800 * (long(x + step) - long(x - step)) / (2 * step)


def coiled(q: Array) -> Array:
    """A coil spring, 3 N/mm, between points 0.4 and 0.05 m from the axis, hardly pre-tensioned where it is shortest."""
    near, far, x = 0.05, 0.4, q + 1.2
    long = np.sqrt(near**2 + far**2 - 2 * near * far * np.cos(x))
    return -3000 * (long - (far - near) + 0.02) * near * far * np.sin(x) / long


def between_links(cure: str) -> Torque:
    force, growth, less, phase, squares, twice = told(cure.replace("√(", "√ "), "model: ")
    for words in (") × sin(x) / l, where x is position", "× (l −", "and l = √(", "cos x)."):
        assert words in cure

    def pull(q: Array) -> Array:
        x = q + phase
        long = np.sqrt(squares + twice * np.cos(x))
        return (force + growth * (long + less)) * np.sin(x) / long

    return at_joint(lambda q, v, a, T: pull(q))


def waves(cure: str) -> Torque:
    numbers = told(cure, "model: ")
    if "sin(angle)" in cure:
        (sine, cosine), count = numbers, 1.0
    else:
        sine, count, cosine, _ = numbers
    return at_joint(lambda q, v, a, T: sine * np.sin(count * q) + cosine * np.cos(count * q))


STATED_AT_C = 25.0
"""At which the friction of these arms is as stated."""
RUBS = between("speed", lambda n, s: n[0] * np.sign(s) + n[1] * s)
TURNS, TURNS_BEFORE = (between("acceleration", lambda n, a: n[0] * a, last) for last in (3, 2))
AT, FROM = f"joint {JOINT + 1}", "joint 3 from joint 2"
CASES = {
    "near rest": Case(
        "stribeck_friction", AT, at_joint(lambda q, v, a, T: 3 * np.exp(-((v / 0.15) ** 2)) * np.sign(v)), near_rest
    ),
    "curve of speed": Case("viscous_curve", AT, at_joint(lambda q, v, a, T: 2.0 * v * np.abs(v)), curve),
    "grease that thins": Case(
        "viscous_curve", AT, at_joint(lambda q, v, a, T: 4.0 * np.abs(v) ** 0.6 * np.sign(v)), curve
    ),
    "warm": Case("thermal_friction", AT, at_joint(lambda q, v, a, T: -0.12 * (T - 25) * v), with_warmth, True),
    "warm and dry": Case(
        "thermal_friction", AT, at_joint(lambda q, v, a, T: -0.12 * (T - 25) * np.sign(v)), with_warmth, True
    ),
    "rubs with the sum": Case("coupled_friction", FROM, rubbing(1), RUBS),
    "rubs with the difference": Case("coupled_friction", FROM, rubbing(-1), RUBS),
    "turns with the sum": Case("coupled_inertia", "joint 2 from joint 1", turning(1, 0), TURNS_BEFORE),
    "turns with the difference": Case("coupled_inertia", FROM, turning(-1, 1), TURNS),
    "spring": Case("gravity_balance", AT, at_joint(lambda q, v, a, T: 5 * (q - 0.4)), spring),
    "counterweight": Case("gravity_balance", AT, at_joint(lambda q, v, a, T: 6 * np.sin(q + 0.5)), waves),
    "gas spring": Case("gravity_balance", AT, at_joint(lambda q, v, a, T: mounted(q)), between_links),
    "coil spring": Case("gravity_balance", AT, at_joint(lambda q, v, a, T: coiled(q)), between_links),
    "ripple": Case("torque_ripple", AT, at_joint(lambda q, v, a, T: 2 * np.sin(9 * q + 0.5)), waves),
}


AGAIN = (
    "gas spring",
    "counterweight",
    "grease that thins",
    "warm",
    "rubs with the sum",
    "turns with the sum",
    "coil spring",
    "turns with the difference",
    "curve of speed",
    "ripple",
    "warm and dry",
)
"""Like another's card: with the difference, a sign has to be read as well; "spring" is a mount, too."""


@pytest.mark.parametrize("seed", seeds(11, 14))
@pytest.mark.parametrize("kind", [pytest.param(kind, marks=[pytest.mark.long] * (kind in AGAIN)) for kind in CASES])
def test_who_adds_what_the_card_says_has_the_torque(kind: str, seed: int) -> None:
    case = CASES[kind]
    (cause,) = diagnosed(STATED, case.planted, seed, case.warm)
    assert (cause.effect, cause.location) == (case.name, case.place)
    known = cause_named(cause.effect)
    assert known is not None
    assert getattr(known.remedy, "__module__", "") == remedies_of_laws.__name__
    assert left((STATED, case.planted), (STATED, case.read(cause.cure), as_it_is), seed) < 0.03


@pytest.mark.parametrize("seed", seeds(11, 14))
def test_dry_and_viscous_friction_that_both_fall_with_warmth_are_two_causes(seed: int) -> None:
    """Grease thins, and a seal lets go: told as one of them, that one had the other's size."""
    planted = at_joint(lambda q, v, a, T: -0.12 * (T - 25) * v - 0.1 * (T - 25) * np.sign(v))
    found = {cause.title: cause for cause in diagnosed(STATED, planted, seed, True)}
    assert set(found) == {f"viscous thermal friction at {AT}", f"dry thermal friction at {AT}"}
    for title, true in ((f"viscous thermal friction at {AT}", -0.12), (f"dry thermal friction at {AT}", -0.1)):
        low, high = found[title].parameters[0].interval
        assert low < true < high
        assert high < 0.9 * true
    both = [with_warmth(cause.cure) for cause in found.values()]
    cured = lambda motion, torque: both[1](motion, both[0](motion, torque))
    assert left((STATED, planted), (STATED, cured, as_it_is), seed) < 0.03


@pytest.mark.parametrize("seed", seeds(11, 14))
def test_an_arm_that_is_only_warmed_up_is_farther_from_what_is_stated_and_the_card_says_so(seed: int) -> None:
    case = CASES["warm"]
    (cause,) = diagnosed(STATED, case.planted, seed, True)
    assert "To warm the arm up first helps only with friction that was fitted as warm." in cause.cure

    motion = moved(seed, 7)
    warm = replace(motion, warmth=np.full_like(motion.warmth, motion.warmth.max()))
    cold = replace(motion, warmth=np.full_like(motion.warmth, STATED_AT_C))

    def missed(at: Motion, law: Torque) -> float:
        stated = simulated(STATED, at)
        return float(np.linalg.norm(case.planted(at, stated) - law(at, stated)))

    assert missed(cold, as_it_is) < missed(motion, as_it_is) < missed(warm, as_it_is)
    assert missed(warm, with_warmth(cause.cure)) < 0.05 * missed(warm, as_it_is)


def test_friction_near_rest_that_is_no_bell_is_written_out_with_both_its_terms() -> None:
    """A bell, and how it changes as it becomes wider."""
    height, wider, speed = Parameter("stribeck", "N m", 0.8, 0.1), Parameter("wider", "N m", -0.5, 0.1), 0.3
    numbers = (height, wider, Parameter("speed", "rad/s", speed, float("nan")))
    cure = remedies_of_laws.near_rest(Fitted("", numbers, robot()))
    first, second = told(cure.replace("2 x", ""), "model: ")[:2]
    assert cure.endswith("× sign of the speed, where x is (speed / (0.3 rad/s))².")
    v = np.linspace(0, 1, 50)
    bell = lambda at: np.exp(-((v / at) ** 2))
    x = (v / speed) ** 2
    by_wider = (bell(speed * 1.0001) - bell(speed / 1.0001)) / (2 * np.log(1.0001))
    assert np.allclose((first + second * 2 * x) * np.exp(-x), 0.8 * bell(speed) - 0.5 * by_wider, atol=1e-6)
    plain = remedies_of_laws.near_rest(Fitted("", (height, Parameter("wider", "N m", 0.1, 0.1), numbers[2]), robot()))
    assert near_rest(plain) is not None


def test_friction_near_rest_that_falls_exponentially_is_written_out_as_that() -> None:
    numbers = (
        Parameter("stribeck", "N m", 0.8, 0.1),
        Parameter("wider", "N m", 0.1, 0.1),
        Parameter("speed", "rad/s", 0.3, float("nan")),
    )
    cure = remedies_of_laws.near_rest(Fitted("", numbers, robot(), (0.01, 1.0, 0.3)))
    assert "exp(-|speed| / (0.3 rad/s)) × sign of the speed" in cure
    assert "exp(-(speed / (0.3 rad/s))²)" in remedies_of_laws.near_rest(Fitted("", numbers, robot(), (0.01, 0.3)))
