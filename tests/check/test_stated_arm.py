"""A stated tool whose numbers stand in another order is asked about; one that is somewhere else is not."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.check.report import check
from armscope.check.stated_arm import nominal_fits
from armscope.check.suspicions import against_arm
from armscope.recordings import as_recordings
from armscope.robot import chain
from armscope.robot.arm import build_arm
from armscope.robot.library import nominal_description
from armscope.verdict.schema import ANOTHER_MODEL
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


def test_a_payload_whose_place_nobody_states_is_told_with_the_place_that_the_points_show(arm, sound):
    loaded = replace(sound, payload=np.where(np.arange(len(sound)) % 2, 5.0, 0.0))
    (hint,) = [each.text() for each in check(loaded, arm).suspicions if "payload" in each.text()]
    told = [float(each) for each in hint.partition("[")[2].partition("]")[0].split(",")]
    np.testing.assert_allclose(told, 1e3 * np.array(TOOL[""]), atol=3)
    stated = build_arm(arm.description.model_copy(update={"tool_mm": tuple(1e3 * np.array(TOOL[""]))}))
    assert not [each for each in check(loaded, stated).suspicions if "payload" in each.text()]
    nothing_carried = check(replace(loaded, payload=0 * loaded.payload), arm).suspicions
    assert not [each for each in nothing_carried if "tool_mm" in each.text()]


def table(name, noise_mm=0.05, seed=0, rows=60):
    """Points of an arm of the library, seen from somewhere, with joint errors of a milliradian."""
    rng, arm = np.random.default_rng(seed), build_arm(nominal_description(name))
    q = rng.uniform(-1.8, 1.8, (rows, arm.n_motors))
    frames = chain(arm, q + rng.normal(0, 1e-3, arm.n_motors))
    points = frames.tool + frames.tool_rotation @ rng.normal(0, 0.05, 3)
    points = (
        Rotation.random(random_state=seed).apply(points)
        + np.array([2, 1, 0.3])
        + rng.normal(0, noise_mm * 1e-3, (rows, 3))
    )
    columns = {f"q{j + 1}_rad": q[:, j] for j in range(arm.n_motors)}
    return as_recordings(pd.DataFrame(columns | {f"{a}_mm": points[:, k] * 1e3 for k, a in enumerate("xyz")}))


@pytest.mark.parametrize("name", ["ur5", "iiwa14"])
def test_the_arm_that_made_the_points_comes_first(name):
    first, second = nominal_fits(table(name))[:2]
    assert first.name == name
    assert first.explains
    assert first.rms_mm < 0.5 * second.rms_mm


def test_points_of_no_arm_of_the_library_are_explained_by_none():
    q = np.random.default_rng(0).uniform(-1, 1, (80, 6))
    points = np.random.default_rng(1).uniform(-800, 800, (80, 3))
    columns = {f"q{j + 1}_rad": q[:, j] for j in range(6)} | {f"{a}_mm": points[:, k] for k, a in enumerate("xyz")}
    assert not any(fit.explains for fit in nominal_fits(as_recordings(pd.DataFrame(columns))))


def test_only_arms_with_as_many_motors_are_tried():
    assert {fit.name for fit in nominal_fits(table("panda"))} == {"panda", "iiwa7", "iiwa14"}


@pytest.mark.parametrize(("stated", "weight"), [("ur5e", "hint"), ("ur10", "problem")])
def test_a_table_of_another_arm_is_told_with_that_arm(stated, weight):
    found = against_arm(build_arm(nominal_description(stated)), table("ur5")).suspicions
    (other,) = [each for each in found if each.kind == ANOTHER_MODEL]
    assert other.weight == weight
    assert "armscope init ur5 " in other.cure


@pytest.mark.parametrize("joint", [1, 2])
def test_a_zero_far_off_makes_no_other_arm_of_it(joint):
    points = table("ur5e")
    points.motor_angles[:, joint] += np.radians(3)
    found = against_arm(build_arm(nominal_description("ur5e")), points).suspicions
    assert not any(each.kind == ANOTHER_MODEL for each in found)
