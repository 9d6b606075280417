"""What of the library an arm can have at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.timing import stretches
from tests.motion.moving import ROBOT, moved, robot


@pytest.mark.parametrize(("turned_over", "left"), [(0, {"difference"}), (180, {""})])
def test_what_turns_with_two_parallel_joints_is_the_next_link_and_no_cause_of_its_own(
    turned_over: int, left: set[str]
) -> None:
    """Joint 3 is parallel to joint 2, or points the other way; joints 1 and 2 are at right angles."""
    first, second, last = ROBOT["dh"]["joints"]  # type: ignore[index]
    rows = [first, {**second, "alpha_deg": turned_over}, last]
    arm = robot(dh={"joints": rows})
    placed = place_causes(seen_in(arm, list(stretches(moved(arm, 1))), 0.02))
    found = [(each.location, each.variant) for each in placed if each.cause.name == "coupled_inertia"]
    assert {variant for place, variant in found if place == "joint 2 from joint 1"} == {"", "difference"}
    assert {variant for place, variant in found if place == "joint 3 from joint 2"} == left


def test_what_two_slides_have_between_them_is_a_mass() -> None:
    arm = robot()
    seen = replace(seen_in(arm, list(stretches(moved(arm, 1))), 0.02), arm=replace(arm, sliding=np.full(3, True)))
    units = {each.parameters for each in place_causes(seen) if each.cause.name == "coupled_inertia"}
    assert units == {(("inertia", "kg"),)}


@pytest.mark.parametrize(("gravity", "says"), [([0.0, 0.0, -9.81], False), ([0.0, -9.81, 0.0], True)])
def test_a_centre_that_shows_as_an_inertia_only_is_no_cause_of_its_own(gravity: list[float], says: bool) -> None:
    """Upright, the first link has one number that shows; lying, its weight turns it as well."""
    arm = robot(gravity_m_s2=gravity)
    placed = place_causes(seen_in(arm, list(stretches(moved(arm, 1))), 0.02))
    first = [(each.cause.name, each.variant) for each in placed if each.location == "link 1"]
    assert (("link_first_moment", "") in first) is says
    assert first.count(("link_inertia", "")) == 1
    assert ("link_inertia", "all six") not in first


def test_springs_and_counterweights_hold_as_a_rule_a_third_of_what_their_joint_carries() -> None:
    seen = seen_in(robot(), list(stretches(moved(robot(), 1))), 0.02)
    forms = [each for each in place_causes(seen) if each.cause.name == "gravity_balance" and each.joints == (1,)]
    assert len(forms) == 3
    for form in forms:
        at_the_ends = form.usual[0] * (np.ptp(seen.q[1]) / 2 if form.columns.kind == "spring" else 1.0)  # type: ignore[union-attr]
        assert at_the_ends == pytest.approx(seen.effort[1] / 3)
