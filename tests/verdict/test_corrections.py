"""Numbers to enter in a controller's model: an arm built from them stands where the diagnosed one does."""

from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from armscope.robot.arm import Arm, build_arm
from armscope.robot.kinematics import forward_kinematics
from armscope.robot.library import nominal_description
from armscope.verdict.corrections import corrected_origins, corrected_rows
from armscope.verdict.effects import FoundEffect, Parameter
from tests.report.verdicts import found
from tests.robot.test_urdf import TORSO_ARM, build

ERRORS = {"tx": 0.7e-3, "ty": -0.2e-3, "tz": 0.4e-3, "rx": 6e-4, "ry": -9e-4}


def saying(arm: Arm, *effects: FoundEffect) -> Any:
    """As much of a verdict as corrections ask for."""
    return SimpleNamespace(model=SimpleNamespace(arm=arm), effects=effects)


def another_shape(joint: int, errors: dict[str, float] = ERRORS) -> FoundEffect:
    """A link whose place in a URDF is off; errors in m and rad."""
    told = (
        Parameter(name, "mm" if name[0] == "t" else "rad", value * (1e3 if name[0] == "t" else 1), 1e-6)
        for name, value in errors.items()
    )
    return found("link_geometry", f"link {joint}", *told)


@pytest.mark.parametrize("joint", [1, 2, 3])
def test_a_urdf_with_the_corrected_origin_stands_where_the_link_of_another_shape_does(joint: int, tmp_path) -> None:
    arm = build()
    angles = np.random.default_rng(joint).uniform(-1.5, 1.5, (20, arm.n_motors))
    off = forward_kinematics(arm, angles, {f"joint {joint}": np.array([*ERRORS.values(), 0.0])})
    table = corrected_origins(saying(arm, another_shape(joint)))
    assert table is not None
    assert table["changed"].tolist() == [j == joint for j in range(1, arm.n_joints + 1)]
    tree = ElementTree.parse(TORSO_ARM)
    for row in table.to_dict("records"):
        (element,) = [each for each in tree.getroot().findall("joint") if each.get("name") == row["joint"]]
        origin = element.find("origin")
        origin = ElementTree.SubElement(element, "origin") if origin is None else origin
        origin.set("xyz", " ".join(repr(row[f"corrected_{axis}_m"]) for axis in "xyz"))
        origin.set("rpy", " ".join(repr(row[f"corrected_{axis}_rad"]) for axis in ("roll", "pitch", "yaw")))
    tree.write(tmp_path / "corrected.urdf")
    mended = forward_kinematics(build(tmp_path / "corrected.urdf"), angles)
    np.testing.assert_allclose(mended, off, atol=1e-9)
    assert np.abs(off - forward_kinematics(arm, angles)).max() > 1e-4


def test_an_origin_that_hardly_turns_keeps_its_stated_angles() -> None:
    arm = build()
    table = corrected_origins(saying(arm, another_shape(2, {"tx": 1e-3, "rx": 4e-6})))
    assert table is not None
    for axis in ("roll", "pitch", "yaw"):
        np.testing.assert_allclose(table[f"corrected_{axis}_rad"], table[f"stated_{axis}_rad"], atol=1e-15)


def test_an_arm_has_rows_or_origins_never_both() -> None:
    urdf = saying(build())
    rows = saying(build_arm(nominal_description("irb120")))
    assert corrected_rows(urdf) is None
    assert corrected_origins(rows) is None
    assert corrected_rows(rows) is not None
