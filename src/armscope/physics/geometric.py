"""Geometric effects: constant errors of the D-H rows, encoder zeros, a linkage's bar lengths."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.physics.clause import Number, Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import command
from armscope.physics.effect import AXES, ONE, Cure, Direction, Driver, Effect, Part, Placed, Product, Term, motor, term
from armscope.physics.form_constants import FORM
from armscope.physics.joint_directions import directions_of_a_joint
from armscope.physics.linkage_words import BARS, OF_WHAT, bars_differ
from armscope.physics.loaded_arm import LINKAGE_JOINT, LoadedArm
from armscope.physics.placing import moving_joints, nowhere
from armscope.physics.scene import Scene
from armscope.physics.wobble import AXIS_WOBBLE
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.denavit_hartenberg import row_twist
from armscope.robot.parallelogram import forearm_deviation

MILLIMETRE = 1e-3
ROUNDING = 1e-9
"""Of a twist's components: axes of a file that stands square hold no others."""


def row_terms(arm: Arm, j: int) -> dict[str, Term]:
    """Constant errors of D-H row j (1-based) but for the joint's zero: a, alpha, d, and beta where axes are parallel.

    What each does is `armscope.robot.denavit_hartenberg.row_twist`; a URDF has no rows but `directions_of_a_joint`.
    """
    if arm.description.dh is None:
        twists = {axis: (f"joint {j}", twist) for axis, twist in directions_of_a_joint(arm, j).items()}
    else:
        parallel = abs(np.sin(np.radians(arm.description.dh.joints[j - 1].alpha_deg))) < FORM.parallel_rad
        kinds = ("a", "alpha", "d", *(["beta"] if parallel else []))
        twists = {kind: row_twist(arm, j, kind) for kind in kinds}
    return {name: _constant(name, *twist) for name, twist in twists.items()}


def _constant(name: str, location: str, twist: Array) -> Term:
    """A length (a, d, tx, ty, tz) in mm, or an angle, that moves a frame by a twist per SI unit."""
    length = name in ("a", "d", "tx", "ty", "tz")
    twist = np.where(np.abs(twist) < ROUNDING, 0.0, twist)
    products = (Product(Direction(location, AXES[n]), ONE, float(twist[n])) for n in np.flatnonzero(twist))
    size = PLAUSIBLE.length_m if length else PLAUSIBLE.twist_rad
    return term(name, "mm" if length else "rad", *products, si=MILLIMETRE if length else 1.0, plausible=size)


def _place_offsets(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in moving_joints(recordings):
        yield joint_zero(JOINT_OFFSET, j)


JOINT_OFFSET = Effect(
    "joint_offset",
    "geometric",
    _place_offsets,
    "The encoder's zero is off, so the joint is always at an angle other than the commanded one.",
    "Bring the joint to its calibration mark or level its link with an inclinometer at zero and read the angle.",
    command(
        "Correct the encoder's zero (mastering) by the angle found,",
        otherwise="or compensate for it in the command: commanded = wanted - offset. "
        "In the controller's model: theta = stated theta + offset.",
        change="mastering",
        instruction="Reset the zero of {location}: {zero}.",
    ),
    clauses=("the zero of {location} is off by {offset:+}",),
    labels={"offset": "zero is off by"},
    atlas="constant",
    contained_in=("angle", "load", "time", "temperature"),
    departs=True,
)


def _place_links(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in range(1, arm.n_joints + 1):
        terms = tuple(row_terms(arm, j).values())
        yield Placed(LINK_GEOMETRY, f"link {j}", terms, (1.0,) * len(terms), "constant")


_ROW = {
    "a": "length a", "d": "length d", "alpha": "twist α", "theta": "turn θ", "beta": "twist β",
    "tx": "shift along x", "ty": "shift along y", "tz": "shift along z", "rx": "tilt about x", "ry": "tilt about y",
}  # fmt: skip
"""Numbers of a D-H row, or of a URDF's joint in the axes of its file (`armscope.robot.urdf_writing.axes_told`)."""


def _differs(told: Told) -> str:
    """Of the parameters that rows tell from zero the two that are largest beside what arms show."""
    if not told.numbers:
        return f"{told.location} differs from its drawing"
    surest = sorted(told.numbers.items(), key=lambda p: -abs(p[1].value) / (p[1].stderr or math.inf))
    clear = [(name, p) for name, p in surest if p.stderr and abs(p.value) > 3 * p.stderr] or surest[:1]
    largest = sorted(clear, key=lambda p: -abs(p[1].value) / _plausible(p[1]))[:2]
    errors = " and ".join(f"{_ROW.get(name, name)} by {number:+}" for name, number in largest)
    return f"{told.location} differs from its drawing: {errors}"


def _plausible(number: Number) -> float:
    return PLAUSIBLE.length_m / MILLIMETRE if number.unit == "mm" else PLAUSIBLE.twist_rad


LINK_GEOMETRY = Effect(
    "link_geometry",
    "geometric",
    _place_links,
    "The link is longer, shorter or more twisted than its D-H row, or its joint's origin in a URDF, says.",
    "Measure the two neighbouring joint axes with the tracker by turning one joint at a time (circle-point analysis).",
    Cure(
        "No command of one joint undoes it: put the corrected D-H row (in a URDF: the joint's origin) into the "
        "controller's model (each number: the stated one plus the error told here), whose inverse kinematics then "
        "reaches the wanted point.",
        change="D-H row",
        instruction="Correct {location} in the controller's model: {row}.",
    ),
    clauses=(_differs,),
    labels=_ROW,
    atlas="constant",
    departs=True,
)


def background(arm: Arm) -> list[Placed]:
    """Every link's constant errors: what every real arm has, always allowed for with a prior of tolerance size.

    The angles are the motors' zeros, which move the arm in the same ways as the rows' theta, so that a zero that stands
    out is one of the background's own columns.
    """
    placed = [joint_zero(BACKGROUND, j) for j in range(1, arm.n_motors + 1)]
    for j in range(1, arm.n_joints + 1):
        terms = tuple(row_terms(arm, j).values())
        placed.append(Placed(BACKGROUND, f"link {j}", terms, (1.0,) * len(terms), "constant"))
    return placed


def joint_zero(effect: Effect, j: int) -> Placed:
    """The zero of motor ``j``, as named for itself or as one of the small errors of geometry."""
    offset = term("offset", "rad", (motor(j), ONE), plausible=PLAUSIBLE.zero_rad)
    return Placed(effect, f"joint {j}", (offset,), (1.0,), "constant")


BACKGROUND = Effect(
    "link_geometry",
    "geometric",
    nowhere,
    "Geometric errors of tolerance size, as every arm has them.",
    "Compare with the maker's tolerances.",
    Cure("A geometric calibration takes them out."),
)


FOREARM = Direction(f"joint {LINKAGE_JOINT}", "rz")


def _place_linkage(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if arm.description.parallelogram is not None:
        errors = {"plausible": PLAUSIBLE.bar_m, "si": MILLIMETRE}
        terms = tuple(term(bar, "mm", Product(FOREARM, Driver(bar)), **errors) for bar in ("rod", "rocker"))
        yield Placed(PARALLELOGRAM_GEOMETRY, "parallelogram", terms, (1.0, 1.0), f"angle of joint {LINKAGE_JOINT}")
    elif is_parallelogram(arm):
        yield from _unstated_bars(Scene(arm, recordings))


def is_parallelogram(arm: Arm) -> bool:
    """Whether two motors turn the elbow against each other, as a parallelogram does, whatever its bars."""
    turned = np.flatnonzero(arm.actuation[LINKAGE_JOINT - 1]) if arm.n_joints >= LINKAGE_JOINT else np.empty(0)
    return bool(len(turned) == 2) and np.prod(arm.actuation[LINKAGE_JOINT - 1][turned]) < 0


def _unstated_bars(scene: Scene) -> list[Placed]:
    """Bars of unknown lengths: errors as shares of the rocker's, at each direction that it may have on the forearm."""
    return _bars_at(scene, np.arange(0.0, 180.0, FORM.rocker_step_deg)) if np.ptp(scene.elbow_angle) > 0 else []


def finer_bars(scene: Scene, placed: Placed) -> list[Placed]:
    """Bars of unknown lengths at directions of the rocker less than a coarse step from those of others.

    Returns:
        The bars at each finer direction; none where the bars are stated, or are no bars.
    """
    if placed.effect is not PARALLELOGRAM_GEOMETRY or not placed.scanned:
        return []
    return _bars_at(
        scene,
        placed.scanned[0][2] + np.arange(-FORM.rocker_step_deg, FORM.rocker_step_deg, FORM.rocker_fine_step_deg)[1:],
    )


def _bars_at(scene: Scene, angles_deg: Array) -> list[Placed]:
    """Bars with the rocker at each of some angles on the forearm at which no pose holds the linkage flat."""
    angles = np.radians(angles_deg)
    kept = [n for n, a in enumerate(angles) if np.abs(np.sin(scene.elbow_angle + a)).min() > FORM.flat]
    return [
        Placed(
            PARALLELOGRAM_GEOMETRY,
            "parallelogram",
            tuple(
                term(
                    bar,
                    "m/m",
                    Product(FOREARM, Driver(f"{bar} share", (float(angles[n]),))),
                    plausible=PLAUSIBLE.bar_share,
                )
                for bar in ("rod", "rocker")
            ),
            (1.0, 1.0),
            f"angle of joint {LINKAGE_JOINT}",
            scanned=(("crank_angle", "deg", float(angles_deg[n])),),
            multiplicity=len(kept),
            variant=f"{angles_deg[n]:g} degrees",
        )
        for n in kept
    ]


def _closed_loop(scene: LoadedArm, part: Part) -> Iterator[tuple[Direction, Array]]:
    """The forearm's turn with the bars' lengths in error, rad: the loop closed exactly where the bars are stated."""
    if scene.arm.description.parallelogram is None:
        amounts = zip(part.values, part.placed.terms, strict=True)
        yield FOREARM, np.sum([value * scene.driver(term.products[0].driver) for value, term in amounts], axis=0)
        return
    errors = {term.name: value for term, value in zip(part.placed.terms, part.values, strict=True)}
    nominal = scene.linkage
    actual = replace(nominal, rocker=nominal.rocker + errors["rocker"], rod=nominal.rod + errors["rod"])
    yield FOREARM, forearm_deviation(actual, scene.elbow_angle) - forearm_deviation(nominal, scene.elbow_angle)


PARALLELOGRAM_GEOMETRY = Effect(
    "parallelogram_geometry",
    "geometric",
    _place_linkage,
    "The linkage's opposite bars differ in length, so the forearm does not keep parallel to its crank.",
    "Turn motor 2 alone and watch the forearm's inclination: in a true parallelogram it does not change.",
    Cure(
        "Adjust each bar that is off by minus its error, all before anything is measured,",
        otherwise="or put the true lengths into the controller's model (rod = stated rod + rod, rocker = stated rocker "
        f"+ rocker; errors without a unit are shares {OF_WHAT}); its inverse kinematics then reaches the wanted point.",
        change="linkage",
        instruction="Set the parallelogram's bars right: {bars}.",
    ),
    clauses=(bars_differ,),
    labels={bar: f"{bar} is off by (ppm: {OF_WHAT})" for bar in BARS},
    atlas="constant",
    exact=_closed_loop,
    departs=True,
)

EFFECTS = [JOINT_OFFSET, LINK_GEOMETRY, AXIS_WOBBLE, PARALLELOGRAM_GEOMETRY]
