"""The truth of a moving world: what is of one name adds up, as an arm has it."""

from __future__ import annotations

from typing import Any

import pandas as pd

from armscope.proof.motion.truth import _truth


def one(effect: str, location: str, strength: float, **numbers: float) -> dict[str, Any]:
    parameters = [{"name": name, "unit": "kg", "value": value} for name, value in numbers.items()]
    about = {"driver": "load", "shape": "", "minor": False, "alternatives": [], "rms_nm": 1.0}
    return {"effect": effect, "location": location, "parameters": parameters, "strength": strength, **about}


def content(effects: list[dict[str, Any]], rough: list[dict[str, Any]]) -> dict[str, Any]:
    scoring = {"category": "rough", "arm": "a", "fresh": True, "rows": 9, "stated": True, "outside_library": False}
    rest = {"also_allowed": [], "background": [], "zeros_rad": [], "left_on_test_nm": [1.0], "left_moving_nm": [1.0]}
    return {"effects": effects, "rough": rough, "scoring": scoring, **rest}


def test_a_cause_has_the_numbers_that_the_arm_has_rough_ones_included() -> None:
    stands_out = one("link_mass", "link 2", 5.0, mass=-26.0)
    small = [one("link_mass", "link 2", 0.4, mass=4.5), one("link_mass", "link 3", 0.4, mass=1.0)]
    truth = _truth("w", content([stands_out], small), pd.DataFrame())
    assert truth.effects[0].parameters == {"mass": (-21.5, "kg")}
    assert not truth.effects[0].minor
    assert [each.parameters["mass"][0] for each in truth.rough] == [4.5, 1.0]


def test_two_loads_of_one_flange_are_one() -> None:
    both = [one("payload_error", "payload", 23.0, mass=2.0), one("payload_error", "payload", 9.0, mass=1.25)]
    (load,) = _truth("w", content(both, []), pd.DataFrame()).effects
    assert load.parameters == {"mass": (3.25, "kg")}
    assert load.strength == 32.0


def test_a_number_that_only_one_of_two_has_is_not_compared() -> None:
    gripper = one("payload_error", "payload", 23.0, mass=2.0)
    share = one("payload_error", "payload", 1.0)
    (load,) = _truth("w", content([gripper], [share]), pd.DataFrame()).effects
    assert load.parameters == {}
