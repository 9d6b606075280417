"""Where every effect's linear parameters stand among the columns."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import ColumnOrder, grouped_columns
from armscope.physics.effect import Placed, Term
from armscope.physics.model import FittedModel


@dataclass(frozen=True, eq=False)
class ParameterLayout:
    """All distinct terms that take part, and where each effect's terms stand among them."""

    terms: tuple[Term, ...]  # the columns, in order
    frames: Indices  # columns of the free frames
    background: tuple[Indices, ...]  # columns of each family's background
    background_scale: tuple[Array, ...]  # SI, size that each of these columns is expected to have
    columns: tuple[Indices, ...]  # columns of each effect

    @functools.cached_property
    def column_order(self) -> ColumnOrder:
        """The columns sorted by how they are best multiplied."""
        return grouped_columns(self.terms)

    def of(self, placed: Placed) -> Indices:
        """Columns of an effect whose terms are all in the layout."""
        return np.array([self.index[term] for term in placed.terms])

    def only(self, columns: Indices) -> ParameterLayout:
        """Some of the columns, in this order, for sums of them alone; which effects they are of is not known there."""
        none = np.empty(0, dtype=np.intp)
        return ParameterLayout(tuple(self.terms[n] for n in columns), none, (), (), ())

    @functools.cached_property
    def index(self) -> dict[Term, int]:
        """Where each term stands among the columns."""
        return {term: number for number, term in enumerate(self.terms)}


def parameter_layout(
    frames: Sequence[Placed], backgrounds: Sequence[Sequence[Placed]], effects: Sequence[Placed]
) -> ParameterLayout:
    """Gather the terms of all effects, each once.

    Args:
        frames: always free.
        backgrounds: by family.
        effects: that compete or are named.

    Returns:
        Terms, and which of them each effect has.
    """
    index: dict[Term, int] = {}

    def add(placed: Placed) -> Indices:
        return np.array([index.setdefault(term, len(index)) for term in placed.terms], dtype=np.intp)

    frame_columns = np.concatenate([add(p) for p in frames])
    scales = [{int(n): s for p in family for n, s in zip(add(p), p.prior_scale, strict=True)} for family in backgrounds]
    columns = tuple(add(p) for p in effects)
    return ParameterLayout(
        tuple(index),
        frame_columns,
        tuple(np.array(sorted(family), dtype=np.intp) for family in scales),
        tuple(np.array([family[column] for column in sorted(family)], dtype=np.float64) for family in scales),
        columns,
    )


def current_parameters(layout: ParameterLayout, model: FittedModel) -> Array:
    """(p,) the model's values of a layout's terms (frames count as zero: they are part of the linearisation point)."""
    values = np.zeros(len(layout.terms))
    for part in (*model.background, *model.parts):
        for term, value in zip(part.placed.terms, part.values, strict=True):
            values[layout.index[term]] += value
    return values
