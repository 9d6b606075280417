"""What can't be told apart is known beforehand."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.world.effects import LIBRARY
from armscope.world.rivals import rivals
from armscope.world.spec import KINDS
from armscope.world.strength import equilibrium
from tests.world.by_hand import ARMS
from tests.world.scenes import drawn, scene_of


@pytest.mark.parametrize("arm", [ARMS[0], *(pytest.param(name, marks=pytest.mark.long) for name in ARMS[1:])])
def test_the_patterns_of_each_effect_make_what_the_engine_simulates(arm):
    """Every effect but those left out, at two places, simulated small: its own patterns explain it to a percent."""
    scene, _ = scene_of(arm, count=30)
    known = rivals(scene)
    for kind in LIBRARY:
        if (
            kind.effect in ("gear_mesh", "loose_target", "payload_error", "base_shift", "zero_shift")
            or kind.name == "compliance_change"
            or kind.name == "backlash/load"
        ):
            continue
        for place in kind.places(scene.description)[2:4] or kind.places(scene.description)[:1]:
            effect = drawn(scene, kind.name, place).scaled(0.1)
            displacement = (equilibrium(scene, [effect]).tool - equilibrium(scene, []).tool).ravel()
            own = [r.columns for r in known if (r.effect, r.location) == (kind.effect, place)]
            left = [np.linalg.norm(displacement - c @ np.linalg.lstsq(c, displacement, rcond=None)[0]) for c in own]
            assert min(left) < 0.01 * np.linalg.norm(displacement), (kind.name, place)


def test_kinds_have_distinct_names():
    assert len(KINDS) == len({kind.name for kind in KINDS.values()})
