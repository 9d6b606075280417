"""Elastic effects: what gives way under gravity. Loads come from `armscope.physics.scene`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.core.types import Array
from armscope.physics.clause import below_zero
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import command
from armscope.physics.effect import AXES, Cure, Direction, Driver, Effect, Placed, Product, Term, motor, term
from armscope.physics.form_constants import FORM
from armscope.physics.load_drivers import static_regressor
from armscope.physics.placing import varies
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

UNKNOWN_MASSES = "unknown masses"
"""The variant of a joint's compliance that trusts no stated mass."""


def loaded_joints(scene: Scene) -> list[int]:
    """Motors (1-based) whose load varies by more than a trace: under less, a drive would have to be a soft spring."""
    torques = scene.torques
    # a single odd row is no variation
    varies_by = np.ptp(np.quantile(torques, (0.02, 0.98), axis=0), axis=0) if len(torques) > 1 else np.abs(torques[0])
    return [int(j) for j in np.flatnonzero(varies_by > FORM.trace_of_load * varies_by.max(initial=1e-9)) + 1]


def _place_joints(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if not arm.has_masses and recordings.torque is None:
        yield from _unknown_masses(arm, recordings)
        return
    scene = Scene(arm, recordings)
    for j in loaded_joints(scene):
        compliance = drive(scene, j, Driver("torque", (j,)))
        yield Placed(JOINT_COMPLIANCE, f"joint {j}", (compliance,), (1.0,), f"load of joint {j}")
        if recordings.torque is not None and arm.has_masses:
            by_masses = drive(scene, j, Driver("gravity torque", (j,)))
            driver = f"load of joint {j} by the stated masses"
            yield Placed(JOINT_COMPLIANCE, f"joint {j}", (by_masses,), (1.0,), driver, variant="stated masses")
    if recordings.torque is None:
        yield from _unknown_masses(arm, recordings)


def drive(scene: Scene, j: int, load: Driver) -> Term:
    """The give of a drive under a load.

    Args:
        scene: the rows.
        j: the motor, from 1.
        load: what it gives way to, N m.

    Returns:
        The compliance, rad/(N m) where the load is a torque.
    """
    size = plausible_give(PLAUSIBLE.drive_rad, scene.driver(load))
    return term("compliance", "rad/(N m)", (motor(j), load), plausible=size)


def plausible_give(turn: float, load: Array) -> float:
    """Rad per unit of a load (N,) whose largest value turns what gives way by ``turn`` rad; infinite without load."""
    largest = float(np.abs(load).max(initial=0.0))
    return turn / largest if largest > 0 else np.inf


def _unknown_masses(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """Compliance with unknown mass moments: linear in compliance x mass moment; a payload keeps it absolute."""
    scene = Scene(arm, recordings)
    for j in range(1, arm.n_motors + 1):
        loads = list(_mass_moment_terms(scene, j))
        if not loads:
            continue
        terms, shape = [term for term, _ in loads], [share for _, share in loads]
        if varies(recordings.payload, 1e-6):
            terms.append(drive(scene, j, Driver("payload torque", (j,))))
            shape.append(1.0)
        yield Placed(
            JOINT_COMPLIANCE,
            f"joint {j}",
            tuple(terms),
            tuple(shape),
            f"load of joint {j}, masses unknown",
            variant=UNKNOWN_MASSES,
            partly_unseen=True,
        )


def _mass_moment_terms(scene: Scene, j: int) -> Iterator[tuple[Term, float]]:
    """Combinations of mass moments that load motor j independently (singular vectors), and what each is expected to do.

    All are equally likely in kg m: the strongest, which comes first, does most to the motor. Beside stated masses,
    which hold that one, none is likelier than another.
    """
    regressor = static_regressor(scene)[:, j - 1]
    spread = regressor - regressor.mean(axis=0)
    _, size, directions = np.linalg.svd(spread, full_matrices=False)
    if size[0] < 1e-6:
        return
    strong = size > FORM.mass_directions_share * size[0]
    for number, (direction, share) in enumerate(zip(directions[strong], size[strong] / size[0], strict=True), start=1):
        load = Driver("regressor", (j, *(float(w) for w in direction)))
        give = plausible_give(PLAUSIBLE.drive_rad, scene.driver(load))
        name = f"compliance_times_moment_{number}"
        yield term(name, "rad/(m/s^2)", (motor(j), load), plausible=give), 1.0 if scene.arm.has_masses else float(share)


JOINT_COMPLIANCE = Effect(
    "joint_compliance",
    "elastic",
    _place_joints,
    "The joint's drive gives way about its axis in proportion to the load that gravity puts on the motor.",
    "Hang a known weight on the tool in the same pose and measure how far this joint turns.",
    command(
        "Let the controller's elastic model hold against it,",
        otherwise="or compensate for it in the command: commanded = wanted - compliance x load (load: gravity's "
        "torque on this motor, positive along its pull).",
        change="elastic model",
        instruction="Let the controller's elastic model hold {location} against gravity, or {correction}{size}.",
    ),
    clauses=(
        below_zero("compliance", "{location} turns against gravity's pull, as no spring does, by {compliance}"),
        "{location} gives way by {compliance} under gravity",
        "{location} gives way by {soft_turn} under small loads already, and then hardens",
        "{location} gives way under gravity",
    ),
    labels={"soft_turn": "gives way under small loads by"},
    atlas="gravity load",
    nonnegative=True,
    contained_in=("load",),
)


def _place_beams(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if not arm.has_masses:
        return
    scene = Scene(arm, recordings)
    for j in range(1, arm.n_joints + 1):
        if np.linalg.norm(arm.step_along(j)[:3, 3]) < FORM.shortest_beam_m:
            continue
        flexibility = term(
            "flexibility",
            "1/(N m^2)",
            *(Product(Direction(scene.beam_site(j), axis), Driver("bend", (j, n))) for n, axis in enumerate(AXES)),
            plausible=plausible_give(PLAUSIBLE.beam_rad, np.linalg.norm(scene.bending(j)[:, 3:], axis=1)),
        )
        yield Placed(LINK_BENDING, f"link {j}", (flexibility,), (1.0,), f"load at the end of link {j}")


LINK_BENDING = Effect(
    "link_bending",
    "elastic",
    _place_beams,
    "The link bends like a beam under the load at its end.",
    "Put reflectors on both ends of the link and load the arm.",
    Cure(
        "Stiffen the link.",
        otherwise="No motor bends it back: otherwise let the corrected model's inverse kinematics compute the commands "
        "(link's end moved by + flexibility x the beam's shape; `armscope compensate`).",
        change="elastic model",
        instruction="Put the bending of {location} into the model, or stiffen it.",
    ),
    clauses=("{location} bends under its load",),
    labels={"flexibility": "flexibility 1/(E·I)"},
    atlas="gravity load",
    nonnegative=True,
)

EFFECTS = [JOINT_COMPLIANCE, LINK_BENDING]
