"""What the paper prints, as package data: Table 2, coefficients of Eqs. (9)-(20), and (15)-(17) read as physics."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

import numpy as np
import pandas as pd
import yaml
from numpy.typing import ArrayLike

from armscope.core.averages import rms_distance
from armscope.core.types import Array
from armscope.errormodels.features import FDP_AI, FDP_CI, SDP_AI, SDP_CI, FeatureSet, ModelSpec

AXES = ("x", "y", "z")
UNCOMPENSATED = "Uncompensated"
IDENTIFICATION = "identification"
TEST_TRAJECTORIES = ("test 1", "test 2", "test 3")
TRAJECTORIES = (IDENTIFICATION, *TEST_TRAJECTORIES)
PRINTED_MODELS: dict[str, ModelSpec] = {spec.name: spec for spec in (FDP_CI, FDP_AI, SDP_CI, SDP_AI)}
EQUATIONS = {"FDP(AI)": 9, "SDP(AI)": 12, "FDP(CI)": 15, "SDP(CI)": 18}
"""The number of each model's first equation (x); y and z follow."""

HALF_DIGIT_MM = 0.05  # Table 2 is printed with one decimal


def printed_table2() -> pd.DataFrame:
    """Table 2 (p. 961): columns model, trajectory, axis, printed. The paper says "RMS" and gives no unit."""
    with _data("table2.csv").open() as stream:
        return pd.read_csv(stream).rename(columns={"value": "printed"})


def printed_coefficients() -> pd.DataFrame:
    """Eqs. (9)-(20): columns model, equation, axis, term, coefficient, unit (mm per unit of the term)."""
    rows = []
    for key, by_axis in _equations().items():
        model = _model_name(key)
        for number, axis in enumerate(AXES):
            for term, value in by_axis[axis].items():
                rows.append((model, EQUATIONS[model] + number, axis, term, value, _unit(model, term)))
    return pd.DataFrame(rows, columns=["model", "equation", "axis", "term", "coefficient", "unit"])


def _unit(model: str, term: str) -> str:
    if term == "const":
        return "mm"
    _, power, exponent = term.partition("^")
    return f"mm/{'mm' if model.endswith('(CI)') else 'rad'}{power}{exponent}"


def printed_texts() -> dict[tuple[str, str, str], str]:
    """Eqs. (9)-(20) to the letter: (model, axis, term) -> coefficient as printed, trailing zeros and all."""
    return {
        (_model_name(key), axis, term): text
        for key, by_axis in _equation_texts().items()
        for axis in AXES
        for term, text in by_axis[axis].items()
    }


def printed_matrix(model: str) -> Array:
    """(3, terms) printed coefficients of "FDP(CI)", ..., in the order of `printed_features`."""
    by_axis = _equations()[model.replace("(", "_").rstrip(")")]
    terms = printed_features(model).term_names
    return np.array([[by_axis[axis][term] for term in terms] for axis in AXES], dtype=float)


def printed_half_digits(model: str) -> Array:
    """(3, terms) half of the last printed digit of each coefficient, in the order of `printed_features`."""
    by_axis = _equation_texts()[model.replace("(", "_").rstrip(")")]
    terms = printed_features(model).term_names
    decimals = [[len(by_axis[axis][term].partition(".")[2]) for term in terms] for axis in AXES]
    return 0.5 * 10.0 ** -np.array(decimals)


def printed_features(model: str) -> FeatureSet:
    """The terms of a printed model: px, py, pz, or theta1, theta2, theta3, theta6 of six (theta4 = theta5 = 0)."""
    spec = PRINTED_MODELS[model]
    if spec.space == "cartesian":
        return FeatureSet(spec, ("px", "py", "pz"), (True, True, True))
    names = tuple(f"theta{joint}" for joint in range(1, 7))
    return FeatureSet(spec, names, (True, True, True, False, False, True))


def predict_printed(model: str, inputs: ArrayLike) -> Array:
    """(N, 3) errors in mm that the printed equations predict at ``inputs``: (N, 3) mm, or (N, 6) rad."""
    return printed_features(model).matrix(inputs) @ printed_matrix(model).T


@cache
def _equations() -> dict[str, dict[str, dict[str, float]]]:
    content: dict[str, Any] = yaml.safe_load(_data("equations.yaml").read_text(encoding="utf-8"))
    return content


@cache
def _equation_texts() -> dict[str, dict[str, dict[str, str]]]:
    text: dict[str, Any] = yaml.load(_data("equations.yaml").read_text(encoding="utf-8"), Loader=yaml.BaseLoader)
    return text


def _model_name(key: str) -> str:
    return f"{key.replace('_', '(')})"


def _data(name: str) -> Any:
    return resources.files("armscope.paper") / "data" / name


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
