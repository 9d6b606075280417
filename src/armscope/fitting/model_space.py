"""All columns that take part, and where each effect's stand among them."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import ColumnOrder, grouped_columns
from armscope.physics.effect import Placed, Term, clash


@dataclass(frozen=True, eq=False)
class Pool:
    """All distinct terms that take part, and where each effect's terms stand among them.

    Attributes:
        terms: the columns, in order.
        frames: columns of the free frames.
        background: columns of each family's background, in the order of `armscope.physics.backgrounds.FAMILIES`.
        background_shape: relative size that each of these columns is expected to have.
        candidates: effects that compete.
        columns: columns of each candidate.
    """

    terms: tuple[Term, ...]
    frames: Indices
    background: tuple[Indices, ...]
    background_shape: tuple[Array, ...]
    candidates: tuple[Placed, ...]
    columns: tuple[Indices, ...]

    @functools.cached_property
    def excludes(self) -> tuple[frozenset[int], ...]:
        """For each candidate, those that can't stand beside it: other forms of it, and curves that contain it."""
        places: dict[str, list[int]] = {}
        for number, placed in enumerate(self.candidates):
            places.setdefault(placed.location, []).append(number)
        return tuple(
            frozenset(
                other for other in places[placed.location] if other != number and clash(placed, self.candidates[other])
            )
            for number, placed in enumerate(self.candidates)
        )

    @functools.cached_property
    def special_cases(self) -> tuple[tuple[frozenset[int], int], ...]:
        """For every free curve, the candidates that it contains, and how many of them may well stand side by side.

        What follows a joint's own angle is one, as a rule; an offset and a compliance are a common pair.
        """
        return tuple(
            (
                frozenset(n for n in self.excludes[number] if self.candidates[n].parametrisation != "curve"),
                1 if placed.variant == "angle" else 2,
            )
            for number, placed in enumerate(self.candidates)
            if placed.parametrisation == "curve" and not placed.refinement
        )

    def excess_special_cases(self, candidates: frozenset[int]) -> int:
        """By how many effects some curve's special cases at one place exceed what is common."""
        return max((len(special & candidates) - common for special, common in self.special_cases), default=0)

    @functools.cached_property
    def requires(self) -> dict[int, frozenset[int]]:
        """Candidates that do nothing by themselves, and those that each of them can rest on."""
        return {
            number: frozenset(
                n
                for n, other in enumerate(self.candidates)
                if other.family == placed.effect.requires and not other.effect.requires
            )
            for number, placed in enumerate(self.candidates)
            if placed.effect.requires
        }

    @functools.cached_property
    def nonnegative(self) -> NDArray[np.bool_]:
        """Whether each candidate has one value that can't be negative."""
        return np.array(
            [placed.effect.nonnegative and len(placed.terms) == 1 for placed in self.candidates], dtype=np.bool_
        )

    def requirements_met(self, candidates: frozenset[int]) -> bool:
        """Whether every one of some candidates has what it rests on."""
        return all(candidates & needed for number, needed in self.requires.items() if number in candidates)

    @functools.cached_property
    def column_order(self) -> ColumnOrder:
        """The columns sorted by how they are best multiplied."""
        return grouped_columns(self.terms)

    def of(self, placed: Placed) -> Indices:
        """Columns of an effect whose terms are all in the pool."""
        return np.array([self.index[term] for term in placed.terms])

    @functools.cached_property
    def index(self) -> dict[Term, int]:
        """Where each term stands among the columns."""
        return {term: number for number, term in enumerate(self.terms)}


def pool(frames: Sequence[Placed], backgrounds: Sequence[Sequence[Placed]], candidates: Sequence[Placed]) -> Pool:
    """Gather the terms of all effects, each once."""
    index: dict[Term, int] = {}

    def add(placed: Placed) -> Indices:
        return np.array([index.setdefault(term, len(index)) for term in placed.terms], dtype=np.intp)

    frame_columns = np.concatenate([add(p) for p in frames])
    shapes = [{int(n): s for p in family for n, s in zip(add(p), p.prior_scale, strict=True)} for family in backgrounds]
    columns = tuple(add(p) for p in candidates)
    return Pool(
        tuple(index),
        frame_columns,
        tuple(np.array(sorted(family), dtype=np.intp) for family in shapes),
        tuple(np.array([family[column] for column in sorted(family)], dtype=np.float64) for family in shapes),
        tuple(candidates),
        columns,
    )
