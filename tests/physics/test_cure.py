"""Every cure, applied as worded in the world in which its effect was planted, must take the error away.

The world is `armscope.world`'s: MuJoCo, built without a line of the physics whose cures are tried. An effect is
planted, fitted, cured by what its definition says, and the arm moves again under the cured commands.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.core.location import Location
from armscope.diagnosis.summary.parameters import parameters
from armscope.physics.drift import base_shift, tool_shift
from armscope.physics.effect import Part, Placed
from armscope.physics.loose_target import Way, nest
from armscope.physics.payload import payload_errors
from armscope.physics.registry import EFFECTS, library
from armscope.physics.scene import Scene
from armscope.physics.soft_start import soft_starts
from armscope.physics.transmission import mesh
from armscope.physics.zero_shift import zero_shift
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.robot.gravity import gravity_torques
from armscope.robot.kinematics import joint_jacobian
from armscope.world.effects_around import weight_along_tool
from armscope.world.imperfections import DRIVE
from armscope.world.kinds import Concealed
from armscope.world.spec import KINDS
from armscope.world.statics import Hidden, Session, balance
from armscope.world.strength import equilibrium, make_scene

from ..world.scenes import drawn, scene_of
from .scenes import arm_named

ROWS = 60
ERROR_M = 0.5e-3
LEFT = 0.01
"""The share of its error that a cured effect may leave: what is of second order in it."""

PLANTED = {
    "joint_offset": ("joint_offset", "joint 2"),
    "gear_ratio": ("gear_ratio", "joint 3"),
    "gear_eccentricity": ("gear_eccentricity", "joint 2"),
    "gear_mesh": ("gear_mesh", "joint 1"),
    "backlash": ("backlash", "joint 3"),
    "servo_lag": ("servo_lag", "joint 2"),
    "joint_coupling": ("joint_coupling", "joint 3 from joint 2"),
    "joint_compliance": ("joint_compliance", "joint 2"),
    "bearing_compliance": ("bearing_compliance", "joint 2"),
    "base_compliance": ("base_compliance", "base"),
    "link_bending": ("link_bending", "link 2"),
    "link_geometry": ("link_geometry", "link 2"),
    "axis_wobble": ("axis_wobble", "joint 2"),
    "thermal_expansion": ("thermal_expansion", "link 2"),
    "parallelogram_geometry": ("parallelogram_geometry", "parallelogram"),
    "base_drift": ("base_drift", "base"),
    "base_shift": ("base_shift", "base"),
    "zero_shift": ("zero_shift", "joint 2"),
    "instrument_scale": ("instrument_scale", "instrument"),
    "holder_sag": ("holder_sag", "tool"),
    "unknown": ("gear_ratio", "joint 3"),  # which a free curve of the joint's angle holds, too
}
"""By effect: the world's kind and its place. Payload and tool, which worlds hide otherwise, have tests of their own."""
GRAVITYS_SIDE = ("backlash", "backlash/load", "joint 2")
CASES = [*((name, *planted) for name, planted in PLANTED.items()), GRAVITYS_SIDE]


@dataclass(frozen=True)
class World:
    """An arm that conceals something, in a session of poses that it is wanted to reach."""

    arm: Arm
    session: Session
    concealed: tuple[Concealed, ...]
    wanted: np.ndarray
    name: str

    def readings(self, commanded: np.ndarray | None = None) -> np.ndarray:
        """Where the tool is measured under other commands."""
        session = self.session if commanded is None else replace(self.session, commanded=commanded)
        scene, _ = make_scene(scene_of(self.name, count=ROWS)[0].description, session)
        return equilibrium(scene, self.concealed).tool

    def table(self) -> Recordings:
        """The wanted poses, and what was measured there."""
        session, count = self.session, len(self.session)
        return Recordings(
            motor_angles=session.commanded,
            positions=self.readings(),
            run=np.full(count, "1"),
            target=np.full(count, ""),
            id=np.arange(1, count + 1).astype(str),
            time=session.time,
            temperature=session.temperature,
            payload=session.payload,
            approach=session.approach,
            speed=session.speed,
        )


def world_with(kind: str, place: str, *others: Concealed) -> World:
    """A world in which an effect moves the tool by half a millimetre."""
    name = "parallelogram-120kg" if kind == "parallelogram_geometry" else "six-axis"
    scene, wanted = scene_of(name, count=ROWS)
    effect = drawn(scene, kind, place)
    for _ in range(2):
        effect = effect.scaled(ERROR_M / rms(equilibrium(scene, [effect]).tool - wanted))
    return World(arm_named(name), scene.session, (effect, *others), wanted, name)


def test_a_drive_that_hardens_is_commanded_away_by_the_rule_on_its_card() -> None:
    """The world's drive has a bend where the rule has a smooth curve: what lies between them may be left."""
    scene, wanted = scene_of("six-axis", count=ROWS)
    effect = Concealed(DRIVE, "joint 3", {"compliance": 1e-12, "soft": 1e-3, "knee": 0.15})
    world = World(arm_named("six-axis"), scene.session, (effect,), wanted, "six-axis")
    table = world.table()
    (placed,) = [p for p in soft_starts(world.arm, table) if p.location == "joint 3"]
    part = fitted(world, table, [placed])
    (turn,) = part.values
    load = gravity_torques(world.arm, chain(world.arm, world.session.commanded), table.payload)[:, 2]
    formula = r"commanded = wanted - soft_turn x tanh\(10 x load / (\S+) N m\)"
    (largest,) = map(float, re.findall(formula, placed.effect.cure.words))  # all that the rule needs is printed
    assert abs(largest - np.abs(load).max()) < 1e-3 * largest
    commanded = world.session.commanded.copy()
    commanded[:, 2] -= turn * np.tanh(10 * load / np.abs(load).max())
    before, after = (rms(readings - wanted) for readings in (world.readings(), world.readings(commanded)))
    assert after < 0.15 * before
    wrong = 2 * world.session.commanded - commanded
    assert rms(world.readings(wrong) - wanted) > 1.8 * before
    np.testing.assert_allclose(placed.effect.cure.commanded(Scene(world.arm, table), part), commanded, atol=1e-9)


@pytest.mark.parametrize("way", ["along", "across"])
def test_a_loose_target_is_brought_where_it_was_meant_to_go_but_near_the_slope_from_which_it_slides(way: Way) -> None:
    """The world's target falls at once where the rule's slides over: near that slope, what lies between is left."""
    world = world_with(f"loose_target/{way}", "tool")
    table, values = world.table(), world.concealed[0].values
    direction = np.array([values[f"nest_{axis}"] for axis in "xyz"])
    part = fitted(world, table, [nest(way, direction)])
    after = world.readings(by_inverse_kinematics(Scene(world.arm, table), [part], world.wanted))
    pull = weight_along_tool(make_scene(scene_of(world.name, count=ROWS)[0].description, world.session)[0])
    along = np.abs(pull @ direction)
    steep = (along if way == "along" else np.sqrt(np.maximum(1 - along**2, 0))) > 3 * values["least_slope"]
    assert steep.mean() > 0.4
    assert rms((after - world.wanted)[steep]) < 0.1 * rms((table.positions - world.wanted)[steep])


def candidates(effect: str, place: str, world: World, table: Recordings) -> list[Placed]:
    """The library's forms of an effect at a place; those that are scanned for, at the numbers that were planted."""
    values = world.concealed[0].values
    if effect == "gear_mesh":
        return [mesh(Location.of(place).number, round(values["per_turn"]))]
    if effect == "base_shift":
        return [base_shift(table, int(np.argmax(world.session.time >= values["time"])), 1)]
    if effect == "zero_shift":
        row = int(np.argmax(world.session.time >= values["time"]))
        return [zero_shift(table, row, 1, Location.of(place).number)]
    forms = [p for p in library(world.arm, table) if p.key == (effect, place) and not p.refinement]
    return [p for p in forms if p.variant == "angle"] if effect == "unknown" else forms


def fitted(world: World, table: Recordings, forms: Sequence[Placed]) -> Part:
    """The form that explains the readings best, fitted to them by Gauss-Newton on the exact model."""
    scene, found = Scene(world.arm, table), []
    for placed in forms:
        part = Part(placed, np.zeros(len(placed.terms)))
        for _ in range(4):
            posture = scene.posture([part])
            X = np.stack([posture.column(term).ravel() for term in placed.terms], axis=1)
            step = np.linalg.lstsq(X, (table.positions - posture.tool).ravel(), rcond=1e-10)[0]
            part = Part(placed, part.values + step)
        found.append((rms(table.positions - scene.posture([part]).tool), part))
    return min(found, key=lambda pair: pair[0])[1]


def by_inverse_kinematics(scene: Scene, parts: Sequence[Part], wanted: np.ndarray) -> np.ndarray:
    """(N, m) commands for which the corrected model stands at the wanted points: Newton's method, smallest steps."""
    angles = scene.recordings.motor_angles
    for _ in range(5):
        posture = Scene(scene.arm, replace(scene.recordings, motor_angles=angles)).posture(parts)
        J = joint_jacobian(posture.frames) @ scene.arm.actuation
        angles = angles + np.einsum("nmk,nk->nm", np.linalg.pinv(J, rcond=1e-3), wanted - posture.tool)
    return angles


@pytest.mark.parametrize(("effect", "kind", "place"), CASES)
def test_a_cure_takes_the_error_away_in_the_world_that_conceals_the_effect(effect: str, kind: str, place: str) -> None:
    world = world_with(kind, place)
    table = world.table()
    part = fitted(world, table, candidates(effect, place, world, table))
    scene, cure = Scene(world.arm, table), part.placed.effect.cure
    before = rms(table.positions - world.wanted)
    if cure.readings is not None:
        after = cure.readings(table.positions, part)
    elif cure.commanded is not None:
        commanded = cure.commanded(scene, part)
        after = world.readings(commanded)
        opposite = world.readings(2 * table.motor_angles - commanded)
        assert rms(opposite - world.wanted) > 1.9 * before, "the other sign doubles the error"
    else:
        assert "inverse kinematics" in cure.words
        after = world.readings(by_inverse_kinematics(scene, [part], world.wanted))
    assert before > 0.9 * ERROR_M
    assert rms(after - world.wanted) < LEFT * before


@pytest.mark.parametrize(("effect", "kind", "place"), [case for case in CASES if case[0] != "unknown"])
def test_a_command_is_what_the_cures_own_formula_says(effect: str, kind: str, place: str) -> None:
    """The formula in the words, read as it stands and calculated, gives the angles that the cure commands."""
    world = world_with(kind, place)
    table = world.table()
    part = fitted(world, table, candidates(effect, place, world, table))
    cure = part.placed.effect.cure
    formulas = re.findall(r"commanded = (.+?)(?=[.,;:]|\s\(|$)", cure.words)
    assert bool(formulas) == (cure.commanded is not None)
    if cure.commanded is None:
        return
    at = Location.of(place)
    scene = Scene(world.arm, table)
    load = scene.torques[:, at.index]
    names = {p.name: p.value for p in parameters(part.placed, part.values, np.eye(len(part.values)))} | {
        "wanted": table.motor_angles[:, at.index],
        "other": table.motor_angles[:, max(at.source - 1, 0)],
        "load": load,
        "side": np.sign(load),
        "approach": table.approach[:, at.index],
        "speed": table.speed[:, at.index],
        "cos": np.cos,
        "after": table.time > world.concealed[0].values.get("time", np.inf),
    }
    formula = formulas[-1] if part.placed.variant == "load" else formulas[0]
    said = eval(formula.replace(" x ", " * "), {"__builtins__": {}}, names)
    np.testing.assert_allclose(cure.commanded(scene, part)[:, at.index], said, atol=1e-12)


@pytest.mark.parametrize("kind", ["payload_error", "payload_error/centre"])
def test_a_payload_stated_rightly_is_commanded_away_with_the_right_load(kind: str) -> None:
    scene, _ = scene_of("six-axis", count=ROWS)
    springs = [Concealed(KINDS["joint_compliance"], f"joint {j}", {"compliance": 2e-6}) for j in (2, 3)]
    world = World(arm_named("six-axis"), scene.session, (drawn(scene, kind, "payload"), *springs), scene_of(
        "six-axis", count=ROWS)[1], "six-axis")  # fmt: skip
    table = world.table()
    stated = Scene(world.arm, table)
    give = [
        Part(p, np.array([2e-6]))
        for p in library(world.arm, table)
        if p.name == "joint_compliance" and not p.variant and Location.of(p.location).number in (2, 3)
    ]
    posture = stated.posture(give)
    variant = "centre" if kind.endswith("centre") else "mass"
    placed = next(p for p in payload_errors(table, give) if p.variant == variant)
    X = np.stack([posture.column(term).ravel() for term in placed.terms], axis=1)
    part = Part(placed, np.linalg.lstsq(X, (table.positions - posture.tool).ravel(), rcond=None)[0])

    def missed(load: Scene) -> float:
        angles = table.motor_angles
        for each in give:
            angles = angles + each.placed.effect.cure.commanded(load, each) - table.motor_angles
        return rms(world.readings(angles) - world.wanted)

    assert part.placed.effect.cure.statement is not None
    assert missed(stated.loaded_as(part.placed.effect.cure.statement(part))) < LEFT * missed(stated)


def test_a_tool_that_moved_is_cured_by_the_moved_tool_point() -> None:
    scene, wanted = scene_of("six-axis", count=ROWS)
    world = World(arm_named("six-axis"), scene.session, (), wanted, "six-axis")
    jump = np.array([0.4e-3, -0.3e-3, 0.5e-3])

    def readings(commanded: np.ndarray) -> np.ndarray:
        session = replace(world.session, commanded=commanded)
        hidden = Hidden.nothing(scene.geometry, session)
        hidden.layout = replace(hidden.layout, tool_error=jump)
        moved = balance(scene.geometry, session, hidden).tool
        late = np.arange(ROWS) >= ROWS // 2
        return np.where(late[:, None], moved, world.readings(commanded))

    table = replace(world.table(), positions=readings(world.session.commanded))
    part = fitted(world, table, [tool_shift(table, ROWS // 2, 1)])
    np.testing.assert_allclose(part.values, jump, rtol=1e-6, atol=1e-9)
    cured = readings(by_inverse_kinematics(Scene(world.arm, table), [part], wanted))
    assert rms(cured - wanted) < LEFT * rms(table.positions - wanted)


def test_every_effect_has_a_cure_that_was_tried() -> None:
    elsewhere = {
        "compliance_change",
        "payload_change",
        "thermal_bow",
        "thermal_zero",
    }  # tests of what they are named after
    assert {effect.name for effect in EFFECTS} == {*PLANTED, *elsewhere, "loose_target", "payload_error", "tool_shift"}
