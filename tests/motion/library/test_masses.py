"""A link whose centre of mass lies far from where it is stated: its inertia about its joint goes with the square."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law
from armscope.motion.library.masses import as_a_body, as_it_leans, at_its_centre, place_masses
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.samples.timing import stretches
from armscope.robot.dynamics import MovingArm
from tests.motion.moving import ROBOT, moved, robot
from tests.seeds import seeds

LINKS: list[dict[str, Any]] = ROBOT["links"]  # type: ignore[assignment]
OFF_M = np.array([0.0, 0.12, 0.0])
"""Of link 3; its square is a fifth of what the link's inertia about its joint is."""


@pytest.mark.long
def test_a_centre_far_off_is_one_cause_and_no_inertia_beside_it() -> None:
    arm = robot()
    stated = arm.inertial[20:30]
    body = pin.Inertia.FromDynamicParameters(stated)
    true = pin.Inertia(body.mass, body.lever + OFF_M, body.inertia).toDynamicParameters()
    inertial = arm.inertial.copy()
    inertial[20:30] = true

    def off_centre(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return np.asarray(arm.torques(q, dq, ddq, inertial) - rigid)

    motions = moved(arm, 7, off_centre, noise=0.005)
    (cause,) = diagnose_motion(arm, motions, MotionSettings(cutoff=10.0)).verdict.effects
    assert (cause.effect, cause.location) == ("link_first_moment", "link 3")
    found = {each.name: each for each in cause.parameters}
    assert found["my"].value == pytest.approx(body.mass * OFF_M[1], rel=0.02)
    low, high = found["my"].interval
    assert low < body.mass * OFF_M[1] < high


LOAD_KG, AT_M = 1.5, np.array([0.33, -0.06, 0.09])
"""In the last joint's frame; the tool point lies at 0.3 m."""


@pytest.mark.parametrize("stated", [0.0, 1.2])
def test_a_loads_columns_are_what_a_body_at_its_place_adds(stated: float) -> None:
    arm = robot()
    free = next(each for each in placed_on(arm) if each.cause is catalogue.PAYLOAD and each.width == 4)
    at_tool = pin.Inertia.FromDynamicParameters(arm.point_load()[20:30])
    values = LOAD_KG * np.r_[1.0, AT_M]
    mass = stated + LOAD_KG
    whole = pin.Inertia(mass, (stated * at_tool.lever + values[1:]) / mass, np.zeros((3, 3)))
    exact = as_a_body(free, arm, values, stated)
    assert exact.inertial is not None
    added = (exact.inertial @ values)[20:30]
    assert added == pytest.approx(whole.toDynamicParameters() - stated * arm.point_load()[20:30], abs=1e-9)
    assert as_a_body(free, arm, -values) is free


@pytest.mark.parametrize("seed", seeds(3, 5))
def test_a_load_off_the_flange_is_one_cause(seed: int) -> None:
    """And not a mass at the tool, moments of the last link, and an inertia."""
    arm = robot()
    inertial = arm.inertial.copy()
    inertial[20:30] += pin.Inertia(LOAD_KG, AT_M, np.zeros((3, 3))).toDynamicParameters()

    def loaded(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return np.asarray(arm.torques(q, dq, ddq, inertial) - rigid)

    motions = moved(arm, seed, loaded, noise=0.01, seconds=15.0)
    (cause,) = diagnose_motion(arm, motions, MotionSettings(cutoff=10.0)).verdict.effects
    assert (cause.effect, cause.location) == ("payload_error", "payload")
    found = {each.name: each for each in cause.parameters}
    assert found["mass"].value == pytest.approx(LOAD_KG, rel=0.03)
    for name, value in zip(("mx", "my", "mz"), LOAD_KG * AT_M, strict=True):
        assert found[name].value == pytest.approx(value, abs=0.03 * LOAD_KG)


def placed_on(arm: MovingArm) -> list[PlacedCause]:
    seen = seen_in(arm, list(stretches(moved(arm, 3, runs=2))), LIBRARY.still_rad)
    return list(place_masses(seen))


def times_as_heavy(factor: float) -> MovingArm:
    """The arm, of a material that is so much denser."""
    heavier = [
        {
            "mass_kg": factor * link["mass_kg"],
            "com_mm": link["com_mm"],
            "inertia_kg_m2": [factor * each for each in link["inertia_kg_m2"]],
        }
        for link in LINKS
    ]
    return robot(links=heavier)


def test_what_competes_does_not_hang_on_how_heavy_the_arm_is() -> None:
    """A kilogram more was too little to compete on an arm of a ton: a spring and a centre took its name."""
    offered = [
        {(str(each), each.variant, each.parameters) for each in placed_on(times_as_heavy(factor))}
        for factor in (1.0, 20.0, 400.0)
    ]
    links = [{each for each in these if "link" in each[0]} for these in offered]
    assert links[0] <= links[1] == links[2]
    assert {variant for name, variant, _ in links[2] if name == "link mass at link 2"} == {"", catalogue.AT_ITS_CENTRE}


def test_a_mass_at_the_centre_leaves_the_inertia_about_it() -> None:
    body = pin.Inertia.FromDynamicParameters(robot().inertial[10:20])
    heavier = pin.Inertia(body.mass + 0.7, body.lever, body.inertia).toDynamicParameters()
    added = 0.7 * at_its_centre(robot().inertial[10:20])
    np.testing.assert_allclose(robot().inertial[10:20] + added, heavier, atol=1e-12)


def test_a_gravity_that_leans_keeps_its_size() -> None:
    """2 degrees take 0.06 % off the pull downwards: a link was told to be lighter by as much."""
    for arm in (robot(), robot(gravity_m_s2=[3.0, -4.0, -8.443])):
        seen = seen_in(arm, list(stretches(moved(arm, 3, runs=2))), LIBRARY.still_rad)
        (lean,) = [each for each in place_masses(seen) if each.cause is catalogue.GRAVITY]
        down, values = arm.model.gravity.linear, np.array([0.03, -0.02])
        sizes = []
        for each in (lean, as_it_leans(lean, arm, values)):
            assert isinstance(each.columns, Law)
            sizes.append(np.linalg.norm(down + values @ np.array(each.columns.numbers).reshape(-1, 3)))
        assert sizes[1] == pytest.approx(np.linalg.norm(down), rel=1e-12)
        assert sizes[0] > 1.0005 * sizes[1]


GRIPPER = pin.Inertia(0.8, np.array([0.31, 0.02, 0.03]), np.diag([0.004, 0.009, 0.007]))
"""kg, m in the last joint's frame, kg m^2 about its own centre."""


@pytest.mark.long
@pytest.mark.parametrize("link", [pytest.param(1.0, marks=pytest.mark.long), 0.97])
@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_load_with_an_inertia_of_its_own_is_a_load(seed: int, link: float) -> None:
    """As a point it was none: masses that are off "without a name" took its place.

    What its link weighs otherwise than stated is part of what it seems to weigh. Where it is no point, nothing tells
    the two apart, and its interval must know that.
    """
    arm, inertial = robot(), robot().inertial.copy()
    inertial[20:30] = link * inertial[20:30] + GRIPPER.toDynamicParameters()

    def carried(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return np.asarray(arm.torques(q, dq, ddq, inertial) - rigid)

    verdict = diagnose_motion(arm, moved(arm, seed, carried, noise=0.001), MotionSettings(cutoff=10.0)).verdict
    cause = verdict.effects[0]
    assert (cause.effect, cause.location) == ("payload_error", "payload")
    found = {each.name: each for each in cause.parameters}
    true = {"mass": GRIPPER.mass, "mx": GRIPPER.mass * 0.31, "my": GRIPPER.mass * 0.02, "Izz": 0.007}
    for name in true if link == 1 or "Izz" in found else ():
        low, high = found[name].interval
        assert low < true[name] < high, name
    assert found["mass"].value == pytest.approx(GRIPPER.mass - (1 - link) * arm.inertial[20], abs=0.02)
    assert verdict.held_out.model < 0.1 * verdict.held_out.background
