"""A load's cure, typed into robot.yaml as printed, is the arm that has it: in either convention, beside another."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import yaml

from armscope.motion.library.remedies import Fitted
from armscope.motion.library.remedies_of_loads import OWN_INERTIA, as_tool_load
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import MovingArm, build_moving_arm
from armscope.verdict.effects import Parameter
from tests.motion.moving import ROBOT, robot

TRUE: dict[str, Any] = {"mass_kg": 1.7, "com_mm": [20.0, -10.0, 60.0]}
OTHER: dict[str, Any] = {"mass_kg": 0.9, "com_mm": [-15.0, 30.0, 25.0], "inertia_kg_m2": [0.004, 0.005, 0.006, 0, 0, 0]}


def arm(load: dict[str, Any] | None, convention: str, **more: Any) -> MovingArm:
    """An arm whose last row turns its frame against the joint's."""
    rows = [dict(row) for row in ROBOT["dh"]["joints"]]  # type: ignore[index]
    rows[-1] |= {"alpha_deg": 90, "d_mm": 99.6, "theta_offset_deg": 25}
    spec: dict[str, Any] = {**ROBOT, "dh": {"convention": convention, "joints": rows}, **more}
    return build_moving_arm(RobotDescription.model_validate(spec if load is None else {**spec, "tool_load": load}))


def numbers(of: MovingArm, than: MovingArm, names: str = "mass mx my mz") -> tuple[Parameter, ...]:
    """What a fit says of one arm, of which the other is stated."""
    values = dict(zip(("mass", "mx", "my", "mz"), (of.inertial - than.inertial)[-10:-6], strict=True))
    return tuple(
        Parameter(name, "kg" if name == "mass" else "kg m", float(values[name]), 1e-6) for name in names.split()
    )


def typed_in(cure: str) -> dict[str, Any]:
    found = yaml.safe_load(cure.partition("`tool_load` of robot.yaml to ")[2].partition(" (±")[0])
    assert isinstance(found, dict)
    return found


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_load_is_told_in_the_frame_of_the_file(convention: str) -> None:
    stated, true = arm(None, convention), arm(TRUE, convention)
    cure = as_tool_load(Fitted("State it.", numbers(true, stated), stated))
    assert typed_in(cure) == {"mass_kg": pytest.approx(1.7), "com_mm": pytest.approx([20, -10, 60], abs=0.06)}
    assert np.allclose(arm(typed_in(cure), convention).inertial, true.inertial, rtol=1e-3, atol=1e-4)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("more", [0.6, -0.3])
def test_beside_a_stated_load_both_are_one_body(convention: str, more: float) -> None:
    stated = arm(OTHER, convention)
    at = np.array(OTHER["com_mm"]) if more < 0 else np.array([5.0, 40.0, 70.0])
    mass = OTHER["mass_kg"] + more
    centre = (OTHER["mass_kg"] * np.array(OTHER["com_mm"]) + more * at) / mass
    true = arm({"mass_kg": mass, "com_mm": centre.tolist()}, convention)
    cure = as_tool_load(Fitted("State it.", numbers(true, stated), stated))
    found = typed_in(cure)
    assert found["mass_kg"] == pytest.approx(mass, abs=1e-4)
    assert found["com_mm"] == pytest.approx(centre, abs=0.06)
    far = [1e-3 * (np.array(OTHER["com_mm"]) - centre), 1e-3 * (at - centre)]
    xx = 0.004 + sum(m * (d[1] ** 2 + d[2] ** 2) for m, d in zip((0.9, more), far, strict=True))
    assert found["inertia_kg_m2"][0] == pytest.approx(xx, rel=0.01)


def test_the_interval_of_the_centre_grows_with_that_of_mass_and_moments() -> None:
    stated, true = arm(None, "standard"), arm(TRUE, "standard")
    exact = numbers(true, stated)
    told = [Parameter(each.name, each.unit, each.value, 0.004 if each.unit == "kg m" else 0.0) for each in exact]
    sure = as_tool_load(Fitted("State it.", tuple(told), stated))
    told[0] = Parameter("mass", "kg", exact[0].value, 0.02)
    unsure = as_tool_load(Fitted("State it.", tuple(told), stated))
    assert "(±" not in sure  # a mass without an interval has none
    assert "± 0.039 kg; ± " in unsure
    half = [float(each) for each in unsure.partition("kg; ± ")[2].partition(" mm")[0].split(",")]
    least = 1.96e3 * 0.004 / 1.7
    assert all(each >= least - 0.05 for each in half)
    assert max(half) > least + 0.5


def test_a_mass_alone_is_at_the_tool_point_and_one_run_is_named() -> None:
    stated = arm(None, "standard", tool_mm=[0, 10, 80])
    cure = as_tool_load(Fitted("State it.", (Parameter("mass", "kg", 0.8, 0.01),), stated, run="p2"))
    assert typed_in(cure) == {"mass_kg": 0.8, "com_mm": [0, 10, 80]}
    assert "for run p2 alone" in cure
    assert "(± 0.020 kg), for run" in cure, "its place was not fitted, and has no interval"
    assert "+0.800 ± 0.020 kg at `tool_mm`. That place was not fitted" in cure
    unstated = as_tool_load(Fitted("State it.", (Parameter("mass", "kg", 0.8, 0.01),), arm(None, "standard")))
    assert "at the last frame's origin, `tool_mm` not being stated" in unstated


def test_what_this_motion_does_not_tell_is_named_and_what_is_no_load_goes_into_the_link() -> None:
    stated, true = robot(), robot(tool_load=TRUE)
    cure = as_tool_load(Fitted("State it.", numbers(true, stated, "mass mx my"), stated))
    assert "Where it sits along z of the last joint, this motion does not tell." in cure
    assert typed_in(cure)["com_mm"][:2] == pytest.approx([20, -10], abs=0.06)
    assert ", – mm)" in cure, "no interval of what was not fitted"
    lighter = as_tool_load(Fitted("State it.", numbers(stated, true), stated))
    assert "mass −1.70" in lighter
    assert "corrected.urdf has both" in lighter


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("stated", [None, OTHER])
def test_a_load_with_an_inertia_of_its_own_is_typed_in_with_it(convention: str, stated: dict[str, Any] | None) -> None:
    gripper = {**TRUE, "inertia_kg_m2": [0.003, 0.004, 0.0055, 0.0004, -0.0003, 0.0002]}
    alone, without, before = (arm(load, convention) for load in (gripper, None, stated))
    point = numbers(alone, without)
    own = alone.inertial[-6:] - arm(TRUE, convention).inertial[-6:]
    inertia = tuple(Parameter(n, "kg m^2", float(v), 1e-6) for n, v in zip(OWN_INERTIA, own, strict=True))
    cure = as_tool_load(Fitted("State it.", (*point, *inertia), before))
    true = without.inertial + (alone.inertial - without.inertial) + (before.inertial - without.inertial)
    assert np.allclose(arm(typed_in(cure), convention).inertial, true, rtol=2e-3, atol=2e-4)
