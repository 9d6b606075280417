"""What tilts under the moment of all that it carries: the joints' bearings and the base."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations_with_replacement

import numpy as np

from armscope.core.types import Array
from armscope.core.words import rounded
from armscope.physics.clause import CLEAR, Told, clear_ones
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Cure, Direction, Driver, Effect, Placed, Product, Term, term
from armscope.physics.elastic import plausible_give
from armscope.physics.form_constants import FORM
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

TWO_AXES = "two axes"
"""The variant of a compliance that is not the same about x and y: pedestals, beds and housings are not round."""
THREE_AXES = "three axes"
"""The variant of a base that has a moment about its own axis, too: an arm on a wall or a slope."""
ABOUT_ITS_FOOT = "about its foot"
"""Variants of a base that stands on a pedestal: its origin moves across as it tilts."""


def _place_bearings(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if not arm.has_masses:
        return
    scene = Scene(arm, recordings)
    for place in tilting_joints(scene):
        driver = f"moment across {place}"
        yield Placed(BEARING_COMPLIANCE, place, (_tilt(scene, place),), (1.0,), driver)
        if len(terms := _by_axes(scene, place)) > 1:
            yield Placed(BEARING_COMPLIANCE, place, terms, (1.0,) * len(terms), driver, variant=TWO_AXES)


def tilting_joints(scene: Scene) -> Iterator[str]:
    """Joints whose moment across varies: a tilt that is the same in all rows is an error of the links beside it."""
    for place in (f"joint {j}" for j in range(1, scene.arm.n_joints + 1)):
        across = scene.moment(place)[:, :2]
        if np.linalg.norm(np.std(across, axis=0)) > FORM.varying_load * np.sqrt(np.mean(np.sum(across**2, axis=1))):
            yield place


def _tilt(scene: Scene, location: str) -> Term:
    return term(
        "compliance",
        "rad/(N m)",
        *(Product(Direction(location, axis), Driver("moment", (location, n))) for n, axis in enumerate(("rx", "ry"))),
        plausible=tilt_per_moment(scene, location),
    )


def tilt_per_moment(scene: Scene, location: str, axes: int = 2) -> float:
    """How far a bearing or the base plausibly tilts under a moment.

    Args:
        scene: the rows.
        location: the joint, or "base".
        axes: of its frame, x first, about which a moment tilts it.

    Returns:
        rad/(N m); infinite where none is.
    """
    return plausible_give(PLAUSIBLE.bearing_rad, np.linalg.norm(scene.moment(location)[:, :axes], axis=1))


BY_AXES = {
    "compliance_x": "about x", "compliance_y": "about y", "compliance_z": "about z",
    "compliance_xy": "about x under a moment about y", "compliance_xz": "about x under a moment about z",
    "compliance_yz": "about y under a moment about z",
    "shift": "its origin moves across by", "shift_x": "its origin moves along y by",
    "shift_y": "its origin moves along x by", "shift_xy": "its origin moves crosswise by",
}  # fmt: skip
"""What the numbers of a symmetric compliance are called; each also says what is about the other axis."""

BEARING_COMPLIANCE = Effect(
    "bearing_compliance",
    "elastic",
    _place_bearings,
    "The joint's bearing tilts across its axis under the moment that everything beyond puts on it.",
    "Hang a known weight on the outstretched arm and measure the tilt on both sides of the bearing.",
    Cure(
        "Preload or replace the bearing.",
        otherwise="No motor turns across its axis: otherwise let the corrected model's inverse kinematics compute the "
        "commands (axis tilted by + compliance x moment; `armscope compensate`).",
        change="bearing",
        instruction="Preload or replace the bearing of {location}.",
    ),
    clauses=(
        "the bearing of {location} tilts by {compliance} under gravity",
        clear_ones(
            "the bearing of {location} tilts {} under gravity", compliance_x="about its x", compliance_y="about its y"
        ),
        "the bearing of {location} tilts under gravity",
    ),
    labels=BY_AXES,
    atlas="gravity load",
    nonnegative=True,
)


def _place_base(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if arm.has_masses:
        scene = Scene(arm, recordings)
        yield Placed(BASE_COMPLIANCE, "base", (_tilt(scene, "base"),), (1.0,), "moment on the base")
        terms = _by_axes(scene, "base", "xyz" if leans(scene) else "xy")
        variant = THREE_AXES if leans(scene) else TWO_AXES
        yield Placed(BASE_COMPLIANCE, "base", terms, (1.0,) * len(terms), "moment on the base", variant=variant)
        if variant == TWO_AXES:
            even = (_tilt(scene, "base"), _foot_shift(scene, "shift", "xx", "yy"))
            yield Placed(BASE_COMPLIANCE, "base", even, (1.0,) * 2, "moment on the base", variant=ABOUT_ITS_FOOT)
            shifts = {"compliance_x": ("xx",), "compliance_y": ("yy",), "compliance_xy": ("xy", "yx")}
            own = (*terms, *(_foot_shift(scene, t.name.replace("compliance", "shift"), *shifts[t.name]) for t in terms))
            about = f"{TWO_AXES}, {ABOUT_ITS_FOOT}"
            yield Placed(BASE_COMPLIANCE, "base", own, (1.0,) * len(own), "moment on the base", variant=about)


def _foot_shift(scene: Scene, name: str, *turns: str) -> Term:
    """How far the base's origin moves across, as it tilts about a foot below it: height x tilt, m/(N m).

    A turn "xy" is one about x under a moment about y. About x, what stands above the foot moves against y.
    """
    across = {"x": ("ty", -1.0), "y": ("tx", 1.0)}
    moved = []
    for about, under in map(tuple, turns):
        axis, sign = across[about]
        moved.append(Product(Direction("base", axis), Driver("moment", ("base", "xy".index(under))), sign))
    return term(name, "m/(N m)", *moved, plausible=PLAUSIBLE.foot_m * tilt_per_moment(scene, "base"))


def leans(scene: Scene) -> bool:
    """Whether gravity puts a moment on the base about its own axis, as on a wall."""
    moment = np.abs(scene.moment("base")[:, :3]).max(axis=0, initial=0.0)
    return bool(moment[2] > FORM.trace_of_load * moment.max())


def _by_axes(scene: Scene, location: str, axes: str = "xy") -> tuple[Term, ...]:
    """A symmetric compliance about some axes: soft ones that lie anyhow; what no row loads is left out."""
    moment = np.abs(scene.moment(location)[:, :3]).max(axis=0, initial=0.0)
    loaded = moment > FORM.trace_of_load * moment.max()
    size = tilt_per_moment(scene, location, len(axes))
    terms = []
    # those about one axis first, as `stiffest_of_two` takes them
    for one, two in sorted(combinations_with_replacement(range(len(axes)), 2), key=lambda pair: pair[0] != pair[1]):
        pairs = [(one, two)] if one == two else [(one, two), (two, one)]
        acting = [
            (Direction(location, f"r{axes[about]}"), Driver("moment", (location, under)))
            for about, under in pairs
            if loaded[under]
        ]
        if acting:
            name = "compliance_" + axes[one] + axes[two] * (one != two)
            terms.append(term(name, "rad/(N m)", *acting, plausible=size))
    return tuple(terms)


def stiffest_of_two(values: Array, covariance: Array) -> tuple[float, float]:
    """The smaller principal compliance, rad/(N m), of one about two axes; what is elastic has no negative one.

    Args:
        values: (3,) about x, about y, and across.
        covariance: (3, 3) of them.

    Returns:
        Value and standard error.
    """
    x, y, across = values
    size, axes = np.linalg.eigh(np.array([[x, across], [across, y]]))
    u, v = axes[:, 0]
    slope = np.array([u * u, v * v, 2 * u * v])
    return float(size[0]), float(np.sqrt(slope @ covariance @ slope))


def _about_its_foot(told: Told) -> str:
    """A clause of a base that tilts about a point on its own axis; not for use where either size is open."""
    tilt, shift = told.numbers["compliance"], told.numbers["shift"]
    if min(tilt.value - CLEAR * tilt.stderr, abs(shift.value) - CLEAR * shift.stderr) <= 0:
        raise KeyError("shift")
    height = shift.value / tilt.value
    where = f"{rounded(abs(height))} m {'below' if height > 0 else 'above'} its origin"
    return f"the base tilts by {tilt} under the arm's moment, about a point {where}"


BASE_COMPLIANCE = Effect(
    "base_compliance",
    "elastic",
    _place_base,
    "The base (pedestal, floor, bolts) tilts under the arm's moment.",
    "Put a reflector or an inclinometer on the base and swing the outstretched arm around.",
    Cure(
        "Stiffen the mounting.",
        otherwise="No motor turns the base: otherwise let the corrected model's inverse kinematics compute the "
        "commands (base tilted by + compliance x moment, and moved across as far as is told; `armscope compensate`).",
        change="mounting",
        instruction="Tighten and stiffen the mounting of the base.",
    ),
    clauses=(
        _about_its_foot,
        "the base tilts by {compliance} under the arm's moment",
        clear_ones(
            "the base tilts {} under the arm's moment",
            compliance_x="about its x",
            compliance_y="about its y",
            compliance_z="about its z",
        ),
        "the base tilts under the arm's moment",
    ),
    labels=BY_AXES,
    atlas="gravity load",
    nonnegative=True,
)

EFFECTS = [BEARING_COMPLIANCE, BASE_COMPLIANCE]
