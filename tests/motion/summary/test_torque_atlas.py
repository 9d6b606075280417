"""The atlas of an arm in motion: what is planted lights up at its joint and driver, and a clean arm stays dark."""

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.verdict.diagnosis import Atlas
from tests.motion.moving import Plant, clinging
from tests.motion.test_pipeline import diagnosed, rubbing_with_load
from tests.seeds import seeds


def at(joint: int, torque: Plant) -> Plant:
    """A torque of one joint (from 1), a function of that joint's own motion."""

    def plant(*motion: Array) -> Array:
        extra = np.zeros_like(motion[0])
        extra[:, joint - 1] = torque(*(each[:, joint - 1] for each in motion))
        return extra

    return plant


def share(atlas: Atlas, joint: str, driver: str) -> float:
    return float(atlas.share[atlas.locations.index(joint), 0, atlas.drivers.index(driver)])


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_clean_arm_stays_dark(seed: int) -> None:
    atlas = diagnosed(None, seed).atlas
    assert atlas.locations == ("joint 1", "joint 2", "joint 3")
    assert {"joint angle", "speed", "acceleration", "load", "torque", "time"} <= set(atlas.drivers)
    assert np.nanmax(atlas.share) < 0.03
    assert np.nanmax(atlas.left) < 0.03


@pytest.mark.long
@pytest.mark.parametrize(
    ("plant", "joint", "driver"),
    [
        (at(1, lambda q, dq, ddq, rigid: 2 * np.sin(9 * q)), "joint 1", "joint angle"),
        (rubbing_with_load, "joint 2", "load"),
        *(
            pytest.param(at(3, torque), "joint 3", driver, marks=pytest.mark.long)
            for driver, torque in (
                ("constant", lambda q, dq, ddq, rigid: np.ones_like(q)),
                ("direction", lambda q, dq, ddq, rigid: 2 * np.abs(dq)),
            )
        ),
    ],
)
def test_what_is_planted_lights_up_at_its_joint_and_driver_and_is_gone_after_the_fit(
    plant: Plant, joint: str, driver: str
) -> None:
    atlas = diagnosed(plant).atlas
    assert share(atlas, joint, driver) > 0.9
    rest = atlas.share.copy()
    rest[atlas.locations.index(joint), 0, atlas.drivers.index(driver)] = 0
    assert np.nanmax(rest) < 0.7
    others = [n for n, place in enumerate(atlas.locations) if place != joint]
    assert np.nanmax(atlas.share[others]) < 0.03
    assert np.nanmax(atlas.left) < 0.03


@pytest.mark.long
def test_what_no_cause_names_stays_lit_after_the_fit() -> None:
    lugging = diagnosed(at(3, lambda q, dq, ddq, rigid: 2 * np.tanh(ddq)), seconds=15.0).atlas
    cell = lugging.locations.index("joint 3"), 0, lugging.drivers.index("acceleration")
    assert lugging.share[cell] > 0.5
    assert lugging.left[cell] > 0.5
    assert share(diagnosed(clinging).atlas, "joint 2", "way since the last reversal") > 0.9
