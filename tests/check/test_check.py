"""Sound tables are left in peace, what is odd in one is said."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.check.report import check
from armscope.recordings import read_recordings
from armscope.robot import load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import Instrument
from tests.calibration.worlds import far_away, measured, poses, ur_like
from tests.check.conftest import TOOL
from tests.robot.arms import STANDARD, dh_arm

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared" / "recordings"


def problems(recordings, arm):
    return [each.text() for each in check(recordings, arm).suspicions if each.weight == "problem"]


def test_a_sound_table_has_no_suspicions(arm, sound):
    report = check(sound, arm)
    assert report.suspicions == ()
    assert "nothing looks wrong" in report.text()
    assert not report.has_problems
    # no orientation, no arm, one row in ten: still sound
    assert check(replace(sound, orientation=None), arm).suspicions == ()
    assert check(sound).suspicions == ()
    assert check(sound.rows(slice(0, None, 2)), arm).suspicions == ()


def test_an_instrument_coarser_than_all_that_is_left_is_in_another_unit(arm, sound):
    for sigma, said in ((0.05, False), (50.0, True)):
        stated = arm.description.model_copy(update={"instrument": Instrument(sigma_mm=sigma)})
        found = problems(sound, build_arm(stated))
        assert bool(found) == said
        assert not said or "was it in micrometres?" in found[0]


def _runs(*tables):
    """Several tables as runs a, b, ... of one."""
    names = [name for name, table in zip("abc", tables, strict=False) for _ in range(len(table))]
    stacked = {
        field: np.concatenate([getattr(table, field) for table in tables])
        for field in ("motor_angles", "positions", "target", "id", "orientation")
    }
    return replace(tables[0], run=np.array(names), **stacked)


@pytest.mark.long
@pytest.mark.parametrize("share", [pytest.param(80, marks=pytest.mark.long), 20])
def test_a_mistake_of_one_run_is_named_with_its_run_however_few_rows_it_has(arm, sound, share):
    other = sound.rows(slice(share))
    for mistake, words in (
        (replace(other, positions=other.positions / 1e3), "metres that were declared as millimetres in run b"),
        (replace(other, positions=other.positions * 1e3), "millimetres that were declared as metres in run b"),
        (replace(other, positions=other.positions * [1, -1, 1]), "mirror image of the arm's in run b"),
        (replace(other, positions=np.roll(other.positions, 7, axis=0)), "does not explain the points in run b"),
    ):
        found = problems(_runs(sound, mistake), arm)
        assert len(found) == 1
        assert words in found[0]
    assert problems(_runs(sound, other), arm) == []


@pytest.mark.long
def test_a_tool_that_sits_quite_elsewhere_in_a_run_is_a_moved_tool_and_no_other_robot(arm):
    rng = np.random.default_rng(3)
    tables = [
        measured(arm, poses(rng, 60, 6), far_away(rng), {"": tool}, 5e-5, rng) for tool in ([0, 0, 0.1], [0.4, 0, 0])
    ]
    both = replace(
        tables[0],
        run=np.repeat(["a", "b"], 60),
        **{
            field: np.concatenate([getattr(table, field) for table in tables])
            for field in ("motor_angles", "positions", "target", "id")
        },
    )
    report = check(both, arm)
    assert not report.has_problems, report.text()
    assert "tool seems to have moved between runs" in report.text()


@pytest.mark.long
def test_a_tool_longer_than_the_arm_explains_nothing(arm):
    # where only two joints move, a tool of a kilometre puts the points upon their sphere
    rng = np.random.default_rng(4)
    angles = np.tile([0.1, -1, 1, 0.2, 0.3, 0.4], (60, 1))
    angles[:, :2] += rng.uniform(-1, 1, (60, 2))
    table = measured(arm, angles, far_away(rng), TOOL, 5e-5, rng)
    assert problems(table, arm) == []
    found = problems(replace(table, positions=table.positions * 1e3), arm)
    assert len(found) == 1
    assert "millimetres that were declared as metres" in found[0]


@pytest.mark.parametrize("motor", range(6))
def test_one_joint_that_moves_alone_is_no_other_robot(arm, motor):
    rng = np.random.default_rng(5)
    angles = np.tile([0.1, -1, 1, 0.2, 0.3, 0.4], (40, 1))
    angles[:, motor] += np.linspace(-1.5, 1.5, 40)
    assert problems(measured(arm, angles, far_away(rng), TOOL, 5e-5, rng), arm) == []


def test_another_robot_is_said_to_be_one(sound):
    assert "does not explain the points" in problems(sound, dh_arm(STANDARD))[0]
    found = problems(sound, dh_arm(STANDARD[:5]))
    assert found == ["the table has 6 motor angles, test arm has 5 motors. Is this the right robot for the recordings?"]


def test_the_report_counts_what_the_table_holds(arm, sound):
    payload = np.full(80, 2.0)
    temperature = np.where(np.arange(80) < 8, np.nan, np.linspace(20, 25, 80))
    again = sound.rows(np.r_[np.arange(80), 5, 6, 7])
    again = replace(again, payload=np.r_[payload, [2.0] * 3], temperature=np.r_[temperature, [21.0] * 3])
    again.positions[81] += [1e-4, 0, 0]
    again.positions[82] += [0, 1e-4, 0]
    angles = again.motor_angles.copy()
    angles[:, 4] = 0.3 + np.random.default_rng(0).normal(scale=1e-4, size=83)
    report = check(replace(again, motor_angles=angles))
    assert [motor.moved for motor in report.contents.motors] == [True] * 4 + [False, True]
    assert report.contents.runs[0].rows == 83
    assert report.contents.runs[0].configurations == 80
    missing = {context.name: context.missing for context in report.contents.context}
    assert missing == {"temperature": 8, "payload": 0, "orientation": 0}
    text = report.text()
    assert "payload: 2 kg throughout" in text
    assert "payload never changes" in text
    # revisits, with the joint noise above, of poses 5, 6 and 7; held apart from exact copies
    assert check(again).contents.repeats.copies == 1
    assert check(again).contents.repeats.visits == 2
    assert check(again).contents.repeats.scatter == pytest.approx(1e-4 / np.sqrt(2 * 3), rel=1e-3)


def test_a_run_without_what_another_run_recorded_is_looked_at_all_the_same(arm, sound):
    empty = replace(sound, payload=np.full(len(sound), np.nan), time=np.arange(len(sound), dtype=float))
    names = [context.name for context in check(empty, arm).contents.context]
    assert "time" in names
    assert "payload" not in names


def test_points_at_one_place_or_in_one_plane_are_said():
    rng = np.random.default_rng(2)
    arm, base = ur_like(), (np.eye(3), np.zeros(3))
    still = measured(arm, np.tile([0.1, -1, 1, 0.2, 0.3, 0.4], (20, 1)), base, TOOL, 1e-5, rng)
    report = check(still)
    assert report.has_problems
    assert "every joint stands still" in report.text()
    assert "at one point" in report.text()
    assert problems(still, arm) == ["every joint stands still."]
    turning = np.tile([0.1, -1, 1, 0.2, 0.3, 0.4], (20, 1))
    turning[:, 0] = np.linspace(-2, 2, 20)
    for place in (base, far_away(rng)):  # the plane may lean any way
        report = check(measured(arm, turning, place, TOOL, 1e-6, rng))
        assert "lie in one plane" in report.text()
    two = replace(measured(arm, np.vstack([turning, poses(rng, 20, 6)]), base, TOOL), run=np.repeat(["a", "b"], 20))
    assert "only q1 move" in check(two).text()
    assert check(two).contents.runs[1].moved == (1, 2, 3, 4, 5, 6)


def test_too_few_rows_are_looked_at_without_the_arm(arm, sound):
    for count in (1, 2, 3):
        text = check(sound.rows(slice(count)), arm).text()
        assert "too few rows to fit base and tool" in text
        assert re.search(r"\d+ are there, \d+ are needed", text)
        assert "plane" not in text


def test_joints_beyond_their_limits_are_counted(sound):
    arm = ur_like(joint_limits_deg=[[-360, 360]] * 5 + [[-90, 90]])
    beyond = int(np.sum(np.abs(sound.motor_angles[:, 5]) > np.pi / 2 + 1e-3))
    assert f"joint 6 is outside its limits in {beyond} rows" in check(sound, arm).text()


@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (lambda t: {"positions": t.positions / 1e3}, "mm, though joints move by up to"),
        (lambda t: {"positions": t.positions * 1e3}, "mm, though joints move by up to"),
        (lambda t: {"motor_angles": np.radians(t.motor_angles)}, "radians that were declared as degrees"),
    ],
)
def test_without_an_arm_units_that_no_arm_has_are_hinted_at(mistake, words, sound):
    found = check(replace(sound, **mistake(sound))).suspicions
    assert [each.weight for each in found] == ["hint"]
    assert words in found[0].text()


@pytest.mark.shared
@pytest.mark.parametrize(
    "name",
    [
        "irb120-offsets",
        *(pytest.param(name, marks=pytest.mark.long) for name in ("ur10-ipa", "ma1400-leica", "iiwa7-payload")),
        "panda-charuco",  # with orientations
    ],
)
def test_real_tables_have_no_problems_and_their_mistakes_are_still_named(name):
    if not SHARED.is_dir():
        pytest.skip("../shared/recordings is not here, so there is nothing to look at")
    recordings = read_recordings(SHARED / name / "recordings.csv.gz")
    arm = load_arm(ROOT / "config" / "recordings" / name / "robot.yaml")
    report = check(recordings, arm)
    assert not report.has_problems, report.text()
    assert ("tool seems to have moved" in report.text()) == (name == "iiwa7-payload")
    mirrored = problems(replace(recordings, positions=recordings.positions * [1, 1, -1]), arm)
    assert len(mirrored) == 1
    assert "left-handed" in mirrored[0]
    if recordings.orientation is not None:
        other = replace(recordings, orientation=np.roll(recordings.orientation, -1, axis=1))
        assert "order x, y, z, w" in problems(other, arm)[0]


@pytest.mark.parametrize("lost", [[30], [3, 14, 40, 55, 70]])
def test_lost_readings_do_not_condemn_a_table(arm, sound, lost):
    """One row of 0, 0, 0 in eighty was told as another robot, and nothing was diagnosed."""
    points = sound.positions.copy()
    points[lost] = 0.0
    report = check(replace(sound, positions=points), arm)
    assert not report.has_problems
    (hint,) = [each.text() for each in report.suspicions if "where all others put the tool" in each.text()]
    assert "exactly 0, 0, 0" in hint
    slip = sound.positions.copy()
    slip[lost[0], 2] *= 10
    assert "Mistyped" in " ".join(each.text() for each in check(replace(sound, positions=slip), arm).suspicions)
