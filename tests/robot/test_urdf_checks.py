"""Impossible bodies are refused in a URDF as in robot.yaml; what published files have is not."""

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from armscope.core.inputs import InputError
from armscope.robot.description import LinkMass
from armscope.robot.urdf_checks import refuse_contradictions
from armscope.robot.urdf_file import root_of

SHARED = Path(__file__).parents[3] / "shared"
BODY = (
    "<link name='l'><inertial><mass value='9'/>"
    "<inertia ixx='{}' iyy='{}' izz='{}' ixy='{}' ixz='0' iyz='0'/></inertial></link>"
)


def with_inertia(*numbers):
    return ET.fromstring(f"<robot name='made'>{BODY.format(*numbers)}</robot>")


@pytest.mark.parametrize(
    "numbers", [("-0.02", 0.16, 0.16, 0), (0.1, 0.1, 0.3, 0), (0.1, 0.1, 0.1, 0.2), (0.1, 0.1, "thick", 0)]
)
def test_an_inertia_that_no_body_has_is_refused_at_its_link(numbers):
    with pytest.raises(InputError, match=f"link l, inertia: found '{numbers[0]} {numbers[1]} {numbers[2]} "):
        refuse_contradictions("made.urdf", with_inertia(*numbers))


@pytest.mark.parametrize(
    "numbers",
    [(0, 0, 0, 0), (0, 0.16, 0.16, 0), (0.0999, 0.1, 0.2, 0), (1, 1, 1, 0), (0.5, 0.5, 1, -0.5), (1e-9,) * 3 + (0,)],
)
def test_dummies_thin_rods_plates_and_rounded_numbers_are_bodies(numbers):
    refuse_contradictions("made.urdf", with_inertia(*numbers))
    xx, yy, zz, xy = numbers
    LinkMass(mass_kg=9, com_mm=(0, 0, 0), inertia_kg_m2=(xx, yy, zz, xy, 0, 0))


def test_the_rule_is_that_of_robot_yaml():
    with pytest.raises(InputError) as error:
        refuse_contradictions("made.urdf", with_inertia(-0.02, 0.16, 0.16, 0))
    with pytest.raises(ValueError, match=r"principal inertias -0\.02, 0\.16, 0\.16"):
        LinkMass(mass_kg=9, com_mm=(0, 0, 0), inertia_kg_m2=(-0.02, 0.16, 0.16, 0, 0, 0))
    assert "no body has principal inertias -0.02, 0.16, 0.16" in str(error.value)


def with_range(kind, lower, upper):
    limit = f"<limit effort='1' velocity='1'{lower}{upper}/>"
    joint = f"<joint name='j1' type='{kind}'><parent link='a'/><child link='b'/>{limit}</joint>"
    return ET.fromstring(f"<robot name='made'><link name='a'/><link name='b'/>{joint}</robot>")


@pytest.mark.parametrize(
    ("kind", "lower", "upper", "told"),
    [
        ("revolute", "-180", "180", r"joint j1, limit lower: found '-180'.*-180 degrees are -3\.14159"),
        ("revolute", "-3", "1e16", r"joint j1, limit upper: found '1e16'.*`continuous`"),
        ("revolute", "2", "-2", r"joint j1, limit: found 'lower 2, upper -2'; lower is not above upper"),
        ("prismatic", "0.5", "0.1", r"found 'lower 0\.5, upper 0\.1'"),
    ],
)
def test_a_range_that_is_in_degrees_or_the_wrong_way_round_is_refused(kind, lower, upper, told):
    with pytest.raises(InputError, match=told):
        refuse_contradictions("made.urdf", with_range(kind, f" lower='{lower}'", f" upper='{upper}'"))


@pytest.mark.parametrize(
    ("kind", "lower", "upper"),
    [
        ("revolute", "", ""), ("revolute", " lower='0'", " upper='0'"),
        ("revolute", " lower='-12.56'", " upper='12.56'"),
        ("revolute", " lower='-inf'", " upper='inf'"), ("continuous", " lower='-1e16'", " upper='1e16'"),
        ("prismatic", " lower='-20'", " upper='20'"),
    ],
)  # fmt: skip
def test_a_range_that_is_not_stated_or_can_be_is_taken(kind, lower, upper):
    refuse_contradictions("made.urdf", with_range(kind, lower, upper))


@pytest.mark.shared
@pytest.mark.skipif(not SHARED.is_dir(), reason="no folder of shared material")
def test_shared_urdfs_load_as_they_are():
    files = sorted(SHARED.glob("motions/*/*.urdf"))
    assert files
    for file in files:
        root_of(str(file))
