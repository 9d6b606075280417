"""Eqs. (15)-(17) read as physics: a displacement that is linear in position is a rigid motion, a scale and a rest."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from armscope.core.averages import rms_distance
from armscope.paper.printed import AXES, printed_matrix


def reading(points_mm: ArrayLike) -> pd.DataFrame:
    """The printed equations as rotation + translation + scale + rest, and what each part moves on the given points.

    Args:
        points_mm: (N, 3) tool points over which the parts are weighed (identification poses), mm.

    Returns:
        Columns quantity, value, unit, meaning. delta = t + G p with G = scale 1 + [rotation]x + rest (symmetric,
        without trace); the translation is given at the robot's base and at the points' centre.
    """
    points = np.asarray(points_mm, dtype=float)
    coefficients = printed_matrix("FDP(CI)")
    translation, gradient = coefficients[:, 0], coefficients[:, 1:]
    turn = (gradient - gradient.T) / 2
    rotation = np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
    scale = float(np.trace(gradient)) / 3
    rest = (gradient + gradient.T) / 2 - scale * np.eye(3)
    centre = points.mean(axis=0)
    arms = points - centre
    shares = {
        "translation of the centre": np.broadcast_to(translation + gradient @ centre, points.shape),
        "rotation": np.cross(rotation, arms),
        "scale": scale * arms,
        "rest": arms @ rest.T,
    }
    rows = [("rotation", float(np.linalg.norm(rotation)) * 1e3, "mrad", "size of the rotation vector")]
    for axis, k in zip(AXES, range(3), strict=True):
        moved_centre = shares["translation of the centre"][0, k]
        rows += [
            (f"rotation about {axis}", rotation[k] * 1e3, "mrad", "base frame"),
            (f"translation {axis}", translation[k], "mm", "at the base's origin"),
            (f"translation {axis} of the centre", moved_centre, "mm", "at the points' centre"),
        ]
    rows.append(("scale", scale * 100, "%", "negative: measured distances are shorter than nominal ones"))
    rows.append(
        ("rest", float(np.linalg.norm(rest)) * 1e3, "mm/m", "Frobenius norm of what is neither motion nor scale")
    )
    for name, value in zip(("largest", "middle", "smallest"), np.linalg.eigvalsh(rest)[::-1], strict=True):
        rows.append((f"rest, {name} strain", value * 1e3, "mm/m", "principal strain of the rest"))
    total = points @ gradient.T + translation
    for name, part in {"all": total, **shares}.items():
        moved = rms_distance(part)
        rows.append((f"RMS moved by {name}", moved, "mm", "3D root mean square over the points"))
    return pd.DataFrame(rows, columns=["quantity", "value", "unit", "meaning"])
