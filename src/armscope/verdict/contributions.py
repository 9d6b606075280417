"""What each cause does to the tool, row by row, and so what curing it alone would leave.

With everything in place the model stands where the recordings were taken. One cause's contribution is how far the tool
moves when its effects alone are taken out of the exact model, less what base and tool frames, which are always fitted
again, take up of it. What was measured minus the nominal arm is then the sum of all contributions, of the small errors
that have no name, and of what is left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.averages import rms
from armscope.core.location import Location
from armscope.core.rotations import turn_onto
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS
from armscope.physics.backgrounds import DRIFT, GEOMETRIC
from armscope.physics.effect import AXES, Direction, Driver, Part
from armscope.physics.elastic import UNKNOWN_MASSES, drive
from armscope.physics.model import FittedModel
from armscope.physics.registry import effect_named
from armscope.physics.scene import Posture
from armscope.verdict.constants import REPAIRS
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import FoundEffect
from armscope.verdict.moments import since
from armscope.verdict.wording import SMALL, main_and_minor


@dataclass(frozen=True, eq=False)
class Repair:
    """Effects that are cured together, with their contribution (n, 3), mm in base axes; NaN-free.

    `zero` is the joint's own zero, rad, that a curve's correction has to hold (`Ground.own_zero`); `unsaid` (n, 3) is
    what the model moves beyond `moved`, where a cure as worded cannot take out all of it (`Ground.as_worded`).
    """

    name: str
    effects: tuple[FoundEffect, ...]
    parts: tuple[Part, ...]
    moved: Array
    zero: float = 0.0
    unsaid: Array | None = None

    @property
    def requires(self) -> str:
        """The family without whose correction curing them does nothing; "" for none."""
        known = effect_named(self.effects[0].effect) if len(self.effects) == 1 else None
        return known.requires if known else ""


@dataclass(frozen=True, eq=False)
class Contributions:
    """Of n of the rows: their numbers, what is left (n, 3) mm, and what each cause adds to it."""

    rows: Indices  # (n,) numbers of the rows, from 0
    left: Array  # (n, 3) with everything cured
    causes: tuple[Repair, ...]  # the major ones, most important first
    # minor effects, and major ones beyond `REPAIRS.major_apart`, together; None where there are none
    smaller: Repair | None
    small: dict[str, Array]  # by family, (n, 3) of the small errors without a name
    single: tuple[Repair, ...] = ()  # each of those that are taken together in `smaller`

    @property
    def switches(self) -> list[tuple[str, Array]]:
        """All that can be cured by itself, in words, with its contribution."""
        named = [(cause.name, cause.moved) for cause in self.causes]
        if self.smaller is not None:
            named.append((self.smaller.name, self.smaller.moved))
        least = REPAIRS.switch_seen * rms(self.before)
        return [*named, *((SMALL[family], moved) for family, moved in self.small.items() if rms(moved) > least)]

    @property
    def everywhere(self) -> Array:
        """(n, 3) the small errors of all families."""
        return sum(self.small.values(), np.zeros_like(self.left))

    @property
    def before(self) -> Array:
        """(n, 3) nothing cured."""
        everything = [cause.moved for cause in (*self.causes, *([self.smaller] if self.smaller else []))]
        unsaid = [cause.unsaid for cause in self.causes if cause.unsaid is not None]
        return np.asarray(self.left + self.everywhere + sum(everything) + sum(unsaid))

    def cured(self, causes: Sequence[int]) -> float:
        """RMS per axis, mm, once these of the causes are cured and nothing else."""
        return rms(self.before - sum((self.causes[n].moved for n in causes), np.zeros_like(self.left)))


@dataclass(frozen=True, eq=False)
class Ground:
    """Rows of a verdict on which contributions are calculated, with the whole fitted model in place."""

    verdict: Diagnosis
    rows: Indices  # (n,) numbers of the rows, from 0
    posture: Posture
    taken_up: Array  # (3 n, f) orthonormal: what frames take up

    def free(self, moved: Array) -> Array:
        """(n, 3) without what frames take up."""
        flat = moved.reshape(-1)
        return np.asarray((flat - self.taken_up @ (self.taken_up.T @ flat)).reshape(-1, 3))

    def moved_by(self, parts: Sequence[Part]) -> Array:
        """(n, 3) how far the tool moves, mm, when parts are taken out of the exact model."""
        if not parts:
            return np.zeros((len(self.rows), 3))
        out, model = {id(part) for part in parts}, self.verdict.model
        kept, small = (tuple(p for p in some if id(p) not in out) for some in (model.parts, model.background))
        return self._without(replace(model, parts=kept, background=small))

    def _without(self, others: FittedModel) -> Array:
        return self.free(1e3 * (self.posture.tool - self._brought_back(others.posture(self.posture.scene).tool)))

    def as_worded(self, effect: FoundEffect, parts: Sequence[Part]) -> Array | None:
        """(n, 3) how far the tool moves, mm, when a cause is cured by the numbers in its rule; None: as it was fitted.

        A drive whose mass moments were fitted, too, is commanded away by compliance x load, and that load comes from
        the stated masses: what the fitted moments add to it is in no rule.
        """
        named = [p.value for p in effect.parameters if p.name == "compliance"]
        arm, scene = self.verdict.model.arm, self.posture.scene
        if [p.placed.variant for p in parts] != [UNKNOWN_MASSES] or not (named and arm.has_masses):
            return None
        (placed,) = (part.placed for part in parts)
        j = Location.of(placed.location).number
        stated = replace(placed, terms=(drive(scene, j, Driver("torque", (j,))),), prior_scale=(1.0,), variant="")
        cured = Part(stated, np.array([-named[0]]))
        return self._without(replace(self.verdict.model, parts=(*self.verdict.model.parts, cured)))

    def own_zero(self, effect: FoundEffect, parts: Sequence[Part]) -> float:
        """The constant (rad or m) that a correction by a joint's curve must hold beside the curve's shape.

        It is the joint's zero. Where small errors of geometry are fitted, they hold it, and the part's mean is 0; at
        the first and the last joint it is a turn of base or tool, which are placed anyway. Elsewhere no other step sets
        it: a table without it leaves the tool where the zero puts it.
        """
        if not effect.nameless or effect.curve is None or not any(p.placed.effect.cure.commanded for p in parts):
            return 0.0
        table = self.verdict.recordings
        amounts = self.verdict.model.scene(table.rows(spread_evenly(len(table), REPAIRS.motion_rows))).amounts(parts)
        direction, turned = next(iter(amounts.items()), (None, np.zeros(1)))
        moved = None if direction is None else self.posture.displacement(direction)
        if moved is None or direction is None or Location.of(direction.location).kind != "motor":
            return 0.0
        zero = float(np.mean(turned))
        return zero if rms(self.free(1e3 * zero * moved)) > REPAIRS.constant_felt * rms(self.moved_by(parts)) else 0.0

    def _brought_back(self, points: Array) -> Array:
        """(n, 3) points with the bases turned back where they lie far off, m.

        A curve at the first joint may hold a mean of many degrees, which the base takes up; columns of a small turn
        take up its first order alone, and leave millimetres that nobody sees.
        """
        points, there, run = points.copy(), self.posture.tool, self.posture.scene.recordings.run
        for together in self.verdict.model.set_ups:
            rows = np.isin(run, together)
            if not rows.any():
                continue
            here, wanted = points[rows].mean(axis=0), there[rows].mean(axis=0)
            turn = turn_onto(points[rows] - here, there[rows] - wanted)
            if np.abs(turn - np.eye(3)).max() > REPAIRS.far_turn_rad:
                points[rows] = (points[rows] - here) @ turn.T + wanted
        return points

    def left_and_before(self) -> tuple[Array, Array]:
        """(n, 3) each: with everything cured, and with nothing."""
        residuals = self.verdict.residuals
        return self.free(residuals.after[self.rows]), self.free(residuals.before[self.rows])

    def left_and_small(self, explained: Array) -> tuple[Array, dict[str, Array]]:
        """What is left (n, 3) beside named effects that explain so much, and by family the small errors without a name.

        Small errors that the evidence does not ask for and that move next to nothing are part of what is left.
        """
        left, before = self.left_and_before()
        rest = before - left - explained
        if not self.verdict.background.present and rms(rest) ** 2 < REPAIRS.switch_seen * rms(before) ** 2:
            return before - explained, {}
        return left, self.small(rest)

    def small(self, rest: Array) -> dict[str, Array]:
        """By family, (n, 3) of the small errors without a name.

        Args:
            rest: (n, 3) what neither named effects nor what is left account for. What the families' parts do not
                account for either is what errors do only together, and goes to a wander, which takes up what it can,
                or, without one, to the largest.
        """
        families: dict[str, list[Part]] = {}
        for part in self.verdict.model.background:
            families.setdefault(part.placed.family, []).append(part)
        small = {family: self.moved_by(parts) for family, parts in families.items()}
        wanders = any(each.family == DRIFT and each.present for each in self.verdict.background_families)
        takes_rest = DRIFT if wanders else max(small, key=lambda family: rms(small[family]), default=GEOMETRIC)
        rest = rest - sum(small.values(), np.zeros_like(rest))
        return {**small, takes_rest: small.get(takes_rest, np.zeros_like(rest)) + rest}


def ground_of(verdict: Diagnosis) -> Ground:
    """At most `REPAIRS.rows` rows of a verdict that are no bad shots."""
    trusted = np.flatnonzero(verdict.residuals.weight > REPAIRS.trusted_weight)
    rows = trusted[spread_evenly(len(trusted), REPAIRS.rows)]
    posture = verdict.model.posture(verdict.model.scene(verdict.recordings.rows(rows)))
    return Ground(verdict, rows, posture, _frames(verdict, posture))


def contributions(verdict: Diagnosis) -> Contributions:
    """What each cause of a verdict moves, on at most `REPAIRS.rows` rows that are no bad shots."""
    ground, parts = ground_of(verdict), parts_of(verdict)
    main, minor = main_and_minor(verdict.effects)
    apart = {id(effect) for effect in sorted(main, key=lambda effect: -effect.weight)[: REPAIRS.major_apart]}

    def alone(effect: FoundEffect) -> Repair:
        its = parts[id(effect)]
        fitted, worded = ground.moved_by(its), ground.as_worded(effect, its)
        zero = ground.own_zero(effect, its)
        if worded is None:
            return Repair(effect.title + since(effect), (effect,), its, fitted, zero)
        return Repair(effect.title + since(effect), (effect,), its, worded, zero, fitted - worded)

    causes = tuple(alone(effect) for effect in main if id(effect) in apart)
    rest = [effect for effect in (*main, *minor) if parts[id(effect)] and id(effect) not in apart]
    together = tuple(part for effect in rest for part in parts[id(effect)])
    name = f"{len(rest)} smaller effects together" if len(rest) > 1 else "one smaller effect"
    smaller = Repair(name, tuple(rest), together, ground.moved_by(together)) if rest else None
    single = tuple(alone(effect) for effect in rest)
    named = [cause.moved for cause in (*causes, *([smaller] if smaller else []))]
    named += [cause.unsaid for cause in causes if cause.unsaid is not None]
    left, small = ground.left_and_small(sum(named, np.zeros((len(ground.rows), 3))))
    return Contributions(ground.rows, left, causes, smaller, small, single)


def _frames(verdict: Diagnosis, posture: Posture) -> Array:
    """(3 n, f) orthonormal: what base (one for all runs of a set-up) and tool frames take up."""
    run = posture.scene.recordings.run
    columns = [
        moved * np.isin(run, together)[:, None]
        for together in verdict.model.set_ups
        for axis in AXES
        if (moved := posture.displacement(Direction("base", axis))) is not None
    ]
    columns += [posture.column(term) for part in verdict.model.tools for term in part.placed.terms]
    X = np.stack([column.reshape(-1) for column in columns], axis=1)
    scale = np.linalg.norm(X, axis=0)
    left, size, _ = np.linalg.svd(X[:, scale > 0] / scale[scale > 0], full_matrices=False)
    return np.asarray(left[:, size > NUMERICS.cancelling])


def parts_of(verdict: Diagnosis) -> dict[int, tuple[Part, ...]]:
    """The part of the fitted model of every effect, by the effect's `id`; none for scatter, which is no model."""
    waiting = list(verdict.model.parts)
    parts: dict[int, tuple[Part, ...]] = {}
    for effect in verdict.effects:
        alike = [p for p in waiting if p.placed.key == (effect.effect, effect.location)]
        same = [p for p in alike if p.placed.driver == effect.driver and _same_scanned(p, effect)]
        # scatter, which no part stands for, is no curve that follows something
        parts[id(effect)] = tuple((same or ([] if effect.nameless else alike))[:1])
        waiting = [p for p in waiting if not any(p is taken for taken in parts[id(effect)])]
    return parts


def _same_scanned(part: Part, effect: FoundEffect) -> bool:
    """Whether the numbers that were found by trying values are the effect's."""
    told = {parameter.name: parameter.value for parameter in effect.parameters}
    return all(name not in told or np.isclose(told[name], value) for name, _, value in part.placed.scanned)
