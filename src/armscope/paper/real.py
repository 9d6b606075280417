"""The paper's models on recordings of a real arm: the same identification poses' criterion, fits and Table 2.

The measurement frame and the tool offset are not known beforehand, so they are fitted first, on the identification rows
and with the nominal arm: six numbers for the base and three for each target. What is left is the error that the
models predict; its frame is the arm's base.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.paper.measurements import Measurements, PoseSet
from armscope.paper.printed import IDENTIFICATION
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.world.poses import Choice, choose_poses
from armscope.world.tolerances import geometric_errors

HELD_OUT = "held out"
MOST_CANDIDATES = 3000
LARGEST_SHARE = 0.7
"""At most this share of the configurations is used for identification, where there are few."""

FRAME_ITERATIONS = 50
FRAME_STEP = 1e-12


@dataclass(frozen=True, eq=False)
class RealStudy:
    """A real arm's measurements in the form of the paper's.

    Attributes:
        measurements: sets "identification" and "held out"; one robot, named as the arm.
        choice: of the identification configurations among the candidates, with its observability index.
        base_position_m, base_rotation: (3,), (3, 3) the arm's base in the measurement frame, fitted.
        tools_m: fitted tool point in the last frame by target, m.
    """

    measurements: Measurements
    choice: Choice
    base_position_m: Array
    base_rotation: Array
    tools_m: dict[str, Array]


def select_rows(recordings: Recordings, run: str | None = None, first_id: int | None = None) -> Recordings:
    """The rows of one run, from an id on (numbers), in their order.

    Args:
        recordings: all runs of a set.
        run: which; None takes all.
        first_id: the first row's id; None takes all.

    Returns:
        The rows.

    Raises:
        InputError: a run that the recordings don't have; nothing left.
    """
    keep = np.ones(len(recordings), dtype=bool)
    if run is not None:
        keep &= recordings.run == run
        if not keep.any():
            cure = nearest(run, set(recordings.run.tolist()))
            raise InputError(recordings.source, "column run", run, "no row has this run", cure)
    if first_id is not None:
        numbers = np.array([float(text) if text.isdecimal() else np.nan for text in recordings.id])
        keep &= numbers >= first_id
        if not keep.any():
            raise InputError(recordings.source, "column id", first_id, "no row has this id or a later one")
    return recordings.rows(keep)


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
    if arm.n_motors != recordings.n_motors:
        raise InputError(
            recordings.source, "line 1", f"{recordings.n_motors} motor angles", f"{arm.name} has {arm.n_motors} motors"
        )
    configuration = _configurations(recordings)
    first_rows = np.unique(configuration, return_index=True)[1]
    rows_each = len(recordings) / len(first_rows)
    n_chosen = int(min(count / rows_each, LARGEST_SHARE * len(first_rows)))
    targets, target = np.unique(recordings.target, return_inverse=True)
    if n_chosen * rows_each < 6 + 3 * len(targets) + 4:
        raise InputError(
            recordings.source, "", f"{len(recordings)} rows", "too few to fit frames and models and to hold some out"
        )
    rng = np.random.default_rng(seed)
    candidates = first_rows
    if len(candidates) > MOST_CANDIDATES:
        candidates = np.sort(rng.choice(first_rows, MOST_CANDIDATES, replace=False))
    jacobian = geometric_errors(arm).jacobian(chain(arm, recordings.motor_angles[candidates]))
    choice = choose_poses(jacobian, n_chosen, rng)
    identified = np.isin(configuration, configuration[candidates[choice.rows]])
    frames = chain(arm, recordings.motor_angles)
    # the last frame's origin: the nominal tool point without its offset
    origins = frames.tool - frames.tool_rotation @ arm.tool
    fit = _FrameFit(frames.tool_rotation, origins, recordings.positions, target)
    rotation, position, tools = fit.solve(identified, np.tile(arm.tool, (len(targets), 1)))
    nominal = origins + np.einsum("nij,nj->ni", frames.tool_rotation, tools[target])
    measured = (recordings.positions - position) @ rotation
    errors = (measured - nominal) * 1e3
    sets = tuple(
        PoseSet(name, recordings.motor_angles[rows], nominal[rows] * 1e3, errors[None, rows])
        for name, rows in ((IDENTIFICATION, identified), (HELD_OUT, ~identified))
    )
    by_target = {str(name): tools[k] for k, name in enumerate(targets)}
    return RealStudy(Measurements((arm.name,), sets), choice, position, rotation, by_target)


def _configurations(recordings: Recordings) -> NDArray[np.intp]:
    """(N,) number of each row's configuration: rows of one run and id with equal angles are targets of one."""
    keys = np.column_stack([recordings.run, recordings.id, recordings.motor_angles.astype(str)])
    return np.asarray(np.unique(keys, axis=0, return_inverse=True)[1]).ravel()


@dataclass(frozen=True, eq=False)
class _FrameFit:
    """measured = R (R_i tool + o_i) + t: Gauss-Newton for R, t and the tool of each target."""

    tool_rotation: Array
    origins: Array
    measured: Array
    target: NDArray[np.intp]

    def solve(self, rows: NDArray[np.bool_], tools: Array) -> tuple[Array, Array, Array]:
        """(R, t, tools) from the given rows."""
        turned, origins = self.tool_rotation[rows], self.origins[rows]
        measured, target = self.measured[rows], self.target[rows]
        nominal = origins + np.einsum("nij,nj->ni", turned, tools[target])
        centre, goal = nominal.mean(axis=0), measured.mean(axis=0)
        rotation = Rotation.align_vectors(measured - goal, nominal - centre)[0].as_matrix()
        position = goal - rotation @ centre
        for _ in range(FRAME_ITERATIONS):
            nominal = origins + np.einsum("nij,nj->ni", turned, tools[target])
            predicted = nominal @ rotation.T
            columns = self._columns(predicted, rotation @ turned, target, len(tools))
            gap = (measured - predicted - position).ravel()
            step = np.linalg.lstsq(columns, gap, rcond=1e-10)[0]
            rotation = Rotation.from_rotvec(step[:3]).as_matrix() @ rotation
            position = position + step[3:6]
            tools = tools + step[6:].reshape(-1, 3)
            if np.abs(step).max() < FRAME_STEP:
                break
        return rotation, position, tools

    @staticmethod
    def _columns(predicted: Array, turned: Array, target: NDArray[np.intp], n_targets: int) -> Array:
        """(3 N, 6 + 3 targets) slopes of the predicted points by a turn, a shift and the tools."""
        n_rows = len(predicted)
        columns = np.zeros((n_rows, 3, 6 + 3 * n_targets))
        columns[:, :, :3] = np.swapaxes(np.cross(np.eye(3), predicted[:, None, :]), 1, 2)
        columns[:, :, 3:6] = np.eye(3)
        for number in range(n_targets):
            mine = target == number
            columns[mine, :, 6 + 3 * number : 9 + 3 * number] = turned[mine]
        return columns.reshape(3 * n_rows, -1)
