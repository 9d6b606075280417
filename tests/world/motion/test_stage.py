"""What a moving world conceals stays possible: at the limit and beyond it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from armscope.world.motion.kinds import LIBRARY
from armscope.world.motion.mechanism import MovingArm
from armscope.world.motion.stage import SLOWEST_SWING_HZ, WRONG_CENTRE, WRONG_MASS, PlainArm

from .arms import arm

DESCRIPTION, GEOMETRY, DYNAMICS = arm("six-axis")
POSES = np.array([[0.0, 0.3, 0.2, 0.0, 0.4, 0.0]])
SESSION = SimpleNamespace(temperature=np.array([[20.0], [45.0]]), angle=POSES)
ARM = SimpleNamespace(description=DESCRIPTION, dynamics=DYNAMICS, session=SESSION)
LONGEST = np.abs(GEOMETRY.rows[:, [0, 2]]).max()


def inertia() -> float:
    """kg m^2 of all that hangs on joint 2, by the energy of turning it."""
    links, turning = MovingArm(GEOMETRY, DYNAMICS.without_friction()), np.eye(6)[1:2]
    return float(2 * (links.energy(POSES, turning) - links.energy(POSES, 0 * turning))[0])


LIMITS = {
    PlainArm.holds_its_link: {"compliance": 1 / (inertia() * (2 * np.pi * SLOWEST_SWING_HZ) ** 2)},
    PlainArm.mass_may_be: {"mass": -WRONG_MASS * DYNAMICS.mass[1]},
    PlainArm.centre_may_be: {"mx": WRONG_CENTRE * LONGEST * DYNAMICS.mass[1], "my": 0.0, "mz": 0.0},
    PlainArm.resists_when_warm: {"per_kelvin": -DYNAMICS.viscous[1] / 25.0},
    PlainArm.resists_either_way: {"viscous_difference": -DYNAMICS.viscous[1]},
}


@pytest.mark.parametrize("may_be", LIMITS, ids=lambda rule: rule.__name__)
def test_what_is_just_possible_passes_and_a_little_more_does_not(may_be) -> None:
    within, beyond = ({name: share * x for name, x in LIMITS[may_be].items()} for share in (0.99, 1.01))
    assert may_be(ARM, 1, within)
    assert not may_be(ARM, 1, beyond)


def test_each_limit_is_some_kinds() -> None:
    assert {kind.possible for kind in LIBRARY} == {None, *LIMITS}
