"""A stated tool whose numbers stand in another order is asked about; one that is somewhere else is not."""

import numpy as np
import pytest

from armscope.check.report import check
from armscope.robot.arm import build_arm
from tests.check.conftest import TOOL

X, Y, Z = (1e3 * each for each in TOOL[""])


def asked(arm, sound, tool_mm):
    stated = build_arm(arm.description.model_copy(update={"tool_mm": tuple(tool_mm)}))
    return [each.text() for each in check(sound, stated).suspicions if "`tool_mm`" in each.text()]


@pytest.mark.parametrize("tool_mm", [(Z, Y, X), (Y, X, Z), (-X, Y, Z), (X, Y, -Z)])
def test_another_order_or_sign_is_asked_about_with_the_numbers_as_the_points_have_them(arm, sound, tool_mm):
    (hint,) = asked(arm, sound, tool_mm)
    told = [float(each) for each in hint.rpartition("[")[2].partition("]")[0].split(",")]
    np.testing.assert_allclose(told, (X, Y, Z), atol=1e-3)


@pytest.mark.parametrize("tool_mm", [(X, Y, Z), (X + 40, Y, Z), (X, Y, Z + 75), (0, 0, 0)])
def test_a_tool_that_is_right_or_another_is_not(arm, sound, tool_mm):
    assert not asked(arm, sound, tool_mm)
