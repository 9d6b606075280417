"""The paper's models on recordings of a real arm: the same identification poses' criterion, fits and Table 2.

The measurement frame and the tool offset are not known beforehand, so they are fitted first, on the identification rows
and with the nominal arm: six numbers for the base and three for each target. What is left is the error that the
models predict; its frame is the arm's base.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.grouping import same_configuration
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.fitting.constants import STEPS
from armscope.fitting.placement import FlangePoses, all_alike, place_frames
from armscope.paper.identification_poses import ChosenPoses, choose_identification_poses
from armscope.paper.measurements import Measurements, PoseSet
from armscope.paper.printed import IDENTIFICATION
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.world.tolerances import geometric_errors

HELD_OUT = "held out"
MOST_CANDIDATES = 3000
LARGEST_SHARE = 0.7  # At most this share of the configurations is used for identification, where there are few


@dataclass(frozen=True, eq=False)
class RealStudy:
    """A real arm's measurements in the form of the paper's."""

    measurements: Measurements  # sets "identification" and "held out"; one robot, named as the arm
    choice: ChosenPoses  # of the identification configurations among the candidates, with its observability index
    base_position_m: Array  # (3,) the arm's base in the measurement frame, fitted
    base_rotation: Array  # (3, 3) the arm's base in the measurement frame, fitted
    tools_m: dict[str, Array]  # fitted tool point in the last frame by target, m


def real_measurements(arm: Arm, recordings: Recordings, seed: int, count: int = 85) -> RealStudy:
    """Choose identification rows, fit the frames on them, and give all errors (measured minus nominal).

    Args:
        arm: the nominal arm, described by D-H rows.
        recordings: measured positions; several targets of one configuration stay together.
        seed: of the candidates, where there are more configurations than can be compared.
        count: identification rows (85); fewer where the recordings are few, so that some are held out.

    Returns:
        Errors (mm) at identification and held-out rows, the choice of rows, and the fitted frames.

    Raises:
        InputError: an arm with another number of motors, or too few rows to fit frames and models.
    """
    recordings.check_motors(arm.name, arm.n_motors)
    configuration = same_configuration(recordings.motor_angles, recordings.run, recordings.id)
    first_rows = np.sort(np.unique(configuration, return_index=True)[1])
    rows_each = len(recordings) / len(first_rows)
    n_chosen = int(min(count / rows_each, LARGEST_SHARE * len(first_rows)))
    targets, target = np.unique(recordings.target, return_inverse=True)
    if n_chosen * rows_each < 6 + 3 * len(targets) + 4:
        by_table = LARGEST_SHARE * len(first_rows) < count / rows_each
        found = f"{len(recordings)} rows" if by_table else f"{count} identification poses, of {len(recordings)} rows"
        raise InputError(recordings.source, "", found, "too few to fit frames and models and to hold some out")
    rng = np.random.default_rng(seed)
    candidates = first_rows
    if len(candidates) > MOST_CANDIDATES:
        candidates = np.sort(rng.choice(first_rows, MOST_CANDIDATES, replace=False))
    jacobian = geometric_errors(arm).jacobian(chain(arm, recordings.motor_angles[candidates]))
    choice = choose_identification_poses(jacobian, n_chosen, rng)
    identified = np.isin(configuration, configuration[candidates[choice.rows]])
    frames = chain(arm, recordings.motor_angles)
    # the last frame's origin: the nominal tool point without its offset
    origins = frames.tool - frames.tool_rotation @ arm.tool
    chosen = np.flatnonzero(identified)
    poses = FlangePoses(
        origins[chosen],
        frames.tool_rotation[chosen],
        recordings.positions[chosen],
        np.zeros_like(chosen),
        target[chosen],
    )
    stated = np.tile(arm.tool, (len(targets), 1))
    placed = place_frames(poses, poses.start(stated, 1), STEPS.registration, all_alike, stated).state
    rotation, position, tools = placed.rotations[0], placed.translations[0], placed.tools
    nominal = origins + np.einsum("nij,nj->ni", frames.tool_rotation, tools[target])
    measured = (recordings.positions - position) @ rotation
    errors = (measured - nominal) * 1e3
    sets = tuple(
        PoseSet(name, recordings.motor_angles[rows], nominal[rows] * 1e3, errors[None, rows])
        for name, rows in ((IDENTIFICATION, identified), (HELD_OUT, ~identified))
    )
    by_target = {str(name): tools[k] for k, name in enumerate(targets)}
    return RealStudy(Measurements((arm.name,), sets), choice, position, rotation, by_target)
