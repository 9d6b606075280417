"""What a table of an arm in motion holds, and what looks wrong with it, before anything is fitted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Literal

import numpy as np

from armscope.check.motion_channels import Channels
from armscope.check.motion_clock import other_clock
from armscope.check.motion_constants import MOTION
from armscope.check.motion_load import unstated_load, with_a_load, with_stated_payload
from armscope.check.motion_mistakes import mistakes
from armscope.check.motion_readings import Samples
from armscope.check.suspicion import SAYS_MORE, TOO_SHORT, Suspicion, first_of_suspicions, verdict_lines
from armscope.core.sampling import spread_evenly
from armscope.core.told import InWords
from armscope.core.types import Array
from armscope.motion.check import channels, doubts_about, refuse_other_joints, refuse_unknown_gains, too_short
from armscope.motion.samples.spikes import without_spikes
from armscope.motion.samples.timing import gaps, mended_rows
from armscope.motion.samples.turns import counted_on, leaps
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm


def links_beside_motors(motions: Motions) -> Iterator[Suspicion]:
    """What is wrong with links' positions, joint by joint; the position of another joint is told as that."""
    if motions.link is None:
        return
    for j in np.flatnonzero(np.isfinite(motions.link).all(axis=0)).tolist():
        motor, link = motions.q[:, j], motions.link[:, j]
        if np.ptp(motor) < MOTION.link_travel:
            continue
        factor = float(np.polyfit(motor, link, 1)[0])
        if abs(factor - 1) <= MOTION.link_factor:
            continue
        if (other := _follows(motions, j)) is not None:
            statement = f"q{j + 1}_link is the position of joint {other + 1}, and not of joint {j + 1}"
            cure = f"Are columns shifted or exchanged? Call it q{other + 1}_link."
        else:
            statement, cure = f"q{j + 1}_link turns {factor:.4g} times as far as q{j + 1}", _guessed(factor)
        yield Suspicion("problem", statement, cure)


def _follows(motions: Motions, j: int) -> int | None:
    """The other joint that a link's position follows as its own link does, if it is one."""
    assert motions.link is not None
    for other in range(motions.n_motors):
        motor = motions.q[:, other]
        if other == j or np.ptp(motor) < MOTION.link_travel:
            continue
        factor, zero = np.polyfit(motor, motions.link[:, j], 1)
        missed = float(np.std(motions.link[:, j] - factor * motor - zero))
        if abs(factor - 1) < MOTION.link_factor and missed < MOTION.link_factor * np.std(motor):
            return other
    return None


def _guessed(factor: float) -> str:
    if abs(factor + 1) < MOTION.link_factor:
        return "It counts the other way: turn its sign."
    for unit, of in (("degrees", 180 / np.pi), ("radians", np.pi / 180)):
        if abs(factor / of - 1) < MOTION.link_factor:
            return f"It is in {unit}: call the column by that unit."
    other = "the motor's own turns" if abs(factor) < 1 else "another joint's position"
    return f"Both are positions of the joint, behind the gear; is one of them {other}?"


@dataclass(frozen=True, repr=False)
class MotionCheck(InWords):
    """What was seen: the contents in lines, and what looks wrong."""

    contents: tuple[str, ...]
    suspicions: tuple[Suspicion, ...]

    @property
    def has_problems(self) -> bool:
        """Whether anything makes results from this table meaningless."""
        return any(each.weight == "problem" for each in self.suspicions)

    def to_json(self) -> dict[str, Any]:
        """Contents and suspicions as plain data."""
        told = [vars(each) for each in self.suspicions]
        return {"problems": self.has_problems, "suspicions": told, "contents": list(self.contents)}

    def sentences(self) -> tuple[str, ...]:
        """What looks wrong, in which table, and what says more."""
        return first_of_suspicions(self.suspicions), f"{self.contents[0]}.", SAYS_MORE

    def text(self) -> str:
        """The report as plain text."""
        return "\n".join([*self.contents, *verdict_lines(self.suspicions)])


def check_moving(motions: Motions, arm: MovingArm | None = None) -> MotionCheck:
    """Look through a table of motions. Raises InputError: time goes back or is in milliseconds, nothing moves, no
    channel records torque, other joints slide, or currents have no gain."""
    if arm is not None:
        refuse_other_joints(arm, motions)
        refuse_unknown_gains(arm, motions)
    motions, alone = without_spikes(motions)
    motions, turns = counted_on(motions)
    kept, time, notices = mended_rows(motions)
    told = [
        Suspicion("hint", notice.text.rstrip(".")) for notice in [*alone, *turns, *notices, *doubts_about(motions, arm)]
    ]
    even = motions.rows(kept).at_times(time)
    told += [Suspicion("hint", notice.text.rstrip(".")) for notice in gaps(even)]
    broken = list(_leaps(motions))
    found = [*_too_short(even), *broken, *told, *_dead(motions), *_units(motions)]
    found += [*_speeds(even), *_same_paths(even), *links_beside_motors(even)]
    if arm is not None and not broken:  # speeds across a leap are no speeds
        runs = {run: _coarse(even, run) for run in even.runs}
        samples, arm = _samples([few for _, few in runs.values()]), with_stated_payload(arm, even)
        if even.kind == "torque" and (loaded := with_a_load(samples, arm)) is not None:
            arm, mass = loaded
            found.append(unstated_load(mass))
        found += mistakes(samples, arm, Channels.of(even, arm))
        found += other_clock(even, runs, arm)
    return MotionCheck(tuple(contents_of_motion(even)), tuple(found))


def contents_of_motion(motions: Motions) -> Iterator[str]:
    """How much was recorded of each run, and how far each joint's position, and torque, force or current, goes."""
    yield f"{motions.source}: {len(motions)} samples of {motions.n_motors} motors, {motions.kind}"
    for run in motions.runs:
        time = motions.time[motions.run == run]
        rate = 1 / float(np.median(np.diff(time)))
        yield f"  run {run or '(no name)'}: {len(time)} samples, {np.ptp(time):.4g} s at {rate:.4g} Hz"
    for j in range(motions.n_motors):
        factor, unit = (1e3, "mm") if motions.sliding[j] else (180 / np.pi, "deg")
        low, high = factor * motions.q[:, j].min(), factor * motions.q[:, j].max()
        kind, of_kind = ("force", "N") if motions.sliding[j] else ("torque", "N m")
        kind, of_kind = ("current", "A") if motions.kind == "current" else (kind, of_kind)
        yield f"  q{j + 1}: {low:8.2f} ... {high:8.2f} {unit}, {kind} {_range(motions.effort[:, j])} {of_kind}"


def _range(values: Array) -> str:
    return f"{values.min():.4g} ... {values.max():.4g}"


def _dead(motions: Motions) -> Iterator[Suspicion]:
    for name, values in zip(channels(motions), motions.effort.T, strict=True):
        if np.ptp(values) == 0:
            yield Suspicion("problem", f"{name} is {values[0]:g} in every row", "Is the channel recorded?")


def _too_short(motions: Motions) -> Iterator[Suspicion]:
    if (short := too_short(motions)) is not None:
        yield Suspicion("problem", f"{short.found}: {short.rule}", short.cure, TOO_SHORT)


def _leaps(motions: Motions) -> Iterator[Suspicion]:
    for j, row, step in leaps(motions):
        rows = f"from line {row + 1} to line {row + 2}"
        statement = f"q{j + 1} leaps by {np.degrees(step):.0f} deg {rows}: no joint moves so"
        cure = (
            "Was it recorded within one turn, and filtered or interpolated since? Count the turns on before that. "
            "Otherwise leave out the rows about it."
        )
        yield Suspicion("problem", statement, cure)


def _units(motions: Motions) -> Iterator[Suspicion]:
    reached = np.where(motions.sliding, 0.0, np.abs(motions.q).max(axis=0))
    far = np.flatnonzero(reached > MOTION.far_turns)
    for j in far:
        statement = f"q{j + 1}_rad reaches {reached[j]:.4g} rad, {reached[j] / (2 * np.pi):.3g} turns"
        # one joint may turn on and on, an arm does not
        weight: Literal["problem", "hint"] = "problem" if len(far) > 1 else "hint"
        yield Suspicion(weight, statement, f"Are these degrees? Then call the column q{j + 1}_deg.")


def _speeds(motions: Motions) -> Iterator[Suspicion]:
    """Recorded speeds against the derivatives of the angles: factor and lag."""
    if motions.dq is None or not np.isfinite(motions.dq).all():
        return
    for j in range(motions.n_motors):
        found = [_speed_of_run(motions, run, j) for run in motions.runs]
        told = [each for each in found if each is not None]
        if not told:
            continue
        scale, late = (float(np.median([each[k] for each in told])) for k in (0, 1))
        name, step = f"dq{j + 1}", float(np.median(np.diff(motions.time)))
        if abs(scale - 1) > MOTION.speed_scale:
            cure = "It is in degrees a second, perhaps." if abs(scale * np.pi / 180 - 1) < MOTION.speed_scale else ""
            statement = f"{name} is {scale:.4g} times the derivative of q{j + 1}"
            yield Suspicion("problem" if scale < 0 else "hint", statement, cure)
        if abs(late) > MOTION.late:
            statement = f"{name} is {abs(late * step) * 1e3:.3g} ms {'later' if late > 0 else 'earlier'} than q{j + 1}"
            yield Suspicion("hint", statement, "Speeds are filtered, often; torques are compared by the angles alone.")


def _speed_of_run(motions: Motions, run: str, joint: int) -> tuple[float, float] | None:
    """(factor, samples late) of a recorded speed in a run; None where the joint hardly moves."""
    assert motions.dq is not None
    rows = np.flatnonzero(motions.run == run)
    q, dq = motions.q[rows, joint], motions.dq[rows, joint]
    if len(rows) < 4 * MOTION.farthest_lag or np.ptp(dq) == 0 or len(np.unique(q)) < len(q) // 20:
        return None
    slope = np.gradient(q, motions.time[rows])
    inside = slice(MOTION.farthest_lag, len(rows) - MOTION.farthest_lag)
    lags = np.arange(-MOTION.farthest_lag, MOTION.farthest_lag + 1)
    shifted = np.array([dq[MOTION.farthest_lag + lag : len(rows) - MOTION.farthest_lag + lag] for lag in lags])
    fit = shifted @ slope[inside]
    power = np.maximum(np.sum(shifted**2, axis=1), 1e-300)
    best = int(np.argmax(fit**2 / power))
    quality = fit**2 / power / max(float(slope[inside] @ slope[inside]), 1e-300)
    if quality[best] < MOTION.clear_derivative:
        return None  # too noisy a derivative tells neither
    late = float(lags[best])
    if 0 < best < len(lags) - 1:
        below, at, above = quality[best - 1 : best + 2]
        late += float((below - above) / (2 * (below - 2 * at + above)))
    return float(power[best] / fit[best]), late


def _same_paths(motions: Motions) -> Iterator[Suspicion]:
    if motions.n_motors == 1:
        return  # every path of one axis passes where another one did
    from scipy.spatial import cKDTree  # takes long to import: a table that is refused needs none

    span = np.maximum(np.ptp(motions.q, axis=0), 1e-9)
    paths = {run: motions.q[motions.run == run] / span for run in motions.runs}
    for one, other in combinations(paths, 2):
        dense = cKDTree(paths[one][spread_evenly(len(paths[one]), MOTION.rows)])
        away = dense.query(paths[other][spread_evenly(len(paths[other]), 300)])[0]
        if float(np.percentile(away, 90)) < MOTION.same_path * np.sqrt(motions.n_motors):
            statement = f"run {other} repeats the path of run {one}"
            yield Suspicion("hint", statement, "Held out, it tests the noise and not the model: hold out another path.")


def _samples(parts: Sequence[Samples]) -> Samples:
    """Of all runs, differenced over a twentieth of a second: to see sign, size and order."""
    return Samples(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("q", "dq", "ddq", "effort")))


def _coarse(motions: Motions, run: str) -> tuple[Array, Samples]:
    """Time and samples of a run, differenced over a twentieth of a second: to see sign and size."""
    rows = np.flatnonzero(motions.run == run)
    time = motions.time[rows]
    step = max(int(MOTION.coarse / float(np.median(np.diff(time)))), 1)
    q, time = motions.q[rows][::step], time[::step]
    if len(q) < MOTION.samples:
        none = np.empty((0, motions.n_motors))
        return np.empty(0), Samples(none, none, none, none)
    dq = np.gradient(q, time, axis=0)
    inside = slice(2, -2)
    ddq, effort = np.gradient(dq, time, axis=0), motions.effort[rows][::step]
    return time[inside], Samples(q[inside], dq[inside], ddq[inside], effort[inside])
