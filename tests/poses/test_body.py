"""What the body is made of where shapes leave something out."""

import numpy as np
import pytest

from armscope.poses.body import collision_shapes, pieces
from armscope.robot import chain, load_arm

BARE = '<link name="{}"/>'
SHAPED = (
    '<link name="{}"><collision><origin xyz="0 0 0.5"/><geometry><box size="0.2 0.2 {}"/></geometry></collision></link>'
)


def arm_with(folder, lengths, tool_mm=(0, 0, 0)):
    """Links of 1 m, each with a box of a length about its middle, or none; the tip 1 m beyond the last joint."""
    links = "".join(SHAPED.format(f"l{n}", each) if each else BARE.format(f"l{n}") for n, each in enumerate(lengths, 1))
    joints = "".join(
        f'<joint name="j{n}" type="revolute"><parent link="{f"l{n - 1}" if n > 1 else "base"}"/><child link="l{n}"/>'
        f'<origin xyz="0 0 {n > 1:d}"/><axis xyz="1 0 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        for n in range(1, len(lengths) + 1)
    )
    tip = f'<link name="tip"/><joint name="t" type="fixed"><parent link="l{len(lengths)}"/><child link="tip"/>'
    content = f'<robot name="r"><link name="base"/>{links}{joints}{tip}<origin xyz="0 0 1"/></joint></robot>'
    (folder / "arm.urdf").write_text(content)
    (folder / "robot.yaml").write_text(f"name: r\nurdf: arm.urdf\ntip: tip\ntool_mm: {list(tool_mm)}\n")
    return load_arm(folder / "robot.yaml")


def body_of(arm, angles):
    frames = chain(arm, np.asarray([angles], float))
    return pieces(arm, frames, collision_shapes(arm.description), 0.05), frames


def test_the_way_from_the_last_shape_to_the_tip_is_a_part(tmp_path):
    body, frames = body_of(arm_with(tmp_path, [1, 0.4]), [0.2, 0.4])
    assert [each.name for each in body] == ["link 1", "link 2", "tool"]
    np.testing.assert_allclose(body[-1].end, frames.tool, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(body[-1].end - body[-1].start), 0.4)  # the box ends in a cap of 0.1


def test_a_tip_within_the_last_shape_needs_no_more_than_the_tool(tmp_path):
    assert [each.name for each in body_of(arm_with(tmp_path, [1, 1]), [0.2, 0.4])[0]] == ["link 1", "link 2"]
    body, frames = body_of(arm_with(tmp_path, [1, 1], (300, 0, 0)), [0.2, 0.4])
    assert [each.name for each in body] == ["link 1", "link 2", "tool"]
    np.testing.assert_allclose(np.linalg.norm(body[-1].end - body[-1].start), 0.3)
    np.testing.assert_allclose(body[-1].end, frames.tool, atol=1e-12)


@pytest.mark.parametrize("bare", [0, 1, 2])
def test_a_link_without_a_shape_is_a_line_of_the_assumed_radius(tmp_path, bare):
    lengths = [1, 1, 1]
    lengths[bare] = 0
    body, frames = body_of(arm_with(tmp_path, lengths), [0.2, 0.4, -0.7])
    (line,) = [each for each in body if each.radius == 0.05]
    assert line.name == f"link {bare + 1}"
    points = [*frames.joint_origin[0], frames.tool[0]]
    np.testing.assert_allclose([line.start[0], line.end[0]], points[bare : bare + 2], atol=1e-12)
