"""What relieves a joint's drive of a part of its load: a balancing spring that nobody stated does the same.

Most large arms have a spring or a gas cylinder beside joint 2 that takes a part of gravity's load, as a wave per turn.
Where robot.yaml does not say so, the drive gives way to less than is computed, by the compliance times that wave: the
same motion as that of a gear or an encoder's disc off its centre. Only its side tells: a spring relieves the drive.
A drive that gives way to other masses than the stated ones may be one as well, where what it does less is such a wave.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.summary.constants import TELLING
from armscope.physics.effect import Driver, Part, Term
from armscope.physics.elastic import JOINT_COMPLIANCE, UNKNOWN_MASSES
from armscope.physics.model import FittedModel
from armscope.physics.scene import Scene
from armscope.physics.transmission import GEAR_ECCENTRICITY
from armscope.verdict.effects import Alternative

LOOK_FOR_A_SPRING = (
    "See first whether a spring or a gas cylinder balances this joint: then the gear may be sound, and the wave is "
    "the part of the load that it takes."
)
LOOK_BESIDE_THE_MASSES = (
    "See first whether a spring or a gas cylinder balances this joint: then the masses may be as stated, and it takes "
    "the part of their load that is missing."
)


def balancing_spring(model: FittedModel, part: Part, scene: Scene) -> tuple[Alternative, str] | None:
    """What stands beside a part of the model as its alternative, where it relieves the joint's drive, and what to see.

    Args:
        model: the fitted model, of which the drive's give is a part, named or not.
        part: another part of it, or the drive's give under masses of its own.
        scene: recorded rows.

    Returns:
        The alternative and how to confirm it; None where the part is no wave per turn and no drive under other masses,
        its drive does not give way, or the wave adds to what the drive gives, lies across it, or is the larger one: no
        spring lifts the arm.
    """
    placed = part.placed
    drives = [
        each
        for each in (*model.background, *model.parts)
        if each.placed.effect.name == JOINT_COMPLIANCE.name and each.placed.location == placed.location
    ]
    gives = sum((_turn(drive.placed.terms, drive.values, scene) for drive in drives), np.zeros(len(scene)))
    if placed.effect.name == GEAR_ECCENTRICITY.name and placed.variant == "1":
        waves, confirm = (_turn(placed.terms[n : n + 1], np.ones(1), scene) for n in range(2)), LOOK_FOR_A_SPRING
        relieved = _relieves(part.values, _least_squares(gives, *waves)[:2])
    elif placed.variant == UNKNOWN_MASSES and scene.arm.has_masses:
        confirm = LOOK_BESIDE_THE_MASSES
        relieved = _masses_relieve(int(placed.location.removeprefix("joint ")), gives, scene)
    else:
        return None
    if not relieved:
        return None
    return Alternative("balancing_spring", placed.location, "elastic", 0.0, placed.driver, 0.0), confirm


def _masses_relieve(joint: int, gives: Array, scene: Scene) -> bool:
    """Whether a drive gives (N,) rad less than stated masses have it by a wave, and by more than they are off."""
    load = scene.driver(Driver("torque", (joint,)))
    waves = [scene.driver(Driver(wave, (joint, 1.0))) for wave in ("cosine", "sine")]
    compliance, *wave = _least_squares(gives, load, *waves)[:3]
    relief, whole = np.array(wave), compliance * _least_squares(load, *waves)[:2]
    return _relieves(relief, whole) and bool(np.linalg.norm(relief) >= TELLING.masses_off * np.linalg.norm(whole))


def _relieves(wave: Array, whole: Array) -> bool:
    """Whether a wave (cosine, sine) works against a larger one."""
    size, largest = np.linalg.norm(wave), np.linalg.norm(whole)
    return bool(0.0 < size < largest and wave @ whole <= -TELLING.relieves * size * largest)


def _least_squares(values: Array, *columns: Array) -> Array:
    """What each column accounts for of the values (N,), and last a constant."""
    return np.asarray(np.linalg.lstsq(np.column_stack([*columns, np.ones_like(values)]), values)[0])


def _turn(terms: Sequence[Term], values: Array, scene: Scene) -> Array:
    """(N,) rad by which terms turn their motor."""
    products = [(value * p.factor, p.driver) for each, value in zip(terms, values, strict=True) for p in each.products]
    return np.asarray(np.sum([factor * scene.driver(driver) for factor, driver in products], axis=0))
