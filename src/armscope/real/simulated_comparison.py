"""The comparison of compliances tried on simulated arms: do its intervals hold, does it agree when it should?

Arms are drawn and simulated at the real runs' commanded angles, with much that the comparison's model does not have: a
gear's mesh, lost motion by the side of load, links and a base that bend, joints that drag others along, heavier masses
than stated, bad shots. True loads are gravity's of mass moments fitted to the recorded torques; the comparison sees
torques with errors as the recorded ones have them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics import elastic, geometric, tilting, transmission
from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel, predict, predict_orientation
from armscope.physics.wobble import about_their_origins
from armscope.real.compliance_tables import ORIENTATIONS, POINTS, half_width
from armscope.real.compliances import as_heavy_as_recorded, compare_compliances, fit_give, gravity_as_recorded
from armscope.real.constants import COMPLIANCE, DRAWN
from armscope.real.reference import ReferenceCompliances
from armscope.recordings import Recordings
from armscope.robot import Arm

KINDS = {"the same arm": 1.0, "an arm 15 % softer": 1.15}
"""What the other run is recorded on: by how much its compliances are larger."""


@dataclass(frozen=True, eq=False)
class DrawnArm:
    """A simulated arm: compliances of drives and bearings, rad/(N m), and all else."""

    drives: Array
    bearings: Array
    rest: tuple[Part, ...]


def draw_arm(arm: Arm, rows: Recordings, rng: np.random.Generator) -> DrawnArm:
    """An arm that is a little wrong everywhere; joints that move in ``rows`` have waves.

    Args:
        arm: the nominal arm.
        rows: whose joints' motions are followed.
        rng: draws its faults.

    Returns:
        Compliances of drives and bearings, rad/(N m), and all other effects.
    """
    drives = rng.uniform(*DRAWN.drives_rad_nm, arm.n_motors)
    bearings = rng.uniform(*DRAWN.bearings_rad_nm, arm.n_joints)
    normal = [
        (geometric.background(arm), DRAWN.geometry),
        (transmission.GEAR_ECCENTRICITY.place(arm, rows), DRAWN.wave_rad),
    ]
    normal += [(about_their_origins(arm, rows), DRAWN.wobble_rad)]
    counts = rng.integers(*DRAWN.mesh_waves, arm.n_motors)
    normal += [([transmission.mesh(j + 1, int(count)) for j, count in enumerate(counts)], DRAWN.mesh_rad)]
    dragged = [placed for placed in transmission.JOINT_COUPLING.place(arm, rows) if rng.random() < DRAWN.dragging]
    normal += [(dragged, DRAWN.dragged)]
    rest = [Part(placed, size * rng.normal(size=len(placed.terms))) for places, size in normal for placed in places]
    gaps = [placed for placed in transmission.BACKLASH.place(arm, rows) if placed.variant == "load"]
    positive = [
        (gaps, DRAWN.gap_rad),
        (elastic.LINK_BENDING.place(arm, rows), DRAWN.bend),
        ([base for base in tilting.BASE_COMPLIANCE.place(arm, rows) if not base.variant], DRAWN.base_rad_nm),
    ]
    rest += [Part(placed, np.array([rng.uniform(0, size)])) for places, size in positive for placed in places]
    return DrawnArm(drives, bearings, tuple(rest))


def simulate_recordings(
    arm: Arm, rows: Recordings, drawn: DrawnArm, softer: float, rng: np.random.Generator
) -> Recordings:
    """``rows`` as a drawn arm gives them, its compliances ``softer`` times as large.

    Args:
        arm: the nominal arm.
        rows: angles, torques and context.
        drawn: the arm's faults.
        softer: factor of its compliances.
        rng: draws the noise.

    Returns:
        Rows with points, orientations and torques as that arm gives them.
    """
    heavy = as_heavy_as_recorded(arm, rows)[0]
    assert rows.torque is not None
    torque = gravity_as_recorded(arm, rows)
    loaded = replace(rows, torque=torque)
    # the sensors' errors of one row come with another, so that nobody can know them
    recorded = torque + rng.permutation(rows.torque - torque)
    give = [
        Part(placed, np.array([softer * compliances[Location.of(placed.location).index]]))
        for effect, compliances in (
            (elastic.JOINT_COMPLIANCE, drawn.drives),
            (tilting.BEARING_COMPLIANCE, drawn.bearings),
        )
        for placed in effect.place(heavy, loaded)
        if placed.variant == ""
    ]
    bases = {str(run): Base(Rotation.random(1, rng).as_matrix()[0], rng.normal(size=3)) for run in np.unique(rows.run)}
    model = FittedModel(heavy, bases, (), (*give, *drawn.rest))
    points, turns = predict(model, loaded), Rotation.from_matrix(predict_orientation(model, loaded))
    noise = np.where(rng.random(len(rows)) < DRAWN.bad_shots, DRAWN.far_mm, DRAWN.point_mm)[:, None]
    points = points + 1e-3 * noise * rng.normal(size=points.shape)
    if not rows.oriented.any():
        return replace(rows, positions=points, torque=recorded)
    shaken = Rotation.from_rotvec(1e-3 * DRAWN.turn_mrad * rng.normal(size=points.shape))
    turned = shaken * turns * Rotation.random(1, rng)[0]
    return replace(rows, positions=points, torque=recorded, orientation=turned.as_quat(scalar_first=True))


def compare_on_simulated_arms(
    arm: Arm, one: Recordings, other: Recordings, joints: Sequence[int], arms: int, seed: int
) -> pd.DataFrame:
    """Drawn arms recorded in two runs and compared.

    Args:
        arm: the nominal arm.
        one, other: the runs whose angles and torques are taken.
        joints: which compliances are compared.
        arms: how many are drawn.
        seed: of the drawing.

    Returns:
        A row per kind of the other run's arm: arm, arms, agree (how many), numbers, held (joints' intervals in both
        runs that hold the drawn compliance).
    """
    found = []
    for kind, softer in KINDS.items():
        agree, held = [], []
        for number in range(arms):
            rng = np.random.default_rng([seed, number])
            drawn = draw_arm(arm, one, rng)
            first = fit_give(arm, simulate_recordings(arm, one, drawn, 1.0, rng), "one")
            second = fit_give(arm, simulate_recordings(arm, other, drawn, softer, rng), "other")
            agree.append(compare_compliances(first, second).probability > COMPLIANCE.agrees)
            for give, factor in ((first, 1.0), (second, softer)):
                held += [
                    abs(give.mean[j - 1] - factor * drawn.drives[j - 1]) < half_width(give.stderr[j - 1])
                    for j in joints
                ]
        found.append({"arm": kind, "arms": arms, "agree": sum(agree), "numbers": len(held), "held": sum(held)})
    return pd.DataFrame(found)


def compare_simulated_runs(
    arm: Arm, recordings: Recordings, reference: ReferenceCompliances, arms: int, seed: int
) -> pd.DataFrame:
    """`compare_on_simulated_arms` at the first two runs' angles and torques: by points alone, and by orientations, too.

    Args:
        arm: the nominal arm.
        recordings: all runs of a set.
        reference: which runs and joints are asked for.
        arms: how many are drawn.
        seed: of the drawing.

    Returns:
        As `compare_on_simulated_arms`, with what was learned from and the two runs.
    """
    one, other = reference.runs[:2]
    found = []
    for learned in (POINTS, ORIENTATIONS) if recordings.oriented.any() else (POINTS,):
        rows = replace(recordings, orientation=None) if learned == POINTS else recordings
        first, second = rows.of_runs([one]), rows.of_runs([other])
        table = compare_on_simulated_arms(arm, first, second, list(reference.microrad_per_nm), arms, seed)
        found.append(table.assign(learned=learned, one=one, other=other))
    return pd.concat(found, ignore_index=True)
