"""Which poses tell two hypotheses apart: greedy, against what the rival could still adapt to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def separating(
    jacobian: Array, apart: Array, covariance: Array, noise: float, count: int
) -> tuple[NDArray[np.intp], Array]:
    """The poses where two predictions differ most, each chosen after the rival has adapted to those before.

    Args:
        jacobian: (N, 3, p) of the rival's parameters.
        apart: (N, 3) difference of the two predictions.
        covariance: (p, p) of the rival's parameters so far; each choice updates it.
        noise: 1-sigma per axis, in the unit of ``apart``.
        count: how many poses.

    Returns:
        Rows (count,) in the order of choice, and how far apart the predictions are there (count,).
    """
    chosen: list[int] = []
    separation: list[float] = []
    left = apart.copy()
    for _ in range(min(count, len(apart))):
        blocks = jacobian @ covariance @ np.swapaxes(jacobian, 1, 2) + noise**2 * np.eye(3)
        score = np.einsum("ni,ni->n", left, np.linalg.solve(blocks, left[:, :, None])[:, :, 0])
        score[chosen] = -1
        pose = int(np.argmax(score))
        chosen.append(pose)
        separation.append(float(np.linalg.norm(left[pose])))
        gain = covariance @ jacobian[pose].T @ np.linalg.inv(blocks[pose])
        left = left - jacobian @ (gain @ left[pose])
        covariance = covariance - gain @ jacobian[pose] @ covariance
    return np.array(chosen), np.array(separation)
