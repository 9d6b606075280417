"""Which other effects could stand in place of a concealed one: decided before anybody diagnoses anything.

Every effect of the vocabulary is, to first order, a few displacement patterns of the tool: MuJoCo's site Jacobian of a
slide or hinge times what drives it. An alternative is a place and an effect whose patterns, together with free frames
and the other concealed effects, reproduce the concealed displacement up to what the noise hides.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.world.effects_around import SAGS, weight_along_tool
from armscope.world.effects_of_links import REFERENCE_C, close_loop, skewing_tilt
from armscope.world.kinds import Scene, joints, links_longer_than
from armscope.world.layout import BASE_FREEDOMS, SEGMENTS, TARGET_FREEDOMS, Layout, all_freedoms, segment_hinges
from armscope.world.mechanism import Mechanism

MOMENTS = tuple(np.linspace(0.1, 0.9, 17).tolist())  # Shares of the rows after which a rival jumps


@dataclass(frozen=True, eq=False)
class Rival:
    """An effect at a place with its patterns (3 N, k) per unit of its k linear numbers."""

    effect: str
    location: str
    columns: Array


class Patterns:
    """Jacobians and gravity loads of every freedom an arm could have, at the rows of a scene (nominal arm)."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        geometry, session = scene.geometry, scene.session
        self.bending = [Location.of(place).index for place in links_longer_than(0.1)(scene.description)]
        layout = Layout(
            row_errors=np.zeros((geometry.n_joints, 4)),
            freedoms=all_freedoms(geometry.n_joints),
            flexibility=dict.fromkeys(self.bending, 1.0),
        )
        mechanism = Mechanism(geometry, layout)
        self.index = mechanism.index
        self.jacobian = np.empty((len(session), 3, mechanism.n_freedoms))
        self.load = np.empty((len(session), mechanism.n_freedoms))
        self.tool = np.empty((len(session), 3))
        qpos = np.zeros((len(session), mechanism.n_freedoms))
        qpos[:, mechanism.angle_columns()] = scene.chain_angles() + geometry.rows[:, 3]
        for row in mechanism.each_row(session.payload):
            self.load[row], _ = mechanism.load(qpos[row])
            self.jacobian[row] = mechanism.tool_jacobian()
            self.tool[row] = mechanism.tool()
        angles = mechanism.angle_columns()
        self.motor_jacobian = self.jacobian[:, :, angles] @ geometry.actuation
        self.chain_jacobian = self.jacobian[:, :, angles]

    def of(self, freedom: str) -> Array:
        """(N, 3) displacement of the tool per unit of a freedom."""
        return self.jacobian[:, :, self.index[freedom]]

    def given_way(self, *freedoms: str) -> Array:
        """(N, 3) displacement when the freedoms give way alike under gravity, per unit compliance."""
        return np.asarray(sum(self.of(name) * self.load[:, self.index[name], None] for name in freedoms))


def rivals(scene: Scene) -> list[Rival]:
    """Every effect of the vocabulary at every place (meshes of gears, nests and payload errors left out)."""
    patterns = Patterns(scene)
    found = [*_base_rivals(patterns), *_joint_rivals(patterns), *_link_rivals(patterns)]
    found += _target_rivals(patterns)
    found.append(_rival("instrument_scale", "instrument", patterns.tool))
    return found


def _rival(effect: str, location: str, *displacements: Array) -> Rival:
    return Rival(effect, location, np.stack([d.reshape(-1) for d in displacements], axis=1))


def _base_rivals(patterns: Patterns) -> Iterator[Rival]:
    time = patterns.scene.session.time
    twists = [patterns.of(name) for name in BASE_FREEDOMS]
    yield _rival("base_drift", "base", *(twist * (time / time[-1])[:, None] for twist in twists))
    for share in MOMENTS:
        after = (time > np.quantile(time, share))[:, None]
        yield _rival("base_shift", "base", *(twist * after for twist in twists))
    yield _rival("base_compliance", "base", patterns.given_way("base rx", "base ry"))


def _target_rivals(patterns: Patterns) -> Iterator[Rival]:
    """A nest's direction enters it otherwise than in proportion: it is left out."""
    pull, along = weight_along_tool(patterns.scene), [patterns.of(name) for name in TARGET_FREEDOMS]
    ways = [{(one, other), (other, one)} for one, other in SAGS.values()]
    yield _rival("holder_sag", "tool", *(np.sum([along[a] * pull[:, b, None] for a, b in way], axis=0) for way in ways))


def _joint_rivals(patterns: Patterns) -> Iterator[Rival]:
    scene = patterns.scene
    session = scene.session
    chain = scene.chain_angles()
    places = joints(scene.description)
    later = [(session.time > np.quantile(session.time, share))[:, None] for share in MOMENTS]
    for j, place in enumerate(places):
        turn, angle = patterns.motor_jacobian[:, :, j], session.commanded[:, j]
        torque = scene.torque[:, j]
        yield _rival("joint_offset", place, turn)
        for after in later:
            yield _rival("zero_shift", place, turn * after)
        yield _rival("gear_ratio", place, turn * angle[:, None])
        for order in (1, 2):
            yield _rival("gear_eccentricity", place, *_waves(turn, order * angle))
        yield _rival("backlash", place, turn * session.approach[:, j, None])
        yield _rival("backlash", place, turn * np.sign(torque)[:, None])
        yield _rival("joint_compliance", place, turn * torque[:, None])
        yield _rival("compliance_change", place, turn * (torque * (session.temperature - 20))[:, None])
        for after in later:
            yield _rival("compliance_change", place, turn * torque[:, None] * after)
        tilts = (f"tilt {j + 1} x", f"tilt {j + 1} y")
        yield _rival("bearing_compliance", place, patterns.given_way(*tilts))
        for order in (1, 2):
            waves = [wave for tilt in tilts for wave in _waves(patterns.of(tilt), order * chain[:, j])]
            yield _rival("axis_wobble", place, *waves)
        yield _rival("servo_lag", place, turn * session.speed[:, j, None])
        for k, other in enumerate(places):
            if k != j:
                yield _rival("joint_coupling", f"{place} from {other}", turn * session.commanded[:, k, None])


def _waves(displacement: Array, angle: Array) -> tuple[Array, Array]:
    return displacement * np.cos(angle)[:, None], displacement * np.sin(angle)[:, None]


def _link_rivals(patterns: Patterns) -> Iterator[Rival]:
    scene = patterns.scene
    geometry, session = scene.geometry, scene.session
    warmer = (session.temperature - REFERENCE_C)[:, None]
    for j in range(geometry.n_joints):
        place = f"link {j + 1}"
        shift = [patterns.of(f"shift {j + 1} {axis}") for axis in "xyz"]
        along_a, along_d = (
            np.asarray(sum(c * s for c, s in zip(way, shift, strict=True)))
            for way in geometry.lengthening(j, geometry.rows)
        )
        skewed = [patterns.of(tilt)] if (tilt := skewing_tilt(geometry, j)) else []
        yield _rival("link_geometry", place, _twisted_row(patterns, j), along_a, along_d, *skewed)
        a, d = geometry.rows[j, 0], geometry.rows[j, 2]
        if j in patterns.bending:
            yield _rival("thermal_expansion", place, (a * along_a + d * along_d) * warmer)
            step = (
                geometry.step_to_joint(j, geometry.rows)
                if geometry.modified
                else geometry.step_to_link(j, geometry.rows)
            )
            piece = float(np.linalg.norm(step.position)) / SEGMENTS
            yield _rival("link_bending", place, patterns.given_way(*segment_hinges(j)) * piece)
    linkage = scene.description.parallelogram
    if linkage is not None:
        elbow = scene.chain_angles()[:, 2] + geometry.rows[2, 3] + np.radians(linkage.crank_angle_deg)
        bars = np.array([linkage.crank_mm, linkage.rod_mm, linkage.rocker_mm, linkage.upper_arm_mm]) * 1e-3
        tiny = 1e-6
        slopes = [(close_loop(elbow, *(bars + tiny * unit)) - elbow) / tiny for unit in (np.eye(4)[1], np.eye(4)[2])]
        yield _rival(
            "parallelogram_geometry", "parallelogram", *(patterns.chain_jacobian[:, :, 2] * s[:, None] for s in slopes)
        )


def _twisted_row(patterns: Patterns, j: int) -> Array:
    """Displacement per unit of alpha of D-H row j (0-based)."""
    geometry = patterns.scene.geometry
    if geometry.modified:
        # alpha turns about x through the row's start; the tilt about x through the joint's origin, d further along z
        return np.asarray(patterns.of(f"tilt {j + 1} x") - geometry.rows[j, 2] * patterns.of(f"shift {j + 1} y"))
    if j + 1 == geometry.n_joints:
        return np.zeros_like(patterns.tool)
    return patterns.of(f"tilt {j + 2} x")
