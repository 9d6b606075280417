"""Every effect of the vocabulary moves the tool as a hand calculation says."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.world.effects import LIBRARY, linear_numbers
from armscope.world.effects_around import BASE
from armscope.world.effects_of_joints import SOFT_SIDE
from armscope.world.effects_of_links import close_loop
from armscope.world.statics import Hidden
from armscope.world.strength import equilibrium
from tests.world.by_hand import ARMS, HandArm, cantilever, spread, turn
from tests.world.scenes import drawn, scene_of

EXACT_M = 1e-10
FIRST_ORDER = 0.01
"""Share of the largest displacement that a first-order formula may miss."""


def moved(scene, *effects):
    return equilibrium(scene, effects).tool - equilibrium(scene, []).tool


def turned_by_hand(name, scene, motor_errors):
    """Displacement when the motors stand elsewhere, exactly."""
    arm = HandArm.named(name)
    commanded = scene.session.commanded
    return np.array([arm.point(q + e) - arm.point(q) for q, e in zip(commanded, motor_errors, strict=True)])


def on_motor(scene, motor, amount):
    errors = np.zeros_like(scene.session.commanded)
    errors[:, motor] = amount
    return errors


def wave(values, angle):
    return values["amplitude"] * np.cos(values["per_turn"] * angle - values["phase"])


MOTOR_ERRORS = {
    "joint_offset": lambda v, s, j: v["offset"],
    "gear_ratio": lambda v, s, j: v["ratio"] * s.commanded[:, j],
    "gear_eccentricity": lambda v, s, j: wave(v, s.commanded[:, j]),
    "gear_mesh": lambda v, s, j: wave(v, s.commanded[:, j]),
    "backlash": lambda v, s, j: -s.approach[:, j] * v["gap"] / 2,
    "zero_shift": lambda v, s, j: v["jump"] * (s.time > v["time"]),
    "servo_lag": lambda v, s, j: -s.speed[:, j] * v["delay"],
    "joint_coupling": lambda v, s, j: v["coupling"] * s.commanded[:, j - 1],
}
BASE_TWISTS = {
    "base_drift": lambda v, s: s.time,
    "base_shift": lambda v, s: (s.time > v["time"]).astype(float),
}
CHECKED_BELOW = {
    "backlash/load", "joint_compliance", "bearing_compliance", "base_compliance", "axis_wobble", "link_geometry",
    "link_bending", "thermal_expansion", "parallelogram_geometry", "instrument_scale", "payload_error",
    "payload_error/centre", "compliance_change", "compliance_change/temperature",
    "holder_sag", "loose_target/along", "loose_target/across",
}  # fmt: skip


def test_no_effect_of_the_library_goes_unchecked():
    assert set(MOTOR_ERRORS) | set(BASE_TWISTS) | CHECKED_BELOW == {kind.name for kind in LIBRARY}
    assert set(BASE_TWISTS) < {kind.name for kind in BASE}


def test_a_closed_loop_has_bars_of_their_lengths_and_bars_too_short_do_not_close():
    crank_angle = np.linspace(0.5, 2.5, 9)
    angle = close_loop(crank_angle, 0.4, 1.02, 0.41, 1.0)
    rod = 1.0 + 0.41 * np.exp(1j * angle) - 0.4 * np.exp(1j * crank_angle)
    np.testing.assert_allclose(np.abs(rod), 1.02, rtol=1e-12)
    with pytest.raises(RuntimeError, match="joined"):
        close_loop(crank_angle, 0.4, 0.1, 0.41, 1.0)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("kind", MOTOR_ERRORS)
def test_an_error_of_a_motor_angle_turns_the_motor_by_the_contracts_formula(kind, name):
    scene, _ = scene_of(name)
    effect = drawn(scene, kind, "joint 3 from joint 2" if kind == "joint_coupling" else "joint 3")
    by_hand = turned_by_hand(name, scene, on_motor(scene, 2, MOTOR_ERRORS[kind](effect.values, scene.session, 2)))
    assert np.abs(by_hand).max() > 1e-5
    assert np.abs(moved(scene, effect) - by_hand).max() < EXACT_M


@pytest.mark.parametrize("kind", BASE_TWISTS)
def test_a_moving_base_moves_the_whole_arm_by_its_twist(kind):
    scene, tool = scene_of("six-axis")
    effect = drawn(scene, kind, "base")
    v = effect.values
    twist = np.array([v[name] for name in ("x", "y", "z", "rx", "ry", "rz")])
    by_hand = (twist[:3] + np.cross(twist[3:], tool)) * BASE_TWISTS[kind](v, scene.session)[:, None]
    assert np.abs(moved(scene, effect) - by_hand).max() < FIRST_ORDER * np.abs(by_hand).max()


@pytest.mark.parametrize("name", [ARMS[0], *(pytest.param(name, marks=pytest.mark.long) for name in ARMS[1:])])
def test_a_compliant_joint_turns_its_motor_by_compliance_times_gravitys_torque(name):
    scene, _ = scene_of(name)
    arm = HandArm.named(name)
    for j in (1, 2):
        effect = drawn(scene, "joint_compliance", f"joint {j + 1}").scaled(0.2)
        compliance, errors = effect.values["compliance"], []
        for q, payload in zip(scene.session.commanded, scene.session.payload, strict=True):
            error = np.zeros(len(q))
            for _ in range(30):
                error[j] = compliance * arm.torques(q + error, payload)[j]
            errors.append(error)
        assert np.abs(moved(scene, effect) - turned_by_hand(name, scene, errors)).max() < EXACT_M


@pytest.mark.parametrize("name", ARMS)
def test_a_gap_closes_on_the_side_that_gravity_loads(name):
    scene, _ = scene_of(name)
    effect = drawn(scene, "backlash/load", "joint 3")
    arm = HandArm.named(name)
    torque = np.array(
        [arm.torques(q, m)[2] for q, m in zip(scene.session.commanded, scene.session.payload, strict=True)]
    )
    by_hand = turned_by_hand(name, scene, on_motor(scene, 2, np.sign(torque) * effect.values["gap"] / 2))
    clear = np.abs(torque) > 2 * max(SOFT_SIDE, effect.values["gap"]) * scene.largest_torque(2)
    assert clear.sum() > 8
    assert np.abs(moved(scene, effect) - by_hand)[clear].max() < EXACT_M


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize(
    ("kind", "joint"), [("bearing_compliance", 2), ("bearing_compliance", 3), ("base_compliance", None)]
)
def test_a_soft_bearing_tilts_across_its_axis_under_the_moment_there(kind, joint, name):
    scene, tool = scene_of(name)
    arm = HandArm.named(name)
    effect = drawn(scene, kind, "base" if joint is None else f"joint {joint}").scaled(0.2)
    by_hand = []
    for q, payload, point in zip(scene.session.commanded, scene.session.payload, tool, strict=True):
        frame = np.eye(4) if joint is None else arm.frames(arm.actuation @ q)[0][joint - 1]
        origin, axis = frame[:3, 3], frame[:3, 2]
        moment = arm.moment(q, payload, origin, 0 if joint is None else joint - 1)
        across = moment - (moment @ axis) * axis
        by_hand.append(np.cross(effect.values["compliance"] * across, point - origin))
    assert np.abs(moved(scene, effect) - by_hand).max() < FIRST_ORDER * np.abs(by_hand).max()


@pytest.mark.parametrize("name", ARMS)
def test_a_wobbling_axis_tilts_about_its_dh_origin_in_the_frame_that_carries_it(name):
    scene, tool = scene_of(name)
    arm = HandArm.named(name)
    effect = drawn(scene, "axis_wobble", "joint 3")
    v, by_hand = effect.values, []
    for q, point in zip(scene.session.commanded, tool, strict=True):
        chain = arm.actuation @ q
        frame = arm.frames(chain)[0][2]
        tilt = wave(v, chain[2]) * (frame[:3, :3] @ [np.cos(v["direction"]), np.sin(v["direction"]), 0])
        by_hand.append(np.cross(tilt, point - frame[:3, 3]))
    assert np.abs(moved(scene, effect) - by_hand).max() < FIRST_ORDER * np.abs(by_hand).max()


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("kind", ["link_geometry", "thermal_expansion"])
def test_lengths_and_twists_of_a_link_change_its_dh_row(kind, name):
    scene, tool = scene_of(name)
    arm = HandArm.named(name)
    place = {"parallelogram-120kg": 2, "six-axis": 4, "seven-axis": 3}[name]
    effect = drawn(scene, kind, f"link {place}")
    v, by_hand = effect.values, []
    for q, warm, point in zip(scene.session.commanded, scene.session.temperature - 20, tool, strict=True):
        rows = arm.rows.copy()
        if kind == "link_geometry":
            rows[place - 1, :3] += [v["a"], v["alpha"], v["d"]]
        else:
            rows[place - 1, [0, 2]] *= 1 + v["coefficient"] * warm
        by_hand.append(skewed(arm, q, rows, place, v.get("beta", 0.0)) - point)
    assert ("beta" in v) == (kind == "link_geometry" and name == "parallelogram-120kg"), "of parallel axes alone"
    assert np.abs(moved(scene, effect) - by_hand).max() < EXACT_M


def skewed(arm, q, rows, place, beta):
    """The tool point where all behind D-H row ``place`` is turned by ``beta`` about y of its frame."""
    behind = arm.frames(arm.actuation @ q, rows)[1][place - 1]
    return (behind @ turn("y", beta) @ np.linalg.inv(behind) @ np.append(arm.point(q, rows), 1))[:3]


@pytest.mark.parametrize(
    ("name", "place"), [("parallelogram-120kg", 2), ("six-axis", 4), ("seven-axis", 3), ("seven-axis", 5)]
)
def test_a_bending_link_is_euler_bernoullis_cantilever_under_all_that_it_carries_and_itself(name, place):
    scene, tool = scene_of(name)
    arm = HandArm.named(name)
    effect = drawn(scene, "link_bending", f"link {place}").scaled(0.2)
    body = place - 2 if arm.modified else place - 1
    by_hand = []
    for q, payload, point in zip(scene.session.commanded, scene.session.payload, tool, strict=True):
        carrying, behind = arm.frames(arm.actuation @ q)
        start, end = (
            (behind[place - 2], carrying[place - 1]) if arm.modified else (carrying[place - 1], behind[place - 1])
        )
        start, end = start[:3, 3], end[:3, 3]
        loads = [(end, arm.loads(q, payload, body + 1))]
        loads += [(foot, [load]) for foot, load in spread(*arm.loads(q, payload, body)[0], start, end)]
        angle, shift = cantilever(loads, start, end)
        f = effect.values["flexibility"]
        by_hand.append(f * (shift + np.cross(angle, point - end)))
    assert np.abs(moved(scene, effect) - by_hand).max() < FIRST_ORDER * np.abs(by_hand).max()


def test_a_parallelogram_with_wrong_bars_still_closes():
    """Elbow, rocker pin, crank pin: rebuilt from where the forearm went, the rod has its new length."""
    scene, _ = scene_of("parallelogram-120kg")
    effect = drawn(scene, "parallelogram_geometry", "parallelogram")
    arm = HandArm.named("parallelogram-120kg")
    hidden = Hidden.nothing(scene.geometry, scene.session)
    effect.hide(hidden, scene)
    crank = (scene.session.commanded @ arm.actuation.T)[:, 2] + np.pi / 2
    rocker = crank + hidden.chain[:, 2]
    length = 0.4 + effect.values["rocker"]
    crank_pin = 0.4 * np.stack([np.cos(crank), np.sin(crank)])
    rocker_pin = np.array([[1.15], [0.0]]) + length * np.stack([np.cos(rocker), np.sin(rocker)])
    assert np.linalg.norm(rocker_pin - crank_pin, axis=0) == pytest.approx(1.15 + effect.values["rod"], abs=1e-12)
    assert np.abs(hidden.chain[:, 2]).max() < 5e-3
    only_forearm = np.zeros((len(crank), 6))
    only_forearm[:, 2] = hidden.chain[:, 2]
    by_hand = turned_by_hand("parallelogram-120kg", scene, only_forearm)
    assert np.abs(moved(scene, effect) - by_hand).max() < EXACT_M


def test_an_instruments_scale_stretches_everything_about_the_origin():
    scene, tool = scene_of("seven-axis")
    effect = drawn(scene, "instrument_scale", "instrument")
    assert moved(scene, effect) == pytest.approx(effect.values["scale"] * tool, abs=1e-15)


def test_what_is_loose_on_the_tool_moves_in_the_last_frame_by_how_that_stands_to_gravity():
    scene, _ = scene_of("six-axis")
    arm = HandArm.named("six-axis")
    turns = np.array([arm.frames(arm.actuation @ q)[1][-1][:3, :3] for q in scene.session.commanded])
    weight = turns.transpose(0, 2, 1) @ np.array([0.0, 0.0, -1.0])
    sag = drawn(scene, "holder_sag", "tool")
    x, y, xy, xz, yz = (sag.values[f"sag_{name}"] for name in ("x", "y", "xy", "xz", "yz"))
    by_hand = np.einsum("nij,nj->ni", turns, weight @ np.array([[x, xy, xz], [xy, y, yz], [xz, yz, 0.0]]))
    np.testing.assert_allclose(moved(scene, sag), by_hand, atol=EXACT_M)
    for way in ("along", "across"):
        nest = drawn(scene, f"loose_target/{way}", "tool")
        play, *direction, least = nest.values.values()
        onto = np.outer(direction, direction)
        pulled = weight @ (onto if way == "along" else np.eye(3) - onto)
        steep = np.linalg.norm(pulled, axis=1)
        shift = play * np.where(steep > least, 1 / steep, 0)[:, None] * pulled
        by_hand = np.einsum("nij,nj->ni", turns, shift)
        np.testing.assert_allclose(moved(scene, nest), by_hand, atol=EXACT_M)


def test_a_heavier_payload_bends_a_soft_joint_further_and_a_stiff_arm_not_at_all():
    scene, _ = scene_of("six-axis")
    arm = HandArm.named("six-axis")
    soft, heavier = drawn(scene, "joint_compliance", "joint 2").scaled(0.05), drawn(scene, "payload_error", "payload")
    errors = []
    for q, payload in zip(scene.session.commanded, scene.session.payload, strict=True):
        extra = arm.torques(q, payload + heavier.values["mass"])[1] - arm.torques(q, payload)[1]
        errors.append(np.eye(6)[1] * soft.values["compliance"] * extra)
    by_hand = turned_by_hand("six-axis", scene, errors)
    difference = equilibrium(scene, [soft, heavier]).tool - equilibrium(scene, [soft]).tool
    assert np.abs(difference - by_hand).max() < FIRST_ORDER * np.abs(by_hand).max()
    assert np.abs(moved(scene, heavier)).max() == 0


def test_a_payloads_centre_off_the_tool_point_adds_its_lever():
    scene, _ = scene_of("seven-axis")
    arm = HandArm.named("seven-axis")
    soft, off = (
        drawn(scene, "joint_compliance", "joint 6").scaled(0.02),
        drawn(scene, "payload_error/centre", "payload"),
    )
    centre = np.array([off.values[f"com_{axis}"] for axis in "xyz"])
    errors = []
    for q, payload in zip(scene.session.commanded, scene.session.payload, strict=True):
        carrying, behind = arm.frames(arm.actuation @ q)
        extra = np.cross(behind[-1][:3, :3] @ centre, payload * arm.gravity) @ carrying[5][:3, 2]
        errors.append(np.eye(7)[5] * soft.values["compliance"] * extra)
    by_hand = turned_by_hand("seven-axis", scene, errors)
    difference = equilibrium(scene, [soft, off]).tool - equilibrium(scene, [soft]).tool
    assert np.abs(difference - by_hand).max() < FIRST_ORDER * np.abs(by_hand).max()


@pytest.mark.parametrize("kind", ["gear_eccentricity", "gear_mesh"])
def test_cosine_and_sine_parts_say_the_same_as_amplitude_and_phase(kind):
    scene, _ = scene_of("six-axis")
    effect = drawn(scene, kind, "joint 1")
    (c_name, cosine), (s_name, sine) = linear_numbers(effect).items()
    order = int(effect.values["per_turn"])
    assert (c_name, s_name) == (f"cosine_{order}", f"sine_{order}")
    q = np.linspace(-3, 3, 50)
    assert cosine * np.cos(order * q) + sine * np.sin(order * q) == pytest.approx(wave(effect.values, q), abs=1e-15)
