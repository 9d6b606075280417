"""`armscope init`: from nothing but a URDF, a pasted table, a name or a foreign file to what `check` accepts."""

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from armscope.robot import chain, load_arm
from tests.robot.test_dh_table import PASTED
from tests.robot.test_urdf import TORSO_ARM


def run(*words, given=None):
    return CliRunner().invoke(app, [str(word) for word in words], input=given)


def test_a_name_a_table_and_a_urdf_become_robot_yaml(tmp_path):
    robot = tmp_path / "robot.yaml"
    for what, given, motors in (("ur5e", None, 6), ("-", PASTED, 6), (TORSO_ARM, None, 6)):
        done = run("init", what, "-o", robot, "--force", given=given)
        assert done.exit_code == 0, done.output
        assert load_arm(robot).n_motors == motors
    assert "guess: tip" in done.stderr


MIMIC = (
    '<joint name="j2" type="revolute"><parent link="l2"/><child link="l3"/><axis xyz="0 1 0"/>'
    '<limit lower="-3" upper="3" effort="1" velocity="1"/><mimic {}/></joint>'
)


def test_a_urdf_of_one_chain_becomes_robot_yaml(tmp_path):
    """Nothing to hold: name, file and tip are single values, and what was guessed follows them."""
    (tmp_path / "arm.urdf").write_text(plain_urdf(6))
    done = run("init", tmp_path / "arm.urdf", "-o", tmp_path / "robot.yaml")
    assert done.exit_code == 0, done.output
    assert load_arm(tmp_path / "robot.yaml").n_motors == 6
    assert "source:\n  tip: 'guessed" in (tmp_path / "robot.yaml").read_text()


FLOATS = '<joint name="free" type="floating"><parent link="l2"/><child link="l3"/></joint>'


@pytest.mark.parametrize(
    ("third", "told"),
    [
        (FLOATS, "joint free: found 'a floating joint'"),
        (FLOATS.replace("floating", "planar"), "joint free: found 'a planar joint'"),
        (MIMIC.format('joint="j1" offset="0.1"'), "joint j2: found 'mimic of j1'; its offset of 0.1"),
        (MIMIC.format('joint="j2"'), "joint j2: found 'mimic of j2'"),
    ],
)
def test_a_robot_yaml_that_no_command_could_read_is_not_written(third, told, tmp_path):
    whole = plain_urdf(4)
    start = whole.index('<joint name="j2"')
    (tmp_path / "arm.urdf").write_text(
        whole[:start] + third + whole[whole.index("</joint>", start) + len("</joint>") :]
    )
    done = run("init", tmp_path / "arm.urdf", "--tip", "l4", "-o", tmp_path / "robot.yaml")
    assert isinstance(done.exception, InputError), done.output
    assert told in str(done.exception)
    assert not (tmp_path / "robot.yaml").exists()


def test_an_arm_whose_joints_slide_still_becomes_robot_yaml(tmp_path):
    whole = plain_urdf(3).replace('type="revolute"', 'type="prismatic"')
    (tmp_path / "gantry.urdf").write_text(whole)
    assert run("init", tmp_path / "gantry.urdf", "-o", tmp_path / "robot.yaml").exit_code == 0
    assert "gantry.urdf" in (tmp_path / "robot.yaml").read_text()


def plain_urdf(joints: int) -> str:
    """A chain of joints that turn, each 0.3 m above the one before."""
    links = "".join(f'<link name="l{n}"/>' for n in range(joints + 1))
    chained = "".join(
        f'<joint name="j{n}" type="revolute"><parent link="l{n}"/><child link="l{n + 1}"/><origin xyz="0 0 0.3"/>'
        f'<axis xyz="{n % 2} 0 {1 - n % 2}"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        for n in range(joints)
    )
    return f'<robot name="plain">{links}{chained}</robot>'


def test_standard_output_holds_the_file_alone(tmp_path):
    done = run("init", "ur10", "-o", "-")
    (tmp_path / "robot.yaml").write_text(done.stdout)
    assert load_arm(tmp_path / "robot.yaml").name == "Universal Robots UR10 (CB series)"


def test_the_list_of_arms_is_what_was_asked_for():
    done = run("init", "--list")
    assert "ur5e" in done.stdout
    assert run("init").stdout == ""


def test_bytes_that_are_no_text_are_one_error():
    done = CliRunner().invoke(app, ["init", "-"], input=b"a alpha d theta\n\xff\x80 0 0 0\n")
    assert isinstance(done.exception, InputError)
    assert "0xff" in str(done.exception)
    assert CliRunner().invoke(app, ["init", "-"], input=PASTED.encode("utf-16")).exit_code == 0


def test_a_foreign_table_becomes_a_mapping_that_import_takes(tmp_path):
    arm = load_arm_of("ur5e", tmp_path)
    q = np.random.default_rng(0).uniform(-2, 2, (40, 6))
    points = chain(arm, q).tool * 1e3
    columns = {f"Joint{j + 1}": np.degrees(q[:, j]) for j in range(6)} | {a: points[:, k] for k, a in enumerate("XYZ")}
    foreign = tmp_path / "log.csv"
    pd.DataFrame(columns).to_csv(foreign, sep=";", decimal=",", index=False)
    assert run("init", foreign, "-o", tmp_path / "mapping.yaml").exit_code == 0
    assert run("import", foreign, "-m", tmp_path / "mapping.yaml", "-o", tmp_path / "rec.csv").exit_code == 0
    checked = run("check", tmp_path / "rec.csv", "-r", tmp_path / "robot.yaml")
    assert checked.exit_code == 0, checked.output


def load_arm_of(name, folder):
    run("init", name, "-o", folder / "robot.yaml")
    return load_arm(folder / "robot.yaml")


@pytest.mark.parametrize(("what", "words"), [("ur55", "'ur5'"), ("", "nothing"), ("nowhere.urdf", "readable")])
def test_what_is_none_of_these_is_one_error(what, words):
    done = run("init", what)
    assert isinstance(done.exception, InputError)
    assert words in str(done.exception)


def test_a_file_of_the_users_is_not_overwritten(tmp_path):
    (tmp_path / "robot.yaml").write_text("mine")
    assert run("init", "ur5", "-o", tmp_path / "robot.yaml").exit_code != 0
    assert (tmp_path / "robot.yaml").read_text() == "mine"
