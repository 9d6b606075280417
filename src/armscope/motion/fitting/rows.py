"""Rows of torque and model: every column formed at full rate, filtered as the torque is, and kept every n-th time."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices, Progress, unheard
from armscope.motion.fitting.model_estimate import Estimate
from armscope.motion.fitting.modelled_samples import StatedSamples, friction, modelled_samples, stated_samples
from armscope.motion.fitting.pauses import Pauses, joined, pauses_of, stands
from armscope.motion.library.dry_friction import ChangeOfSides
from armscope.motion.library.laws import FOLLOWS_MODEL, Law
from armscope.motion.library.layout import CAUSES_OF_OWN, OWN, TorqueLayout
from armscope.motion.samples.preparation import Preparation, parts
from armscope.motion.samples.timing import Stretch


@dataclass(frozen=True, eq=False)
class MotionRows:
    """K rows of m joints."""

    layout: TorqueLayout  # of the columns
    # time, run, stretch: (K,) of each row
    time: Array
    run: NDArray[np.str_]
    stretch: Indices
    # q, dq: (K, m) positions, velocities
    q: Array
    dq: Array
    # torque, nominal: (K, m) measured, as motors' torque, low-passed; and what the stated masses ask for
    torque: Array
    nominal: Array
    # (K, m) that tell nothing: a joint stands, and its friction may be anything; or its torque was cut off
    still: NDArray[np.bool_]
    # columns, at: of each joint (K, p_j), and (p_j,) where these columns stand
    columns: tuple[NDArray[np.float32], ...]
    at: tuple[Indices, ...]
    # (m,) by which recorded torque exceeds the true one, as far as known: times as much of every column that is true
    # torque is recorded. A gain's own column is the stated torque, so that (1 + gain) (stated + added) = stated + gain
    # * stated + (1 + gain) added is linear but for that factor
    gain: Array
    # (m,) s later than the speed, at which friction changes sides in columns; what is told is beyond that
    turning: Array
    samples: tuple[StatedSamples, ...]  # that they were formed of
    pauses: tuple[Pauses, ...]  # of each joint, in which it is held by nobody knows what

    def __len__(self) -> int:
        return len(self.time)

    def modelled(self, coefficients: Array, which: Indices | slice = slice(None)) -> Array:
        """(K, m) torque that coefficients (p,) add to the nominal one, in all rows or some."""
        index, shares = self.layout.made_of_masses
        whole = coefficients.copy()
        whole[self.layout.inertial] += shares @ coefficients[index]
        found = np.column_stack([self._at(j, whole, which) for j in range(len(self.columns))])
        if not self.layout.differs_by_run:
            return found
        run = self.run[which]
        for name in np.unique(run):
            there = np.flatnonzero(run == name)
            lacking = np.zeros(len(coefficients))
            lacking[self.layout.inertial] = (shares - self.layout.shares_in(str(name))) @ coefficients[index]
            if np.any(lacking):
                rows = np.arange(len(self))[which][there]
                found[there] -= np.column_stack([self._at(j, lacking, rows) for j in range(len(self.columns))])
        return found

    def stated_payload(self, runs: Sequence[str]) -> float:
        """Kg that are stated in some runs, or in all where none is given, in the mean of their samples."""
        there = [each.signals for each in self.samples if not runs or each.signals.run in runs]
        stated = [np.zeros(len(each.time)) if each.payload is None else each.payload for each in there]
        return float(np.mean(np.concatenate(stated))) if stated else 0.0

    @property
    def moving(self) -> NDArray[np.bool_]:
        """(K, m) where a joint moves and no force of a pause is most of what a row holds."""
        return ~(self.still | np.column_stack([own.holding(len(self)) for own in self.pauses]))

    def without_pauses(self, left: Array) -> Array:
        """What a model leaves (K, m), without what goes with the forces that hold joints in pauses."""
        return np.column_stack([own.without(each) for own, each in zip(self.pauses, left.T, strict=True)])

    def _at(self, joint: int, whole: Array, which: Indices | slice) -> Array:
        """(K,) of one joint; ``whole``: coefficients (p,) with combinations of masses counted in."""
        at = self.at[joint]
        used = np.flatnonzero(whole[at])
        recorded = (self.gain_of_columns(joint) * whole[at])[used].astype(np.float32)
        return (self.columns[joint][which][:, used] @ recorded).astype(np.float64)

    def gain_of_columns(self, joint: int) -> Array:
        """(p_j,) by which each column of a joint is recorded: 1 of what is no true torque."""
        return np.where(np.isin(self.at[joint], self.layout.of_readings), 1.0, self.gain[joint])


def build_rows(
    layout: TorqueLayout,
    stretches: Sequence[Stretch],
    how: Preparation,
    model: Estimate,
    progress: Progress = unheard,
    before: MotionRows | None = None,
) -> MotionRows:
    """All rows of a table.

    Args:
        layout: of the columns.
        stretches: even samples, ``effort`` in N m.
        how: filters and decimation.
        model: of which load, delay and gain are functions.
        progress: hears how far it is.
        before: the same rows for another model, whose columns stay where they don't follow it; scanned numbers may
            differ.

    Returns:
        The rows, in the order of the stretches.
    """
    pieces, done, total = [], 0, sum(len(stretch) for stretch in stretches)
    fresh = range(len(layout.placed)) if before is None else _following(layout, before.layout)
    if before is None:
        made = (_Piece(layout, *stated_samples(layout.arm, signals), how, model) for signals in parts(stretches, how))
    else:
        made = (_Piece(layout, samples, None, how, model) for samples in before.samples)
    for piece in made:
        pieces.append(piece.rows(fresh))
        done += len(piece.signals.kept) * how.every
        progress("forming the model's columns", min(done / total, 1.0))
    return _joined(layout, pieces) if before is None else _renewed(layout, before, pieces)


def _following(layout: TorqueLayout, before: TorqueLayout) -> list[int]:
    """Numbers of the causes whose columns another model changes, or another scanned number."""
    return [
        number
        for number, (cause, old) in enumerate(zip(layout.placed, before.placed, strict=True))
        if cause is not old or (isinstance(cause.columns, Law) and cause.columns.kind in FOLLOWS_MODEL)
    ]


def _joined(layout: TorqueLayout, pieces: list[MotionRows]) -> MotionRows:
    whole = {
        name: np.concatenate([getattr(piece, name) for piece in pieces])
        for name in ("time", "run", "stretch", "q", "dq", "torque", "nominal", "still")
    }
    at, columns = pieces[0].at, []
    for j in range(len(at)):
        columns.append(np.concatenate([piece.columns[j] for piece in pieces]))
    samples = tuple(each for piece in pieces for each in piece.samples)
    pauses, (gain, turning) = joined([(len(each), each.pauses) for each in pieces]), (pieces[0].gain, pieces[0].turning)
    return MotionRows(
        layout, columns=tuple(columns), at=at, gain=gain, turning=turning, samples=samples, pauses=pauses, **whole
    )


def _renewed(layout: TorqueLayout, before: MotionRows, pieces: list[MotionRows]) -> MotionRows:
    columns, nominal, stated = [], before.nominal, np.nan_to_num(layout.arm.stated_background)
    for j, (old, at) in enumerate(zip(before.columns, before.at, strict=True)):
        fresh, where = old.copy(), np.searchsorted(at, pieces[0].at[j])
        fresh[:, where] = np.concatenate([piece.columns[j] for piece in pieces])
        columns.append(fresh)
        own = np.searchsorted(at, OWN * j + np.arange(CAUSES_OF_OWN))
        if np.any(moved := (fresh[:, own] - old[:, own]) @ stated[j]):  # friction that is stated turns as late
            nominal = nominal.copy() if nominal is before.nominal else nominal
            nominal[:, j] += moved
    of = replace(before, gain=pieces[0].gain, turning=pieces[0].turning)
    return replace(of, layout=layout, columns=tuple(columns), nominal=nominal)


class _Piece:
    """Some samples, with what the model says of them, on the way to rows."""

    def __init__(
        self, layout: TorqueLayout, samples: StatedSamples, regressor: Array | None, how: Preparation, model: Estimate
    ) -> None:
        self.layout, self.samples, self.how, self.regressor = layout, samples, how, regressor
        self.gain = np.ones(layout.arm.n_motors) if model.gain is None else model.gain
        self.turning = np.zeros(layout.arm.n_motors) if model.turning is None else model.turning
        arm, signals = layout.arm, samples.signals
        self.arm, self.signals = arm, signals
        turning = ChangeOfSides.of(arm, self.turning, layout.width_of_sides, layout.order_of_sides)
        at = modelled_samples(arm, samples, model, turning, how, regressor)
        self.background, self.moment, self.rounded = at.own, at.moment, at.rounded

    def low(self, values: Array) -> Array:
        """The rows of samples."""
        return self.how.low_passed(values, self.signals.kept, self.signals.stride)

    def rows(self, causes: Iterable[int]) -> MotionRows:
        """Rows with the columns of some causes; with the inertial ones where these were formed."""
        layout, signals, kept, m = self.layout, self.signals, self.signals.kept, self.layout.arm.n_motors
        own = self._own_columns(causes)
        columns, at = [], []
        regressor = None if self.regressor is None else self.low(self.regressor)
        for j in range(m):
            of_joint, where = own[j]
            gain = [self.moment.read[:, j]] if len(layout.gains) and self.moment.read is not None else []
            made = [self.low(np.column_stack([self.background[:, j], *of_joint, *gain, self.rounded[:, j]]))]
            index = [OWN * j + np.arange(OWN), *where, layout.gains[j : j + 1] if gain else layout.gains]
            index.append(layout.response)
            if regressor is not None:
                made.append(regressor[:, j] * layout.inertial_scale)
                index.append(layout.inertial)
            order = np.argsort(np.concatenate(index))
            columns.append(np.hstack(made)[:, order].astype(np.float32))
            at.append(np.concatenate(index)[order])
        still = stands(layout.arm, signals, self.moment.rate)[kept] | (False if signals.cut is None else signals.cut)
        fresh = regressor is not None  # else they are the rows' that are renewed
        return MotionRows(
            layout=layout,
            pauses=pauses_of(layout.arm, signals, self.how, still) if fresh else (),
            time=signals.time[kept],
            run=np.full(len(kept), signals.run),
            stretch=np.full(len(kept), signals.stretch),
            q=signals.q[kept],
            dq=signals.dq[kept],
            torque=signals.effort,
            nominal=np.zeros((len(kept), m)) if regressor is None else self._nominal(regressor),
            still=still,
            columns=tuple(columns),
            at=tuple(at),
            gain=self.gain,
            turning=self.turning,
            samples=(self.samples,),
        )

    def _nominal(self, regressor: Array) -> Array:
        stated = np.nan_to_num(self.arm.stated_background)
        nominal = regressor @ self.arm.inertial
        if np.any(stated):
            nominal += self.low(friction(self.background, stated))
        return nominal if self.signals.payload is None else nominal + self.low(np.asarray(self.samples.carried))

    def _own_columns(self, causes: Iterable[int]) -> list[tuple[list[Array], list[Indices]]]:
        """By joint: columns (N, c) of causes, and where they stand."""
        own: list[tuple[list[Array], list[Indices]]] = [([], []) for _ in range(self.arm.n_motors)]
        for number in causes:
            cause, index = self.layout.placed[number], self.layout.columns[number]
            if cause.columns is not None:
                values = cause.columns_in(self.moment)
                for n, joint in enumerate(cause.joints):
                    own[joint][0].append(values[:, n])
                    own[joint][1].append(index)
        return own
