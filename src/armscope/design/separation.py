"""Which poses tell two hypotheses apart: greedy, against what the rival could still adapt to."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array, Indices


def separating(jacobian: Array, apart: Array, covariance: Array, noise: float, count: int) -> tuple[Indices, Array]:
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
    n, _, p = jacobian.shape
    # each choice changes the covariance by rank three, so that nothing but these products has to follow it
    spread = (jacobian.reshape(3 * n, p) @ covariance).reshape(n, 3, p)
    blocks = spread @ np.swapaxes(jacobian, 1, 2) + noise**2 * np.eye(3)
    for _ in range(min(count, n)):
        score = np.einsum("ni,ni->n", left, np.linalg.solve(blocks, left[:, :, None])[:, :, 0])
        score[chosen] = -1
        pose = int(np.argmax(score))
        chosen.append(pose)
        separation.append(float(np.linalg.norm(left[pose])))
        across = (spread.reshape(3 * n, p) @ jacobian[pose].T).reshape(n, 3, 3)
        gain = across @ np.linalg.inv(blocks[pose])
        left = left - gain @ left[pose]
        spread = spread - (gain.reshape(3 * n, 3) @ spread[pose]).reshape(n, 3, p)
        blocks = blocks - gain @ np.swapaxes(across, 1, 2)
    return np.array(chosen), np.array(separation)
