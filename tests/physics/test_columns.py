"""Every effect is written once; its columns must be the slope of its own exact model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.measurement.channel import ORIENTATIONS, POSITIONS
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.backgrounds import backgrounds
from armscope.physics.drift import base_shift, tool_shift
from armscope.physics.effect import Part, Placed
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.frames import free_frames
from armscope.physics.payload import payload_errors
from armscope.physics.payload_change import payload_changes
from armscope.physics.registry import EFFECTS, library
from armscope.physics.scene import Scene
from armscope.physics.transmission import mesh
from armscope.physics.zero_shift import zero_shift
from armscope.recordings import Recordings

from .scenes import arm_named, full_table

LATER = [pytest.param(name, marks=pytest.mark.long) for name in ("seven-axis", "six-axis")]
KINDS = ["parallelogram-120kg", "four-axis-modified", *LATER]
"""By standard rows and by modified ones; the others have no effect that one of these lacks."""


def with_orientations(table: Recordings) -> Recordings:
    return replace(table, orientation=np.tile([1.0, 0.0, 0.0, 0.0], (len(table), 1)))


def every_placed(scene: Scene) -> list[Placed]:
    arm, table = scene.arm, scene.recordings
    give = [Part(p, np.full(len(p.terms), 1e-6)) for p in JOINT_COMPLIANCE.place(arm, table) if p.variant == ""]
    return [
        *library(arm, table),
        *[placed for family in backgrounds(arm, table).values() for placed in family],
        *[mesh(j, 17) for j in range(1, arm.n_motors + 1)],
        base_shift(table, 5, 1),
        tool_shift(table, 5, 1),
        zero_shift(table, 5, 1, 2),
        *payload_errors(table, give),
        *payload_changes(table, give),
        *free_frames(table, tool_per_run=True),
    ]


@pytest.mark.parametrize("name", KINDS)
def test_columns_are_the_slope_of_the_exact_model(name: str) -> None:
    arm = arm_named(name)
    scene = Scene(arm, with_orientations(full_table(arm, 24, seed=5)))
    posture = scene.posture()
    seen = set()
    for placed in every_placed(scene):
        seen.add(placed.name)
        for n, term in enumerate(placed.terms):
            column = posture.column(term)
            size = np.abs(column).max()
            if size == 0:
                continue
            step = np.zeros(len(placed.terms))
            step[n] = 1e-6 / size
            ahead, behind = (scene.posture([Part(placed, sign * step)]).tool for sign in (1, -1))
            slope = (ahead - behind) / (2 * step[n])
            # metres near 1 with 1e-16 rounding over a displacement of 2e-6
            assert np.abs(slope - column).max() < 3e-6 * size, (str(placed), term.name)
    expected = {effect.name for effect in EFFECTS} | {
        "base_frame",
        "tool_frame",
        "tool_turn",
        "base_wander",
        "link_wander",
        "orientation_error",
    }
    expected -= {"parallelogram_geometry"} if arm.description.parallelogram is None else set()
    assert seen == expected


@pytest.mark.long
@pytest.mark.parametrize(
    "name",
    ["parallelogram-120kg", *(pytest.param(name, marks=pytest.mark.long) for name in ("seven-axis", "six-axis"))],
)
def test_columns_of_turns_are_the_slope_of_the_exact_orientation(name: str) -> None:
    arm = arm_named(name)
    scene = Scene(arm, with_orientations(full_table(arm, 24, seed=5)))
    posture = scene.posture()
    seen = WhitenedPosture.plain(posture, (POSITIONS, ORIENTATIONS))
    turning = set()
    for placed in every_placed(scene):
        for n, term in enumerate(placed.terms):
            column = seen.column(term)
            np.testing.assert_array_equal(column[:, :3], posture.column(term))
            size = np.abs(column[:, 3:]).max()
            if size == 0:
                continue
            turning.add(placed.name)
            step = np.zeros(len(placed.terms))
            step[n] = 1e-5 / size
            ahead, behind = (
                Rotation.from_matrix(scene.posture([Part(placed, sign * step)]).seen_rotation) for sign in (1, -1)
            )
            slope = (ahead * behind.inv()).as_rotvec() / (2 * step[n])
            assert np.abs(slope - column[:, 3:]).max() < 1e-5 * size, (str(placed), term.name)
    assert "tool_turn" in turning
    assert not turning & {"instrument_scale", "tool_frame"}


def test_every_effect_says_what_happens_how_to_confirm_and_how_to_cure() -> None:
    for effect in EFFECTS:
        for sentence in (effect.physics, effect.confirm, effect.cure.words):
            assert sentence.endswith("."), effect.name
            assert len(sentence) > 30, effect.name


def test_a_joint_that_never_moves_has_no_effect_that_follows_its_angle() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 24, seed=6)
    table.motor_angles[:, 3] = 0.2
    follows = [p for p in library(arm, table) if p.driver == "angle of joint 4" and p.name != "axis_wobble"]
    assert follows == []
    assert any(p.driver == "angle of joint 5" for p in library(arm, table))
