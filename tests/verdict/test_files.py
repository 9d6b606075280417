"""A correction table, executed as it is written: in the world that conceals the cause, it reaches what is promised."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.core.location import Location
from armscope.diagnosis.summary.effect_curve import curve_of
from armscope.physics.effect import Part
from armscope.physics.freeform import UNKNOWN
from armscope.physics.scene import Scene
from armscope.verdict.contributions import Contributions, contributions
from armscope.verdict.diagnosis import Diagnosis, Residuals
from armscope.verdict.files import curves_table
from armscope.verdict.work_order import work_order
from tests.physics.test_cure import World, fitted, world_with
from tests.report import verdicts
from tests.verdict.test_contributions import missed
from tests.world.scenes import drawn, scene_of


def found_as_a_curve(place: str) -> tuple[World, Diagnosis, Contributions]:
    """A ratio and a zero of the same joint, which nobody but a free curve of its angle is there to tell."""
    scene, _ = scene_of("six-axis", count=60)
    world = world_with("gear_ratio", place, drawn(scene, "joint_offset", place))
    table = world.table()
    (placed,) = [p for p in UNKNOWN.place(world.arm, table) if (p.location, p.variant) == (place, "angle")]
    part = fitted(world, table, [placed])
    curve = curve_of(placed, part.values, 1e-12 * np.eye(len(part.values)), Scene(world.arm, table))
    effect = verdicts.found("unknown", place, driver=placed.driver, curve=curve)
    case = verdicts.case(effects=(effect,))
    model = replace(case.verdict.model, arm=world.arm, parts=(Part(placed, part.values),))
    model = replace(model, bases={"1": next(iter(model.bases.values()))})
    points = Scene(world.arm, table).posture(()).tool
    before, after = table.positions - points, table.positions - Scene(world.arm, table).posture([part]).tool
    rows = Residuals(1e3 * points, 1e3 * before, 1e3 * after, np.ones(len(table)), table.id, table.run)
    verdict = replace(case.verdict, recordings=table, model=model, residuals=rows)
    return world, verdict, contributions(verdict)


@pytest.mark.parametrize(("place", "own"), [("joint 3", True), ("joint 1", False)])
def test_a_curve_subtracted_as_it_is_written_reaches_what_its_step_promises(place: str, own: bool) -> None:
    """Without the joint's zero the error of the zero stays; at joint 1 it is a turn of the base, which is placed."""
    world, verdict, worth = found_as_a_curve(place)
    table, joint = curves_table(verdict), Location.of(place).index
    assert table is not None
    commanded = world.session.commanded.copy()
    commanded[:, joint] -= np.interp(commanded[:, joint], table["at"], table["value"])
    promised, before = worth.cured([0]), rms(worth.before)
    assert promised < 0.02 * before
    assert missed(world, world.readings(commanded)) == pytest.approx(promised, abs=0.02 * before)
    assert bool(table["zero_in_value"].abs().max()) == own
    task = work_order(verdict, worth).tasks[0]
    assert "curves.csv (unknown, " in task.cure
    assert ("holds the joint's own zero" in task.cure) == own
    low, high = (f"{1e3 * end:+.3f}".replace("-", "−") for end in np.interp(
        [world.session.commanded[:, joint].min(), world.session.commanded[:, joint].max()], table["at"], table["value"]
    ))  # fmt: skip
    assert low in task.motion
    assert high in task.motion
