"""MuJoCo's mechanisms stand where hand calculations say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry
from armscope.world.statics import Hidden, Session, balance
from armscope.world.strength import equilibrium, make_scene
from tests.world.by_hand import ARMS, HandArm
from tests.world.scenes import drawn, scene_of


def one_joint(
    alpha_deg: float, tool_mm: tuple[float, float, float] = (0, 0, 0), gravity: tuple = (0, 0, -9.81)
) -> RobotDescription:
    """A link of one metre on one joint, without mass."""
    return RobotDescription.model_validate(
        {
            "name": "rod",
            "dh": {"joints": [{"a_mm": 1000, "alpha_deg": alpha_deg, "d_mm": 0}]},
            "tool_mm": tool_mm,
            "gravity_m_s2": gravity,
        }
    )


def still(angle: float, payload: float) -> Session:
    one = np.ones((1, 1))
    return Session(angle * one, np.array([payload]), np.zeros(1), np.full(1, 20.0), np.ones(1, int), one, 0 * one)


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_that_conceals_nothing_stands_where_the_product_of_dh_matrices_says(name):
    scene, tool = scene_of(name)
    by_hand = [HandArm.named(name).point(q) for q in scene.session.commanded]
    assert np.abs(tool - by_hand).max() < 1e-12
    assert np.abs(equilibrium(scene, []).tool - by_hand).max() < 1e-12


rows = st.lists(
    st.tuples(*(st.floats(-1500, 1500), st.floats(-180, 180), st.floats(-1500, 1500), st.floats(-180, 180))),
    min_size=1,
    max_size=7,
)


@given(rows=rows, convention=st.sampled_from(["standard", "modified"]), seed=st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=40)
def test_any_dh_table_becomes_the_mechanism_that_its_matrices_describe(rows, convention, seed):
    keys = ("a_mm", "alpha_deg", "d_mm", "theta_offset_deg")
    content = {
        "name": "any arm",
        "dh": {"convention": convention, "joints": [dict(zip(keys, row, strict=True)) for row in rows]},
        "tool_mm": [10, -20, 30],
        "links": [{"mass_kg": 1, "com_mm": [0, 0, 0]}] * len(rows),
        "gravity_m_s2": [0, 0, -9.81],
    }
    q = np.random.default_rng(seed).uniform(-3, 3, len(rows))
    one = np.ones((1, len(rows)))
    session = Session(q[None], np.zeros(1), np.zeros(1), np.full(1, 20.0), np.ones(1, int), one, one)
    scene, tool = make_scene(RobotDescription.model_validate(content), session)
    arm = HandArm(content)
    assert tool[0] == pytest.approx(arm.point(q), abs=1e-10)
    assert scene.torque[0] == pytest.approx(arm.torques(q, 0.0), abs=1e-8)


@pytest.mark.parametrize("name", ARMS)
def test_motor_torques_are_those_of_virtual_work_on_every_mass(name):
    scene, _ = scene_of(name)
    arm = HandArm.named(name)
    by_hand = [arm.torques(q, m) for q, m in zip(scene.session.commanded, scene.session.payload, strict=True)]
    assert np.allclose(scene.torque, by_hand, rtol=1e-9, atol=1e-7)


def test_a_spring_settles_where_its_torque_equals_the_weight_of_the_turned_link():
    """A rod that turns in a vertical plane, far from its unloaded angle: c m g l cos(q + delta) + delta = 0."""
    description = one_joint(0, gravity=(0, -9.81, 0))
    geometry, session = Geometry(description), still(0.4, 30.0)
    hidden = Hidden.nothing(geometry, session)
    hidden.motor_spring(0, 5e-4)
    delta = brentq(lambda d: d + 5e-4 * 30 * 9.81 * np.cos(0.4 + d), -1, 1, xtol=1e-15)
    found = balance(geometry, session, hidden)
    assert delta < -0.1
    assert found.tool[0, :2] == pytest.approx([np.cos(0.4 + delta), np.sin(0.4 + delta)], abs=1e-11)
    assert found.residual < 1e-9


def test_a_spring_too_weak_for_its_load_is_an_error():
    description = one_joint(0, gravity=(0, -9.81, 0))
    geometry, session = Geometry(description), still(0.4, 30.0)
    hidden = Hidden.nothing(geometry, session)
    hidden.motor_spring(0, 1.0)
    with pytest.raises(RuntimeError, match="no equilibrium"):
        balance(geometry, session, hidden)


def test_a_segmented_link_bends_like_a_cantilever():
    """Tip under an end load F: F L^3 / 3 E I down, F L^2 / 2 E I turned; half a metre beyond the tip shows the turn."""
    flexibility, force = 1e-5, 20 * 9.81
    for tool, lever in (((0, 0, 0), 0.0), ((500, 0, 0), 0.5)):
        geometry = Geometry(one_joint(0, tool))
        session = still(0.7, 20.0)
        hidden = Hidden.nothing(geometry, session)
        hidden.bend(0, flexibility)
        # the load hangs at the tool point: a force and, with a lever, a moment at the link's end
        moment = force * lever
        drop = flexibility * (force / 3 + moment / 2) + lever * flexibility * (force / 2 + moment)
        assert -balance(geometry, session, hidden).tool[0, 2] == pytest.approx(drop, rel=6e-3)


@pytest.mark.parametrize("name", ARMS)
def test_nothing_is_left_over_on_any_spring_in_equilibrium(name):
    scene, _ = scene_of(name)
    effects = [drawn(scene, "joint_compliance", f"joint {j}") for j in (2, 3, 4, 5)]
    effects += [drawn(scene, "bearing_compliance", f"joint {j}") for j in (1, 2, 3)]
    effects += [drawn(scene, "base_compliance", "base"), drawn(scene, "link_bending", "link 3")]
    assert equilibrium(scene, effects).residual < 1e-7


@pytest.mark.parametrize("name", ARMS)
def test_two_springs_at_one_place_add_their_compliances(name):
    scene, _ = scene_of(name)
    one = drawn(scene, "joint_compliance", "joint 2")
    tilt = drawn(scene, "bearing_compliance", "joint 3")
    twice = equilibrium(scene, [one, one, tilt, tilt]).tool
    double = equilibrium(scene, [one.scaled(2), tilt.scaled(2)]).tool
    assert np.abs(twice - double).max() < 1e-12


def test_rows_with_different_payloads_do_not_disturb_each_other():
    scene, _ = scene_of("six-axis")
    effect = drawn(scene, "joint_compliance", "joint 2")
    together = equilibrium(scene, [effect]).tool
    for row in range(4):
        assert equilibrium(scene.rows(np.array([row])), [effect]).tool[0] == pytest.approx(together[row], abs=1e-13)


def test_a_payload_off_the_tool_point_turns_the_wrist():
    scene, _ = scene_of("seven-axis")
    hidden = Hidden.nothing(scene.geometry, scene.session)
    hidden.motor_spring(6, 1e-3)
    at_tool = balance(scene.geometry, scene.session, hidden).motor_torque[:, 6]
    hidden.layout = replace(hidden.layout, payload_offset=np.array([0.1, 0.0, 0.0]))
    off_tool = balance(scene.geometry, scene.session, hidden).motor_torque[:, 6]
    loaded = scene.session.payload > 0
    assert np.all(np.abs(off_tool - at_tool)[loaded] > 1e-3)
    assert np.abs(off_tool - at_tool)[~loaded] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    ("moving", "giving", "place"),
    [("base_drift", "base_compliance", "base"), ("axis_wobble", "bearing_compliance", "joint 2")],
)
def test_what_moves_and_gives_way_at_one_place_does_both(moving, giving, place):
    scene, nominal = scene_of("six-axis")
    both = [drawn(scene, moving, place), drawn(scene, giving, place)]
    alone = [equilibrium(scene, [effect]).tool - nominal for effect in both]
    together = equilibrium(scene, both).tool - nominal
    size = min(np.abs(part).max() for part in alone)
    assert np.abs(together - sum(alone)).max() < 0.02 * size
