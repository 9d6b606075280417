"""Tables of motions that look right and are not, and some that look odd and are right."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.check.motions import check_moving
from armscope.core.inputs import InputError
from armscope.motion.check import check_motions
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.samples.timing import mended
from armscope.recordings.motions import as_motions, read_motions
from tests.motion.moving import moved, robot, table
from tests.seeds import seeds


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_runs_of_which_one_is_sampled_four_times_more_slowly_name_nothing(seed: int) -> None:
    """A joint that turns back passes all low speeds between two of its samples: no friction near rest is told there."""
    motion = table(robot(), seed, seconds=10.0)
    slower = motion[motion["run"] == "path 2"].iloc[::4]
    mixed = pd.concat([motion[motion["run"] == "path 1"], slower], ignore_index=True)
    verdict = diagnose_motion(robot(), as_motions(mixed, "motions.csv", 3)).verdict
    assert verdict.answer == "nothing missing"
    assert not verdict.effects


def test_a_channel_in_coarse_steps_is_not_cut_off() -> None:
    """It keeps its largest value as it keeps any other."""
    motions = moved(robot(), 3)
    coarse = replace(motions, effort=np.round(motions.effort / 5) * 5)
    assert max(np.sum(coarse.effort[:, j] == coarse.effort[:, j].max()) for j in range(3)) > 20
    assert "cut off" not in {notice.kind for notice in check_motions(robot(), coarse)}


def test_a_run_of_one_sample_is_a_counter() -> None:
    motion = table(robot(), 3, seconds=3.0)
    numbered = as_motions(motion.assign(run=np.arange(len(motion))), "motions.csv", 3)
    with pytest.raises(InputError, match=r"line 2, column run: .*number the rows"):
        mended(numbered)


def test_a_position_in_metres_beside_a_torque_says_which_two_do_not_go_together() -> None:
    motion = table(robot(), 3, seconds=3.0)
    with pytest.raises(InputError, match="found 'tau1_nm beside q1_m'"):
        as_motions(motion.rename(columns={"q1_rad": "q1_m"}), "motions.csv", 3)
    with pytest.raises(InputError, match="found 'f2_n beside q2_rad'"):
        as_motions(motion.rename(columns={"tau2_nm": "f2_n"}), "motions.csv", 3)


def test_millimetres_called_metres_are_asked_after() -> None:
    motion = table(robot(), 3, seconds=3.0).rename(columns={"q1_rad": "q1_m", "tau1_nm": "f1_n"})
    with pytest.raises(InputError, match=r"column q1_m: .*Are these millimetres\?"):
        as_motions(motion.assign(q1_m=1000 * motion["q1_m"]), "motions.csv", 3)


def test_a_torque_of_a_motor_that_the_arm_lacks_is_told() -> None:
    motion = table(robot(), 3, seconds=3.0).assign(tau4_nm=1.0, temperature4_c=20.0)
    assert as_motions(motion, "motions.csv", 3).notes == ("columns not used: tau4_nm, temperature4_c",)


def test_rows_that_are_parted_otherwise_than_the_first_line_are_told(tmp_path: Path) -> None:
    first, *rest = table(robot(), 3, seconds=3.0).to_csv(index=False).splitlines()
    (tmp_path / "motions.csv").write_text("\n".join([first, *(line.replace(",", ";") for line in rest)]))
    with pytest.raises(InputError, match="parted by semicolons or tabs"):
        read_motions(tmp_path / "motions.csv")


def test_gravity_that_points_up_is_asked_after_before_a_sign_is_turned() -> None:
    hanging = robot(gravity_m_s2=[0, 0, 9.81])
    told = [each.cure for each in check_moving(moved(robot(), 3), hanging).suspicions if "opposite" in each.statement]
    assert told
    assert all("points up" in cure for cure in told)


def test_a_speed_that_never_changes_while_the_joint_moves_is_told() -> None:
    motion = table(robot(), 3, seconds=3.0).assign(dq1_rad_s=0.0, dq2_rad_s=0.0, dq3_rad_s=0.0)
    (told,) = (each for each in check_motions(robot(), as_motions(motion, "motions.csv", 3)) if each.kind == "no speed")
    assert told.text.startswith("The recorded speed dq1, dq2, dq3 never changes")


@pytest.mark.parametrize(("warmth", "kelvin"), [(300.0, True), (-200.0, True), (80.0, False), (-30.0, False)])
def test_kelvin_and_numbers_for_no_value_are_no_temperature_of_an_arm(warmth: float, kelvin: bool) -> None:
    motions = as_motions(table(robot(), 3, seconds=3.0).assign(temperature_c=warmth), "motions.csv", 3)
    if not kelvin:
        assert not [each for each in check_motions(robot(), motions) if "temperature" in each.text]
        return
    for look in (lambda: check_motions(robot(), motions), lambda: check_moving(motions)):
        with pytest.raises(InputError, match=r"Are these kelvin\? .* leave the cell empty"):
            look()


def test_rows_given_twice_are_told_as_such_and_taken_once() -> None:
    motion = table(robot(), 3, runs=1, seconds=3.0)
    twice = as_motions(motion.loc[motion.index.repeat(2)].reset_index(drop=True), "motions.csv", 3)
    found, notices = mended(twice)
    assert [notice.kind for notice in notices] == ["rows given twice"]
    assert "600 rows are given twice" in notices[0].text
    np.testing.assert_array_equal(found.time, motion["time_s"])


def test_a_table_appended_to_itself_says_from_which_row_on() -> None:
    motion = table(robot(), 3, runs=1, seconds=3.0)
    again = as_motions(pd.concat([motion, motion], ignore_index=True), "motions.csv", 3)
    with pytest.raises(InputError, match="It is line 2 once more: are rows given twice"):
        mended(again)


@pytest.mark.long
def test_nothing_missing_says_how_coarsely_the_torque_was_recorded() -> None:
    motions = moved(robot(), 3)
    steps = np.array([0.0, 1.5, 0.0])
    rounded = np.where(steps > 0, np.round(motions.effort / np.maximum(steps, 1e-9)) * steps, motions.effort)
    verdict = diagnose_motion(robot(), replace(motions, effort=rounded)).verdict
    assert verdict.answer == "nothing missing"
    assert "Recorded coarsely: tau2_nm in steps of 1.5, whose rounding is 0.43 RMS" in verdict.headline
    assert "tau1_nm" not in verdict.headline


@pytest.mark.long
def test_a_run_in_which_nothing_moves_takes_no_part() -> None:
    """Held out, or all that is left where another is, it has no row that tells anything."""
    motion = table(robot(), 3)
    stands = motion["run"] == "path 2"
    still = motion.copy()
    still.loc[stands, ["q1_rad", "q2_rad", "q3_rad"]] = [0.3, -0.2, 0.5]
    verdict, alone = (
        diagnose_motion(robot(), as_motions(each, "motions.csv", 3)).verdict for each in (still, motion[~stands])
    )
    assert verdict.runs == ("path 1",)
    assert [each.text for each in verdict.notices if each.kind == "run stands"] == [
        "Run path 2: no joint moves in it. It takes no part."
    ]
    assert (verdict.headline, verdict.held_out.model) == (alone.headline, alone.held_out.model)
    with pytest.raises(InputError, match="no joint that moves"):
        diagnose_motion(robot(), as_motions(still[stands], "motions.csv", 3))
    with pytest.raises(InputError, match="has no such run in motion"):
        diagnose_motion(robot(), as_motions(still, "motions.csv", 3), MotionSettings(held_out=("path 2",)))
