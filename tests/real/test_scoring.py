"""A name counts only for what is new in it, sizes on top of what was there, and what won back is measured unseen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from armscope.proof.answers import Answer
from armscope.real.making import LEFT_MM
from armscope.real.rates import tables
from armscope.real.scoring import Sealed, score
from armscope.recordings.columns import AXES_MM
from tests.proof.cases import claim

SPRING = {"compliance": (2e-6, 1e-7, "rad/(N m)")}
ROWS = 50


def sealed(truth, claims, world="world-000", left=0.0, off=0.0, part="fixed", set_="arm"):
    readings = pd.DataFrame(np.zeros((ROWS, 3)), columns=AXES_MM)
    readings[LEFT_MM] = left * np.ones((ROWS, 3)) / np.sqrt(3)
    predicted = pd.DataFrame(off * np.ones((ROWS, 3)) / np.sqrt(3), columns=AXES_MM)
    answer = Answer(world, tuple(claims), True, "explained", 0.1, "", predicted)
    return Sealed(set_, part, truth, readings, answer)


def original(*claims, off=0.0):
    return sealed({"kind": "original"}, claims, "original", off=off, part="original")


def altered(*claims, effect="joint_compliance", location="joint 2", value=1e-6, alternatives=(), **changes):
    truth = {
        "kind": "altered", "effect": effect, "location": location, "driver": "gravity load", "size": 1.0,
        "rms_mm": 0.1, "level_mm": 0.1, "noncentrality": 100.0, "skipped": [],
        "parameters": [{"name": "compliance", "value": value, "unit": "rad/(N m)"}],
        "alternatives": [list(each) for each in alternatives],
    }  # fmt: skip
    return sealed(truth | changes.pop("truth", {}), claims, **({"left": 0.1} | changes))


def case(before, after):
    return score([before, after]).cases.iloc[0]


def spring(value=1e-6, where="joint 2", **more):
    return claim("joint_compliance", where, parameters={"compliance": (value, 1e-7, "rad/(N m)")}, **more)


def test_a_new_name_is_found():
    found = case(original(), altered(spring()))
    assert (found["outcome"], found["found"], found["size_ratio"]) == ("named", True, pytest.approx(1))


def test_a_name_that_the_original_has_as_well_is_not_found():
    assert case(original(spring()), altered(spring()))["outcome"] == "missed"


def test_a_number_that_grew_by_what_was_planted_is_found_and_held_against_both_together():
    scores = score([original(spring(3e-6)), altered(spring(4.05e-6))])
    assert scores.cases.iloc[0]["outcome"] == "named"
    number = scores.numbers.iloc[0]
    assert number["true"] == pytest.approx(4e-6)
    assert number["covered"]


def test_an_interval_that_misses_both_together_does_not_hold():
    scores = score([original(spring(3e-6)), altered(spring(4.5e-6))])
    assert not scores.numbers.iloc[0]["covered"]


def test_a_drive_with_masses_unknown_is_told_by_what_it_moves():
    own, grown, alike = (
        claim("joint_compliance", "joint 2", parameters={"moment_x": (value, 1e-7, "rad")}, rms=rms)
        for value, rms in ((1e-5, 0.2), (2e-5, 0.4), (1e-5, 0.202))
    )
    assert case(original(own), altered(grown))["outcome"] == "named"
    assert case(original(own), altered(alike))["outcome"] == "missed"


def test_a_number_that_went_the_other_way_is_not_found():
    assert case(original(spring(3e-6)), altered(spring(2e-6)))["outcome"] == "missed"


@pytest.mark.parametrize(
    ("said", "outcome"),
    [
        (claim("backlash", "joint 3"), "acceptable"),
        (claim("link_bending", "link 5", alternatives=[("joint_compliance", "joint 2")]), "listed"),
        (claim("gear_ratio", "joint 2"), "located"),
        (claim("unknown", "joint 2"), "located"),
        (claim("gear_ratio", "joint 4"), "missed"),
    ],
)
def test_outcomes_of_other_names(said, outcome):
    assert case(original(), altered(said, alternatives=[("backlash", "joint 3")]))["outcome"] == outcome


def test_only_names_that_nothing_asks_for_count_as_new():
    said = (spring(), claim("gear_ratio", "joint 4"), claim("link_geometry", "link 1"), claim("unknown", "joint 5"))
    found = case(original(claim("link_geometry", "link 1"), claim("joint_offset", "joint 6")), altered(*said))
    assert (found["new_names"], found["new"], found["lost"]) == (1, "gear_ratio joint 4", "joint_offset joint 6")


def test_a_name_that_the_arms_own_verdict_listed_is_new_and_yet_heard_of():
    own = claim("gear_eccentricity", "joint 5", alternatives=[("gear_ratio", "joint 5")])
    found = case(original(own), altered(spring(), claim("gear_ratio", "joint 5"), claim("gear_ratio", "joint 4")))
    assert (found["new_names"], found["unheard_of"]) == (2, 1)


def test_a_jump_is_right_if_no_seen_row_lies_between():
    truth = {"effect": "base_shift", "location": "base", "parameters": [{"name": "x", "value": 1.0, "unit": "mm"}]}
    truth |= {"jump_between_ids": [40.0, 43.0]}
    for row, right in ((41.0, True), (43.0, True), (40.0, False), (44.0, False)):
        said = claim("base_shift", "base", parameters={"x": (1.0, 0.1, "mm"), "row": (row, float("nan"), "")})
        assert case(original(), altered(said, truth=truth))["row_right"] == right


def test_waves_of_the_arm_and_planted_ones_of_the_same_count_add_as_waves():
    def wave(amplitude, phase):
        numbers = {
            "amplitude": (amplitude, 1e-6, "rad"),
            "phase": (phase, 0.01, "rad"),
            "per_turn": (9.0, np.nan, "1/turn"),
        }
        return claim("gear_mesh", "joint 2", parameters=numbers, rms=amplitude)

    planted = [("amplitude", 3e-4, "rad"), ("phase", np.pi / 2, "rad"), ("per_turn", 9.0, "1/turn")]
    truth = {
        "effect": "gear_mesh",
        "parameters": [dict(zip(("name", "value", "unit"), p, strict=True)) for p in planted],
    }
    scores = score([original(wave(4e-4, 0.0)), altered(wave(5e-4, np.arctan2(3, 4)), truth=truth | {"rms_mm": 1e-5})])
    expected = scores.numbers.set_index("parameter")["true"]
    assert expected["amplitude"] == pytest.approx(5e-4)
    assert expected["phase"] == pytest.approx(np.arctan2(3, 4))
    assert scores.numbers["covered"].dropna().all()


def test_all_that_was_planted_is_won_back_by_a_perfect_model_and_nothing_by_the_old_one():
    before = original(off=0.3)
    for off, recovered in ((0.3, 1.0), (0.5, 0.0)):
        # the planted 0.4 mm stand across the arm's own 0.3 mm
        after = altered(spring(), off=off)
        left = np.zeros((ROWS, 3))
        left[:, :] = 0.4 * np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
        after.readings[LEFT_MM] = left
        found = case(before, after)
        assert found["floor_mm"] == pytest.approx(0.3)
        assert found["without_mm"] == pytest.approx(0.5)
        assert found["recovered"] == pytest.approx(recovered, abs=1e-9)


def test_rates_count_both_halves_and_each():
    other = [{"name": "compliance", "value": 2e-6, "unit": "rad/(N m)"}]
    missed = altered(claim("gear_ratio", "joint 5"), part="fresh", truth={"parameters": other})
    worlds = [original(), altered(spring()), missed]
    rates = tables(score(worlds))["rates"]
    shown = rates[(rates["by"] == "all") & (rates["score"] == "found")].set_index("half")
    assert shown["cases"].to_dict() == {"fixed": 1, "fresh": 1, "both": 2}
    assert shown["right"].to_dict() == {"fixed": 1, "fresh": 0, "both": 1}


def test_what_was_won_back_is_the_middle_of_the_cases_of_each_arm_and_size():
    worlds = [original()]
    for number, factor in enumerate((1.0, 1.2, 9.0)):
        value = [{"name": "compliance", "value": (1 + number) * 1e-6, "unit": "rad/(N m)"}]
        worlds.append(altered(spring(factor * (1 + number) * 1e-6), off=0.1 * factor, truth={"parameters": value}))
    middle = tables(score(worlds))["held_out"]
    assert middle["cases"].tolist() == [3]
    assert middle["size_ratio"].iloc[0] == pytest.approx(1.2)
    assert middle["with_mm"].iloc[0] == pytest.approx(0.12)


def test_the_same_recordings_in_both_halves_count_once():
    rates = tables(score([original(), altered(spring()), altered(spring(), part="fresh")]))["rates"]
    shown = rates[(rates["by"] == "all") & (rates["score"] == "found")].set_index("half")
    assert shown["cases"].to_dict() == {"fixed": 1, "fresh": 1, "both": 1}


def test_what_follows_a_load_is_told_where_columns_are_withheld():
    truth = {"kind": "withheld", "rows": "run", "withheld": "torques withheld", "orientations": False}
    loaded = claim("joint_compliance", "joint 2")
    loaded = replace(loaded, driver="load of joint 2")
    scores = score(
        [original(), sealed(truth, [loaded], part="withheld"), sealed(truth, [claim("joint_offset", "joint 1")])]
    )
    assert scores.withheld["load_found"].tolist() == [True, False]
    assert scores.withheld["compliance_found"].tolist() == [True, False]
