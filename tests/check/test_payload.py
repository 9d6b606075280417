"""A payload without a place is told with the place that the points show."""

from dataclasses import replace

import numpy as np

from armscope.check.report import check
from armscope.robot.arm import build_arm
from tests.check.conftest import TOOL


def test_a_payload_whose_place_nobody_states_is_told_with_the_place_that_the_points_show(arm, sound):
    loaded = replace(sound, payload=np.where(np.arange(len(sound)) % 2, 5.0, 0.0))
    (hint,) = [each.text() for each in check(loaded, arm).suspicions if "payload" in each.text()]
    told = [float(each) for each in hint.partition("[")[2].partition("]")[0].split(",")]
    np.testing.assert_allclose(told, 1e3 * np.array(TOOL[""]), atol=3)
    stated = build_arm(arm.description.model_copy(update={"tool_mm": tuple(1e3 * np.array(TOOL[""]))}))
    assert not [each for each in check(loaded, stated).suspicions if "payload" in each.text()]
    nothing_carried = check(replace(loaded, payload=0 * loaded.payload), arm).suspicions
    assert not [each for each in nothing_carried if "tool_mm" in each.text()]
