"""Orientations as files state them, as unit quaternions (w, x, y, z) with w >= 0."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.core.types import Array
from armscope.recordings.constants import POSSIBLE


class NotARotation(ValueError):
    """Numbers that are no rotation; ``row`` is the first one, ``rule`` and ``cure`` say why."""

    def __init__(self, row: int, found: object, rule: str, cure: str = "") -> None:
        super().__init__(rule)
        self.row, self.found, self.rule, self.cure = row, found, rule, cure


def from_quaternions(values: Array, order: str) -> Array:
    """(N, 4) in ``order`` ("wxyz" or "xyzw") to (N, 4) wxyz; NaN rows stay NaN. Raises NotARotation: a length that
    is not 1 within 1 %."""
    norm = np.linalg.norm(values, axis=1)
    wrong = np.flatnonzero(np.abs(norm - 1) > POSSIBLE.off_unit)
    if len(wrong):
        raise NotARotation(
            int(wrong[0]), values[wrong[0]].tolist(), f"a quaternion has length 1, this one {norm[wrong[0]]:.4g}"
        )
    scalar_last = values if order == "xyzw" else np.roll(values, -1, axis=1)
    return _quaternions(scalar_last, Rotation.from_quat)


def from_euler(angles: Array, sequence: str) -> Array:
    """(N, 3) rad to (N, 4) wxyz; capitals: about moving axes (intrinsic), small: about fixed axes (extrinsic)."""
    return _quaternions(angles, lambda known: Rotation.from_euler(sequence, known))


def from_rotation_vectors(vectors: Array) -> Array:
    """(N, 3) the axis times the angle, rad, to (N, 4) wxyz."""
    return _quaternions(vectors, Rotation.from_rotvec)


def from_matrices(values: Array) -> Array:
    """(N, 3, 3) to (N, 4) wxyz. Raises NotARotation: axes that are not of unit length and at right angles, or form a
    left-handed frame."""
    finite = np.isfinite(values).all(axis=(1, 2))
    off = np.abs(np.swapaxes(values, 1, 2) @ values - np.eye(3)).max(axis=(1, 2))
    wrong = np.flatnonzero(finite & (off > POSSIBLE.off_unit))
    if len(wrong):
        row = int(wrong[0])
        raise NotARotation(row, values[row].round(4).tolist(), "a rotation matrix has unit axes at right angles")
    left = np.flatnonzero(finite & (np.linalg.det(np.where(np.isfinite(values), values, 0)) < 0))
    if len(left):
        row = int(left[0])
        cure = "One axis of the instrument's frame is mirrored: flip its sign where the files come from."
        raise NotARotation(
            row, values[row].round(4).tolist(), "a rotation matrix is right-handed (determinant +1)", cure
        )
    return _quaternions(values, Rotation.from_matrix)


def _quaternions(values: Array, convert: object) -> Array:
    """Convert the rows without NaN, canonical sign, scalar first."""
    assert callable(convert)
    known = np.isfinite(values).reshape(len(values), -1).all(axis=1)
    quaternions = np.full((len(values), 4), np.nan)
    if known.any():
        quaternions[known] = np.roll(convert(values[known]).as_quat(canonical=True), 1, axis=1)
    return quaternions
