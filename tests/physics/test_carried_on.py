"""What follows the order of rows is unchanged at numbered rows; at poses of now it is that of the last row of a run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.carried_on import carried_on
from armscope.physics.drift import Pause, base_shift, drift_with_pauses
from armscope.physics.effect import Part, Placed
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.model_file import load_model, save_model
from armscope.physics.wander import link_wander, wander
from armscope.recordings import Recordings

from .scenes import arm_named, full_table

ARM = arm_named("six-axis")
ROWS, FIRST_RUN = 60, 25


def table_of(runs: int) -> Recordings:
    run = np.repeat(["a", "b"], [FIRST_RUN, ROWS - FIRST_RUN]) if runs > 1 else np.full(ROWS, "a")
    return replace(full_table(ARM, ROWS, seed=3), time=None, run=run, target=np.full(ROWS, ""))


def holding(placed: Placed, table: Recordings) -> FittedModel:
    base = Base(np.eye(3), np.zeros(3))
    values = np.full(len(placed.terms), 1e-3)
    return FittedModel(ARM, {str(run): base for run in np.unique(table.run)}, parts=(Part(placed, values),))


PLACED = {
    "a drift with a pause": lambda table: drift_with_pauses([Pause(20.0, "a", 500.0, ("b",))], 1),
    "a wave of the base": lambda table: wander(table, ())[0],
    "a wave of a link": lambda table: link_wander(ARM, table)[0],
}


@pytest.mark.parametrize("name", PLACED)
@pytest.mark.parametrize("runs", [1, 2])
def test_a_pose_of_now_is_as_the_last_row_of_its_run(name: str, runs: int, tmp_path) -> None:
    table = table_of(runs)
    model = holding(PLACED[name](table), table)
    save_model(tmp_path / "model.yaml", carried_on(model, table))
    carried = load_model(tmp_path / "model.yaml")
    np.testing.assert_allclose(predict(carried, table), predict(model, table), atol=1e-12)
    end = np.where(table.run == "b", table.number[-1], table.number[FIRST_RUN - 1] if runs > 1 else table.number[-1])
    of_now = predict(carried, replace(table, number=np.full(ROWS, np.nan)))
    np.testing.assert_allclose(of_now, predict(model, replace(table, number=end)), atol=1e-12)
    assert np.abs(of_now - predict(model, replace(table, number=np.full(ROWS, np.nan)))).max() > 1e-6


def test_what_jumped_at_a_row_needs_nothing() -> None:
    table = table_of(1)
    model = holding(base_shift(table, 30, 1), table)
    assert carried_on(model, table).moves_like(model)
