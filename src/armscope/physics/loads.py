"""Loads are known, but not exactly: every stated mass may be off by some share, for all that gives way at once.

A load times a compliance is bilinear; around the stated masses and a model's present compliances it is a column per
link, and one for the payload: the change of all loads per share of its mass times what gives way under them. One more
is of all links alike: what a drawing leaves out of one (covers, cables, grease) it leaves out of the others. Were they
off independently, six links 15 % heavier would be less likely than a payload heavier and links lighter by 8 % both, and
all that gives way 8 % stiffer than it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from armscope.core.types import Array
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.drivers import follows
from armscope.physics.effect import Cure, Driver, Effect, Part, Placed, Product, Term
from armscope.physics.loaded_arm import LoadedArm
from armscope.physics.placing import nowhere
from armscope.recordings import Recordings
from armscope.robot import Arm

STATED_MASSES = Effect(
    "stated_masses",
    "elastic",
    nowhere,  # it needs a model that gives way
    "The mass is other than stated, so everything that gives way under it is loaded differently.",
    "Weigh it, or record the motors' torques at rest and compare them with gravity by the stated masses.",
    Cure("Correct the link's mass in robot.yaml: mass = stated mass x (1 + share)."),
    atlas="gravity load",
)


def givings(parts: Sequence[Part], torques_recorded: bool) -> Iterator[Product]:
    """What gives way in a model's parts, and how much; recorded torques hold the true load already.

    Args:
        parts: of the model.
        torques_recorded: whether motors' loads were recorded.

    Yields:
        Directions with the load that they follow and the motion per unit of it, SI.
    """
    for part in parts:
        for value, term in zip(part.values, part.placed.terms, strict=True):
            for product in term.products if value else ():
                measured = torques_recorded and follows("torque", product.driver)
                if follows("weight", product.driver) and not measured:
                    yield Product(product.direction, product.driver, product.factor * float(value))


def mass_errors(arm: Arm, recordings: Recordings, parts: Sequence[Part]) -> list[Placed]:
    """The relative error of each link's and of the payload's stated mass, first-order in the model's present values.

    Args:
        arm: whose masses are stated, or not.
        recordings: the rows.
        parts: of the model.

    Returns:
        One per link that weighs something, one of all of them, and one of a payload that does; none where nothing
        gives way.
    """
    known = list(givings(parts, recordings.torque is not None))
    if not known:
        return []
    links = [link for link in range(1, arm.n_joints + 1) if arm.masses[link - 1] > 0]
    errors = [_mass_error(f"link {link}", known, PLAUSIBLE.mass_share, "heavier link", link) for link in links]
    if len(links) > 1:
        errors.append(_mass_error("all links", known, PLAUSIBLE.common_mass_share, "heavier link", *links))
    if recordings.payload is not None and np.any(np.nan_to_num(recordings.payload) > 0):
        errors.append(_mass_error("payload", known, PLAUSIBLE.weighed_share, "heavier by share"))
    return errors


def _mass_error(location: str, known: Sequence[Product], usual: float, heavier: str, *which: int) -> Placed:
    products = (Product(g.direction, Driver(heavier, (g.driver, *which)), g.factor) for g in known)
    share = Term("share", "of its mass", 1.0, tuple(products), usual)
    return Placed(STATED_MASSES, location, (share,), (usual,), "loads")


def torque_stderr(scene: LoadedArm, joint: int) -> Array:
    """(N,) standard error of a motor's load (from 1) by stated masses, N m; none of a recorded load.

    Each mass is off by itself: all links heavier alike make the load larger, which turns no side.
    """
    if scene.recordings.torque is not None:
        return np.zeros(len(scene))
    load = Driver("gravity torque", (joint,))
    links = [link for link in range(1, scene.arm.n_joints + 1) if scene.arm.masses[link - 1] > 0]
    by_share = [PLAUSIBLE.mass_share * scene.driver(Driver("heavier link", (load, link))) for link in links]
    if scene.recordings.payload is not None:
        by_share.append(PLAUSIBLE.weighed_share * scene.driver(Driver("heavier by share", (load,))))
    return np.asarray(np.sqrt(np.sum(np.square(by_share), axis=0)))


def gravity_that_leans(known: Sequence[Product]) -> tuple[Term, Term]:
    """Gravity that leans, about two axes across its stated direction: what gives way then gives way beside its load.

    Args:
        known: what gives way, and how much (`givings`).

    Returns:
        Terms, rad.
    """

    def about(axis: int) -> tuple[Product, ...]:
        return tuple(Product(g.direction, Driver("leaning", (g.driver, axis)), g.factor) for g in known)

    return Term("about_x", "rad", 1.0, about(0)), Term("about_y", "rad", 1.0, about(1))
