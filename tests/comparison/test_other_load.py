"""Another gripper is no softer drive: where changes follow loads, the load at the flange is told beside them."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison import Valued
from armscope.comparison.other_load import other_load
from armscope.robot import chain
from armscope.robot.gravity import gravity_torques
from tests.calibration.worlds import poses
from tests.comparison.test_changes import ARM
from tests.comparison.test_remedies import CHANGE, FOUND

SOFT = 4e-6


def softer(difference: float, stderr: float = 1e-8):
    values = (SOFT, SOFT + difference)
    number = Valued(
        "compliance", "rad/(N m)", values, (stderr,) * 2, (0.0, difference), (0.0, 1e-9), difference, (0, 1)
    )
    return replace(CHANGE, effect="joint_compliance", location="joint 2", title="compliance of 2", parameters=(number,))


def test_a_drive_that_seems_softer_may_be_another_load_of_so_many_kilograms() -> None:
    angles = poses(np.random.default_rng(1), 60, ARM.n_motors)
    frames = chain(ARM, angles)
    now = gravity_torques(ARM, frames)[:, 1]
    loaded = gravity_torques(ARM, frames, np.full(60, 3.0))[:, 1]
    seen = SOFT * float(loaded @ now - now @ now) / float(now @ now)
    told = other_load(ARM, angles, [softer(seen)])
    assert "another load at the flange, by about +" in told
    assert 2.0 < float(told.partition("about +")[2].partition(" kg")[0]) <= 3.1
    assert "by about" not in other_load(ARM, angles, [softer(seen, stderr=1e-4)]), "its size in both is open"
    assert "(compliance of 2)" in other_load(ARM, angles, [softer(seen), CHANGE])


@pytest.mark.parametrize(
    ("effect", "variant", "said"),
    [("backlash", "load", True), ("backlash", "approach", False), ("joint_offset", "", False)],
)
def test_only_what_follows_loads_may_be_a_load(effect: str, variant: str, said: bool) -> None:
    """Play on the side from which a joint came was told as a gripper, too."""
    angles = np.zeros((3, ARM.n_motors))
    assert bool(other_load(ARM, angles, [replace(CHANGE, effect=effect, variant=variant)])) == said


def test_it_stands_behind_what_changed_and_names_stand_in_quotes() -> None:
    found = replace(FOUND, other_load="Another load.")
    assert 'grew in "c" (p = 1e-09 that nothing changed). Another load.' in found.headline
    wave = replace(CHANGE, parameters=(replace(CHANGE.parameters[0], name="cosine_1"),))
    assert "cosine part of the wave, 1 per turn: " in replace(FOUND, changes=(wave,)).text()
