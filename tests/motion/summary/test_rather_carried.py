"""A load that hangs at the last link is not told as that link's own weight, nor a heavier link as a load."""

from __future__ import annotations

import pytest

from armscope.motion.pipeline import diagnose_motion
from armscope.motion.summary.rather_carried import rather_carried
from tests.motion.moving import moved
from tests.motion.planar import planar
from tests.seeds import seeds


@pytest.mark.parametrize("seed", seeds(1, 3))
@pytest.mark.parametrize("mass", [2.0, pytest.param(6.0, marks=pytest.mark.long)])
def test_what_hangs_at_the_tool_point_is_a_load(seed: int, mass: float) -> None:
    """Up to as much as the link weighs: nobody states a link so badly."""
    true = planar(tool_load={"mass_kg": mass, "com_mm": [0, 0, 0]})
    (found,) = diagnose_motion(planar(), moved(true, seed)).verdict.effects
    assert found.effect == "payload_error"
    assert found.parameters[0].value == pytest.approx(mass, rel=0.05)


@pytest.mark.parametrize("seed", seeds(2, 3))
def test_a_heavier_link_that_fits_clearly_better_stays_one(seed: int) -> None:
    selected = diagnose_motion(planar(), moved(planar((1.0, 1.3)), seed)).selected
    assert {selected.rows.layout.placed[n].location for n in selected.best.candidates} == {"link 2"}
    assert rather_carried(selected) is selected


def test_nothing_is_asked_where_no_link_is_heavier() -> None:
    selected = diagnose_motion(planar(), moved(planar(), 1)).selected
    assert rather_carried(selected) is selected
