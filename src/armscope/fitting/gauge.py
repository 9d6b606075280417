"""Where recordings cannot tell base from tool: the tool point stays as stated, and the base takes what it would have.

A tool that keeps its attitude, as a palletiser's does, moves with the base as a shift of its point does: measured
points are the same, but not where the arm's own base stands beneath them, which is what commands are given in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.constants import GAUGE
from armscope.inference.constants import NUMERICS
from armscope.physics.effect import AXES, Term
from armscope.physics.frames import tool_key
from armscope.physics.model import AsStated


@dataclass(frozen=True, eq=False)
class FrameColumns:
    """Which columns of normal equations are free frames."""

    frames: Indices  # all of them
    tools: Indices  # (k,) those of tool points


@dataclass(frozen=True, eq=False)
class Gauge:
    """Directions of tool points that the rows do not tell from the base."""

    directions: Array  # (k, r) orthonormal
    response: Array  # (p, r) what all parameters change by if tool points move along them by one metre
    step: Array  # (p,) to the tool points as stated


def gauge(matrix: Array, information: Array, at: FrameColumns, deviation: Array, noise_mm: float) -> Gauge | None:
    """What is to be held as stated; None where rows tell all tool points, or refute them as stated.

    Args:
        matrix: (p, p) the normal equations with all that holds their parameters, (mm per SI unit)^2.
        information: (p, p) the same of the rows alone.
        at: where frames stand among the p columns.
        deviation: (k,) of the tool points from where they are stated, m.
        noise_mm: per axis.

    Returns:
        The directions, and the step to where they are held.
    """
    noise = max(noise_mm, GAUGE.least_noise_mm)
    directions = untold_directions(information, at, noise)
    if not directions.shape[1]:
        return None
    response, stiffness = _response(matrix, at.tools, directions)
    away = directions.T @ deviation
    if away @ stiffness @ away > directions.shape[1] * (GAUGE.refuted * noise) ** 2:
        return None
    return Gauge(directions, response, -response @ away)


def untold_directions(information: Array, at: FrameColumns, noise_mm: float) -> Array:
    """(k, r) along which tool points are told worse than a stated one is wrong, the arm being as it is.

    Args:
        information: (p, p) of the rows, (mm per SI unit)^2.
        at: where frames stand among the p columns.
        noise_mm: per axis.

    Returns:
        Orthonormal directions.
    """
    tools, others = at.tools, np.setdiff1d(at.frames, at.tools)
    size = np.sqrt(np.maximum(np.diag(information), 1e-300))
    scaled = information / np.outer(size, size)
    beside = scaled[np.ix_(others, tools)]
    left = scaled[np.ix_(tools, tools)] - beside.T @ _solved(scaled[np.ix_(others, others)], beside)
    left *= np.outer(size[tools], size[tools])
    told, directions = np.linalg.eigh((left + left.T) / 2)
    enough = max((noise_mm / (1e-3 * GAUGE.stated_tool_mm)) ** 2, NUMERICS.rounding * float(size[tools].max()) ** 2)
    return np.asarray(directions[:, told < enough])


def _response(matrix: Array, tools: Indices, directions: Array) -> tuple[Array, Array]:
    """(p, r) how all follow tool points along directions, and (r, r) by how much that raises the misfit."""
    turn, held = _turned(len(matrix), tools, directions)
    turned = turn.T @ matrix @ turn
    others = np.setdiff1d(np.arange(len(matrix)), held)
    following = np.zeros((len(matrix), len(held)))
    following[held, np.arange(len(held))] = 1.0
    following[others] = -_solved(turned[np.ix_(others, others)], turned[np.ix_(others, held)])
    stiffness = turned[np.ix_(held, held)] + turned[np.ix_(held, others)] @ following[others]
    return turn @ following, stiffness


def covariance_of_others(matrix: Array, tools: Indices, directions: Array) -> Array:
    """(p, p) inverse of a matrix with tool points held along directions: nothing is uncertain there.

    Args:
        matrix: (p, p) positive definite.
        tools: columns of the tool points.
        directions: (k, r) orthonormal.

    Returns:
        (p, p), times the noise's square a covariance.
    """
    turn, held = _turned(len(matrix), tools, directions)
    turned = turn.T @ matrix @ turn
    others = np.setdiff1d(np.arange(len(matrix)), held)
    inverse = np.zeros_like(matrix)
    inverse[np.ix_(others, others)] = _solved(turned[np.ix_(others, others)], np.eye(len(others)))
    return np.asarray(turn @ inverse @ turn.T)


def _turned(count: int, tools: Indices, directions: Array) -> tuple[Array, Indices]:
    """(p, p) orthogonal: the first of the tools' columns become those along directions; and which these are."""
    complete = np.linalg.qr(directions, mode="complete")[0]
    complete[:, : directions.shape[1]] = directions
    turn = np.eye(count)
    turn[np.ix_(tools, tools)] = complete
    return turn, tools[: directions.shape[1]]


def _solved(matrix: Array, right: Array) -> Array:
    """Least squares; columns are scaled, since what they are of has several units."""
    size = 1 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    found = np.linalg.lstsq(matrix * np.outer(size, size), right * size[:, None], rcond=NUMERICS.rounding)[0]
    return np.asarray(found * size[:, None])


@dataclass(frozen=True, eq=False)
class NamedFrames(FrameColumns):
    """Free frames among a fit's columns, x, y, z of each tool point, and what they are called."""

    bases: Indices  # columns of the bases' shifts, x, y, z of each
    names: tuple[str, ...]  # of the tools, as a sentence has them

    @classmethod
    def among(cls, terms: Sequence[Term], frames: Indices) -> NamedFrames:
        """Those among a fit's terms (p,)."""
        tools: dict[str, dict[str, int]] = {}
        bases: list[int] = []
        for column in frames.tolist():
            product = terms[column].products[0]
            axis = product.direction.axis
            if axis in AXES[:3] and product.direction.location == "tool":
                name = " in run ".join(filter(None, tool_key(product.driver)))
                tools.setdefault(name, {})[axis] = column
            elif axis in AXES[:3] and product.direction.location == "base":
                bases.append(column)
        at = [each[axis] for each in tools.values() for axis in AXES[:3]]
        return cls(frames, np.array(at, dtype=np.intp), np.array(bases, dtype=np.intp), tuple(tools))

    def told(self, held: Gauge) -> tuple[AsStated, ...]:
        """Which axes of which tools go with which of the bases."""
        parts = np.sum(held.directions**2, axis=1).reshape(-1, 3)
        base = f"base {_axes(np.sum(held.response[self.bases] ** 2, axis=1).reshape(-1, 3).sum(axis=0))}"
        seen = [n for n, part in enumerate(parts) if part.max() > GAUGE.share * parts.max()]
        if len(seen) == len(parts):
            return (AsStated(f"tool {_axes(parts.sum(axis=0))}", base),)
        return tuple(AsStated(f"tool of {self.names[n]} {_axes(parts[n])}", base) for n in seen)


def _axes(part: Array) -> str:
    return ", ".join(axis for axis, each in zip("xyz", part, strict=True) if each > GAUGE.share * part.max())
