"""A wave per turn that works against a joint's load: a balancing spring that nobody stated does the same.

Most large arms have a spring or a gas cylinder beside joint 2 that takes a part of gravity's load, as a wave per turn.
Where robot.yaml does not say so, the drive gives way to less than is computed, by the compliance times that wave: the
same motion as that of a gear or an encoder's disc off its centre. Only its side tells: a spring relieves the drive.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.summary.constants import TELLING
from armscope.physics.effect import Part, Term
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.model import FittedModel
from armscope.physics.scene import Scene
from armscope.physics.transmission import GEAR_ECCENTRICITY
from armscope.verdict.effects import Alternative

LOOK_FOR_A_SPRING = (
    "See first whether a spring or a gas cylinder balances this joint: then the gear may be sound, and the wave is "
    "the part of the load that it takes."
)


def balancing_spring(model: FittedModel, wave: Part, scene: Scene) -> Alternative | None:
    """What stands beside a wave of a joint as its alternative, where the wave relieves the joint's drive.

    Args:
        model: the fitted model, of which the drive's give is a part, named or not.
        wave: another part of it.
        scene: recorded rows.

    Returns:
        The alternative; None where the part is no wave per turn, its drive does not give way, or the wave adds to what
        the drive gives, lies across it, or is the larger one: no spring lifts the arm.
    """
    placed = wave.placed
    if placed.effect.name != GEAR_ECCENTRICITY.name or placed.variant != "1":
        return None
    drives = [
        part
        for part in (*model.background, *model.parts)
        if part.placed.effect.name == JOINT_COMPLIANCE.name and part.placed.location == placed.location
    ]
    cosine, sine = (_turn(placed.terms[n : n + 1], np.ones(1), scene) for n in range(2))
    gives = sum((_turn(drive.placed.terms, drive.values, scene) for drive in drives), np.zeros(len(cosine)))
    of_load = np.linalg.lstsq(np.column_stack([cosine, sine, np.ones_like(sine)]), gives)[0][:2]
    size, largest = np.linalg.norm(wave.values), np.linalg.norm(of_load)
    if not 0.0 < size < largest or wave.values @ of_load > -TELLING.relieves * size * largest:
        return None
    return Alternative("balancing_spring", placed.location, "elastic", 0.0, placed.driver, 0.0)


def _turn(terms: Sequence[Term], values: Array, scene: Scene) -> Array:
    """(N,) rad by which terms turn their motor."""
    products = [(value * p.factor, p.driver) for each, value in zip(terms, values, strict=True) for p in each.products]
    return np.asarray(np.sum([factor * scene.driver(driver) for factor, driver in products], axis=0))
