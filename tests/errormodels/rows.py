"""Made-up identification rows for the tests: a six-axis arm's joint angles, positions and errors."""

from __future__ import annotations

import numpy as np

from armscope.errormodels.features import ModelSpec
from armscope.errormodels.swarm_fit import FitProblem


def identification(
    rows: int = 85, still_wrist: bool = False, seed: int = 3
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Joint angles (rad, N x 6), positions (mm, N x 3) and errors (mm, N x 3)."""
    generator = np.random.default_rng(seed)
    reach = np.array([1.2, 0.7, 0.8, 1.0, 1.0, 2.0])
    angles = generator.uniform(-reach, reach, (rows, 6))
    if still_wrist:
        angles[:, 3:5] = 0.0
    forearm = 1000 + 600 * np.cos(angles[:, 1])
    positions = np.stack(
        [forearm * np.cos(angles[:, 0]), forearm * np.sin(angles[:, 0]), 800 + 900 * np.sin(angles[:, 2])], axis=1
    )
    errors = np.stack(
        [
            3 * np.sin(angles[:, 0]) + 2 * angles[:, 1],
            -1 + 4 * np.cos(2 * angles[:, 2]),
            4e-6 * positions[:, 2] * positions[:, 0],
        ],
        axis=1,
    )
    return angles, positions, errors + generator.normal(scale=0.3, size=errors.shape)


def problem(spec: ModelSpec, **of_rows: object) -> FitProblem:
    """The fit of ``spec`` to those rows."""
    angles, positions, errors = identification(**of_rows)
    return FitProblem(spec, angles if spec.space == "angular" else positions, errors, "made up")
