"""A URDF as XML: tags of other programs, impossible masses and lengths, and which link carries the tool."""

import itertools

import pytest

from armscope.core.inputs import InputError
from armscope.robot import load_arm
from armscope.robot.urdf_file import guess_chain, root_of
from tests.robot.test_urdf import TORSO_ARM, changed

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def robot(folder, *joints):
    """A URDF from (name, type, parent, child) and what stands inside."""
    links = sorted({link for _, _, *both, _ in joints for link in both})
    text = "".join(f'<link name="{link}"/>' for link in links)
    for name, kind, parent, child, inside in joints:
        ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/>'
        text += f'<joint name="{name}" type="{kind}">{ends}{inside}</joint>'
    (folder / "made.urdf").write_text(f'<robot name="made">{text}</robot>')
    return folder / "made.urdf"


def arm(prefix="", base="base", n=3):
    links = [base, *(f"{prefix}l{j}" for j in range(1, n + 1))]
    return [
        (f"{prefix}j{j}", "revolute", one, other, LIMIT) for j, (one, other) in enumerate(itertools.pairwise(links), 1)
    ]


def test_tags_whose_prefix_nobody_declared_are_passed_over(tmp_path):
    drake = '<drake:proximity_properties><drake:mesh value="0.1"/></drake:proximity_properties>'
    file = changed(tmp_path, ('<link name="mount"/>', f'<link name="mount">{drake}</link>'))
    assert load_arm(file).n_joints == load_arm(TORSO_ARM).n_joints
    file.write_text(file.read_text().replace("</drake:mesh>", "").replace("</robot>", ""))
    with pytest.raises(InputError, match=r"line \d+, column \d+.*XML"):
        load_arm(file)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('<mass value="4"/>', '<mass value="1e30"/>', r"mass: found '1e30'.*20000 kg"),
        ('<mass value="4"/>', '<mass value="-4"/>', r"mass: found '-4'"),
        ('<mass value="4"/>', '<mass value="nan"/>', r"mass: found 'nan'"),
        ('<mass value="4"/>', '<mass value="four"/>', r"mass: found 'four'.*number of kg"),
        ('<origin xyz="-0.05 0 0.6"', '<origin xyz="-50 0 600"', r"xyz: found '-50 0 600'.*20 m.*metres"),
    ],
)
def test_what_no_arm_has_is_refused_where_it_stands(tmp_path, old, new, words):
    text = TORSO_ARM.read_text()
    assert old in text, old
    with pytest.raises(InputError, match=words):
        load_arm(changed(tmp_path, (old, new)))


def test_the_tool_is_behind_the_last_turning_joint(tmp_path):
    file = robot(tmp_path, *arm(), ("fix", "fixed", "l3", "adapter", ""), ("fix2", "fixed", "l3", "tool0", ""))
    assert guess_chain(str(file), root_of(str(file))).tip == "tool0"


def test_fingers_are_no_arm(tmp_path):
    sliding = [(f"f{k}", "prismatic", "l3", f"finger{k}", LIMIT) for k in (1, 2)]
    file = robot(tmp_path, *arm(), *sliding)
    found = guess_chain(str(file), root_of(str(file)))
    assert (found.tip, found.held) == ("l3", {})
    turning = [(f"f{k}", "revolute", "l3", f"finger{k}", LIMIT) for k in (1, 2)]
    file = robot(tmp_path, *arm(), *turning)
    assert guess_chain(str(file), root_of(str(file))).tip == "l3"
    followers = [("f1", "revolute", "l3", "finger1", LIMIT + '<mimic joint="j1"/>')]
    file = robot(tmp_path, *arm(), *followers)
    assert guess_chain(str(file), root_of(str(file))).tip == "l3"


def test_two_arms_are_one_error_that_names_their_ends(tmp_path):
    file = robot(tmp_path, *arm("left_"), *arm("right_"))
    with pytest.raises(InputError, match=r"2 arms, ending in left_l3, right_l3.*--tip"):
        load_arm(file)
    with pytest.raises(InputError, match=r"1 turning joints in a row"):
        load_arm(robot(tmp_path, *arm(n=1)))


def test_a_rail_is_held_within_its_limits(tmp_path):
    rail = ("rail", "prismatic", "world", "base", '<limit lower="0.3" upper="2" effort="1" velocity="1"/>')
    found = guess_chain("made", root_of(str(robot(tmp_path, rail, *arm()))))
    assert found.held == {"rail": 0.3}
    assert found.guesses["hold_joints.rail"].startswith("guessed")


def test_a_machine_of_which_nothing_turns_is_the_axes_that_slide(tmp_path):
    rail = ("rail", "prismatic", "world", "cart", '<limit lower="0.3" upper="2" effort="1" velocity="1"/>')
    found = guess_chain("made", root_of(str(robot(tmp_path, rail))))
    assert (found.tip, found.held) == ("cart", {})
    with pytest.raises(InputError, match="sliding joint"):
        load_arm(robot(tmp_path, rail))  # positions need hinges; `diagnose` of a motion does not


@pytest.mark.parametrize(
    ("kind", "inside", "told"),
    [
        ("revolute", LIMIT + '<mimic joint="j2"/>', "joint j3 behind it mimics j2, so that no motor"),
        ("floating", "", "joint j3 behind it is floating, which no motor turns: make it `revolute`"),
    ],
)
def test_a_joint_that_ends_the_arm_early_is_named_with_the_reason(kind, inside, told, tmp_path):
    file = robot(tmp_path, *arm(n=2), ("j3", kind, "l2", "l3", inside), ("end", "fixed", "l3", "tool0", ""))
    found = guess_chain(str(file), root_of(str(file)))
    assert found.tip == "l2"
    assert told in found.guesses["tip"]
