"""What can be wrong with a robot.yaml: one error each that names place, value, rule and the nearest known key."""

import numpy as np
import pytest
import yaml

from armscope.core.inputs import InputError
from armscope.robot import load_arm
from tests.robot.arms import SK120

ROW = {"a_mm": 300, "alpha_deg": -90, "d_mm": 800}


def write(folder, **changes):
    content = {"name": "arm", "dh": {"joints": [ROW, ROW]}, **changes}
    file = folder / "robot.yaml"
    file.write_text(yaml.safe_dump({key: value for key, value in content.items() if value is not None}))
    return file


def test_the_plain_description_is_fine(tmp_path):
    arm = load_arm(write(tmp_path))
    assert (arm.n_joints, arm.n_motors, arm.has_masses) == (2, 2, False)
    assert np.isinf(arm.limits).all()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"tol_mm": [0, 0, 0]}, ["tol_mm", "not known", "'tool_mm'"]),
        ({"dh": {"joints": [{**ROW, "a_m": 1}]}}, ["dh.joints[0].a_m", "'a_mm'"]),
        ({"dh": {"joints": [{"a_mm": 1, "alpha_deg": 0}]}}, ["dh.joints[0].d_mm", "nothing"]),
        ({"dh": {"joints": []}}, ["dh.joints", "at least 1"]),
        ({"dh": {"joints": [{**ROW, "a_mm": "wide"}]}}, ["dh.joints[0].a_mm", "'wide'", "number"]),
        ({"dh": {"joints": [{**ROW, "d_mm": 1e6}]}}, ["dh.joints[0].d_mm", "1000000", "20000"]),
        ({"dh": {"joints": [{**ROW, "a_mm": float("nan")}]}}, ["dh.joints[0].a_mm", "nan", "finite"]),
        ({"dh": {"convention": "craig", "joints": [ROW]}}, ["dh.convention", "'craig'", "'modified'"]),
        ({"links": [{"mass_kg": 1, "com_mm": [0, 0, 0]}]}, ["`links`", "2 rows", "has 1"]),
        (
            {"links": [{"mass_kg": -1, "com_mm": [0, 0, 0]}] * 2},
            ["links[0].mass_kg", "-1", "greater than or equal to 0"],
        ),
        ({"links": [{"mass_kg": 1, "com_mm": [0, 0]}] * 2}, ["links[0].com_mm"]),
        (
            {"links": [{"mass_kg": 1, "com_mm": [0, 0, 0], "inertia_kg_m2": [1, 1, 3, 0, 0, 0]}] * 2},
            ["links[0].inertia_kg_m2", "no body", "1, 1, 3"],
        ),
        ({"drives": [{"coulomb_nm": 1}]}, ["`drives`", "2 motors", "has 1"]),
        ({"drives": [{"coulomb": 1}, {}]}, ["drives[0].coulomb", "'coulomb_nm'"]),
        ({"actuation": [{"q1": 1}]}, ["`actuation`", "2 rows", "has 1"]),
        ({"actuation": [{"q1": 1}, {"m2": 1}]}, ["actuation[1]", "'m2'", "q1, q2"]),
        ({"joint_limits_deg": [[-1, 1]]}, ["joint_limits_deg", "2 motors", "has 1"]),
        ({"joint_limits_deg": [[-1, 1], [2, 1]]}, ["joint_limits_deg[1]", "low < high"]),
        ({"instrument": {"sigma_mm": 0}}, ["instrument.sigma_mm", "greater than or equal to 0.0001"]),
        ({"dh": None}, ["`dh`", "`urdf`"]),
        ({"urdf": "arm.urdf"}, ["`dh`", "`urdf`"]),
        ({"dh": None, "urdf": "arm.urdf"}, ["tip"]),
        ({"dh": None, "urdf": "arm.urdf", "tip": "flange"}, ["urdf", "arm.urdf", "readable file"]),
        ({"name": None}, ["name", "nothing"]),
    ],
)
def test_one_error_names_place_value_and_rule(tmp_path, changes, words):
    file = write(tmp_path, **changes)
    with pytest.raises(InputError) as error:
        load_arm(file)
    message = str(error.value)
    assert message.startswith(str(file))
    for word in words:
        assert word in message, message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name: [unclosed", ["line"]),
        ("name: a\nname: b", ["line 2", "'name' twice"]),
        ("- just\n- a list", ["a list", "key: value"]),
        ("", ["found nothing", "key: value"]),
    ],
)
def test_broken_yaml_is_an_input_error(tmp_path, text, words):
    file = tmp_path / "robot.yaml"
    file.write_text(text)
    with pytest.raises(InputError) as error:
        load_arm(file)
    for word in words:
        assert word in str(error.value), error.value


def test_a_missing_file_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match=r"nowhere\.yaml.*readable"):
        load_arm(tmp_path / "nowhere.yaml")


def test_the_sk120_says_where_its_numbers_come_from():
    arm = load_arm(SK120)
    sources = arm.description.source
    assert sources["dh"].startswith("assumed")
    assert "p. 957" in sources["tool_mm"]
    assert np.isclose(arm.tool[0], 0.20532)
    assert arm.actuation[2].tolist() == [0, -1, 1, 0, 0, 0]


@pytest.mark.parametrize(
    ("change", "place", "words"),
    [
        ({"gravity_m_s2": [0, 0, -9810]}, "gravity_m_s2", "9.81 m/s2 on Earth"),
        ({"links": [{"mass_kg": 1e30, "com_mm": [0, 0, 0]}]}, "links[0].mass_kg", "20000"),
        ({"links": [{"mass_kg": 10, "com_mm": [0, 0, 1e6]}]}, "links[0].com_mm[2]", "20000"),
        ({"tool_mm": [0, 0, 1e6]}, "tool_mm[2]", "20000"),
        ({"instrument": {"sigma_mm": 1e4}}, "instrument.sigma_mm", "100"),
        ({"actuation": [{"q1": 1e9}]}, "actuation[0].q1", "1000"),
        ({"dh": {"joints": [{"a_mm": 100, "alpha_deg": 0, "d_mm": 0}] * 100}}, "dh.joints", "99"),
    ],
)
def test_physics_that_no_arm_has_is_refused_where_it_stands(change, place, words, tmp_path):
    row = {"a_mm": 100, "alpha_deg": 0, "d_mm": 0}
    content = {"name": "arm", "dh": {"joints": [row]}} | change
    (tmp_path / "robot.yaml").write_text(yaml.safe_dump(content))
    with pytest.raises(InputError) as caught:
        load_arm(tmp_path / "robot.yaml")
    assert caught.value.place == place
    assert words in str(caught.value)
