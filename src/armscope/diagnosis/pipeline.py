"""From recordings to a verdict: frames, then rounds of columns, selection, exact refit and scan, then judgement."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.check.constants import TABLE
from armscope.check.orientations import trusted_channels
from armscope.check.preconditions import as_notices, check_table, too_far
from armscope.check.report import what_forbids
from armscope.check.suspicion import GRAVITY
from armscope.core.types import Progress, unheard
from armscope.diagnosis.constants import GRAVITY as DIRECTION
from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.gravity_direction import GravityEstimate, estimate_gravity_direction
from armscope.diagnosis.held_out import split_rows
from armscope.diagnosis.judgement import judge
from armscope.diagnosis.play_by_order import select_with_sides
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.leaning_gravity import better_than_a_name
from armscope.diagnosis.undecided import undecided
from armscope.fitting.constants import STEPS
from armscope.fitting.exchanged_tool import exchanged_tool
from armscope.fitting.linearisation import LinearisedTable, residuals
from armscope.fitting.registration import fit_frames
from armscope.fitting.set_ups import compare_bases, set_up_anew
from armscope.measurement.channel import CHANNELS, Channel, ChannelResiduals, nuisances, supported
from armscope.measurement.noise import Noise, known_noise
from armscope.physics.effect import Placed
from armscope.physics.frames import sharing_bases
from armscope.physics.model import FittedModel
from armscope.physics.set_ups import SetUps
from armscope.recordings import Recordings
from armscope.recordings.some_rows import some_rows
from armscope.robot import Arm
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import INTERVAL, FoundEffect
from armscope.verdict.schema import Notice
from armscope.verdict.wording import effect_in_words

TOO_MUCH = " A controller that makes up for too much of the load looks the same, and is corrected by the same commands."


@dataclass(frozen=True)
class Settings:
    """What a user may ask for."""

    seed: int = 0  # of folds and resampling
    tool_per_run: bool = False  # whether the tool offset is free in every run, not only per target
    resamples: int = 10  # how many times rows are resampled for the inclusion frequencies; 0 leaves them out
    cross_validation: bool = True  # whether the procedure is validated on held-out rows
    # whether gravity's direction is free from the start; otherwise it is as the robot's description states, unless a
    # leaning one does clearly better than an effect that would be named
    estimate_gravity: bool = False
    orientation: bool = True  # whether measured orientations are used, where there are some
    # height in the base frame below which the poses to measure next may not reach; None: as low as the arm was in the
    # recordings
    floor_mm: float | None = None

    @property
    def floor(self) -> float | None:
        """m."""
        return None if self.floor_mm is None else 1e-3 * self.floor_mm


def diagnose(
    arm: Arm,
    recordings: Recordings,
    settings: Settings | None = None,
    progress: Progress | None = None,
    channels: Sequence[Channel] = CHANNELS,
) -> Diagnosis:
    """Find where in the arm the mismatch arises, which physics was left out, and how large it is.

    Args:
        arm: the nominal arm.
        recordings: measured rows.
        settings: see `Settings`.
        progress: called with a sentence and the share done, 0 ... 1.
        channels: kinds of reading that are used where the table holds them; the first is the reference.

    Returns:
        The verdict, with the arm and table that it was made from.

    Raises:
        InputError: the recordings don't fit the arm or hold no usable rows.
    """
    settings, progress = settings or Settings(), progress or unheard
    started = time.perf_counter()
    # what nobody uses is not judged either
    checked = check_table(arm, recordings if settings.orientation else replace(recordings, orientation=None))
    table = checked.recordings
    progress("fitting base and tool", 0.02)
    start, tool_per_run, set_ups, told = _frames(arm, _telling(table), settings.tool_per_run)
    rows = LinearisedTable(table, supported(table, channels))
    first = residuals(start, rows)
    channels, table, doubts = trusted_channels(tuple(first.by_channel), table, first)
    if table is not rows.recordings or channels != rows.channels:
        rows = LinearisedTable(table, channels)
    noise = known_noise(arm, table)
    frames = sharing_bases(nuisances(channels, table, tool_per_run), set_ups)
    problems = what_forbids(checked.recordings, arm)
    obstacle = too_far(arm, table, first.points_mm, problems) or _too_few(table, frames)
    notices = (*as_notices(problems, obstacle), *checked.notices, *told, *doubts, *_of_type(arm))
    if obstacle is not None:
        return undecided(start, table, first.points_mm, noise, (*notices, obstacle), time.perf_counter() - started)
    known = _Prepared(start, rows, first, noise, frames, notices)
    if settings.estimate_gravity:
        known = _along(known, _gravity(start, table, noise, tool_per_run))
    verdict = _judged(known, settings, progress)
    beaten, doubted = better_than_a_name(verdict), any(each.kind == GRAVITY for each in problems)
    again = (doubted or beaten is not None) and not settings.estimate_gravity
    if again and (found := estimate_gravity_direction(start, table, noise, tool_per_run)) is not None:
        progress("gravity leans: once more along it", 0.02)
        leaning = _judged(_along(known, _leaning(found, beaten)), settings, progress)
        verdict = _better_of(verdict, leaning, DIRECTION.as_good if doubted else 1.0)
    progress("done", 1.0)
    return verdict.after(time.perf_counter() - started, vars(settings))


@dataclass(frozen=True, eq=False)
class _Prepared:
    """What a diagnosis starts from: base and tool placed, the rows, their noise, and what was said of them so far."""

    start: FittedModel
    rows: LinearisedTable
    first: ChannelResiduals
    noise: Noise
    frames: Sequence[Placed]
    notices: tuple[Notice, ...]


def _judged(known: _Prepared, settings: Settings, progress: Progress) -> Diagnosis:
    """The selection and its verdict."""
    rng = np.random.default_rng(settings.seed)
    split = split_rows(known.rows.recordings, rng)
    found = select_with_sides(known.start, known.rows, known.noise, known.frames, split.of_row, progress)
    state = DiagnosisState(
        **vars(found), start=known.start, recordings=found.table.recordings, first=known.first, noise=known.noise,
        notices=known.notices, split=split, floor=settings.floor,
    )  # fmt: skip
    return judge(state, settings.resamples, settings.cross_validation, rng, progress)


def _along(known: _Prepared, gravity: tuple[Arm, list[Notice]]) -> _Prepared:
    """The same along another direction of gravity, with what is said of it."""
    arm, told = gravity
    return replace(known, start=replace(known.start, arm=arm), notices=(*known.notices, *told))


def _better_of(stated: Diagnosis, leaning: Diagnosis, as_good: float = 1.0) -> Diagnosis:
    """The verdict along gravity that leans, where rows that took no part are met as well by it; all, if none were.

    Springs that may push foretell along the stated direction what real ones do along another.
    """
    before, after = (
        each.held_out.after if np.isfinite(each.held_out.after) else each.residual_after_mm
        for each in (stated, leaning)
    )
    return leaning if after <= as_good * before else stated


def _of_type(arm: Arm) -> list[Notice]:
    """That other arms were asked, and for what."""
    if not arm.type.sizes:
        return []
    text = f"What {arm.type.title} have shown says how large these are as a rule: {', '.join(sorted(arm.type.sizes))}."
    return [Notice("sizes of its type", text)]


def _telling(table: Recordings) -> Recordings:
    """The rows that tell where base and tool stand at first: of a long table some, from which all later fits start."""
    if len(table) <= STEPS.kept_rows:
        return table
    return table.rows(some_rows(table, STEPS.telling_rows, LOOP.rows_of_a_group))


def _frames(arm: Arm, table: Recordings, tool_per_run: bool) -> tuple[FittedModel, bool, SetUps, list[Notice]]:
    """The arm with bases and tools fitted, whether its tool is free in every run, which runs share a base, and why."""
    start, notices = fit_frames(arm, table, tool_per_run), []
    exchanged = None if tool_per_run else exchanged_tool(start, table)
    if exchanged is not None:
        start, tool_per_run = exchanged.model, True
        text = f"From run to run the tool lies elsewhere, {exchanged.apart}: it is free in each run."
        notices.append(Notice("tool exchanged", text))
    compared = compare_bases(start, table)
    if any(len(runs) > 1 for runs in compared.set_ups):
        start = fit_frames(arm, table, tool_per_run, compared.set_ups)
    if text := set_up_anew(compared):
        notices.append(Notice("set up anew", text))
    return start, tool_per_run, compared.set_ups, notices


def _gravity(start: FittedModel, table: Recordings, noise: Noise, tool_per_run: bool) -> tuple[Arm, list[Notice]]:
    """The arm with gravity's direction as estimated, and what to say of it."""
    found = estimate_gravity_direction(start, table, noise, tool_per_run)
    if found is None:
        text = "Nothing speaks for another direction of gravity than stated."
        return start.arm, [Notice("gravity as stated", text)]
    return found.arm, [_estimated(found)]


def _estimated(found: GravityEstimate) -> Notice:
    angle, stderr = np.degrees(found.angle), np.degrees(found.stderr)
    down = ", ".join(f"{g:.3g}" for g in found.arm.gravity)
    text = (
        f"Gravity leans {angle:.1f} +- {INTERVAL * stderr:.1f} degrees from where it is stated "
        f"({found.evidence:.0f} nats): "
        f"gravity_m_s2: [{down}] in the base frame was used."
    )
    return Notice("gravity estimated", text)


def _leaning(found: GravityEstimate, beaten: FoundEffect | None) -> tuple[Arm, list[Notice]]:
    """The arm along gravity that leans though nobody asked, and why."""
    name = "springs that push" if beaten is None else effect_in_words(beaten.effect, beaten.location)
    text = (
        f"The arm gives way to gravity that leans by {np.degrees(found.angle):.1f} degrees from where it is stated; "
        f"along the stated one {name} would be named, and the rows speak against that. The estimated direction was "
        "used: see whether the base stands level, and how it is mounted; level it, or state gravity_m_s2, before "
        f"anything else is changed. Loads told below are along it.{TOO_MUCH * (beaten is None)}"
    )
    return found.arm, [Notice("gravity", text), _estimated(found)]


def _too_few(recordings: Recordings, frames: Sequence[Placed]) -> Notice | None:
    free = sum(len(placed.terms) for placed in frames)
    if len(recordings) >= TABLE.rows and 3 * len(recordings) > 2 * free:
        return None
    text = f"{len(recordings)} rows hold {3 * len(recordings)} numbers, {free} of which base and tool take up: too few."
    return Notice("fewer rows than parameters", text)
