"""The search for an exciting motion: random Fourier series, the best of them bettered joint by joint."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.design.fourier import FourierPath, random_path
from armscope.poses.exciting.columns import Motion, all_columns, stated_friction
from armscope.poses.exciting.constants import MOTION
from armscope.poses.exciting.criterion import MotionScore, Pair, Showable, motion_score, shown_at_all, told_apart
from armscope.poses.exciting.limits import MotionLimits, limits_of
from armscope.poses.obstacles import REASONS, Surroundings, refusals
from armscope.robot import Arm
from armscope.robot.dynamics import inertial_parameters


@dataclass(frozen=True, eq=False)
class Excitation:
    """A motion and what it is worth."""

    # arm, limits, around: what it is for
    arm: Arm
    limits: MotionLimits
    around: Surroundings
    path: FourierPath
    shown: Showable  # what any motion could show
    before: MotionScore  # the scores of the random motions, median first by `value`
    after: MotionScore
    pairs: tuple[Pair, ...]  # what it tells apart; empty: everything
    inseparable: tuple[Pair, ...]  # pairs that were asked for and that no motion tells apart
    lawless: tuple[Pair, ...]  # pairs that were asked for, of which a cause has no law to plan a motion by
    torque: Array  # (m,) largest torque of the stated model along it, N m
    tried: int  # motions that were looked at; `refused`: of them beyond torque limits or in collision
    refused: int


@dataclass(frozen=True)
class MotionRequest:
    """What motion is wanted."""

    period: float = MOTION.period_s  # s
    harmonics: int = MOTION.harmonics
    rounds: int = MOTION.rounds
    seed: int = 0
    pairs: tuple[Pair, ...] = ()  # causes to tell apart
    rate: float = MOTION.rate_hz  # samples per second of the table, all of which keep clear


def times_of_table(period: float, rate: float) -> Array:
    """(N,) s of the samples of a table: one period with both its ends."""
    return np.arange(round(period * rate) + 1) / rate


def excite(
    arm: Arm, wanted: MotionRequest, around: Surroundings, progress: Callable[[int, int], None] | None = None
) -> Excitation:
    """Find a motion that shows what is wanted.

    Args:
        arm: with masses.
        wanted: of the motion.
        around: floor and body.
        progress: called with rounds done and all rounds.

    Returns:
        The motion, with its score beside that of random ones.

    Raises:
        InputError: no masses; no motion is possible.
    """
    rng = np.random.default_rng(wanted.seed)
    limits = limits_of(arm)
    shown = shown_at_all(arm, limits.path, rng)
    asked = told_apart(arm, shown, limits.path, wanted.pairs, rng)
    search = _Search(arm, limits, around, shown, replace(wanted, pairs=asked.apart))
    found = [
        path for path in (search.allowed(_draw(limits, wanted, rng)) for _ in range(MOTION.starts)) if path is not None
    ]
    most = np.inf
    if not found:
        found, most = search.about_clear_poses(rng), 1.0
    path, before, best = _bettered(search, found, rng, progress, most)
    torque = np.abs(search.torques(path)).max(axis=0)
    return Excitation(
        arm, limits, around, path, shown, before, best, asked.apart, asked.alike, asked.lawless, torque,
        search.tried, search.refused,
    )  # fmt: skip


def _bettered(
    search: _Search,
    found: list[FourierPath],
    rng: np.random.Generator,
    progress: Callable[[int, int], None] | None,
    most: float,
) -> tuple[FourierPath, MotionScore, MotionScore]:
    """The best of some motions, bettered; the score of the median one, and its own. ``progress``: as in `excite`;
    ``most``: times as large as they are that changed waves are made where the limits leave room."""
    scores = [search.score(path) for path in found]
    order = np.argsort([each.value for each in scores])
    before = scores[int(order[(len(order) - 1) // 2])]
    path, best = found[int(order[-1])], scores[int(order[-1])]
    steps, rounds = [(path, best)], search.wanted.rounds
    for number in range(rounds):
        step = MOTION.narrowing * (1 - number / rounds) + MOTION.least_step
        tried = _moved(path, step, rng).resting().fitted(search.limits.path, MOTION.uses[0], most)
        worth = search.score(tried)
        if worth.value > best.value and search.possible(tried):
            path, best = tried, worth
            steps.append((path, best))
        if progress is not None:
            progress(number + 1, rounds)
    path, best = next(step for step in reversed(steps) if step is steps[0] or search.clear(step[0]))
    return path, before, best


class _Search:
    """Scores and refuses motions of one arm."""

    def __init__(
        self, arm: Arm, limits: MotionLimits, around: Surroundings, shown: Showable, wanted: MotionRequest
    ) -> None:
        self.arm, self.limits, self.around, self.shown, self.wanted = arm, limits, around, shown, wanted
        self.numbers = np.concatenate([inertial_parameters(arm.model), stated_friction(arm)])
        self.tried = self.refused = 0
        self.why: Counter[str] = Counter()

    def motion(self, path: FourierPath) -> Motion:
        count = max(MOTION.samples, MOTION.per_wave * path.harmonics)
        time = np.arange(count) * path.period / count
        return Motion(*path.at(time), step=path.period / count)

    def score(self, path: FourierPath) -> MotionScore:
        self.tried += 1
        return motion_score(self.arm, self.shown, self.motion(path), self.wanted.pairs)

    def torques(self, path: FourierPath) -> Array:
        """(N, m) of the stated model, fine enough to see its peaks."""
        fine = path.over_period(MOTION.finer)
        found: Array = all_columns(self.arm, Motion(*fine, step=path.period / len(fine[0]))) @ self.numbers
        return found

    def possible(self, path: FourierPath) -> bool:
        """Whether torques and surroundings allow it."""
        beyond = np.any(np.abs(self.torques(path)) > MOTION.torque_use * self.limits.torque, axis=0)
        reasons = [f"goes beyond the torque of joint {j + 1}" for j in np.flatnonzero(beyond)]
        if not reasons:
            reasons = self.in_the_way(path.over_period()[0])
        if not reasons:
            time = times_of_table(path.period, self.wanted.rate)
            reasons = self.in_the_way(path.at(time[spread_evenly(len(time), MOTION.looked_at)])[0])
        self.refused += bool(reasons)
        self.why.update(reasons)
        return not reasons

    def clear(self, path: FourierPath) -> bool:
        """Whether every sample of the table keeps clear of floor, arm and joint limits."""
        time = times_of_table(path.period, self.wanted.rate)
        few = len(time) <= MOTION.looked_at  # all of these were seen
        pieces = [] if few else np.array_split(time, -(-len(time) // MOTION.at_once))
        return not any(self.in_the_way(path.at(piece)[0]) for piece in pieces)

    def in_the_way(self, angle: Array) -> list[str]:
        """What poses (N, m) rad meet or go beyond."""
        low, high = self.limits.path.angle.T
        beyond = np.flatnonzero(np.any((angle < low) | (angle > high), axis=0))
        met = np.unique(refusals(self.arm, angle, self.around))
        return [f"goes beyond the limits of joint {j + 1}" for j in beyond] + [str(reason) for reason in met if reason]

    def allowed(self, path: FourierPath) -> FourierPath | None:
        """The motion, made smaller where it must be."""
        for use in MOTION.uses:
            smaller = path.fitted(self.limits.path, use)
            if self.possible(smaller) and self.clear(smaller):
                return smaller
        return None

    def about_clear_poses(self, rng: np.random.Generator) -> list[FourierPath]:
        """Small motions about poses that are clear, for arms that meet themselves, or the floor, on larger ones.
        Raises InputError: none is possible either."""
        low, high = self.limits.path.angle.T
        poses = rng.uniform(low, high, (MOTION.clear_poses, len(low)))
        reasons = refusals(self.arm, poses, self.around)
        clear, found = poses[reasons == ""][: MOTION.starts], []
        if not len(clear):
            self.why = Counter(map(str, reasons))
        for pose in clear:
            path = _draw(self.limits, self.wanted, rng)
            for share in MOTION.smaller:
                small = replace(path, centre=pose, sine=share * path.sine, cosine=share * path.cosine)
                small = small.fitted(self.limits.path, MOTION.uses[0], 1.0)
                if self.possible(small) and self.clear(small):
                    found.append(small)
                    break
        if not found:
            raise self._none(len(clear))
        return found

    def _none(self, clear: int) -> InputError:
        """That no motion is possible, and what stands in its way most often."""
        (reason, _), *_ = self.why.most_common(1) or [("", 0)]
        cure = "Is --floor-mm in the base frame, z up?"
        if "torque" in reason:
            cure = "Less load, a longer --period-s, or other torque_nm in `drives` (or effort in the URDF)."
        elif reason == REASONS[0]:
            cure = f"Links are {1e3 * self.around.radius_of(self.arm):.0f} mm thick about their lines: see --radius-mm."
        rule = f"nor is any of {clear} small ones about poses that are clear; most often, the arm {reason}"
        return InputError(self.arm.name, "", f"{MOTION.starts} motions refused", rule, cure)


def _draw(limits: MotionLimits, wanted: MotionRequest, rng: np.random.Generator) -> FourierPath:
    return random_path(limits.path, wanted.harmonics, wanted.period, rng)


def _moved(path: FourierPath, step: float, rng: np.random.Generator) -> FourierPath:
    """One or two joints' coefficients and centres moved at random."""
    count = len(path.centre)
    chosen = rng.choice(count, size=min(count, int(rng.integers(1, 3))), replace=False)
    sine, cosine, centre = (np.array(each) for each in (path.sine, path.cosine, path.centre))
    size = step * np.sqrt(np.mean(sine[chosen] ** 2 + cosine[chosen] ** 2, axis=1, keepdims=True))
    sine[chosen] += size * rng.normal(size=(len(chosen), path.harmonics))
    cosine[chosen] += size * rng.normal(size=(len(chosen), path.harmonics))
    centre[chosen] += step * rng.normal(size=len(chosen))
    return replace(path, sine=sine, cosine=cosine, centre=centre)
