"""A long table fitted by sums over all rows, and some rows that tell what is not linear: it ends where passes end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.fitting import model_fit, summed_rows
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.constants import STEPS
from armscope.fitting.linearisation import LinearisedTable, residuals
from armscope.fitting.parameter_layout import parameter_layout
from armscope.fitting.refit import Refit, refit
from armscope.fitting.registration import fit_frames
from armscope.fitting.summed_rows import SummedFit, SummedRows
from armscope.measurement.channel import POSITIONS, ChannelResiduals
from armscope.measurement.row_weights import RowNoise
from armscope.physics.effect import Placed
from armscope.physics.frames import free_frames
from armscope.physics.model import FittedModel
from armscope.physics.registry import library
from armscope.recordings import Recordings

from ..diagnosis.planted import joined, planted

ROWS, TELLING = 1500, 200
WANTED = {
    ("joint_compliance", "joint 2"): [4e-6],
    ("joint_compliance", "joint 3"): [6e-6],
    ("link_geometry", "link 2"): [2e-2, 5e-3, 4e-3, 2e-3],
}


def recordings() -> tuple[FittedModel, Recordings]:
    """Two runs of an arm with large errors, a thirtieth of the rows bad shots; frames fitted."""
    arm, first = planted("six-axis", WANTED, ROWS - 100, 0.05, seed=3)
    _, second = planted("six-axis", WANTED, 100, 0.05, seed=5)
    table = joined(first, second)
    rng = np.random.default_rng(7)
    bad = rng.choice(ROWS, ROWS // 30, replace=False)
    moved = table.positions.copy()
    moved[bad] += 1e-3 * rng.normal(size=(len(bad), 3))
    table = replace(table, positions=moved)
    return fit_frames(arm, table), table


def fitted(start: FittedModel, rows: Recordings | SummedRows, effects: list[Placed], count: int) -> Refit:
    """All effects free, no backgrounds."""
    table = rows.table.recordings if isinstance(rows, SummedRows) else rows
    noise = RowNoise(np.ones(count), np.ones(count))
    return refit(start, rows, free_frames(table, False), [], [(placed, 1.0) for placed in effects], noise, 0.0)


def effects_of(start: FittedModel, table: Recordings) -> list[Placed]:
    return [p for p in library(start.arm, table) if p.key in WANTED and len(p.terms) == len(WANTED[p.key])]


def summed(start: FittedModel, table: Recordings, effects: list[Placed]) -> SummedRows:
    """The table with its sums where a fit to few of its rows ended."""
    layout = parameter_layout(free_frames(table, False), [], effects)
    whole = LinearisedTable(table)
    weights = RowNoise(np.ones(ROWS), np.ones(ROWS)).weights(residuals(start, whole), 0.0)
    (sums,) = normal_equations_by_block(layout, start, whole, weights, np.zeros(ROWS, dtype=np.intp))
    return SummedRows.of(whole, layout, start, sums, 20)


def values(fit: Refit) -> Array:
    return np.concatenate([part.values for part in fit.model.parts])


def stderrs(fit: Refit) -> Array:
    return np.concatenate([np.sqrt(np.diag(fit.covariance_of(part.placed))) for part in fit.model.parts])


@pytest.fixture(scope="module")
def both() -> tuple[Refit, Refit, Refit]:
    """Fits to few rows, to all in passes until nothing moves, and to all by their sums where the first one ended."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(summed_rows, "STEPS", replace(STEPS, telling_rows=TELLING))
        start, table = recordings()
        effects = effects_of(start, table)
        few = fitted(start, table.rows(np.arange(60)), effects, 60)
        # the second run stands on the base that all rows gave it: few rows know the first one's alone
        near = replace(few.model, bases={**start.bases, **few.model.bases})
        exact = fitted(start, table, effects, ROWS)
        again = fitted(exact.model, table, effects, ROWS)
        return few, again, fitted(near, summed(near, table, effects), effects, ROWS)


@pytest.mark.long
def test_it_ends_where_passes_over_all_rows_end(both: tuple[Refit, Refit, Refit]) -> None:
    few, exact, of_sums = both
    stderr = stderrs(exact)
    far = np.abs(values(few) - values(exact)) / stderr
    assert far.max() > 3  # there was somewhere to go
    assert (np.abs(values(of_sums) - values(exact)) / stderr).max() < 0.02
    assert stderrs(of_sums) == pytest.approx(stderr, rel=0.02)
    assert of_sums.noise == pytest.approx(exact.noise, rel=0.01)
    assert of_sums.effective_dof == pytest.approx(exact.effective_dof, rel=1e-3)


def test_residuals_and_weights_are_of_all_rows_at_its_end(both: tuple[Refit, Refit, Refit]) -> None:
    _, exact, of_sums = both
    uncertain = exact.noise * np.sqrt(exact.effective_dof / exact.equations.n)
    apart = of_sums.residuals - exact.residuals
    assert of_sums.residuals.shape == (ROWS, 3)
    assert np.sqrt(np.mean(apart**2)) < 0.05 * uncertain
    assert of_sums.weights.robust_weight == pytest.approx(exact.weights.robust_weight, abs=0.02)
    assert np.count_nonzero(of_sums.weights.robust_weight < 0.5) > ROWS // 60


def test_its_sums_lead_where_it_ended(both: tuple[Refit, Refit, Refit]) -> None:
    """Shares of causes are read from them."""
    _, exact, of_sums = both
    uncertain = 0.05 * exact.noise**2 * exact.effective_dof
    told = [each.equations.rss(each.equations.G @ np.zeros(len(each.equations.b))) for each in (exact, of_sums)]
    assert told[1] == pytest.approx(told[0], rel=0.01)
    solved = [np.linalg.lstsq(each.equations.G, each.equations.b, rcond=1e-12)[0] for each in (exact, of_sums)]
    left = [each.equations.rss(at) for each, at in zip((exact, of_sums), solved, strict=True)]
    assert left[1] == pytest.approx(left[0], rel=0.01, abs=uncertain)


def test_one_step_along_the_sums_alone_would_not_do(both: tuple[Refit, Refit, Refit], monkeypatch) -> None:
    """What is not linear is told by the few rows: without them the fit ends elsewhere."""
    _, exact, _ = both
    monkeypatch.setattr(summed_rows, "STEPS", replace(STEPS, telling_rows=TELLING))
    monkeypatch.setattr(summed_rows.SummedFit, "settled", lambda *_: True)
    start, table = recordings()
    effects = effects_of(start, table)
    few = fitted(start, table.rows(np.arange(60)), effects, 60).model
    near = replace(few, bases={**start.bases, **few.bases})
    step = fitted(near, summed(near, table, effects), effects, ROWS)
    assert (np.abs(values(step) - values(exact)) / stderrs(exact)).max() > 0.1


def test_a_table_that_is_passed_over_starts_with_its_sums(both: tuple[Refit, Refit, Refit], monkeypatch) -> None:
    """The first step on the way costs no pass; the last fit goes on where that ended, and ends where any does."""
    few, exact, _ = both
    start, table = recordings()
    effects = effects_of(start, table)
    near = replace(few.model, bases={**start.bases, **few.model.bases})
    sums = summed(near, table, effects)
    rows = SummedRows.few(sums.table, sums.layout, sums.point, sums.equations)
    passes = []
    counted = normal_equations_by_block
    monkeypatch.setattr(model_fit, "normal_equations_by_block", lambda *given: passes.append(1) or counted(*given))
    rows.on_the_way = True
    crude = fitted(near, rows, effects, ROWS)
    assert len(passes) <= STEPS.on_the_way - 1
    rows.on_the_way = False
    ended = fitted(crude.model, rows, effects, ROWS)
    assert len(passes) > STEPS.on_the_way - 1
    assert (np.abs(values(ended) - values(exact)) / stderrs(exact)).max() < 0.02
    assert ended.noise == pytest.approx(exact.noise, rel=0.01)


def test_sums_that_lead_nowhere_are_not_trusted(both: tuple[Refit, Refit, Refit], monkeypatch) -> None:
    """Passes over all rows follow where a fit by sums does not settle."""
    _, exact, _ = both
    monkeypatch.setattr(summed_rows, "STEPS", replace(STEPS, telling_rows=TELLING))
    start, table = recordings()
    effects = effects_of(start, table)
    rows = summed(start, table, effects)
    wrong = replace(rows.equations, b=1.5 * rows.equations.b)
    found = fitted(start, replace(rows, equations=wrong), effects, ROWS)
    assert (np.abs(values(found) - values(exact)) / stderrs(exact)).max() < 0.1


@pytest.mark.parametrize(("left", "holds"), [(1.0, True), (1.4, True), (1.6, False)])
def test_rows_that_do_not_stand_for_all_are_noticed(left: float, holds: bool) -> None:
    """All rows are then left with more than they are."""
    rng = np.random.default_rng(1)
    some = ChannelResiduals({POSITIONS: 1e-4 * rng.normal(size=(500, 3))})
    everything = ChannelResiduals({POSITIONS: left * 1e-4 * rng.normal(size=(4000, 3))})
    assert object.__new__(SummedFit).holds_for(everything, some) == holds
