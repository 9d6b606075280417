"""What scanning adds to what competes: a planted line of a gear's mesh and a planted jump, each once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext
from armscope.diagnosis.scans.new_candidates import scanned_candidates
from armscope.diagnosis.selection_loop import SelectionLoop
from armscope.fitting.registration import fit_frames
from armscope.inference.search import Search
from armscope.measurement.noise import Noise
from armscope.physics.drift import BASE_SHIFT
from armscope.physics.effect import Part, Placed
from armscope.physics.frames import free_frames
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.transmission import GEAR_MESH, mesh

from ...backgrounds import sizes
from ..planted import planted

LINE = 12
FINE_LINE = 152
STILL = Base(np.eye(3), np.zeros(3))


@pytest.fixture(scope="module")
def loop() -> SelectionLoop:
    """A first round, without scanning, on an arm whose third gear has a line and whose base jumped by 0.5 mm."""
    arm, table = planted("four-axis", {}, 160, 0.02, seed=5)
    ripple = Part(mesh(3, LINE), np.array([4e-4, 0.0]))
    still = FittedModel(arm, {"1": STILL}, (), ())
    table.positions[:] += predict(FittedModel(arm, {"1": STILL}, (), (ripple,)), table) - predict(still, table)
    table.positions[100:] += [5e-4, 0.0, 0.0]
    blocks = np.arange(160) % 5
    round_ = SelectionLoop(
        fit_frames(arm, table), table, Noise(0.0, 0.0, ""), free_frames(table, False), blocks, lambda text, share: None
    )
    round_.round([sizes()])
    return round_


def scanned(loop: SelectionLoop) -> list[Placed]:
    """What a scan finds after the loop's last round."""
    context = ScanContext(loop.problem, loop.space, loop.point, loop.recordings, loop.noise.weights)
    return scanned_candidates(context, Search.on(loop.problem), loop.best, SCANS.ordinary_lines)


def test_the_planted_line_and_the_planted_jump_are_found_once_and_not_again_when_they_compete(
    loop: SelectionLoop,
) -> None:
    found = scanned(loop)
    names = [(placed.key, placed.variant) for placed in found]
    assert len(set(names)) == len(names)
    lines = [placed for placed in found if placed.key == (GEAR_MESH.name, "joint 3")]
    assert mesh(3, LINE).variant in {placed.variant for placed in lines}
    assert any(placed.effect is BASE_SHIFT for placed in found)
    loop.candidates = [*loop.candidates, *found]
    loop.round([sizes()])
    chosen = {loop.space.placed[candidate].key for candidate in loop.best.candidates}
    assert {(GEAR_MESH.name, "joint 3"), (BASE_SHIFT.name, "base")} <= chosen
    assert not {(placed.key, placed.variant) for placed in scanned(loop)} & set(names)


@pytest.mark.long
def test_a_fine_line_that_no_round_scanned_for_is_found_once_all_else_is_known(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("armscope.diagnosis.selection_loop.SCANS", replace(SCANS, scan_of_fine_lines=-1))
    arm, table = planted("four-axis", {}, 160, 0.02, seed=7)
    line = Part(mesh(2, FINE_LINE), np.array([8e-5, 0.0]))
    still = FittedModel(arm, {"1": STILL}, (), ())
    table.positions[:] += predict(FittedModel(arm, {"1": STILL}, (), (line,)), table) - predict(still, table)
    found = diagnose(arm, table, Settings(resamples=0, cross_validation=False)).effects
    assert [(e.effect, e.location, e.parameters[-1].value) for e in found] == [(GEAR_MESH.name, "joint 2", FINE_LINE)]
