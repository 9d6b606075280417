"""The library's arms say where their numbers come from, and stand where other descriptions of them do."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.robot import forward_kinematics, load_arm
from armscope.robot.arm import build_arm
from armscope.robot.library import is_nominal, nominal_description, nominal_file, nominal_names

HONEST = ("published", "read from", "as stated", "from memory", "left out")
ROOT = Path(__file__).parents[2]
DATA = importlib.util.find_spec("cmeel")
EXAMPLES = Path(DATA.submodule_search_locations[0]).parent if DATA and DATA.submodule_search_locations else ROOT
EXAMPLES = EXAMPLES / "cmeel.prefix" / "share" / "example-robot-data" / "robots"


def span(arm, q):
    """(N, N) distances between tool points: what neither base frame nor units of the file change."""
    points = forward_kinematics(arm, q)
    return np.linalg.norm(points[:, None] - points[None], axis=2)


@pytest.mark.parametrize("name", nominal_names())
def test_every_arm_says_where_its_numbers_come_from(name):
    described = nominal_description(name)
    assert described.source["dh"].startswith(HONEST)
    assert (described.links is not None) <= ("links" in described.source)
    assert all(said.startswith(HONEST) for said in described.source.values())
    arm = build_arm(described)
    assert 0.4 < arm.reach < 3.5
    assert np.isfinite(forward_kinematics(arm, np.zeros((1, arm.n_motors)))).all()


@pytest.mark.parametrize(
    ("name", "folder"),
    [("ur10", "ur10-ipa"), ("irb120", "irb120-offsets"), ("iiwa7", "iiwa7-payload"), ("panda", "panda-charuco")],
)
def test_an_arm_of_the_library_is_that_of_a_public_set(name, folder):
    """The mounting is the set's: base and tool may differ, distances along one axis of the last joint may not."""
    ours, theirs = (
        build_arm(nominal_description(name)),
        load_arm(ROOT / "config" / "recordings" / folder / "robot.yaml"),
    )
    q = np.random.default_rng(0).uniform(-1.5, 1.5, (20, ours.n_motors))
    for arm in (ours, theirs):
        arm.tool[:] = 0
    np.testing.assert_allclose(span(ours, q), span(theirs, q), atol=1e-6)


@pytest.mark.parametrize(
    ("name", "urdf"),
    [
        ("ur3", "ur_description/urdf/ur3_robot.urdf"),
        ("ur5", "ur_description/urdf/ur5_robot.urdf"),
        ("ur10", "ur_description/urdf/ur10_robot.urdf"),
        ("panda", "panda_description/urdf/panda.urdf"),
    ],
)
def test_an_arm_of_the_library_stands_where_its_urdf_does(name, urdf):
    """Distances between the tool points of 20 poses, which no base frame changes, to 1 mm."""
    if not (EXAMPLES / urdf).exists():
        pytest.skip("example-robot-data is not installed")
    ours, theirs = build_arm(nominal_description(name)), load_arm(EXAMPLES / urdf)
    flange = {"panda": "panda_link8"}.get(name, "tool0")
    theirs = build_arm(theirs.description.model_copy(update={"tip": flange}))
    q = np.random.default_rng(0).uniform(-1.5, 1.5, (20, ours.n_motors))
    np.testing.assert_allclose(span(ours, q), span(theirs, q), atol=1e-3)


def test_names_are_found_however_they_are_written():
    assert nominal_file("UR 5e") == nominal_file("ur5e")
    assert is_nominal("IRB-120")
    with pytest.raises(InputError, match=r"'ur5x'.*library.*'ur5'"):
        nominal_file("ur5x")


def test_an_arm_named_in_place_of_a_file_is_the_library_s():
    assert load_arm("ur5e").description == nominal_description("ur5e")
    with pytest.raises(InputError, match="readable"):
        load_arm("ur5x")
