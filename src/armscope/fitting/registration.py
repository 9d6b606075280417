"""Frames as they are: base per set-up and tool per target, from a closed-form start anywhere in space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.fitting.constants import STEPS
from armscope.fitting.placement import FlangePoses, place_frames
from armscope.measurement import robust
from armscope.physics.effect import Part
from armscope.physics.frames import TOOL_FRAME, ToolKey, free_frames, tool_keys
from armscope.physics.model import Base, FittedModel
from armscope.physics.set_ups import SetUps, in_order_of_time
from armscope.recordings import Recordings
from armscope.robot import Arm, tool_frames


def fit_frames(arm: Arm, recordings: Recordings, tool_per_run: bool = False, set_ups: SetUps = ()) -> FittedModel:
    """The arm with base and tool fitted to the recordings and no effects.

    Each base starts from the rigid motion of the nominal tool points about their medians onto the measured ones;
    Gauss-Newton with Huber weights then fits bases and tools together.

    Args:
        arm: the nominal arm.
        recordings: N rows.
        tool_per_run: a tool of its own in every run, where it was taken off in between.
        set_ups: runs that share a base; any other has its own.

    Returns:
        The model, its frames in SI units.
    """
    tool, tool_rotation = tool_frames(arm, recordings.motor_angles)
    keys = tool_keys(recordings, tool_per_run)
    which_tool = _tool_of_row(recordings, keys)
    runs, which_run = np.unique(recordings.run, return_inverse=True)
    first_of = {run: together[0] for together in set_ups for run in together}
    stands, base_of_run = np.unique([first_of.get(str(run), str(run)) for run in runs], return_inverse=True)
    which_base = base_of_run[which_run]
    poses = FlangePoses(tool, tool_rotation, recordings.positions, which_base, which_tool)
    stated = np.zeros((len(keys), 3))
    found = place_frames(poses, poses.start(stated, len(stands)), STEPS.registration, _weights, stated).state
    bases = [Base(*each) for each in zip(found.rotations, found.translations, strict=True)]
    return FittedModel(
        arm,
        {run: bases[base_of_run[np.searchsorted(runs, run)]] for run in in_order_of_time(recordings)},
        _tool_parts(recordings, tool_per_run, found.tools),
        tool_turns=_tool_turns(recordings, tool_rotation, bases, which_base, keys, which_tool),
    )


def _tool_turns(
    recordings: Recordings,
    modelled: Array,
    bases: list[Base],
    which_base: NDArray[np.intp],
    keys: list[ToolKey],
    which_tool: NDArray[np.intp],
) -> dict[ToolKey, Array]:
    """How each tool is turned on the last frame (N, 3, 3): the mean of its rows without those far off."""
    turns = {}
    for number, key in enumerate(keys):
        rows = np.flatnonzero(recordings.oriented & (which_tool == number))
        if not len(rows):
            continue
        from scipy.spatial.transform import Rotation  # slow to import, and few tables hold orientations

        placed = np.array([bases[b].rotation for b in which_base[rows]]) @ modelled[rows]
        measured = Rotation.from_quat(recordings.quaternions[rows], scalar_first=True)
        on_flange = Rotation.from_matrix(placed).inv() * measured
        mean = on_flange.mean()
        for _ in range(STEPS.turn_steps):
            mean = on_flange.mean(_weights((mean.inv() * on_flange).as_rotvec()))
        turns[key] = np.asarray(mean.as_matrix())
    return turns


def _tool_parts(recordings: Recordings, per_run: bool, tools: Array) -> tuple[Part, ...]:
    placed = [p for p in free_frames(recordings, per_run) if p.effect is TOOL_FRAME]
    return tuple(Part(p, t) for p, t in zip(placed, tools, strict=True))


def _tool_of_row(recordings: Recordings, keys: list[tuple[str, str | None]]) -> NDArray[np.intp]:
    numbers = np.empty(len(recordings), dtype=np.intp)
    for number, (target, run) in enumerate(keys):
        numbers[(recordings.target == target) & (True if run is None else recordings.run == run)] = number
    return numbers


def _weights(residual: Array) -> Array:
    """(N,) Huber's."""
    return robust.huber_weights(residual, np.ones(len(residual)), 0.0)
