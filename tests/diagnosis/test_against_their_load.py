"""What gives way can't push: such names are found by their fitted values."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import unheard
from armscope.diagnosis.against_their_load import against_their_load
from armscope.diagnosis.selection_loop import SelectionLoop
from armscope.fitting.registration import fit_frames
from armscope.inference.problem import SelectedEffect
from armscope.measurement.noise import Noise
from armscope.physics.frames import free_frames

from ..backgrounds import sizes
from .planted import planted

ROWS = 100


@pytest.mark.parametrize(("compliance", "pushes"), [(2e-6, False), (-2e-6, True)])
def test_a_name_within_a_background_may_not_be_negative_where_it_gives_way(compliance: float, pushes: bool):
    arm, table = planted("six-axis", {("joint_compliance", "joint 2"): [compliance]}, ROWS, 0.02, seed=3)
    blocks = np.arange(ROWS) % 5
    loop = SelectionLoop(fit_frames(arm, table), table, Noise(0.0, 0.0, ""), free_frames(table, False), blocks, unheard)
    loop.round([sizes()])
    space = loop.space
    (number,) = [n for n, p in enumerate(space.placed) if p.key == ("joint_compliance", "joint 2") and not p.variant]
    name = SelectedEffect(number, 4, nested=True)
    loop.best = replace(loop.best, chosen=(name,))
    fit = loop._fitted()
    assert np.sign(fit.model.parts[0].values[0]) == np.sign(compliance)
    assert against_their_load(space, loop.best, fit) == ([number] if pushes else [])
