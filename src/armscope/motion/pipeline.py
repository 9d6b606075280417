"""From a motion to a verdict: time, rows, rounds of selection, motion that took no part, judgement."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from armscope.core.types import Progress, unheard
from armscope.motion.check import COARSE, CUT_OFF, check_motions, refuse_few, runs_in_motion
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.friction_turns import how_friction_turns, plain_rows
from armscope.motion.fitting.pauses import pauses_in_words
from armscope.motion.fitting.ringing import ringing
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import model_of, select_causes
from armscope.motion.fitting.torque_delay import values_of
from armscope.motion.fitting.with_changes import with_changes
from armscope.motion.library.changes_catalogue import CHANGES
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.links.judgement import JudgedTwist, judged_twists, with_links
from armscope.motion.model.fitted import MotionModel, fitted_model
from armscope.motion.parting import parted_in_two, refuse_unknown
from armscope.motion.samples.preparation import Preparation
from armscope.motion.samples.spikes import without_spikes
from armscope.motion.samples.standing import still_span
from armscope.motion.samples.timing import gaps, mended
from armscope.motion.samples.turns import counted_on
from armscope.motion.summary.badly_met import badly_met
from armscope.motion.summary.entering import Entered, as_entered
from armscope.motion.summary.harming import without_what_harms
from armscope.motion.summary.headline import headline, masses_lead
from armscope.motion.summary.held_out_errors import HeldOutErrors
from armscope.motion.summary.holding_out import (
    Fold,
    HeldOutTorque,
    errors_by_run,
    held_out_parts,
    held_out_torques,
    measure,
    that_others_tell,
)
from armscope.motion.summary.identifiable import identifiable, little_excited
from armscope.motion.summary.intervals import Sureness, covariance_of, level_told
from armscope.motion.summary.judgement import (
    answer_of,
    apart_where_useless,
    doubted_beside,
    found_causes,
    joint_backgrounds,
    unexplained,
)
from armscope.motion.summary.lasting import told_of_lasting
from armscope.motion.summary.late_friction import told_late
from armscope.motion.summary.left_over import left_over
from armscope.motion.summary.likeliest import likeliest_in_words
from armscope.motion.summary.link_weights import rather_all_links, told_links
from armscope.motion.summary.names_of_masses import share_of_masses
from armscope.motion.summary.shares import worth_of
from armscope.motion.summary.stated_load import load_or_link
from armscope.motion.summary.step_by_step import waterfall
from armscope.motion.summary.tenable import tenable
from armscope.motion.summary.told_gains import FITTED_GAINS, rests_on_gains, told_gains
from armscope.motion.summary.torque_atlas import torque_atlas
from armscope.motion.verdict import MotionVerdict
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm
from armscope.verdict.diagnosis import Atlas
from armscope.verdict.schema import Notice


@dataclass(frozen=True)
class MotionSettings:
    """What a user may ask for.

    Attributes:
        cutoff: of the low-pass, Hz; None chooses it.
        held_out: runs that take no part in the fit; none holds out each run in turn, or the last two fifths of one.
    """

    cutoff: float | None = None
    held_out: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class MotionDiagnosis:
    """A verdict with what only lives in memory.

    Attributes:
        arm: the nominal arm.
        verdict: what verdict.json holds.
        selected: the finished selection.
        sure: what else would do, and how wide intervals are for it.
        test: rows of the runs that were kept out; None where there were none.
        held: torques where nothing was fitted.
        how: filters and decimation.
        entered: errors on held-out motion when numbers are entered one after the other, see `as_entered`.
        twists: joints whose links were recorded beside their motors.
    """

    arm: MovingArm
    verdict: MotionVerdict
    selected: SelectedCauses
    sure: Sureness
    test: MotionRows | None
    held: tuple[HeldOutTorque, ...]
    how: Preparation
    entered: tuple[Entered, ...] = ()
    twists: tuple[JudgedTwist, ...] = ()

    @functools.cached_property
    def atlas(self) -> Atlas:
        """What the residual torque of each joint follows."""
        return torque_atlas(self.selected)

    @functools.cached_property
    def model(self) -> MotionModel:
        """What model.yaml holds."""
        layout = self.selected.rows.layout
        numbers = [effect.candidate for effect in self.selected.best.chosen]
        q = self.selected.rows.q
        fitted = fitted_model(
            layout,
            self.selected.told,
            [(n, values_of(self.selected, n), covariance_of(self.selected, n, self.sure.factor)) for n in numbers],
            self.how,
            tuple(cause for twist in self.twists for cause in twist.fitted),
        )
        return replace(fitted, positions=np.column_stack([q.min(axis=0), q.max(axis=0)]))


def diagnose_motion(
    arm: MovingArm,
    motions: Motions,
    settings: MotionSettings | None = None,
    progress: Progress = unheard,
) -> MotionDiagnosis:
    """Find which causes make recorded torques differ from those of the arm's model.

    Args:
        arm: the nominal arm.
        motions: samples.
        settings: see `MotionSettings`.
        progress: called with a sentence and the share done, 0 ... 1.

    Returns:
        The verdict, with what it was made from.

    Raises:
        InputError: the samples don't fit the arm or hold nothing to go by.
    """
    settings = settings or MotionSettings()
    motions, alone = without_spikes(motions)
    motions, turns = counted_on(_without_unknown_temperature(motions))
    motions, standing = runs_in_motion(motions)
    refuse_unknown(settings.held_out, motions)
    progress("laying samples on an even grid", 0.0)
    notices = [Notice("table", note) for note in motions.notes] + alone + turns + standing + check_motions(arm, motions)
    motions, told = mended(motions)
    parted = parted_in_two(arm, motions, settings.held_out)
    train, test = parted.train, parted.test
    how, first = chosen_cutoff(arm, train, settings.cutoff)
    plain = plain_rows(arm, train, how)
    turning = how_friction_turns(plain, how)
    seen = replace(seen_in(arm, train, still_span(arm.sliding)), stand=ringing(plain, how))
    seen = replace(seen, waves=first.waves, motion_hz=how.motion_hz, width_of_sides=turning.wide(arm))
    layout = TorqueLayout(arm, tuple(place_causes(seen)), motions.kind == "current", seen.width_of_sides, turning.order)
    refuse_few(layout, sum(how.rows_of(len(stretch)) for stretch in train), motions.source)
    runs = tuple(dict.fromkeys(stretch.run for stretch in train))
    weighing = lambda text, share: progress(text, 0.1 + 0.6 * share)
    selected = select_causes(layout, train, how, runs, weighing, replace(first.model, turning=turning.late))
    selected = _that_stands(selected, with_changes(selected, seen, train, how, weighing), how.rate)
    selected, sure = told_links(selected)
    progress("measuring on motion that took no part", 0.75)
    apart = build_rows(selected.rows.layout, test, how, model_of(selected)) if test else None
    parts, what = held_out_parts(selected, apart, settings.held_out)
    selected, sure = without_what_harms(selected, sure, parts)
    notices += [*told, *gaps(motions), *parted.notices, *_of_the_selection(selected)]
    verdict, held, entered = _judged(selected, sure, parts, what)
    twists = judged_twists(selected, seen, train, how)
    verdict = with_links(verdict, [twist.side for twist in twists])
    progress("done", 1.0)
    verdict = replace(
        verdict,
        headline=_as_far_as_recorded(verdict, notices),
        preparation=how.words + pauses_in_words(selected.rows.pauses),
        notices=(*notices, *verdict.notices, *told_late(selected, sure)),
        samples=len(motions),
        runs=runs,
        settings=asdict(settings),
    )
    return MotionDiagnosis(arm, verdict, selected, sure, apart, held, how, entered, twists)


def _of_the_selection(selected: SelectedCauses) -> list[Notice]:
    """What is said beside the names: how little the motion tells, of gains, and of a stated load."""
    of_gains = [*level_told(selected.rows.layout), *told_gains(selected)]
    return [*little_excited(selected), *of_gains, *load_or_link(selected)]


def _without_unknown_temperature(motions: Motions) -> Motions:
    """Without temperatures where a run has none: what follows them could not be formed there."""
    unknown = motions.temperature is not None and np.isnan(motions.temperature).any()
    return replace(motions, temperature=None) if unknown else motions


def _that_stands(without: SelectedCauses, wider: SelectedCauses, rate: float) -> SelectedCauses:
    """What can stand of the wider selection; where nothing that changes within a run does, of the one without it."""
    for selected in (wider, without):
        told = tenable(rather_all_links(selected, selected.space.starts[1]), rate)
        changing = {told.rows.layout.placed[number].cause for number in told.best.candidates} & set(CHANGES)
        if selected is without or changing:
            break
    return told


def _as_far_as_recorded(verdict: MotionVerdict, notices: Sequence[Notice]) -> str:
    """The headline, with gains it rests on; where nothing is missing, with how coarsely and far torque is recorded."""
    nothing = verdict.answer == "nothing missing"
    kinds = (*((COARSE, CUT_OFF) if nothing else ()), *((FITTED_GAINS,) if nothing or rests_on_gains(verdict) else ()))
    told = verdict.headline
    if nothing and any(notice.kind == CUT_OFF for notice in notices):
        told = f"Beside samples that are cut off, {told[0].lower()}{told[1:]}"
    return " ".join([told, *(notice.text for notice in notices if notice.kind in kinds)])


def _judged(
    selected: SelectedCauses, sure: Sureness, parts: list[Fold], what: str
) -> tuple[MotionVerdict, tuple[HeldOutTorque, ...], tuple[Entered, ...]]:
    held = held_out_torques(parts)
    by_run = errors_by_run(held)
    parts, held, alone = that_others_tell(selected, parts, held)
    what += f", but for {', '.join(alone)}, of whose own load no other run knows" if alone else ""
    held_out = replace(measure(held, what), by_run=by_run)
    worth, by_masses = worth_of(selected)
    numbered = found_causes(selected, sure, worth)
    order, found = [number for number, _ in numbered], [cause for _, cause in numbered]
    steps = waterfall(selected, parts, order, [cause.title for cause in found])
    lasting = left_over(selected)
    off = share_of_masses(selected, selected.best)
    errors = HeldOutErrors(held_out.background, held_out.model, steps[-1].held_out, off, by_masses)
    if parts and parts[0].rows is not selected.rows:  # runs that the user chose
        badly = badly_met(selected, held, by_run, steps[-1].fitted)
        errors = replace(errors, fitted=steps[-1].fitted, badly=tuple(badly.items()))
    left = unexplained(found, lasting, errors)
    found = apart_where_useless(doubted_beside(found, lasting), errors)
    answer, mismatch = answer_of(found, left, errors)
    likeliest = likeliest_in_words(selected) if errors.only_unnamed or masses_lead(found, errors) else ""
    verdict = MotionVerdict(
        answer=answer,
        headline=headline(found, errors, lasting, likeliest),
        mismatch=mismatch,
        effects=tuple(found),
        unexplained=left,
        background=joint_backgrounds(selected, sure),
        masses_share=off,
        held_out=held_out,
        fitted=steps[-1],
        waterfall=steps,
        identifiable=identifiable(selected),
        preparation="",
        notices=tuple(told_of_lasting(lasting)),
        rows=len(selected.rows),
        samples=0,
        runs=(),
    )
    return verdict, held, as_entered(selected, parts, order)
