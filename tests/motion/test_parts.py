"""The steps from samples to a verdict, each by itself."""

import dataclasses
import json

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.inference.model_space import Candidate
from armscope.motion.check import check_motions
from armscope.motion.constants import LIBRARY
from armscope.motion.fitting.consistency import PathAgreement
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.first_look import first_look
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import build_rows
from armscope.motion.fitting.selection import select_causes
from armscope.motion.fitting.space import build_space
from armscope.motion.fitting.weights import estimate_weights, fitted_together, weighed
from armscope.motion.library import catalogue
from armscope.motion.library.causes import Seen
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.masses import place_masses
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.samples import preparation as preparation_room
from armscope.motion.samples.constants import CUTOFF, FILTER
from armscope.motion.samples.preparation import parts, preparation
from armscope.motion.samples.timing import Stretch, mended, stretches
from armscope.motion.summary.headline import headline
from armscope.motion.summary.held_out_errors import HeldOutErrors
from armscope.motion.summary.holding_out import folds
from armscope.motion.summary.judgement import answer_of
from armscope.motion.verdict import FoundCause, UnexplainedTorque, relative
from armscope.recordings.motions import Motions
from armscope.verdict.effects import Parameter
from tests.motion.moving import COULOMB, moved, robot


def seen(motions: Motions) -> Seen:
    return seen_in(robot(), list(stretches(motions)), LIBRARY.still_rad)


def test_repeated_and_uneven_stamps_are_rebuilt_from_angle_and_velocity() -> None:
    rng = np.random.default_rng(0)
    true = np.cumsum(np.r_[0, rng.choice([1, 1, 1, 2], 4000)]) * 1e-3
    q, dq = np.column_stack([np.sin(true), np.cos(2 * true)]), np.column_stack([np.cos(true), -2 * np.sin(2 * true)])
    twice = np.sort(np.r_[np.arange(len(true)), rng.choice(len(true), 200, replace=False)])
    stamps = np.sort(true[twice] + rng.uniform(0, 9e-4, len(twice)))
    table = Motions(
        stamps, q[twice], np.zeros((len(twice), 2)), "torque", np.zeros(2, bool), np.full(len(twice), ""), dq=dq[twice]
    )
    better, notices = mended(table)
    assert [notice.kind for notice in notices] == ["time rebuilt"]
    assert len(better) == len(true)
    moving = np.abs(np.diff(better.time) - np.diff(true)) < 1e-6
    assert moving.mean() > 0.99


def test_time_that_goes_back_or_stands_in_milliseconds_is_refused() -> None:
    motions = moved(robot(), 1, runs=1)
    back = motions.time.copy()
    back[100] = 0.0
    with pytest.raises(InputError, match=r"line 102, column time_s.*does not go back"):
        mended(dataclasses.replace(motions, time=back))
    with pytest.raises(InputError, match="milliseconds"):
        mended(dataclasses.replace(motions, time=motions.time * 1e3))


def test_a_gap_parts_a_run_and_runs_of_other_rates_are_laid_on_one_grid() -> None:
    motions = moved(robot(), 1, runs=2, seconds=15.0)
    kept = np.r_[0:1000, 1100:3000, 3000:6000:2]  # a hole in path 1, half the rate in path 2
    found = list(stretches(motions.rows(kept)))
    assert [stretch.run for stretch in found] == ["path 1", "path 1", "path 2"]
    assert {stretch.rate for stretch in found} == {100.0}  # of a run, not between them


@pytest.mark.long
@pytest.mark.parametrize(
    "kept", [np.r_[0:3000, 3000:6000:2], pytest.param(np.r_[0:6000, 6000:9000:2], marks=pytest.mark.long)]
)
def test_an_arm_whose_runs_have_other_rates_has_nothing_missing(kept: np.ndarray) -> None:
    motions = moved(robot(), 3, runs=len(kept) // 3000 + 1, seconds=15.0)
    found = diagnose_motion(robot(), motions.rows(kept)).verdict
    assert found.answer == "nothing missing"
    assert not found.effects


def test_positions_of_a_slower_run_are_laid_without_corners() -> None:
    motions = moved(robot(), 3, runs=3, noise=0.0, seconds=15.0)
    slow = next(each for each in stretches(motions.rows(np.r_[0:6000, 6000:9000:8])) if each.run == "path 3")
    known = motions.q[6000 : 6000 + len(slow)]
    assert np.abs(slow.q - known).max() < 2e-4


def test_the_filter_has_no_lag_and_derivatives_are_those_of_the_path() -> None:
    time = np.arange(4000) / 400
    q = np.sin(2 * np.pi * 0.7 * time)[:, None]
    how = preparation(400.0, 8.0, "test")
    only = next(parts([Stretch("", 400.0, time, q, q, None, None)], how))
    rows = only.kept
    assert np.diff(rows).min() == how.every > 1
    assert only.dq[rows, 0] == pytest.approx(2 * np.pi * 0.7 * np.cos(2 * np.pi * 0.7 * only.time[rows]), abs=0.02)
    assert how.low_passed(q, rows)[:, 0] == pytest.approx(q[rows, 0], abs=2e-3)
    sections = butter(4, 8.0, fs=400.0, output="sos")
    noise = np.random.default_rng(0).normal(size=(len(q), 2))
    assert how.low_passed(noise, rows)[5:-5] == pytest.approx(
        sosfiltfilt(sections, noise, axis=0)[rows][5:-5], abs=1e-4
    )


def test_long_stretches_in_parts_give_the_rows_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    arm, motions = robot(), moved(robot(), 2, runs=1, seconds=12.0)
    how = preparation(200.0, 10.0, "test")
    layout, model = TorqueLayout(arm, (), False), stated_model(arm)
    whole = build_rows(layout, list(stretches(motions)), how, model)
    monkeypatch.setattr("armscope.motion.samples.preparation.FILTER", dataclasses.replace(FILTER, chunk=500))
    pieces = build_rows(layout, list(stretches(motions)), how, model)
    assert np.array_equal(pieces.time, whole.time)
    assert pieces.torque == pytest.approx(whole.torque, abs=2e-3 * np.abs(whole.torque).max())
    assert pieces.columns[1] == pytest.approx(whole.columns[1], abs=float(2e-2 * np.abs(whole.columns[1]).max()))


def test_the_cutoff_follows_the_motion_and_not_the_noise() -> None:
    how, first = chosen_cutoff(robot(), list(stretches(moved(robot(), 3, noise=0.05))), None)
    assert 2.0 <= how.cutoff < 40.0
    assert "explains as much" in how.words
    assert first.model.background[:, 1] == pytest.approx(COULOMB, rel=0.1)
    assert chosen_cutoff(robot(), list(stretches(moved(robot(), 3, runs=1))), 6.0)[0].cutoff == 6.0


@pytest.mark.long
def test_rows_that_are_thinned_resolve_what_the_filter_lets_through(monkeypatch: pytest.MonkeyPatch) -> None:
    arm = robot()
    train = list(stretches(moved(arm, 3)))
    whole, _ = chosen_cutoff(arm, train, None)
    monkeypatch.setattr(preparation_room, "FILTER", dataclasses.replace(FILTER, most_rows=900))
    thin, _ = chosen_cutoff(arm, train, None)
    asked, _ = chosen_cutoff(arm, train, whole.cutoff)
    assert thin.every > whole.every
    assert thin.cutoff < whole.cutoff
    assert thin.rate / thin.every >= 1.5 * thin.cutoff > 1.5 * thin.rate / thin.every / 4
    assert asked.cutoff == whole.cutoff
    assert thin.cutoff >= thin.position_cutoff / CUTOFF.beyond_motion * 0.95


def test_waves_that_the_library_will_try_are_those_in_the_torque() -> None:
    def rippled(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return np.column_stack([np.zeros(len(q)), 2 * np.cos(13 * q[:, 1] - 1), np.zeros(len(q))])

    longest = next(stretches(moved(robot(), 3, rippled)))
    counts, tried = first_look(robot(), longest, preparation(200.0, 30.0, "test")).waves[1]
    assert 13 in counts
    assert tried > 20 > len(counts)


def test_the_motion_ends_where_positions_show_it_or_torques_do() -> None:
    positions, close, torques = (preparation(200.0, cutoff, "test", 9.0) for cutoff in (8.0, 10.0, 3.0))
    assert (positions.motion_hz, close.motion_hz, torques.motion_hz) == (4.5, 9.0 / 1.4, 3.0)


def test_positions_are_low_passed_close_to_the_motion_where_torques_are_low_passed_above_it() -> None:
    train = list(stretches(moved(robot(), 3)))
    above, below = (chosen_cutoff(robot(), train, cutoff)[0] for cutoff in (30.0, 3.0))
    assert above.position_cutoff < above.cutoff
    assert below.position_cutoff == pytest.approx(above.position_cutoff * 2 / 1.4)
    assert (above.motion_hz, below.motion_hz) == (pytest.approx(above.position_cutoff / 1.4), 3.0)


def test_positions_are_smoothed_where_their_own_noise_begins() -> None:
    quiet, noisy = moved(robot(), 3), moved(robot(), 3)
    worse = dataclasses.replace(noisy, q=noisy.q + 1e-3 * np.random.default_rng(0).normal(size=noisy.q.shape))
    cutoffs = [chosen_cutoff(robot(), list(stretches(each)), 20.0)[0].position_cutoff for each in (quiet, worse)]
    assert 1.0 < cutoffs[1] <= cutoffs[0] < 40.0


def test_correlated_residuals_count_as_fewer_rows() -> None:
    arm, motions = robot(), moved(robot(), 4, seconds=15.0)
    rows = build_rows(
        TorqueLayout(arm, (), False), list(stretches(motions)), preparation(200.0, 10.0, "test"),
        stated_model(arm),
    )  # fmt: skip
    rng = np.random.default_rng(0)
    white = rng.normal(size=rows.torque.shape)
    slow = np.array(white)
    for row in range(1, len(slow)):
        slow[row] = 0.9 * slow[row - 1] + np.sqrt(1 - 0.81) * white[row]
    assert estimate_weights(rows, white).correlated.max() < 2
    assert 8 < np.median(estimate_weights(rows, slow).correlated) < 35  # 19 by theory
    left = rows.torque - rows.nominal - rows.modelled(fitted_together(rows, np.arange(rows.layout.width)))
    assert relative(left, rows.torque) < 0.01


def test_the_library_stands_where_the_table_can_show_it() -> None:
    motions = moved(robot(), 5)
    still = dataclasses.replace(motions, q=motions.q * [1, 1, 0])
    placed = place_causes(seen(still))
    assert not [cause for cause in placed if cause.location == "joint 3"]
    assert {cause.cause for cause in placed} <= set(catalogue.CAUSES)
    warming = [cause for cause in placed if cause.cause is catalogue.TEMPERATURE_FRICTION]
    assert {cause.driver for cause in warming} == {"running time"}, "no temperature is recorded"
    masses = list(place_masses(seen(motions)))
    centres = {cause.location for cause in masses if cause.cause is catalogue.LINK_CENTRE}
    assert centres == {"link 2", "link 3"}  # a standing axis does not feel where its centre lies


def test_a_curve_contains_its_special_cases_and_excludes_them() -> None:
    layout = TorqueLayout(robot(), tuple(place_causes(seen(moved(robot(), 5)))), False)
    space = build_space(layout, np.ones(3), 200.0)

    def numbers(kind: str, driver: str) -> list[tuple[int, Candidate]]:
        found = enumerate(space.candidates)
        return [(n, c) for n, c in found if (c.kind, c.location, c.driver) == (kind, "joint 2", driver)]

    (_, curve), (asymmetry, _) = numbers("unknown", "speed")[0], numbers("asymmetric_friction", "direction")[0]
    assert asymmetry in curve.special_cases
    assert len(space.frames) == 9


def test_one_run_in_turn_is_held_out() -> None:
    arm, motions = robot(), moved(robot(), 6)
    layout = TorqueLayout(arm, tuple(place_causes(seen(motions))), False)
    how = preparation(200.0, 10.0, "test")
    selected = select_causes(layout, list(stretches(motions)), how, ("path 1", "path 2"), lambda text, share: None)
    held = folds(selected)
    assert [set(fold.rows.run[fold.which]) for fold in held] == [{"path 1"}, {"path 2"}]
    # each path counts by its own noise, so that their numbers of independent rows need not add up
    assert held[0].problem.n + held[1].problem.n == pytest.approx(selected.problem.n, rel=0.2)
    for number, fold in enumerate(held):
        (other,) = (k for k in range(2) if k != number)
        as_all = weighed(selected.rows, selected.by_joint[other], selected.weights)
        assert as_all.n == pytest.approx(selected.blocks[other].n)
        own, common = (np.diag(p.equations.G) for p in (fold.problem, fold.problem.with_equations(as_all)))
        ratio = common[own > 0] / own[own > 0]
        assert 0.5 < ratio.min() <= ratio.max() < 2  # the sums of the other path, each joint by its own noise


def test_sizes_that_differ_from_path_to_path_are_no_physics() -> None:
    assert PathAgreement(np.array([0.95, 1.1]), np.array([0.05, 0.05])).consistent
    assert PathAgreement(np.array([2.0, -0.5]), np.array([0.05, 0.05])).consistent is False
    assert PathAgreement(np.array([1.0, 3.0]), np.array([0.1, 2.0])).consistent is None


def test_nothing_found_is_an_answer() -> None:
    assert answer_of([], UnexplainedTorque(False), HeldOutErrors(0.1, 0.1, 0.1)) == ("nothing missing", False)
    foreign = HeldOutErrors(1.06, 1.06, 1.06)
    assert answer_of([], UnexplainedTorque(False), foreign) == ("cannot tell", True)
    assert headline([], foreign).startswith("Cannot tell what is missing: the model foretells these torques no better")


def test_causes_that_make_held_out_motion_worse_are_no_answer() -> None:
    rest = (False, (Parameter("mass", "kg", 1.0, 0.1),), 0.5, "N m", "joint 4", 0.3, 9.0)
    found = [FoundCause("link_mass", "link 4", "masses", "load", "link mass at link 4", *rest)]
    helps, hardly = HeldOutErrors(0.2, 0.1, 0.1), HeldOutErrors(0.2, 0.3, 0.19)
    not_anew = HeldOutErrors(0.2, 0.3, 0.05)
    assert [answer_of(found, UnexplainedTorque(False), each)[0] for each in (helps, hardly, not_anew)] == [
        *("explained", "cannot tell", "explained")
    ]
    assert headline(found, helps).startswith("Link 4 is 1.00 ± 0.20 kg heavier than stated – 30 %")
    assert headline(found, hardly).startswith("Cannot tell what is missing: nothing that was found helps")
    assert "met to 5.0 % instead of 20 % by these causes; to 30 % where" in headline(found, not_anew)
    assert HeldOutErrors(0.058, 0.058, 0.058).words().endswith("met to 5.8 % by friction and rotors alone.")


def test_tables_that_show_nothing_are_refused_and_doubts_are_told() -> None:
    motions = moved(robot(), 7, runs=1)
    with pytest.raises(InputError, match="no joint that moves"):
        check_motions(robot(), dataclasses.replace(motions, q=np.zeros_like(motions.q)))
    with pytest.raises(InputError, match="Is the channel recorded"):
        check_motions(robot(), dataclasses.replace(motions, effort=np.ones_like(motions.effort)))
    with pytest.raises(InputError, match="gain_nm_per_a"):
        check_motions(robot(), dataclasses.replace(motions, kind="current"))
    one_way = motions.q.copy()
    one_way[:, 0] = np.linspace(0, 3, len(one_way))
    again = dataclasses.replace(motions, q=one_way.copy(), run=np.repeat(["there", "again"], len(one_way) // 2))
    again.q[len(one_way) // 2 :, 0] -= 1.5  # each run anew from the start
    assert "one way only" in {notice.kind for notice in check_motions(robot(), again)}
    kinds = {notice.kind for notice in check_motions(robot(), dataclasses.replace(motions, q=one_way))}
    assert "one way only" in kinds
    assert json.dumps(sorted(kinds))


def test_too_few_rows_are_refused_before_anything_is_fitted() -> None:
    few = moved(robot(), 3, runs=1, seconds=2.6)
    with pytest.raises(InputError, match="39 values of friction and masses need at least 78 numbers"):
        diagnose_motion(robot(), few.rows(slice(None, None, 20)))


def test_what_is_wrong_with_the_time_of_many_runs_is_said_once() -> None:
    motions = moved(robot(), 2, seconds=2.0)
    jitter = np.where(np.arange(len(motions)) % 2, 0.001, 0.0)
    _, notices = mended(motions.at_times(motions.time + jitter))
    (told,) = (notice for notice in notices if notice.kind == "uneven time")
    assert told.text.startswith("2 runs, such as run path 1: ")
