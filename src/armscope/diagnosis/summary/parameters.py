"""Fitted values as parameters in the field's units, with standard errors carried through."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.summary.constants import TELLING
from armscope.diagnosis.summary.turning_tilts import ROUND, runs_round, sense_of_round
from armscope.physics.backgrounds import GEOMETRIC
from armscope.physics.effect import Part, Placed
from armscope.physics.model import FittedModel
from armscope.verdict.effects import Parameter
from armscope.verdict.schema import TOOL_AS_STATED, Notice
from armscope.verdict.wording import plain

Reading = Callable[[Array], Array]


def parameters(placed: Placed, values: Array, covariance: Array) -> tuple[Parameter, ...]:
    """The parameters of an effect from its terms' values and covariance, SI units.

    Args:
        placed: the effect.
        values: (k,) of its terms, SI.
        covariance: (k, k) of them.

    Returns:
        Values with standard errors, files' units.
    """
    names, units, reading = _reading(placed, values, covariance)
    read = reading(values)
    if not names:
        return ()
    circles = np.array([2 * np.pi if name in ("phase", "direction") else np.inf for name in names])
    stderr = _spread(reading, values, covariance, circles)
    told = [
        Parameter(name, unit, float(value), float(error))
        for name, unit, value, error in zip(names, units, read, stderr, strict=True)
    ]
    told += [Parameter(name, unit, float(value), 0.0) for name, unit, value in placed.scanned]
    return tuple(told)


def beyond_plausible(parts: Sequence[Part]) -> Notice | None:
    """What to say where a value is larger than real arms show; None where none is."""
    beyond = [(part, term, value) for part in parts for term, value in part.implausible]
    if not beyond:
        return None
    listed = "; ".join(
        plain(f"{term.name} of {part.placed.location} by {value / term.si:+.3g} {term.unit}")
        for part, term, value in beyond[: TELLING.implausible_values]
    )
    if all(part.placed.effect.family != GEOMETRIC for part, _, _ in beyond):
        text = f"Larger than arms show: {listed}. Measure it by itself first: it may stand for something else."
        return Notice("implausible", text)
    text = (
        f"Larger than arms show that were built to their drawing: {listed}. Compare robot.yaml with the drawing first: "
        "is this another model of the arm, another convention of its rows, a number on the next row, or a wrong unit?"
    )
    return Notice("implausible", text)


def tool_as_stated(model: FittedModel) -> list[Notice]:
    """What to say where poses do not tell a tool point from the base."""
    return [
        Notice(
            TOOL_AS_STATED,
            f"These poses do not tell {each.tool} from {each.base}: {each.tool} is kept as stated, and where points "
            "lie in the arm's own base frame rests on tool_mm. In the measurement frame nothing does.",
        )
        for each in model.undetermined
    ]


def undetermined(placed: Placed, covariance: Array) -> tuple[str, ...]:
    """Names of parameters that the rows tell hardly better than is known of any arm; they are held near zero.

    Args:
        placed: the effect.
        covariance: (k, k) of its terms' values, SI units.

    Returns:
        Names; none of waves and curves, which are told as a whole.
    """
    if placed.parametrisation != "plain":
        return ()
    stderr = np.sqrt(np.diag(covariance))
    limits = [TELLING.undetermined * term.prior_size for term in placed.terms]
    return tuple(t.name for t, error, limit in zip(placed.terms, stderr, limits, strict=True) if error > limit)


def _reading(placed: Placed, values: Array, covariance: Array) -> tuple[list[str], list[str], Reading]:
    if placed.parametrisation == "sine" and len(placed.terms) == 2:
        return ["amplitude", "phase"], ["rad", "rad"], _wave
    if placed.parametrisation == "sine":
        names = ["amplitude", "phase", "direction", *["run_out"] * (len(placed.terms) > 4)]
        units = ["mm" if name == "run_out" else "rad" for name in names]
        if not runs_round(values, covariance):
            return names, units, _turning_wave
        del names[1], units[1]
        return names, units, _tilt_that_runs_round
    if placed.parametrisation == "curve":
        return [], [], lambda v: np.empty(0)  # a curve is told as a curve
    si = np.array([term.si for term in placed.terms])
    return [t.name for t in placed.terms], [t.unit for t in placed.terms], lambda v: v / si


def _wave(values: Array) -> Array:
    """(cosine, sine) as amplitude cos(k q - phase)."""
    cosine, sine = values
    return np.array([np.hypot(cosine, sine), np.arctan2(sine, cosine)])


def _turning_wave(values: Array) -> Array:
    """(cosine, sine) about x and about y as amplitude cos(k q - phase) about the best direction (cos, sin).

    Waves along x and y are a run-out, mm.
    """
    tilts, *shifts = values.reshape(-1, 2, 2)
    u, size, vt = np.linalg.svd(tilts)
    direction = float(np.arctan2(u[1, 0], u[0, 0]))
    phase = float(np.arctan2(vt[0, 1], vt[0, 0]))
    if not -np.pi / 2 < direction <= np.pi / 2:
        # the opposite direction half a period later is the same wobble
        direction = direction - np.sign(direction) * np.pi
        phase = phase - np.sign(phase) * np.pi
    return np.array([size[0], phase, direction, *(1e3 * np.linalg.norm(shift, 2) for shift in shifts)])


def _tilt_that_runs_round(values: Array) -> Array:
    """(cosine, sine) about x and about y as a tilt of one size that leans, at angle zero, about a direction.

    The longer half axis of an ellipse is too large for it: noise makes every circle an ellipse.
    """
    tilt, *shifts = values.reshape(-1, 4)
    sense = sense_of_round(tilt)
    x, y = ROUND[sense] @ tilt
    return np.array([np.hypot(x, y), np.arctan2(y, x), *(1e3 * np.linalg.norm(ROUND[sense] @ s) for s in shifts)])


def _spread(reading: Reading, values: Array, covariance: Array, circles: Array) -> Array:
    """Standard errors of a reading: root mean square change over the sigma points of the values' distribution.

    The 2 n points lie root n standard errors along the principal axes of the covariance (Julier & Uhlmann 1997): exact
    for linear readings, and right in size where a reading bends, as an amplitude does about zero, where a slope says
    nothing. Changes of a reading that goes in ``circles`` are taken the short way round.
    """
    unit = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    size, axes = np.linalg.eigh(covariance / np.outer(unit, unit))
    steps = unit[:, None] * axes * np.sqrt(len(values) * np.maximum(size, 0.0))
    middle = reading(values)
    changes = np.array([reading(values + sign * step) - middle for step in steps.T for sign in (1, -1)])
    turns = np.isfinite(circles)
    changes[:, turns] -= circles[turns] * np.round(changes[:, turns] / circles[turns])
    return np.asarray(np.sqrt(np.mean(changes**2, axis=0)))
