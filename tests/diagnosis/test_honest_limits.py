"""Bad input: a clear statement, never a confident name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.report import check
from armscope.compensation.physical import identified_on
from armscope.core.inputs import InputError
from armscope.diagnosis import Settings, diagnose
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.schema import Verdict

from ..physics.scenes import arm_named
from .planted import joined, one_run, planted, recorded

QUICK = Settings(resamples=0, cross_validation=False)


@pytest.fixture
def clean() -> tuple[Arm, Recordings]:
    return planted("four-axis", {}, 80, 0.03, seed=60)


@pytest.fixture(scope="module")
def mirrored() -> tuple[Recordings, Verdict]:
    """The clean table in a left-handed frame, and what is said of it."""
    arm, table = planted("four-axis", {}, 80, 0.03, seed=60)
    table = replace(table, positions=table.positions * [1, -1, 1])
    return table, diagnose(arm, table, QUICK)


def kinds(verdict: Verdict) -> set[str]:
    return {notice.kind for notice in verdict.notices}


def cannot_tell(verdict: Verdict, kind: str) -> None:
    assert verdict.effects == ()
    assert verdict.mismatch is None
    assert verdict.answer == "cannot tell"
    assert kind in kinds(verdict)
    assert verdict.headline.startswith("Cannot tell: ")  # as page and terminal say it


def test_a_clean_table_has_nothing_to_complain_about(clean: tuple[Arm, Recordings]) -> None:
    verdict = diagnose(*clean, QUICK)
    assert verdict.answer == "nothing missing"
    assert kinds(verdict) == set()


def test_fewer_rows_than_parameters(clean: tuple[Arm, Recordings]) -> None:
    arm, table = clean
    cannot_tell(diagnose(arm, table.rows(np.arange(8)), QUICK), "fewer rows than parameters")


def test_the_wrong_robot() -> None:
    _, table = planted("six-axis", {}, 80, 0.03, seed=60)
    cannot_tell(diagnose(arm_named("parallelogram-120kg"), table, QUICK), "wrong robot")


def test_rows_permuted_against_poses(clean: tuple[Arm, Recordings]) -> None:
    arm, table = clean
    order = np.random.default_rng(1).permutation(len(table))
    cannot_tell(diagnose(arm, replace(table, positions=table.positions[order]), QUICK), "wrong robot")


def test_rows_out_of_step_by_one(clean: tuple[Arm, Recordings]) -> None:
    arm, table = clean
    moved = replace(table, positions=np.roll(table.positions, 1, axis=0))
    cannot_tell(diagnose(arm, moved, QUICK), "rows out of step")


def test_lengths_in_another_unit(clean: tuple[Arm, Recordings]) -> None:
    arm, table = clean
    cannot_tell(diagnose(arm, replace(table, positions=table.positions * 1000), QUICK), "units")


def test_a_left_handed_frame(mirrored: tuple[Recordings, Verdict]) -> None:
    cannot_tell(mirrored[1], "left-handed frame")


def test_another_number_of_motors(clean: tuple[Arm, Recordings]) -> None:
    _, table = clean
    with pytest.raises(InputError, match="7 motors"):
        diagnose(arm_named("seven-axis"), table, QUICK)


@pytest.mark.long
def test_repeated_clipped_and_stuck_rows_are_left_out_and_told(clean: tuple[Arm, Recordings]) -> None:
    arm, table = clean
    repeated = table.rows(np.concatenate([np.arange(80), np.arange(10)]))
    assert kinds(diagnose(arm, repeated, QUICK)) == {"repeated rows"}
    clipped = table.positions.copy()
    clipped[:, 2] = np.minimum(clipped[:, 2], np.quantile(clipped[:, 2], 0.9))
    verdict = diagnose(arm, replace(table, positions=clipped), QUICK)
    assert kinds(verdict) == {"clipped rows"}
    assert verdict.effects == ()
    stuck = table.positions.copy()
    stuck[20:24] = stuck[19]
    verdict = diagnose(arm, replace(table, positions=stuck), QUICK)
    assert kinds(verdict) == {"stuck instrument"}
    assert verdict.rows == 76


def test_joints_that_never_move_and_constant_context_are_told(clean: tuple[Arm, Recordings]) -> None:
    arm, table = clean
    held = replace(table, payload=np.full(80, 5.0))
    held.motor_angles[:, 3] = 0.3
    verdict = diagnose(arm, held, QUICK)
    assert {"joints that never move", "constant context"} <= kinds(verdict)


def test_a_table_without_masses_says_what_it_cannot_know() -> None:
    from armscope.robot.arm import build_arm

    arm, table = planted("six-axis", {}, 60, 0.03, seed=61)
    bare = build_arm(arm.description.model_copy(update={"links": None, "tool_load": None}))
    verdict = diagnose(bare, table, QUICK)
    assert "no loads" in kinds(verdict)
    assert verdict.effects == ()


@pytest.mark.long
@pytest.mark.parametrize("wrong", ["mirrored", pytest.param("metres called millimetres", marks=pytest.mark.long)])
def test_a_run_that_fits_nothing_is_no_matter_of_bad_shots(wrong: str) -> None:
    arm = arm_named("four-axis")
    runs = [recorded(arm, one_run(arm, rows, seed), {}, 0.02, seed) for rows, seed in ((90, 3), (40, 4))]
    bad = runs[1].positions * ([1.0, 1.0, -1.0] if wrong == "mirrored" else 1e-3)
    verdict = diagnose(arm, joined(runs[0], replace(runs[1], positions=bad)), QUICK)
    assert verdict.answer == "cannot tell"
    assert "rows fit neither" in verdict.unexplained.description
    assert verdict.unexplained.description.endswith("most of run 2")
    assert "rows fit neither" in verdict.headline
    assert len(verdict.suspects) > 35
    assert verdict.mismatch


def test_a_few_bad_shots_change_no_answer() -> None:
    arm = arm_named("four-axis")
    table = recorded(arm, one_run(arm, 120, 3), {}, 0.02, 3)
    table.positions[::30] += 2e-3
    verdict = diagnose(arm, table, QUICK)
    assert verdict.answer == "nothing missing"
    assert len(verdict.suspects) == 4


@pytest.mark.long
def test_what_looks_wrong_with_the_table_stands_in_every_verdict_not_only_the_command_lines() -> None:
    """The check is part of a diagnosis, whoever asks for it; rows that are left out are not asked about."""
    arm, table = planted("four-axis", {}, 80, 0.03, seed=60)
    found = diagnose(arm, replace(table, temperature=np.linspace(293.0, 299.0, 80)), QUICK)
    assert [notice.kind for notice in found.notices][:1] == ["check"]
    assert "temperature" in found.notices[0].text


@pytest.mark.long
def test_a_diagnosis_keeps_the_table_as_it_was_used(clean: tuple[Arm, Recordings]) -> None:
    """Rows that were left out are in no figure and widen no range of the compensation."""
    arm, table = clean
    angles, positions = table.motor_angles.copy(), table.positions.copy()
    angles[20:24, 0] = 9.0  # the instrument stood still while the arm went far away
    positions[20:24] = positions[19]
    whole = replace(table, motor_angles=angles, positions=positions)
    used = diagnose(arm, whole, QUICK).recordings
    assert len(used) == 76
    far = np.full((1, len(identified_on(arm, used).domain.inputs)), 0.0)
    far[0, 0] = 9.0
    assert identified_on(arm, whole).domain.outside(far)[0] < identified_on(arm, used).domain.outside(far)[0]


@pytest.mark.long
@pytest.mark.parametrize(
    "mistake", ["mirrored", *(pytest.param(each, marks=pytest.mark.long) for each in ("inches", "joints exchanged"))]
)
def test_a_mistake_is_told_once_and_as_the_check_tells_it(
    clean: tuple[Arm, Recordings], mirrored: tuple[Recordings, Verdict], mistake: str
) -> None:
    arm, table = clean
    if mistake == "mirrored":
        wrong, verdict = mirrored
    else:
        inches = replace(table, positions=table.positions / 25.4)
        exchanged = replace(table, motor_angles=table.motor_angles[:, [0, 2, 1, 3]])
        wrong = inches if mistake == "inches" else exchanged
        verdict = diagnose(arm, wrong, QUICK)
    (problem,) = (each for each in check(wrong, arm).suspicions if each.weight == "problem")
    told = [notice.text for notice in verdict.notices if problem.statement[1:] in notice.text]
    assert len(told) == 1
    assert problem.cure in told[0]
