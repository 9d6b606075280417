"""What speaks against a cause that the evidence asks for, and what leaves it open."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from armscope.motion.constants import NOISE
from armscope.motion.fitting.consistency import PathAgreement
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.motion.summary import doubts, tenable
from armscope.motion.summary.doubts import not_told_apart
from armscope.recordings.motions import as_motions
from armscope.verdict.effects import Alternative, Parameter
from tests.motion.moving import behind_its_drive, robot

SOFT = 6e-3
NOTHING = PathAgreement(np.array([1.0, 1.0]), np.array([0.1, 0.1]))


@pytest.fixture(scope="module")
def gives_way() -> MotionDiagnosis:
    return diagnose_motion(robot(), as_motions(behind_its_drive(robot(), 2, SOFT), "motions.csv", 3))


def number_of(found: MotionDiagnosis) -> int:
    (number,) = found.selected.best.candidates
    return number


@pytest.mark.long
def test_a_size_that_no_two_paths_tell_is_undetermined(gives_way: MotionDiagnosis) -> None:
    number = number_of(gives_way)
    alone = np.array([1.0, 1.1]), np.array([0.1, 2.0])
    told = doubts.doubt_of(gives_way.selected, number, PathAgreement(*alone), ())
    assert told.startswith("Undetermined: no two paths tell its size by themselves.")
    assert "no two fifths of the motion" in doubts.doubt_of(
        gives_way.selected, number, PathAgreement(*alone, False), ()
    )
    assert NOISE.blocks_of_time == 5  # fifths
    in_one_run = PathAgreement(*alone, True, ("path 2",))
    assert doubts.doubt_of(gives_way.selected, number, in_one_run, ()) == ""
    assert in_one_run.words == "it is there in run path 2 only: no other path tells its size"


@pytest.mark.long
def test_a_size_that_may_as_well_be_nothing_is_doubtful(gives_way: MotionDiagnosis) -> None:
    """A delay of -0.79 ms, known to 0.91, was told as a fifth of what a drive leaves, and nothing spoke against it."""
    late = Parameter("delay", "ms", -0.79, 0.46)
    told = doubts.doubt_of(gives_way.selected, number_of(gives_way), NOTHING, (late,))
    assert told.startswith("Its 95 % interval holds zero")
    assert not doubts.may_be_nothing((late, Parameter("offset", "N m", 2.0, 0.1)))
    assert not doubts.may_be_nothing((Parameter("speed", "rad/s", 0.1, float("nan")),))


@pytest.mark.long
def test_a_size_whose_interval_is_nearly_as_wide_is_not_determined(gives_way: MotionDiagnosis) -> None:
    """Link 2 of a real arm was told to be 4.3 kg lighter than stated, known to 4.0."""
    told = [
        doubts.doubt_of(gives_way.selected, number_of(gives_way), NOTHING, (Parameter("mass", "kg", -4.31, error),))
        for error in (2.04, 1.0)
    ]
    assert told[0].startswith("Its size is not determined")
    assert told[1] == ""
    powers = Parameter("square", "N m s^2/rad^2", -6.9, 3.0), Parameter("cube", "N m s^3/rad^3", -1.6, 0.7)
    assert not doubts.determined(powers[:1])
    assert doubts.determined(powers)


def test_a_size_that_differs_is_doubtful_and_one_that_agrees_is_not(gives_way: MotionDiagnosis) -> None:
    number = number_of(gives_way)
    differs = PathAgreement(np.array([2.0, -0.5]), np.array([0.05, 0.05]))
    assert "differs from path to path" in doubts.doubt_of(gives_way.selected, number, differs, ())
    assert doubts.doubt_of(gives_way.selected, number, NOTHING, ()) == ""
    assert gives_way.verdict.effects[0].doubt == ""
    assert "in doubt" not in gives_way.verdict.headline


def test_a_link_swings_on_its_drive_by_the_inertia_behind_it(gives_way: MotionDiagnosis) -> None:
    model = robot().model
    data = model.createData()
    (compliance,) = gives_way.verdict.effects[0].parameters[:1]
    heaviest = max(pin.crba(model, data, q)[2, 2] for q in gives_way.selected.rows.q[::10])
    expected = 1 / (2 * np.pi * np.sqrt(compliance.value * heaviest))
    assert doubts.swing_hz(gives_way.selected, number_of(gives_way)) == pytest.approx(expected, rel=0.02)


def test_a_link_swings_with_what_the_arm_carries(gives_way: MotionDiagnosis) -> None:
    """As stated in the heaviest run; it was left out, and the link told to swing too fast."""
    rows = gives_way.selected.rows
    loaded = [
        replace(each, signals=replace(each.signals, payload=np.full(len(each.signals.time), 5.0)))
        for each in rows.samples
    ]
    arm, q = robot(), rows.q[::10]
    model = arm.with_masses(arm.inertial + 5.0 * arm.point_load())
    data = model.createData()
    expected = 1 / (2 * np.pi * np.sqrt(1e-4 * max(pin.crba(model, data, each)[2, 2] for each in q)))
    assert doubts.swing_of(replace(rows, samples=tuple(loaded)), 2, 1e-4) == pytest.approx(expected, rel=0.02)
    assert doubts.swing_of(rows, 2, 1e-4) > 1.2 * expected


def test_a_link_that_would_swing_slowly_is_doubtful(
    gives_way: MotionDiagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(doubts, "swing_hz", lambda *_: 3.21)
    told = doubts.doubt_of(gives_way.selected, number_of(gives_way), NOTHING, ())
    assert "would swing on it at 3.2 Hz" in told


def test_no_link_swings_more_slowly_than_its_motor_moves(
    gives_way: MotionDiagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    selected = gives_way.selected
    assert tenable.tenable(selected, 200.0).best.candidates == selected.best.candidates
    monkeypatch.setattr(tenable, "motion_hz", lambda *_: 1e3)
    assert number_of(gives_way) not in tenable.tenable(selected, 200.0).best.candidates


def test_how_fast_a_joint_moves_is_that_of_its_path(gives_way: MotionDiagnosis) -> None:
    rows = gives_way.selected.rows
    apart = np.gradient(rows.dq[:, 0], rows.time)[rows.run == rows.run[0]][3:-3]
    speed = np.sqrt(np.mean(rows.dq[:, 0] ** 2))
    expected = np.sqrt(np.mean(apart**2)) / speed / (2 * np.pi)
    assert doubts.motion_hz(gives_way.selected, 0) == pytest.approx(expected, rel=0.15)


def test_a_rival_that_fits_as_well_and_only_pays_for_its_numbers_is_a_doubt() -> None:
    """A link's mass was named, certain, where its centre lay elsewhere: three numbers cost 8 nats, and fitted alike."""
    alike = Alternative("link_first_moment", "link 2", "masses", 8.1, "load", 0.4)
    assert not_told_apart([alike]).startswith("These rows fit link first moment at link 2 as well")
    told_apart = replace(alike, discriminability_nats=8.1)
    assert not_told_apart([told_apart]) == not_told_apart([]) == ""
