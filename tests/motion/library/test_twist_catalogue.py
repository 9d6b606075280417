"""What may stand at a joint whose link was recorded."""

import numpy as np

from armscope.motion.library.catalogue import cause_named
from armscope.motion.library.causes import Seen
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.library.twist_catalogue import ELASTICITY, ENCODER_OFFSET, JOINT_PLAY, TWISTS, clash, place_twists
from armscope.motion.library.twist_constants import TWIST
from armscope.motion.samples.timing import stretches
from tests.motion.moving import moved, robot


def seen() -> Seen:
    return seen_in(robot(), list(stretches(moved(robot(), 5, seconds=4.0))), 0.02)


def test_a_torque_that_hardly_changes_tells_no_stiffness_from_a_zero() -> None:
    swing = np.sin(np.linspace(0, 20, 400))
    for torque, told in ((30 + 0.5 * TWIST.changes * 30 * swing, False), (30 + 10 * swing, True)):
        placed = [each.cause for each in place_twists(seen(), 1, torque)]
        assert placed[0] is ENCODER_OFFSET
        assert (ELASTICITY in placed) == told
        assert JOINT_PLAY not in placed  # it never pushes the other way


def test_a_free_curve_of_torque_stands_in_place_of_the_laws_that_it_contains() -> None:
    placed = place_twists(seen(), 1, 30 * np.sin(np.linspace(0, 20, 400)))
    curve = next(each for each in placed if each.is_curve and each.driver == "load")
    other = next(each for each in placed if each.is_curve and each.driver == "time")
    law = next(each for each in placed if each.cause is ELASTICITY)
    assert clash(curve, law)
    assert clash(law, curve)
    assert not clash(other, law)
    assert not clash(other, curve)


def test_every_cause_can_be_named_and_said() -> None:
    for cause in TWISTS:
        assert cause_named(cause.name) is cause
        assert cause.clause is not None or cause is ENCODER_OFFSET
