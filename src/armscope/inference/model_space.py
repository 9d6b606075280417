"""What competes: candidates as sets of columns, and backgrounds of many small values; all of it data.

The inference knows columns, how large each is expected to be, and which candidates exclude, require or contain which.
What a candidate is in the world outside (an effect of a robot arm, say) is known to whoever builds the space.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices

BackgroundSizes = tuple[int, ...]
"""The size of each family's background: an index, 0 for none."""
NONE: frozenset[int] = frozenset()


@dataclass(frozen=True, eq=False)
class Candidate:
    """Columns that enter or leave a hypothesis together. Candidates are told by their numbers in the space."""

    # kind, location: of effect, and where; kinds are equally likely, and locations of one kind
    kind: str
    location: str
    columns: Indices  # (c,) its columns
    prior_scale: Array  # (c,) relative size that each column's coefficient is expected to have
    variant: str = ""  # which of several forms of the kind at this location
    # driver, label: what it follows, and its name, in words
    driver: str = ""
    label: str = ""
    family: str = ""  # what kind of cause it is; the background of that name takes the place of several of its kind
    looks_like: str = ""  # the background that does so instead, where it is another family's; "" where it is its own
    region: str = ""  # coarser than the location: what is taken out together when others are tried in its place
    multiplicity: int = 1  # how many values of a scanned number compete: the prior pays for them
    # (c,) how large each coefficient is expected to be in the columns' own units; None where nothing is known. The
    # smaller of the two counts: what rows don't tell stays within what is plausible
    plausible: Array | None = None
    # (c,) how large each is as a rule, so: much smaller ones are less likely; None where nothing is known
    usual: Array | None = None
    nonnegative: bool = False  # it has one coefficient, which can't be negative
    is_curve: bool = False  # a free curve, which contains special cases
    competes: bool = True  # it enters a search by itself; otherwise only in another's place
    excludes: frozenset[int] = NONE  # candidates that can't stand beside it
    requires: frozenset[int] | None = None  # it does nothing without one of these; None where it stands by itself
    special_cases: frozenset[int] = NONE  # candidates that the curve contains
    side_by_side: int = 1  # how many special cases of the curve may well stand side by side, beside what is ``common``
    common: frozenset[int] = NONE
    as_one: frozenset[int] = NONE  # special cases that are one cause, however many of them there are
    refines: int | None = None  # the candidate of which this is a finer form
    removed_with: frozenset[int] = NONE  # candidates with which, one at a time, it is taken out, too
    # columns of a background that add up to its own, where that has them in place of its own
    summed: frozenset[int] = NONE
    # (c,) of a curve of a load, what each coefficient does, SI units, where that is least; None of others
    at_rest: Array | None = None

    @property
    def held(self) -> Indices:
        """All columns that are zero where it is held at zero."""
        return np.union1d(self.columns, np.array(sorted(self.summed), dtype=np.intp))

    def is_in(self, columns: Indices) -> bool:
        """Whether a background of some columns holds it: by its own columns, or by those that add up to them."""
        inside = {int(column) for column in columns}
        return inside.issuperset(self.columns.tolist()) or (bool(self.summed) and self.summed <= inside)

    @property
    def key(self) -> tuple[str, str]:
        """(kind, location)."""
        return self.kind, self.location

    def excess(self, candidates: frozenset[int]) -> int:
        """By how many its special cases exceed what is common side by side; what is common counts beside too many."""
        inside = self.special_cases & candidates
        allowed = self.side_by_side + max(len(inside & self.as_one) - 1, 0)
        uncommon = len(inside - self.common)
        return (uncommon if uncommon <= allowed else len(inside)) - allowed

    @property
    def taken_up_by(self) -> str:
        """Name of the background that may take its place."""
        return self.looks_like or self.family

    @property
    def identity(self) -> tuple[str, str, str, str]:
        """What is the same for one candidate in several spaces."""
        return self.kind, self.location, self.driver, self.variant


class BackgroundFamily(Protocol):
    """Many small values that are allowed for without names."""

    @property
    def name(self) -> str:
        """The family's name."""

    @property
    def columns(self) -> Indices:
        """(c,) its columns."""

    @property
    def sizes(self) -> int:
        """How many sizes compete, none among them."""

    @property
    def is_priced(self) -> bool:
        """Whether it pays, as one kind of error among the others; one that everything real has is free."""

    @property
    def takes_one(self) -> bool:
        """Whether it may take the place of a single name of its family, not only of several."""

    def prior_variance(self, size: int, scale: Array) -> Array:
        """(c,) prior variances, mm^2, of the columns once they are divided by ``scale`` (p,).

        Args:
            size: index of the background's size.
            scale: (p,) by which columns are divided.

        Returns:
            (c,) mm^2.
        """

    def label(self, size: int) -> float:
        """The size as a number: a share of what is stated."""

    def without(self, columns: Indices) -> BackgroundFamily:
        """The family without some columns, whichever of them it has."""


@dataclass(frozen=True, eq=False)
class ToleranceFamily:
    """Values that have a tolerance each, in units of their own; the sizes are shares of it."""

    name: str  # of the family
    columns: Indices  # (c,) its columns
    tolerance: Array  # (c,) in the columns' own units
    shares: tuple[float, ...]  # of the tolerance, none first
    is_priced: bool = False  # whether it pays
    takes_one: bool = False  # whether it may take the place of a single name of its family, not only of several

    @property
    def sizes(self) -> int:
        """How many shares compete."""
        return len(self.shares)

    def prior_variance(self, size: int, scale: Array) -> Array:
        """As of `BackgroundFamily`."""
        return np.asarray((self.shares[size] * self.tolerance * scale[self.columns]) ** 2)

    def label(self, size: int) -> float:
        """Share of the tolerance."""
        return self.shares[size]

    def without(self, columns: Indices) -> ToleranceFamily:
        """The family without some columns, whichever of them it has."""
        kept = ~np.isin(self.columns, columns)
        return replace(self, columns=self.columns[kept], tolerance=self.tolerance[kept])


@dataclass(frozen=True)
class Exchange:
    """Candidates that leave all at once, each for its twin where it has one, while one more candidate enters."""

    twins: Mapping[int, int | None]  # of each candidate that leaves: what takes its place
    entering: tuple[int, ...]  # the candidates of which one enters; others of them leave


@dataclass(frozen=True, eq=False)
class Companion:
    """A family that is in wherever something is that it acts through, at its last size, and pays nothing."""

    family: BackgroundFamily  # known up to a tolerance, never none
    through: frozenset[int]  # candidates that it acts through
    backgrounds: frozenset[int]  # numbers of the families that it acts through

    def joins(self, candidates: Iterable[int], background: BackgroundSizes) -> bool:
        """Whether it is in a hypothesis of some candidates with some background."""
        return not self.through.isdisjoint(candidates) or any(background[n] for n in self.backgrounds)


@dataclass(frozen=True, eq=False)
class ModelSpace:
    """Everything that may take part."""

    frames: Indices  # columns that are always free
    families: tuple[BackgroundFamily, ...]  # the backgrounds
    candidates: tuple[Candidate, ...]  # what competes
    starts: tuple[BackgroundSizes, ...] = ()  # backgrounds from which a search starts
    exchanges: tuple[Exchange, ...] = ()  # moves of several candidates at once
    companions: tuple[Companion, ...] = ()  # what comes with others by itself

    @functools.cached_property
    def kinds(self) -> int:
        """How many kinds of candidates compete."""
        return max(len({candidate.kind for candidate in self.candidates}), 1)

    @property
    def no_background(self) -> BackgroundSizes:
        """No background at all."""
        return (0,) * len(self.families)

    @functools.cached_property
    def nonnegative(self) -> NDArray[np.bool_]:
        """Whether each candidate has one coefficient that can't be negative."""
        return np.array([candidate.nonnegative for candidate in self.candidates], dtype=np.bool_)

    @functools.cached_property
    def requires(self) -> dict[int, frozenset[int]]:
        """Candidates that do nothing by themselves, and those of which each of them needs one."""
        return {n: c.requires for n, c in enumerate(self.candidates) if c.requires is not None}

    def requirements_met(self, candidates: frozenset[int]) -> bool:
        """Whether every one of some candidates has what it requires."""
        return all(candidates & needed for number, needed in self.requires.items() if number in candidates)

    @functools.cached_property
    def _curves(self) -> tuple[Candidate, ...]:
        return tuple(candidate for candidate in self.candidates if candidate.is_curve and candidate.competes)

    @functools.cached_property
    def _excess(self) -> dict[frozenset[int], int]:
        """What was asked already: a search looks at the same effects with many sizes, folds and draws."""
        return {}

    def excess_special_cases(self, candidates: frozenset[int]) -> int:
        """By how many candidates some curve's special cases exceed what is common side by side."""
        if candidates not in self._excess:
            self._excess[candidates] = max((c.excess(candidates) for c in self._curves), default=0)
        return self._excess[candidates]

    @functools.cached_property
    def finer(self) -> dict[int, int]:
        """The finer form of each candidate that has one."""
        return {c.refines: n for n, c in enumerate(self.candidates) if c.refines is not None}

    @functools.cached_property
    def by_identity(self) -> dict[tuple[str, str, str, str], int]:
        """Numbers of the candidates that compete, by what is the same in several spaces."""
        return {c.identity: n for n, c in enumerate(self.candidates) if c.competes}
