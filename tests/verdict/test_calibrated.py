"""What counts once zeros and rows are right: play of a hundredth of the error may be all that is left."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.geometric import background
from armscope.physics.transmission import BACKLASH
from armscope.verdict.calibrated import mended_by_calibration, once_calibrated, stands_out
from armscope.verdict.contributions import contributions, ground_of, parts_of
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import Cause, FoundEffect, Parameter
from armscope.verdict.importance import with_importance
from armscope.verdict.schema import Background, HeldOut
from armscope.verdict.work_order import work_order
from tests.report import verdicts


def by_whole(found: FoundEffect, _: Sequence[Background]) -> FoundEffect:
    return replace(found, minor=found.share < 0.025)


@pytest.fixture(scope="module")
def off() -> Diagnosis:
    """An arm whose rows are off by millimetres, and a joint with play of a tenth of that."""
    case = verdicts.case(rows=200)
    arm, rng = case.arm, np.random.default_rng(3)
    sides = rng.choice([-1.0, 1.0], (200, arm.n_motors))
    table = replace(case.recordings, approach=sides)
    (gap,) = [p for p in BACKLASH.place(arm, table) if p.location == "joint 2" and "approach" in p.driver][:1]
    small = tuple(Part(p, rng.normal(0, 5e-4, len(p.terms))) for p in background(arm))
    model = replace(case.verdict.model, parts=(Part(gap, np.array([2e-4])),), background=small)
    play = verdicts.found("backlash", "joint 2", Parameter("gap", "rad", 2e-4, 1e-6), driver=gap.driver, minor=True)
    bare = replace(case.verdict, recordings=table, model=model, effects=(play,))
    ground = ground_of(bare)
    moved = ground.moved_by(parts_of(bare)[id(play)]) + ground.moved_by(small)
    noise = rng.normal(0, 0.01, moved.shape)
    residuals = replace(bare.residuals, before=moved + noise, after=noise)
    return replace(
        bare,
        residuals=residuals,
        background=Background("all", True, 1.0, 0.5, 0.9),
        background_families=(Background("geometric", True, 1.0, 0.5, 0.9),),
        held_out=HeldOut(float("nan"), float("nan")),
        causes=(
            Cause("geometric", "family", "arm", (), True, False, 0.9, 0.1, "", ""),
            Cause("transmission", "effect", "joint 2", (play.as_member,), False, True, 0.01, 0.1, "", ""),
        ),
    )


def test_what_dominates_after_calibration_is_major_and_told(off: Diagnosis) -> None:
    told = with_importance(off, by_whole)
    (play,) = told.effects
    assert play.share < 0.025, "of the whole it is next to nothing"
    assert play.share_after_calibration > 0.8
    assert stands_out(play)
    assert not play.minor
    assert "play" in told.headline
    assert "of what calibration leaves" in told.headline
    for unsure in ({"inclusion": 0.2}, {"parameters": (Parameter("gap", "rad", 2e-4, 1e-3),)}):
        (left,) = with_importance(replace(off, effects=(replace(play, minor=True, **unsure),)), by_whole).effects
        assert left.minor, "nobody can rely on it"


def test_it_has_a_step_in_the_work_order(off: Diagnosis) -> None:
    told = with_importance(off, by_whole)
    members = [member for task in work_order(told, contributions(told)).tasks for member in task.members]
    assert "backlash at joint 2" in members


def test_geometry_has_no_share_in_what_its_calibration_leaves(off: Diagnosis) -> None:
    ground = ground_of(off)
    small = {"geometric": ground.moved_by(off.model.background)}
    left, _ = ground.left_and_before()
    after = once_calibrated(ground, left, [], small)
    assert after
    (row,) = background(off.model.arm)[3:4]
    column = ground.free(1e3 * ground.posture.column(row.terms[0]))
    assert abs(after.share(column)) < 1e-6
    (play,) = off.effects
    its = ground.moved_by(parts_of(off)[id(play)])
    noise = float(np.sum(after.end**2) / np.sum(after.start**2))
    assert after.share(its) == pytest.approx(1 - noise, abs=0.02), "with the noise it is all of it"
    assert 0.5 < after.of_scatter(0.01) <= 1.0


def test_where_no_geometry_is_off_nothing_is_asked(off: Diagnosis) -> None:
    ground = ground_of(off)
    left, _ = ground.left_and_before()
    assert once_calibrated(ground, left, [(off.effects[0], left)], {"elastic": left}) is None
    few = replace(ground_of(off), taken_up=np.eye(left.size)[:, : left.size // 2])
    assert once_calibrated(few, left, [], {"geometric": left}) is None


def test_a_calibration_mends_zeros_and_rows_alone() -> None:
    """A wobble runs with the angle, and a bar is in no row: a step promised both."""
    mended = {
        "joint_offset": "joint 2",
        "link_geometry": "link 2",
        "axis_wobble": "joint 2",
        "parallelogram_geometry": "parallelogram",
    }
    said = {effect: mended_by_calibration(verdicts.found(effect, place)) for effect, place in mended.items()}
    assert said == {
        "joint_offset": True,
        "link_geometry": True,
        "axis_wobble": False,
        "parallelogram_geometry": False,
    }
