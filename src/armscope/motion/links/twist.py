"""Links beside their motors, where both are recorded: a second channel beside torque.

A motor that stands at q_m drives its link through a gear, a belt, a shaft: the link is at q_l = q_m + zero - torque /
stiffness (Spong 1987). Torque is what the links ask of the joint, by the masses that were fitted to the torques, moving
as the links' own encoders say. Position and torque are different readings with noise of their own, so each joint's
difference is weighed by itself, with the torque channel's fit as what is known of the load.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import Candidate, ModelSpace
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, build_problem
from armscope.inference.search import Search
from armscope.measurement.robust import huber_weights
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.consistency import agreement_of
from armscope.motion.fitting.model_estimate import Estimate
from armscope.motion.fitting.selected import coefficients_of
from armscope.motion.fitting.selection import blocks_of
from armscope.motion.fitting.weights import autocorrelation_time
from armscope.motion.library.causes import Moment, PlacedCause, Seen
from armscope.motion.library.twist_catalogue import clash, place_twists
from armscope.motion.library.twist_constants import TWIST
from armscope.motion.model.link_motion import moment_of_links
from armscope.motion.samples.preparation import Preparation, Signals, parts
from armscope.motion.samples.timing import Stretch
from armscope.motion.summary.foretelling import held_out_gains
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class TwistRows:
    """K rows of one joint."""

    joint: int  # from 0
    placed: tuple[PlacedCause, ...]  # its zero, and what competes
    # run, stretch: (K,) of each row
    run: NDArray[np.str_]
    stretch: Indices
    measured: Array  # (K,) link less motor, rad (m), low-passed
    torque: Array  # (K,) through the joint, N m (N), low-passed alike
    columns: Array  # (K, p) of all that is placed, rad (m) per unit, low-passed alike

    def __len__(self) -> int:
        return len(self.measured)

    @property
    def at(self) -> list[Indices]:
        """Where the columns of each placed cause stand."""
        ends = np.cumsum([cause.width for cause in self.placed])
        return [np.arange(end - cause.width, end) for cause, end in zip(self.placed, ends, strict=True)]


@dataclass(frozen=True, eq=False)
class SelectedTwist:
    """What the evidence asks for at one joint."""

    rows: TwistRows  # its rows
    blocks: list[NormalEquations]  # sums over runs, or parts of one
    # space, problem, best: what competed, on which sums, and what won; candidate n is cause n + 1 of the rows
    space: ModelSpace
    problem: Problem
    best: Hypothesis

    @property
    def coefficients(self) -> Array:
        """(p,) SI."""
        return coefficients_of(self.problem, self.best)


def twist_rows(seen: Seen, stretches: Sequence[Stretch], how: Preparation, model: Estimate) -> list[TwistRows]:
    """Rows of every joint whose link is recorded.

    Args:
        seen: what the table shows.
        stretches: even samples.
        how: filters and decimation; those of the torques.
        model: the masses that these ask for.

    Returns:
        None of a joint with too few.
    """
    joints = [] if seen.both_sides is None else [int(j) for j in np.flatnonzero(seen.both_sides)]
    made = [_Part.of(seen.arm, signals, how, model) for signals in parts(stretches, how)] if joints else []
    return [_joined(seen, j, made, how) for j in joints if sum(len(p.torque) for p in made) >= TWIST.least_rows]


@dataclass(frozen=True, eq=False)
class _Part:
    signals: Signals
    moment: Moment
    torque: Array

    @classmethod
    def of(cls, arm: MovingArm, signals: Signals, how: Preparation, model: Estimate) -> _Part:
        moment = moment_of_links(arm, signals, model, how.rate / signals.stride)
        return cls(signals, moment, how.low_passed(moment.rigid, signals.kept, signals.stride))


def _joined(seen: Seen, j: int, made: list[_Part], how: Preparation) -> TwistRows:
    torque = np.concatenate([part.torque[:, j] for part in made])
    placed = place_twists(seen, j, torque)
    columns, measured = [], []
    for part in made:
        formed = np.column_stack([c.columns(part.moment)[:, 0] for c in placed if c.columns is not None])
        columns.append(how.low_passed(formed, part.signals.kept, part.signals.stride))
        assert part.signals.twist is not None
        measured.append(part.signals.twist[:, j])
    counts = [len(part.torque) for part in made]
    return TwistRows(
        joint=j,
        placed=placed,
        run=np.repeat(np.array([part.signals.run for part in made]), counts),
        stretch=np.repeat([part.signals.stretch for part in made], counts),
        measured=np.concatenate(measured),
        torque=torque,
        columns=np.concatenate(columns),
    )


def select_twists(rows: TwistRows, runs: Sequence[str]) -> SelectedTwist:
    """The causes that the evidence asks for at one joint, without those that other motion does not bear out.

    Args:
        rows: of the joint.
        runs: names, by which rows are blocked; one name for parts of the time.

    Returns:
        The selection.
    """
    block, barred = blocks_of(rows.run, runs), frozenset[int]()
    found = _rested(rows, block, barred)
    for _ in range(len(rows.placed)):
        gains = held_out_gains(found)
        of_one = {n for n in gains if agreement_of(found, len(runs) > 1, n).consistent is False}
        wrong = of_one | {n for n, gain in gains.items() if gain <= 0}
        if not wrong:
            break
        barred |= wrong
        found = _rested(rows, block, barred)
    return found


def _rested(rows: TwistRows, block: Indices, barred: frozenset[int]) -> SelectedTwist:
    left = rows.measured - rows.columns @ np.linalg.lstsq(rows.columns, rows.measured, rcond=1e-9)[0]
    space, before = _space(rows, barred), None
    for _ in range(TWIST.rounds):
        found = _selected(rows, block, space, left)
        if found.best.candidates == before:
            break
        before, left = found.best.candidates, rows.measured - rows.columns @ found.coefficients
    return found


def _selected(rows: TwistRows, block: Indices, space: ModelSpace, left: Array) -> SelectedTwist:
    """The selection with the noise of what was left."""
    least = max(TWIST.least_share * float(np.std(rows.measured)), 1e-9)
    weight = huber_weights(left[:, None], np.ones(len(left)), least)
    sigma = max(float(np.sqrt(weight @ left**2 / weight.sum())), least)
    weight = weight / autocorrelation_time(rows.stretch, np.sqrt(weight) * left)
    X, y = rows.columns * (PRIOR.unit / sigma), rows.measured * (PRIOR.unit / sigma)
    blocks = []
    for number in range(int(block.max()) + 1):
        which = block == number
        own, w = X[which], weight[which]
        weighed = own * w[:, None]
        blocks.append(NormalEquations(own.T @ weighed, weighed.T @ y[which], float(w @ y[which] ** 2), float(w.sum())))
    problem = build_problem(space, total(blocks), least_noise=0.5 * PRIOR.unit)
    search = Search.on(problem)
    best = search.best((space.no_background,))
    while (weak := search.weakest(best)) is not None:
        best = search.without(best, [weak.candidate])
    return SelectedTwist(rows, blocks, space, problem, best)


def _space(rows: TwistRows, barred: frozenset[int]) -> ModelSpace:
    placed, at = rows.placed[1:], rows.at
    candidates = []
    for n, cause in enumerate(placed):
        excludes = frozenset(k for k, other in enumerate(placed) if k != n and clash(cause, other))
        candidates.append(
            Candidate(
                kind=cause.cause.name,
                location=cause.location,
                columns=at[n + 1],
                prior_scale=np.ones(cause.width),
                variant=cause.variant,
                driver=cause.driver,
                label=str(cause),
                family=cause.cause.family,
                nonnegative=cause.cause.nonnegative,
                is_curve=cause.is_curve,
                competes=n not in barred,
                excludes=excludes,
                special_cases=frozenset(k for k in excludes - barred if cause.is_curve and not placed[k].is_curve),
                side_by_side=2,
            )
        )
    return ModelSpace(frames=at[0], families=(), candidates=tuple(candidates))
