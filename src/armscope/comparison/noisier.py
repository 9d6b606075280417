"""Recordings of which more is left than of others, whatever is fitted: what grew there is no cause that was tried.

Each recording is fitted alone, with effects of its own, so that no cause that changed counts. What is left then is
noise, or what nobody modelled: a joint that became loose, a curve without a name, a target that came off. A few bad
shots are none of these, so it is measured by medians.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri, ndtr

from armscope.comparison.constants import COMPARING, GROWN
from armscope.core.types import Array
from armscope.core.words import enumerated, size_of
from armscope.fitting.joint_scatter import find_scatter
from armscope.verdict.constants import WORDS
from armscope.verdict.wording import millimetres


@dataclass(frozen=True)
class Scatter:
    """A joint that stands a little elsewhere in each row: where, and its standard deviation.

    Of few rows, what is fitted takes part of it along: it is that much or more.
    """

    location: str
    size_rad: float


@dataclass(frozen=True)
class Noisier:
    """A recording of which more is left than of another one."""

    name: str
    than: str  # the recording that it is held against
    left_mm: float  # what its own fit leaves, per axis, by the median of its rows
    usual_mm: float  # the same of the other recording
    p: float  # how often chance makes it as much more, all recordings counted
    scatter: tuple[Scatter, ...]  # joints along whose turning it is left, where it has such a place

    @property
    def told(self) -> str:
        """What is left where, and what that may be, in two sentences."""
        said = f'"{self.name}" is left with {millimetres(self.left_mm)} per axis whatever is fitted, "{self.than}"'
        said += f" with {millimetres(self.usual_mm)}"
        if not self.scatter:
            return f"{said}: more noise, or something that no cause tried describes. {OF_THE_INSTRUMENT}"
        places = [f"{each.location} (by {size_of(each.size_rad, 'rad')} or more)" for each in self.scatter]
        turns = enumerated(places)
        return f"{said}, as if {turns} stood elsewhere each time: no cause tried follows it. {OF_A_JOINT}"


def told_of(found: Sequence[Noisier]) -> str:
    """All of them in words, the noisiest first; empty where there is none."""
    more = len(found) - WORDS.causes
    others = f"More is left of {more} others, too." if more > 0 else ""
    return " ".join([*(each.told for each in found[: WORDS.causes]), *filter(None, [others])])


OF_THE_INSTRUMENT = "Was it the same instrument, as near, and did target and base sit as firmly?"
OF_A_JOINT = "Look for what became loose there, and diagnose that recording alone."


@dataclass(frozen=True, eq=False)
class LeftOver:
    """What is left of a recording."""

    alone: Array  # (N, 3) mm, base axes: with effects of its own, no cause counts, but few rows are fitted too well
    free: float  # how many of the 3N numbers are free then
    # (N, 3) mm: with what all recordings share and what changed, the quiet ones keep the place of the rest
    together: Array
    moved: Array  # (m, N, 3) tool displacement by each motor, mm/rad

    @property
    def variance(self) -> float:
        """Per axis, mm^2, by the median of the rows' squared distances."""
        distances = np.median(np.sum(self.alone**2, axis=1))
        return float(distances / chdtri(3, 0.5)) * self.alone.size / self.free


def noisier(
    names: Sequence[str], families: Sequence[Sequence[int]], left_over: Sequence[LeftOver], dispersion: float
) -> tuple[Noisier, ...]:
    """The recordings of which clearly more is left than of the middle one of their family, the noisiest first.

    Args:
        names: of the recordings.
        families: numbers of recordings that are of the same poses.
        left_over: what is left of each.
        dispersion: by how much neighbouring rows are less independent than they seem.

    Returns:
        Those that are left with `GROWN.times` as much or more, and not by chance.
    """
    found = []
    for family in (each for each in families if len(each) > 1):
        middle = sorted(family, key=lambda k: left_over[k].variance)[(len(family) - 1) // 2]
        for k in family:
            p = min(1.0, by_chance(left_over[k], left_over[middle], dispersion) * len(family))
            left, usual = (float(np.sqrt(left_over[of].variance)) for of in (k, middle))
            if left >= GROWN.times * usual and p <= COMPARING.level:
                places = _grown(left_over[k], left_over[middle])
                found.append(Noisier(names[k], names[middle], left, usual, p, places))
    return tuple(sorted(found, key=lambda each: -each.left_mm / each.usual_mm))


def along_joints(found: Sequence[Noisier]) -> float:
    """How much larger the variance of what is left may be along a joint's turning than per axis, as changes take it.

    A joint that stands elsewhere each time moves the tool along one direction. All that is more than usual lies along
    it, and not a third: what looks like a change of that joint, or of one beside it, is that much less sure.
    """
    return max([1.0, *(3 - 2 * (each.usual_mm / each.left_mm) ** 2 for each in found if each.scatter)])


def by_chance(one: LeftOver, other: LeftOver, dispersion: float) -> float:
    """How often noise of one size leaves as much more of one recording than of another.

    The logarithm of a median of squared distances in space has the variance 1 / (4 N (f m)^2), with the density f of
    chi-squared of three degrees at its median m (Mosteller 1946).

    Args:
        one: of which more is left.
        other: of which less is.
        dispersion: by how much rows are less independent than they seem.

    Returns:
        The probability, one-sided.
    """
    median = chdtri(3, 0.5)
    density = np.sqrt(median / (2 * np.pi)) * np.exp(-median / 2)
    per_row = 1 / (4 * (density * median) ** 2)
    variance = dispersion * per_row * (3 / one.free + 3 / other.free)
    return float(ndtr(-np.log(one.variance / other.variance) / np.sqrt(variance)))


def _grown(one: LeftOver, other: LeftOver) -> tuple[Scatter, ...]:
    """The joints along which clearly more is left than in the other recording."""
    least = float(np.sqrt(other.variance))
    before = {each.motor: each.size for each in find_scatter(other.together, other.moved, least)}
    grown = [
        Scatter(f"joint {each.motor}", each.size)
        for each in find_scatter(one.together, one.moved, least)
        if each.size >= GROWN.times * before.get(each.motor, 0.0)
    ]
    return tuple(sorted(grown, key=lambda each: -each.size_rad))
