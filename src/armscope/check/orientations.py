"""Whether measured orientations are the tool's, and in which reading of their numbers they would be."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from armscope.calibration.geometry import State
from armscope.calibration.model import SetUp
from armscope.check.constants import TRIALS
from armscope.check.suspicion import ORIENTED, Suspicion
from armscope.core.types import Array
from armscope.measurement.channel import NOT_THE_TOOLS_RAD, Channel, ChannelResiduals
from armscope.measurement.constants import WEIGHTS
from armscope.recordings import Recordings
from armscope.verdict.schema import Notice

Reading = tuple[str, str, Callable[[Array], Array]]  # What is wrong, how to mend it, and quaternions (N, 4) read so


def _mirrored() -> Iterator[Reading]:
    """A mirrored axis of the measurement frame changes the sign of the quaternion's other two parts."""
    for axis, signs in {"x": [1, 1, -1, -1], "y": [1, -1, 1, -1], "z": [1, -1, -1, 1]}.items():
        statement = f"the orientations, not the points, are those of a frame with a mirrored axis {axis}"
        cure = "Change the sign of " + " and ".join(f"q{other}" for other in "xyz" if other != axis) + "."
        yield statement, cure, functools.partial(np.multiply, signs)


READINGS: tuple[Reading, ...] = (
    ("as declared", "", lambda q: q),
    (
        "the quaternions are in the order x, y, z, w",
        "Declare order: xyzw, or exchange the columns.",
        lambda q: q[:, [3, 0, 1, 2]],
    ),
    (
        "the quaternions turn the other way: they are the tool frame from the measurement frame",
        "Change the sign of qx, qy, qz.",
        lambda q: q * [1, -1, -1, -1],
    ),
    (
        "the quaternions are in the order x, y, z, w and turn the other way",
        "Declare order: xyzw, and change the sign of x, y, z.",
        lambda q: q[:, [3, 0, 1, 2]] * [1, -1, -1, -1],
    ),
    (
        "the quaternions' columns are one place off: the real part stands in qx",
        "Call the columns qz, qw, qx, qy in place of qw, qx, qy, qz.",
        lambda q: q[:, [1, 2, 3, 0]],
    ),
    *_mirrored(),
)


def trusted_channels(
    channels: Sequence[Channel], recordings: Recordings, left: ChannelResiduals
) -> tuple[tuple[Channel, ...], Recordings, list[Notice]]:
    """Channels whose readings are the arm's, the table without the others' readings, and what to say of those.

    Args:
        channels: that were measured.
        recordings: the table.
        left: what the free frames leave in every channel.

    Returns:
        Those channels, that table, and a notice per channel left out.
    """
    kept, notices = [], []
    for channel in channels:
        doubt = channel.doubt(left[channel.name])
        if doubt is None:
            kept.append(channel)
        else:
            recordings = channel.without(recordings)
            notices.append(Notice(*doubt))
    return tuple(kept), recordings, notices


def orientation_mistakes(rows: SetUp, state: State, quaternions: Array | None) -> list[Suspicion]:
    """The reading of the quaternions (N, 4) under which each tool sits still on the flange.

    Args:
        rows: of one table.
        state: its frames, fitted to positions.
        quaternions: (N, 4) wxyz as in the table; None where there are none.

    Returns:
        At most one suspicion.
    """
    known = np.zeros(len(rows), bool) if quaternions is None else np.isfinite(quaternions).all(axis=1)
    if quaternions is None or not known.any():
        return []
    if known.sum() < WEIGHTS.fewest_orientations:
        return [Suspicion("hint", f"only {known.sum()} rows hold an orientation", "Positions are used alone.")]
    _, frames = rows.frames(state)
    expected = (state.rotations[rows.base] @ frames.tool_rotation)[known]
    group = (rows.base * len(rows.tool_names) + rows.tool)[known]
    spreads = [_tool_spread(expected, reading(quaternions[known]), group) for _, _, reading in READINGS]
    best = int(np.argmin(spreads))
    declared, least = np.degrees(spreads[0]), np.degrees(spreads[best])
    if best != 0 and spreads[best] < min(TRIALS.clearly_better * spreads[0], NOT_THE_TOOLS_RAD):
        statement, cure, _ = READINGS[best]
        seen = f" (the tool's orientation is usually {declared:.3g} degrees off as declared, {least:.2g} degrees so)"
        alone = " Until then positions are used alone." if spreads[0] > NOT_THE_TOOLS_RAD else ""
        return [Suspicion("problem", statement + seen, cure + alone, ORIENTED)]
    if spreads[0] > NOT_THE_TOOLS_RAD:
        statement = (
            f"the orientations scatter by {declared:.0f} degrees against the arm's, in whatever order they are read"
        )
        cure = "Are Euler angles in another sequence or unit, or are they of other rows? Positions are used alone."
        return [Suspicion("hint", statement, cure, ORIENTED)]
    return []


def _tool_spread(expected: Array, quaternions: Array, group: NDArray[np.intp]) -> float:
    """Median angle of the tool's orientation on the flange to its mean, per base frame and tool, rad."""
    from scipy.spatial.transform import Rotation  # slow to import, and few tables hold orientations

    on_flange = Rotation.from_matrix(np.swapaxes(expected, 1, 2)) * Rotation.from_quat(quaternions, scalar_first=True)
    away = np.empty(len(group))
    for number in np.unique(group):
        of_group = on_flange[group == number]
        away[group == number] = (of_group.mean().inv() * of_group).magnitude()
    return float(np.median(away))
