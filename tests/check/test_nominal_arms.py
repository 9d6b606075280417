"""The arm of the library that made the points is the one that explains them best."""

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.check.nominal_arms import nominal_fits
from armscope.check.suspicions import against_arm
from armscope.recordings import as_recordings
from armscope.robot import chain
from armscope.robot.arm import build_arm
from armscope.robot.library import nominal_description
from armscope.verdict.schema import ANOTHER_MODEL


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
