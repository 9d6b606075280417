"""An axis that leans about a point that is not its row's origin: found with its tilt, and with how far it runs out."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Part, Placed
from armscope.physics.wobble import AXIS_WOBBLE, RUNS_OUT
from armscope.recordings import Recordings
from armscope.robot import Arm
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named
from tests.physics.test_tilting import moved, of_one_run, of_variant

QUICK = Settings(resamples=0, cross_validation=False)
TILT, HEIGHT, NOISE_MM = 3e-4, 0.6, 0.02


def wobbles(arm: Arm, table: Recordings, joint: int, per_turn: int) -> tuple[Placed, Placed]:
    """Of a joint's axis, without and with what it runs out."""
    placed = list(AXIS_WOBBLE.place(arm, table))
    plain, out = (
        of_variant(placed, variant, f"joint {joint}") for variant in (str(per_turn), f"{per_turn} {RUNS_OUT}")
    )
    return plain, out


def round_about(height: float) -> Array:
    """A tilt that runs round against the joint, about a point up the axis: cosine, sine about x, y and along x, y."""
    about_x, about_y = np.array([TILT, 0.0]), np.array([0.0, -TILT])
    return np.concatenate([about_x, about_y, -height * about_y, height * about_x])


def test_a_point_up_the_axis_stays_where_it_is() -> None:
    arm = arm_named("six-axis")
    table = of_one_run(arm)
    plain, out = wobbles(arm, table, 1, 1)
    assert out.terms[:4] == plain.terms
    about_origin = moved(arm, table, Part(plain, round_about(0.0)[:4]))
    np.testing.assert_allclose(moved(arm, table, Part(out, round_about(0.0))), about_origin, atol=1e-12)
    tilts = np.zeros((len(table), 3))
    angle = (table.motor_angles @ arm.actuation.T)[:, 0]
    tilts[:, :2] = TILT * np.stack([np.cos(angle), -np.sin(angle)], axis=1)
    of_height = moved(arm, table, Part(out, round_about(HEIGHT))) - about_origin
    # turned about a point h up z, what stands at the origin moves by -h (tilt x z); the base's frame is joint 1's here
    np.testing.assert_allclose(of_height, -HEIGHT * np.cross(tilts, [0.0, 0.0, 1.0]), atol=3e-7)


@pytest.mark.parametrize("joint", [1, 3])
def test_an_axis_that_leans_about_a_point_elsewhere_is_told_with_its_tilt_and_run_out(joint: int) -> None:
    arm = arm_named("six-axis")
    key = ("axis_wobble", f"joint {joint}")
    table = recorded(arm, one_run(arm, 200, 5), {key: list(round_about(HEIGHT))}, NOISE_MM, 5)
    (found,) = diagnose(arm, table, QUICK).effects
    assert (found.effect, found.location) == key
    told = {p.name: p for p in found.parameters}
    low, high = told["amplitude"].interval
    assert low < TILT < high
    low, high = told["run_out"].interval
    assert low < 1e3 * HEIGHT * TILT < high
    assert "phase" not in told, "a tilt that runs round is nowhere largest"
