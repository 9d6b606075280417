"""What a motion tells of masses and friction, and what a path that excites little leaves unknown."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.core.words import rounded
from armscope.motion.constants import CHECK, LIBRARY
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.robot.dynamics import PARAMETERS
from armscope.verdict.schema import Notice


def identifiable(selected: SelectedCauses) -> dict[str, float]:
    """How many combinations of inertial parameters the motion tells, and their condition number."""
    values, _ = _spectrum(selected)
    telling = values[values > LIBRARY.redundant * values.max()]
    return {
        "parameters": float(len(values)),
        "combinations": float(len(telling)),
        "condition": float(telling.max() / telling.min()),
    }


def little_excited(selected: SelectedCauses) -> list[Notice]:
    """What is not known for a path that excites little; nothing of one that excites well."""
    told, condition = [], identifiable(selected)["condition"]
    if condition > CHECK.well_excited:
        told.append(
            f"The path excites little: condition number {rounded(condition)}, "
            f"where {CHECK.well_excited:g} at most is good. "
            f"Masses and inertias are known as stated, and not by this motion, {_weakest(selected)} least of all."
        )
    seen = {cause.joints[0] for cause in selected.rows.layout.placed if cause.cause is catalogue.ASYMMETRY}
    moving = {cause.joints[0] for cause in selected.rows.layout.placed if cause.cause is catalogue.DELAY}
    unseen = [str(j + 1) for j in sorted(moving - seen)]
    if unseen:
        joints = f"Joint{'s' if len(unseen) > 1 else ''} {', '.join(unseen)} move{'' if len(unseen) > 1 else 's'}"
        told.append(f"{joints} too slowly, or one way only: how friction follows speed and load is not known there.")
    if not told:
        return []
    return [Notice("little excited", " ".join([*told, "`armscope excite` plans a motion that shows it."]))]


def _spectrum(selected: SelectedCauses) -> tuple[Array, Array]:
    """(10 n,) singular values of the inertial columns, each column as long as the others, and their vectors."""
    G = selected.problem.equations.G
    inertial = selected.rows.layout.inertial
    own = G[np.ix_(inertial, inertial)]
    scale = np.sqrt(np.maximum(np.diag(own), 1e-300))
    values, vectors = np.linalg.eigh(own / np.outer(scale, scale))
    return np.sqrt(np.maximum(values, 0.0)), vectors


def _weakest(selected: SelectedCauses) -> str:
    """The inertial parameter that is most of the weakest combination that the motion tells."""
    values, vectors = _spectrum(selected)
    least = int(np.flatnonzero(values > LIBRARY.redundant * values.max())[0])
    link, parameter = divmod(int(np.argmax(np.abs(vectors[:, least]))), len(PARAMETERS))
    return f"{PARAMETERS[parameter]} of link {link + 1}"
