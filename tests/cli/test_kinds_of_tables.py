"""A table of points and a table of motions: what belongs to the other kind is told, not passed over."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError

EXAMPLES = Path(__file__).parents[2] / "examples"
POINTS, MOTIONS = EXAMPLES / "one-effect", EXAMPLES / "moving-arm"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("diagnose MOTIONS -r ARM -o OUT --tool-per-run", "--tool-per-run"),
        ("diagnose MOTIONS -r ARM -o OUT --first-id 3", "--first-id"),
        ("diagnose MOTIONS -r ARM -o OUT --estimate-gravity", "--estimate-gravity"),
        ("diagnose MOTIONS -r ARM -o OUT --held-out run1 --held-out run2", "Hold out fewer"),
        ("diagnose POINTS -r ROBOT -o OUT --cutoff 8", "--cutoff"),
        ("diagnose POINTS -r ROBOT -o OUT --held-out a", "--held-out"),
        ("calibrate MOTIONS -r ARM -o OUT", "table of an arm in motion"),
        ("compare MOTIONS MOTIONS -r ARM", "table of an arm in motion"),
        ("compensate MODEL POINTS -o OUT.csv", "model of|of an arm in motion"),
    ],
)
def test_what_is_for_the_other_kind_is_one_error(words, told, tmp_path):
    model = Path(__file__).parents[1] / "fuzz" / "corpus" / "motion-model" / "moving-arm.yaml"
    places = {
        "MOTIONS": MOTIONS / "motions.csv.gz",
        "ARM": MOTIONS / "robot.yaml",
        "POINTS": POINTS / "recordings.csv",
        "ROBOT": POINTS / "robot.yaml",
        "MODEL": model,
        "OUT": tmp_path / "out",
        "OUT.csv": tmp_path / "out.csv",
    }
    error = CliRunner().invoke(app, [str(places.get(word, word)) for word in words.split()]).exception
    assert isinstance(error, InputError), repr(error)
    assert any(each in str(error) for each in told.split("|")), str(error)
    assert not (tmp_path / "out").exists()


SLIDES = """<robot name="scara"><link name="base"/>
<link name="l1"><inertial><mass value="6"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="l2"><inertial><mass value="4"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="l3"><inertial><mass value="2"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="90" velocity="3"/></joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz=".3 0 0"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="90" velocity="3"/></joint>
<joint name="j3" type="prismatic"><parent link="l2"/><child link="l3"/><origin xyz=".3 0 0"/><axis xyz="0 0 1"/>
<limit lower="-.2" upper="0" effort="90" velocity="1"/></joint></robot>"""


@pytest.fixture
def scara(tmp_path):
    (tmp_path / "scara.urdf").write_text(SLIDES)
    (tmp_path / "robot.yaml").write_text("{name: scara, urdf: scara.urdf, tip: l3}")
    rows = [f"{0.01 * k},{0.001 * k},{0.001 * k},{-0.0001 * k},{k},{k},{k}" for k in range(200)]
    (tmp_path / "motions.csv").write_text("\n".join(["time_s,q1_rad,q2_rad,q3_m,tau1_nm,tau2_nm,f3_n", *rows]))
    return tmp_path


@pytest.mark.parametrize("command", ["check", "diagnose"])
def test_a_tip_that_was_guessed_too_near_is_named_with_how_to_name_it(command, scara):
    words = [command, str(scara / "motions.csv"), "--robot", str(scara / "scara.urdf")]
    words += ["-o", str(scara / "out")] if command == "diagnose" else []
    error = CliRunner().invoke(app, words).exception
    assert isinstance(error, InputError), repr(error)
    for told in (
        "found 'q3_m'; the arm has 2 motors",
        "guessed: l2",
        "joint j3, which slides",
        "`{name: scara, urdf: scara.urdf, tip: NAME}`",
    ):
        assert told in str(error)


@pytest.mark.long
def test_of_an_arm_that_slides_excite_says_what_it_leaves_out(scara):
    out = str(scara / "out.csv")
    told = CliRunner().invoke(app, ["excite", str(scara / "scara.urdf"), "-o", out, "--rounds", "0"])
    assert told.exit_code == 0, told.output
    assert "joint j3, which slides behind it, is taken for no part of the arm" in told.output
    error = CliRunner().invoke(app, ["excite", str(scara / "robot.yaml"), "-o", out]).exception
    assert "`diagnose motions.csv` takes both" in str(error)
    checked = CliRunner().invoke(app, ["check", str(scara / "motions.csv"), "--robot", str(scara / "robot.yaml")])
    assert "of 3 motors" in checked.output


def test_a_verdict_of_another_arm_is_no_ground_to_plan_a_motion(tmp_path):
    verdict = tmp_path / "verdict.json"
    other = {"effect": "cable_torque", "location": "joint 2"}
    causes = [{"effect": "torque_offset", "location": "joint 2", "alternatives": [other]}]
    arm, out = str(MOTIONS / "robot.yaml"), str(tmp_path / "out.csv")
    for background in (7, 2):
        joints = [{"joint": f"joint {j + 1}"} for j in range(background)]
        verdict.write_text(json.dumps({"effects": causes, "background": joints}))
        error = CliRunner().invoke(app, ["excite", arm, "--separate", str(verdict), "-o", out]).exception
        assert isinstance(error, InputError), repr(error)
        assert f"{background} joints" in str(error)
