"""Bases of runs are compared: one base, bases that differ a little and are named, or a base that was set up anew.

Bases are moved by moving what was measured, as a rigid body, in the measurement frame.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.diagnosis import Settings, diagnose
from armscope.fitting.constants import STEPS
from armscope.fitting.linearisation import point_residuals
from armscope.fitting.registration import fit_frames
from armscope.fitting.set_ups import compare_bases, set_up_anew
from armscope.physics.frames import free_frames, set_ups_of, sharing_bases
from armscope.physics.model import FittedModel, predict
from armscope.physics.model_file import load_model, save_model
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..diagnosis.planted import one_run, recorded
from ..physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
NAMES = ["b", "a", "c"]
"""Of the runs, as they follow each other: not by the alphabet."""


def three_runs(moved: dict[str, tuple[list[float], list[float]]], rows: int = 40) -> tuple[Arm, Recordings]:
    """Runs of an arm without any error; some with the measured points moved by (mm, mrad), noise 0.02 mm."""
    arm = arm_named("four-axis")
    table = recorded(arm, one_run(arm, 3 * rows, seed=3), {}, 0.02, seed=8)
    table = replace(table, run=np.repeat(NAMES, rows), time=None, temperature=None)
    for run, (shift, turn) in moved.items():
        inside = table.run == run
        turned = table.positions[inside] @ Rotation.from_rotvec(1e-3 * np.array(turn)).as_matrix().T
        table.positions[inside] = turned + 1e-3 * np.array(shift)
    return arm, table


def compared(arm: Arm, table: Recordings) -> tuple[tuple[str, ...], ...]:
    return compare_bases(fit_frames(arm, table), table).set_ups


@pytest.mark.parametrize(
    ("shift_mm", "turn_mrad", "set_ups"),
    [
        ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], (("b", "a", "c"),)),
        ([0.5, -0.3, 0.2], [0.2, 0.0, 0.1], (("b", "a", "c"),)),
        ([30.0, 0.0, 0.0], [0.0, 0.0, 0.0], (("b", "c"), ("a",))),
        ([0.0, 0.0, 0.0], [0.0, 0.0, 40.0], (("b", "c"), ("a",))),
    ],
)
def test_what_settled_is_told_from_what_was_set_up_anew(
    shift_mm: list[float], turn_mrad: list[float], set_ups: tuple[tuple[str, ...], ...]
) -> None:
    arm, table = three_runs({"a": (shift_mm, turn_mrad)})
    found = compare_bases(fit_frames(arm, table), table)
    assert found.set_ups == set_ups
    assert bool(set_up_anew(found)) == (len(set_ups) > 1)
    if len(set_ups) > 1:
        assert all(apart > 3 for apart in found.apart_mm)
        assert "runs b, c and run a" in set_up_anew(found)


def test_a_long_table_is_compared_in_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    """All rows' frames at once took 4 kB a row: 3.5 GB of a million."""
    arm, table = three_runs({"a": ([30.0, 0.0, 0.0], [0.0, 0.0, 0.0])}, rows=STEPS.chunk_rows // 2)
    own, sizes, scene = fit_frames(arm, table), [], FittedModel.scene
    monkeypatch.setattr(FittedModel, "scene", lambda self, rows: sizes.append(len(rows)) or scene(self, rows))
    assert compare_bases(own, table).set_ups == (("b", "c"), ("a",))
    assert sum(sizes) == len(table) > STEPS.chunk_rows >= max(sizes)


def test_bad_shots_do_not_part_runs() -> None:
    arm, table = three_runs({})
    table.positions[[3, 50]] += 0.5
    assert compared(arm, table) == (("b", "a", "c"),)


def test_one_base_for_all_runs_of_a_set_up_is_fitted_as_one() -> None:
    arm, table = three_runs({"a": ([30.0, 0.0, 0.0], [0.0, 0.0, 0.0])})
    set_ups = compared(arm, table)
    model = fit_frames(arm, table, set_ups=set_ups)
    assert list(model.bases) == NAMES
    assert model.bases["b"] is model.bases["c"]
    frames = sharing_bases(free_frames(table, False), set_ups)
    assert sorted(set_ups_of(frames)) == sorted(set_ups)
    assert sum(len(placed.terms) for placed in frames) == 2 * 6 + 3
    alone = point_residuals(fit_frames(arm, table), table)
    assert np.sqrt(np.mean(point_residuals(model, table) ** 2)) < 1.1 * np.sqrt(np.mean(alone**2))


def test_a_base_that_moved_a_little_between_runs_is_named_with_the_runs_and_its_size() -> None:
    """All runs before the move stand together, and so do all after it."""
    both = ([0.12, -0.09, 0.05], [0.05, 0.0, 0.0])
    verdict = diagnose(*three_runs({"a": both, "c": both}), QUICK)
    (found,) = verdict.effects
    assert (found.effect, found.location, found.driver) == ("base_shift", "base", "between runs b and a")
    assert "between runs b and a" in verdict.headline
    told_by = {p.name: p for p in found.parameters}
    moved = [p for name, p in told_by.items() if name in "xyz"]
    assert np.linalg.norm([p.value for p in moved]) == pytest.approx(0.158, abs=4 * max(p.stderr for p in moved))
    assert all(p.stderr < 0.03 for p in moved)


@pytest.mark.long
def test_a_single_run_that_stands_elsewhere_is_named_alone() -> None:
    (found,) = diagnose(*three_runs({"a": ([0.2, -0.1, 0.1], [0.0, 0.0, 0.0])}), QUICK).effects
    assert (found.effect, found.driver) == ("base_shift", "in run a alone")


def test_runs_on_one_base_have_nothing_named() -> None:
    verdict = diagnose(*three_runs({}), QUICK)
    assert verdict.answer == "nothing missing"
    assert not {notice.kind for notice in verdict.notices} & {"set up anew", "tool exchanged"}


def test_a_base_that_was_set_up_anew_is_said_but_not_named() -> None:
    verdict = diagnose(*three_runs({"c": ([400.0, -90.0, 0.0], [0.0, 30.0, 200.0])}), QUICK)
    assert verdict.answer == "nothing missing"
    assert "set up anew" in {notice.kind for notice in verdict.notices}


@pytest.mark.long
def test_a_jump_within_a_run_lasts_through_the_runs_after_it() -> None:
    arm, table = three_runs({})
    table.positions[60:] += [3e-4, -2e-4, 1e-4]
    (found,) = diagnose(arm, table, QUICK).effects
    assert (found.effect, found.location) == ("base_shift", "base")
    row = {p.name: p for p in found.parameters}["row"]
    assert row.value == pytest.approx(61, abs=2)


@pytest.mark.long
def test_the_model_keeps_where_each_run_stands(tmp_path) -> None:
    """Also as a file; a run that it does not know stands where the last one stands."""
    both = ([0.3, -0.3, 0.2], [0.1, 0.0, 0.0])
    arm, table = three_runs({"a": both, "c": both})
    save_model(tmp_path / "model.yaml", diagnose(arm, table, QUICK).model)
    model = load_model(tmp_path / "model.yaml")
    assert np.sqrt(np.mean((predict(model, table) - table.positions) ** 2)) < 0.025e-3
    later = replace(table, run=np.where(table.run == "c", "new", table.run))
    np.testing.assert_array_equal(predict(model, later), predict(model, table))
