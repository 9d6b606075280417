from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.core.inputs import InputError
from armscope.poses.body import collision_shapes, pieces
from armscope.poses.obstacles import (
    Surroundings,
    body_in_words,
    body_notes,
    lowest,
    ranges,
    refusals,
    segment_distance,
    surroundings_notes,
    thinned,
)
from armscope.robot import chain, load_arm
from armscope.robot.kinematics import centre_lines

ROBOTS = Path(__file__).parents[2] / "config" / "robots"


@pytest.fixture(scope="module")
def arm():
    return load_arm(ROBOTS / "six-axis.yaml")


@settings(max_examples=60)
@given(st.integers(0, 10_000), st.sampled_from([0.0, 1.0, 1e-7]))
def test_distances_of_segments_are_those_of_fine_samples(seed, flat):
    """Also for segments in one plane, and nearly parallel ones."""
    rng = np.random.default_rng(seed)
    a, b, c, d = rng.normal(size=(4, 3)) * np.array([1, 1, flat])
    along = np.linspace(0, 1, 201)[:, None]
    one, other = a + along * (b - a), c + along * (d - c)
    sampled = np.linalg.norm(one[:, None] - other[None], axis=2).min()
    exact = segment_distance(a[None], b[None], c[None], d[None])[0]
    assert exact <= sampled + 1e-9
    assert sampled - exact < 0.03


def test_a_parallel_pair_and_a_point():
    start, end = np.array([[0.0, 0, 0]]), np.array([[1.0, 0, 0]])
    assert segment_distance(start, end, start + np.array([0.2, 3, 0]), end + np.array([0.4, 3, 0]))[0] == pytest.approx(
        3
    )
    ahead = start + np.array([2.0, 0, 0])
    assert segment_distance(start, end, ahead, ahead)[0] == pytest.approx(1)


@pytest.mark.parametrize("name", ["six-axis", "seven-axis", "parallelogram-120kg", "sk120"])
def test_the_centre_line_runs_from_base_to_tool_without_gaps(name):
    arm = load_arm(ROBOTS / f"{name}.yaml")
    frames = chain(arm, np.random.default_rng(0).uniform(-1, 1, (3, arm.n_motors)))
    points = np.concatenate([line for _, line in centre_lines(arm, frames)], axis=1)
    assert points[:, 0] == pytest.approx(np.zeros((3, 3)))
    assert points[:, -1] == pytest.approx(frames.tool)
    lines = [line for _, line in centre_lines(arm, frames)]
    for before, after in pairwise(lines):
        assert before[:, -1] == pytest.approx(after[:, 0])


def test_an_upright_arm_is_possible_and_a_folded_one_hits_itself(arm):
    upright, folded = np.zeros(6), np.radians([0, 0, 80, 0, 100, 0])
    stretched = np.radians([0, 60, -60, 0, 0, 0])
    reasons = refusals(arm, np.array([upright, folded, stretched]), Surroundings(radius=0.15))
    assert reasons[0] == ""
    assert reasons[1] == "hits itself"
    assert reasons[2] == ""


def test_a_pose_is_judged_alike_alone_and_among_others(arm):
    angles = np.random.default_rng(1).uniform(arm.limits[:, 0], arm.limits[:, 1], (30, 6))
    around = Surroundings(radius=0.15, floor=0.0, tracker=np.array([4.0, 0, 1.5]))
    together = refusals(arm, angles, around)
    assert len(set(together)) > 2
    assert [refusals(arm, angle[None], around)[0] for angle in angles] == together.tolist()


def urdf_arm(folder, collision):
    """Three links of 1 m that fold in a plane, the axes about x in the file's frame."""
    links = "".join(
        f'<link name="l{n}"><collision><origin xyz="0 0 0.5"/><geometry>{collision}</geometry></collision></link>'
        for n in (1, 2, 3)
    )
    joints = "".join(
        f'<joint name="j{n}" type="revolute"><parent link="{parent}"/><child link="l{n}"/>'
        f'<origin xyz="0 0 {0 if n == 1 else 1}"/><axis xyz="1 0 0"/>'
        '<limit lower="-3.1" upper="3.1" effort="1" velocity="1"/></joint>'
        for n, parent in ((1, "base"), (2, "l1"), (3, "l2"))
    )
    tip = '<link name="tip"/><joint name="t" type="fixed"><parent link="l3"/><child link="tip"/>'
    content = f'<robot name="r"><link name="base"/>{links}{joints}{tip}<origin xyz="0 0 1"/></joint></robot>'
    (folder / "arm.urdf").write_text(f'<?xml version="1.0"?>{content}')
    (folder / "robot.yaml").write_text("name: r\nurdf: arm.urdf\ntip: tip\n")
    return load_arm(folder / "robot.yaml")


def test_collision_shapes_of_a_urdf_are_its_body(tmp_path):
    """Folded by two angles of 2.3 rad, the third link crosses the first; by 1.9 only thick ones touch."""
    angles = np.array([[0.3, 2.3, 2.3], [0.3, 0.5, 0.5], [0.3, 1.9, 1.9]])
    thin = urdf_arm(tmp_path, '<cylinder radius="0.05" length="1"/>')
    shapes = collision_shapes(thin.description)
    assert shapes[0].radius == pytest.approx(0.05)
    length = np.linalg.norm(shapes[0].end - shapes[0].start)
    assert length == pytest.approx(0.9)  # with its caps as long as the cylinder
    frames = chain(thin, angles)
    body = pieces(thin, frames, shapes, 0.01)
    for joint in range(3):  # each capsule lies half-way along its link
        beyond = frames.tool if joint == 2 else frames.joint_origin[:, joint + 1]
        middle = (frames.joint_origin[:, joint] + beyond) / 2
        np.testing.assert_allclose((body[joint].start + body[joint].end) / 2, middle, atol=1e-12)
    assert refusals(thin, angles, Surroundings()).tolist() == ["hits itself", "", ""]
    thick = urdf_arm(tmp_path, '<box size="0.8 0.8 1"/>')
    assert refusals(thick, angles, Surroundings())[2] == "hits itself"
    assert refusals(thick, angles, Surroundings(radius=0.01))[2] == ""  # a stated radius counts instead


def test_a_urdf_whose_meshes_are_missing_falls_back_to_lines(tmp_path):
    arm = urdf_arm(tmp_path, '<mesh filename="package://nowhere/link.stl"/>')
    assert collision_shapes(arm.description) == []
    assert refusals(arm, np.zeros((1, 3)), Surroundings())[0] == ""


def test_the_floor_stops_what_moves_below_it_and_not_the_base(arm):
    low = np.radians([[0, 90, 30, 0, 0, 0], [0, 0, 0, 0, 0, 0]])
    assert chain(arm, low).tool[0, 2] < 0.1
    assert refusals(arm, low, Surroundings(floor=0.0)).tolist() == ["hits the floor", ""]
    assert refusals(arm, low, Surroundings(floor=-5.0)).tolist() == ["", ""]


def test_the_tracker_does_not_see_through_the_arm(arm):
    """The tool is in front of the arm: seen from the front, hidden from behind, both in the arm's plane."""
    pose = np.zeros((1, 6))
    tool = chain(arm, pose).tool[0]
    front, behind = np.array([6.0, 0, tool[2]]), np.array([-6.0, 0, tool[2]])
    assert refusals(arm, pose, Surroundings(tracker=front))[0] == ""
    assert refusals(arm, pose, Surroundings(tracker=behind))[0] == "out of the tracker's sight"
    turned = np.array([[np.pi, 0, 0, 0, 0, 0]])
    assert refusals(arm, turned, Surroundings(tracker=behind))[0] == ""


ARMS = ("six-axis", "seven-axis", "parallelogram-120kg", "sk120", "ur5e", "irb120")


def drawn(name, count=60):
    arm = load_arm(name) if name in ("ur5e", "irb120") else load_arm(ROBOTS / f"{name}.yaml")
    low, high = ranges(arm)
    return arm, np.random.default_rng(3).uniform(low, high, (count, arm.n_motors))


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(ARMS), st.floats(1e-3, 0.5), st.floats(1.0, 3.0), st.sampled_from([None, 0.0, -0.2]))
def test_a_thicker_body_is_refused_wherever_a_thinner_one_is(name, radius, thicker, floor):
    arm, angles = drawn(name)
    thin = refusals(arm, angles, Surroundings(radius, floor)) != ""
    thick = refusals(arm, angles, Surroundings(min(radius * thicker, arm.reach), floor)) != ""
    assert not (thin & ~thick).any()


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(ARMS), st.floats(1e-4, 0.5))
def test_centre_lines_that_cross_are_refused_at_any_radius(name, radius):
    """Of links that share no joint: what separates them has a length."""
    arm, angles = drawn(name, 2000)
    lines = [line for _, line in centre_lines(arm, chain(arm, angles))]
    points = np.concatenate([lines[0], *(line[:, 1:] for line in lines[1:])], axis=1)
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=2).max(axis=0)
    pieces_of = [(points[:, k], points[:, k + 1]) for k in np.flatnonzero(lengths > 1e-6)]
    crosses = np.zeros(len(angles), bool)
    for k, one in enumerate(pieces_of):
        for other in pieces_of[k + 2 :]:
            crosses |= segment_distance(*one, *other) < 1e-4
    assert (refusals(arm, angles[crosses], Surroundings(radius)) != "").all()


def test_a_body_thicker_than_the_arm_reaches_is_no_radius():
    arm, angles = drawn("seven-axis", 3)
    with pytest.raises(InputError, match=r"--radius-mm: found '1e\+12'.*than the arm reaches"):
        refusals(arm, angles, Surroundings(1e9))


def test_an_elbow_that_folds_through_the_upper_arm_is_refused_and_the_pair_named():
    """The forearm stands off the elbow by 250 mm: capsules of 161 mm would touch there in every pose."""
    arm = load_arm(ROBOTS / "sk120.yaml")
    elbow = np.radians([[0, 0, each, 0, 60, 0] for each in (0, 90)])
    assert refusals(arm, elbow, Surroundings()).tolist() == ["", "hits itself"]
    said = [each for each in thinned(arm, Surroundings()) if each.startswith("link 2 and link 4")]
    assert said == ["link 2 and link 4 within 125 mm of their lines, in place of 322 mm"]
    assert thinned(arm, Surroundings(radius=0.01)) == ()


def test_the_measured_point_is_never_under_the_floor(tmp_path):
    """A tip beyond the last collision shape, without a tool: what spans to it is a part of the body."""
    arm = urdf_arm(tmp_path, '<cylinder radius="0.05" length="0.4"/>')
    around = Surroundings(floor=0.0)
    angles = np.random.default_rng(0).uniform(-3, 3, (300, 3))
    possible = angles[refusals(arm, angles, around) == ""]
    assert len(possible) > 5
    assert chain(arm, possible).tool[:, 2].min() >= around.radius_of(arm)


@pytest.mark.parametrize("name", ARMS)
def test_the_lowest_point_is_where_the_floor_begins_to_stop_a_pose(name):
    arm, angles = drawn(name, 30)
    free = angles[refusals(arm, angles, Surroundings()) == ""]
    low = lowest(arm, free, Surroundings())
    assert (low <= chain(arm, free).tool[:, 2]).all()
    for pose, height in zip(free, low, strict=True):
        reasons = [refusals(arm, pose[None], Surroundings(floor=height + step))[0] for step in (-1e-6, 1e-6)]
        assert reasons == ["", "hits the floor"]


ARM = load_arm(Path(__file__).parents[2] / "config" / "robots" / "sk120.yaml")


def test_pairs_that_have_less_room_than_their_radii_ask_for_are_told():
    (body, *less) = body_notes(ARM, Surroundings(radius=0.161))
    assert "161 mm" in body
    assert "links that share a joint are not checked" in body
    assert any("link 2 and link 4 within 125 mm" in note for note in less)
    assert len(body_notes(ARM, Surroundings(radius=0.01))) == 1


def test_what_was_not_looked_at_is_told():
    known = Surroundings(0.01, 0.0, np.array([4.0, 0, 1]))
    assert surroundings_notes(ARM, known) == body_notes(ARM, known)
    told = " ".join(surroundings_notes(ARM, Surroundings(0.01)))
    assert "no --tracker" in told
    assert "no --floor-mm" in told


def test_lines_are_told_from_shapes():
    assert "around the lines between their joints" in body_in_words(ARM, Surroundings())
