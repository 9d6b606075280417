"""Common mistakes are named by what they are, sound tables are left in peace."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.check.report import check
from armscope.recordings import read_recordings
from armscope.robot import chain, load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import Instrument
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like
from tests.robot.arms import STANDARD, dh_arm

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared" / "recordings"
TOOL = {"": [0.05, 0.1, 0.2]}


@pytest.fixture
def arm():
    return ur_like()


@pytest.fixture
def sound(arm):
    """A table with nothing wrong: an arm of usual tolerances, an instrument far away, orientations included."""
    rng = np.random.default_rng(1)
    real, base, angles = planted(arm, rng), far_away(rng), poses(rng, 80, 6)
    recordings = measured(real, angles, base, TOOL, 5e-5, rng)
    turned = Rotation.from_matrix(base[0] @ chain(real, angles).tool_rotation) * Rotation.from_rotvec([0.3, -1.0, 0.5])
    return replace(recordings, orientation=np.roll(turned.as_quat(), 1, axis=1))


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


def _exchange(table):
    positions = table.positions.copy()
    positions[[10, 40]] = positions[[40, 10]]
    return replace(table, positions=positions)


def _off(table, motor, zero):
    return replace(table, motor_angles=table.motor_angles + np.where(np.arange(6) == motor, zero, 0))


def _flip(table, motor):
    return replace(table, motor_angles=table.motor_angles * np.where(np.arange(6) == motor, -1, 1))


def _relative(table, sign):
    """Angle 3 with that of joint 2 added or taken off."""
    return table.motor_angles + sign * table.motor_angles[:, [1]] * (np.arange(6) == 2)


@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (lambda t: replace(t, motor_angles=np.degrees(t.motor_angles)), "degrees that were declared as radians"),
        (lambda t: replace(t, motor_angles=np.radians(t.motor_angles)), "radians that were declared as degrees"),
        (lambda t: replace(t, positions=t.positions / 1e3), "metres that were declared as millimetres"),
        (lambda t: replace(t, positions=t.positions * 1e3), "millimetres that were declared as metres"),
        (lambda t: replace(t, positions=t.positions * [1, -1, 1]), "left-handed"),
        (lambda t: replace(t, positions=t.positions[:, [1, 0, 2]]), "left-handed"),
        (lambda t: replace(t, motor_angles=t.motor_angles[:, ::-1]), "reverse order"),
        (lambda t: replace(t, positions=np.roll(t.positions, 1, axis=0)), "1 row(s) too late"),
        (lambda t: replace(t, positions=np.roll(t.positions, -2, axis=0)), "2 row(s) too early"),
        (lambda t: _flip(t, 2), "joint 3 turns the other way"),
        # an arm upside down: the same to the points, wherever its base may be
        (lambda t: _flip(t, 0), "joint 1 turns the other way"),
        (lambda t: _flip(t, 0), "Or the zero of joint 2 is 180 degrees off: the points can't tell."),
        (_exchange, "2 rows seem to have exchanged their points: a: 11, a: 41"),
        (lambda t: replace(t, orientation=np.roll(t.orientation, -1, axis=1)), "in the order x, y, z, w ("),
        (lambda t: replace(t, orientation=t.orientation * [1, -1, -1, -1]), "turn the other way"),
        (
            lambda t: replace(t, orientation=np.roll(t.orientation * [1, -1, -1, -1], -1, axis=1)),
            "order x, y, z, w and turn the other way",
        ),
        (lambda t: replace(t, orientation=np.roll(t.orientation, 1, axis=1)), "the real part stands in qx"),
        (lambda t: replace(t, motor_angles=-t.motor_angles), "every joint turns the other way"),
        (lambda t: replace(t, motor_angles=_relative(t, 1)), "q3 holds the forearm's angle absolute"),
        (lambda t: replace(t, motor_angles=_relative(t, -1)), "q3 holds the forearm's angle relative to link 2"),
        (lambda t: replace(t, positions=t.positions * 1e-4), "Are these errors, measured minus nominal?"),
        (lambda t: replace(t, positions=t.positions / 10), "centimetres that were declared as millimetres"),
        (lambda t: replace(t, positions=t.positions * [1, 1, 1e-3]), "z looks like metres, where x and y are millim"),
        (lambda t: replace(t, positions=t.positions * [1e-3, 1, 1]), "x looks like metres, where y and z are millim"),
        (lambda t: replace(t, positions=t.positions / 25.4), "inches that were declared as millimetres"),
        (
            lambda t: replace(t, motor_angles=t.motor_angles[:, [0, 1, 2, 4, 3, 5]]),
            "joints 4 and 5 are exchanged",
        ),
        (lambda t: _off(t, 1, np.pi / 2), "zero of joint 2 is 90 degrees off. Add -90 degrees to q2"),
        (lambda t: _off(t, 3, np.pi), "zero of joint 4 is 180 degrees off"),
        (lambda t: replace(t, orientation=t.orientation * [1, 1, -1, -1]), "mirrored axis x"),
        (lambda t: replace(t, orientation=t.orientation * [1, -1, -1, 1]), "mirrored axis z"),
        (
            lambda t: replace(t, positions=t.positions[np.random.default_rng(0).permutation(len(t))]),
            "does not explain the points",
        ),
    ],
)
def test_a_mistake_is_named_by_what_it_is(mistake, words, arm, sound):
    found = problems(mistake(sound), arm)
    assert len(found) == 1
    assert words in found[0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda dh: dh.model_copy(update={"convention": "modified"}),
            "are in the standard convention, not the mod",
        ),
        (
            lambda dh: dh.model_copy(
                update={"joints": [row.model_copy(update={"alpha_deg": -row.alpha_deg}) for row in dh.joints]}
            ),
            "every alpha of the D-H rows has the other sign",
        ),
        (
            lambda dh: dh.model_copy(
                update={"joints": [row.model_copy(update={"a_mm": row.d_mm, "d_mm": row.a_mm}) for row in dh.joints]}
            ),
            "a and d of the D-H rows are exchanged. Exchange a_mm and d_mm",
        ),
    ],
)
def test_a_mistake_in_the_rows_of_robot_yaml_is_named_as_one(change, words, arm, sound):
    stated = arm.description.model_copy(update={"dh": change(arm.description.dh)})
    (found,) = problems(sound, build_arm(stated))
    assert words in found


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


@pytest.mark.parametrize("share", [80, 20])
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


@pytest.mark.parametrize("sequence", ["ZYX", "xyz", "ZXZ", "YXZ"])
@pytest.mark.parametrize("small", [False, True])
def test_orientations_that_are_not_the_tools_are_said_and_left_alone(sequence, small, arm, sound):
    # the tool of poses about one direction turns little, so that another reading may be less wrong by chance
    table = sound.rows(np.abs(sound.motor_angles[:, 0]) < 1.5) if small else sound
    euler = Rotation.from_quat(table.orientation, scalar_first=True).as_euler("XYZ")
    wrong = Rotation.from_euler(sequence, euler).as_quat(scalar_first=True)
    report = check(replace(table, orientation=wrong), arm)
    assert [each.weight for each in report.suspicions] == ["hint"]
    assert "the orientations scatter by" in report.text()
    assert not report.consistency.orientations
    assert check(sound, arm).consistency.orientations


def test_each_target_may_be_turned_in_its_own_way(arm, sound):
    turned = Rotation.from_quat(sound.orientation, scalar_first=True)
    turned[40:] = turned[40:] * Rotation.from_rotvec([0, 0, 2.0])
    target = np.repeat(["p", "q"], 40)
    table = replace(sound, target=target, orientation=turned.as_quat(scalar_first=True))
    assert problems(table, arm) == []
    assert check(table, arm).consistency.orientations
    assert "order x, y, z, w" in problems(replace(table, orientation=np.roll(table.orientation, -1, axis=1)), arm)[0]


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
    assert "no joint moves" in report.text()
    assert "at one point" in report.text()
    assert problems(still, arm) == ["no joint moves."]
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
@pytest.mark.parametrize("name", ["ur10-ipa", "iiwa7-payload", "ma1400-leica", "irb120-offsets", "panda-charuco"])
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
