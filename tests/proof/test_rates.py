"""Rates with intervals, and what is made of them."""

from __future__ import annotations

import pandas as pd
import pytest

from armscope.proof.binomial import rate
from armscope.proof.definitions import judged
from armscope.proof.rates import detection_table, evidence_table


def test_intervals_are_those_of_clopper_and_pearson():
    # 0 of 10: 1 - 0.025^(1/10); 8 of 10: printed in Clopper & Pearson's charts and many tables
    assert rate(pd.Series([False] * 10)).high == pytest.approx(1 - 0.025 ** (1 / 10))
    found = rate(pd.Series([True] * 8 + [False] * 2))
    assert (found.low, found.high) == pytest.approx((0.4439, 0.9748), abs=1e-4)


@pytest.mark.parametrize(
    ("cases", "estimate", "low", "high", "verdict"),
    [
        (40, 0.96, 0.90, 0.99, "met"),
        (40, 0.93, 0.85, 0.97, "open"),
        (400, 0.90, 0.88, 0.93, "not met"),
        (9, 1.0, 0.66, 1.0, "too few cases"),
        (0, float("nan"), float("nan"), float("nan"), "too few cases"),
    ],
)
def test_an_aim_is_met_open_or_not_met_and_never_without_evidence(cases, estimate, low, high, verdict):
    assert judged(cases, estimate, low, high, (0.95, 1.0)) == verdict


def test_names_are_counted_by_their_evidence():
    names = pd.DataFrame(
        {
            "effect": ["backlash", "backlash", "gear_ratio", "unknown"],
            "evidence_nats": [0.4, 50.0, 60.0, 70.0],
            "right": [False, True, True, False],
            "fresh": True,
        }
    )
    table = evidence_table(names).set_index(["seeds", "evidence_nats"])
    assert table.loc[("fresh", "below 1"), "right"] == 0
    assert table.loc[("fresh", "above 30"), "right"] == table.loc[("fresh", "above 30"), "cases"] == 2


def test_what_is_hard_to_see_is_counted_near_the_threshold_only_and_stands_first():
    def alone(effect, size, seen, right, category="single"):
        return {"effect": effect, "size_in_thresholds": size, "seen": seen, "right": right, "category": category}

    rows = [
        alone("backlash", 1.2, True, True), alone("backlash", 2.5, True, False), alone("backlash", 0.9, False, False),
        alone("gear_mesh", 1.1, False, False), alone("gear_mesh", 1.9, True, True), alone("gear_mesh", 9.0, True, True),
        alone("servo_lag", 1.3, False, False, "multiple"),
    ]  # fmt: skip
    effects = pd.DataFrame(rows).assign(minor=False, world=[f"world-{n}" for n in range(len(rows))])
    table = detection_table(effects)
    assert list(table["effect"]) == ["gear_mesh", "gear_mesh", "backlash", "backlash"]
    counts = table.set_index(["effect", "found"])[["right", "cases"]].to_dict("index")
    assert counts["gear_mesh", "seen"] == counts["gear_mesh", "right"] == {"right": 1, "cases": 2}
    assert counts["backlash", "seen"] == {"right": 2, "cases": 2}
    assert counts["backlash", "right"] == {"right": 1, "cases": 2}


def test_too_much_coverage_misses_the_aim_as_too_little_does():
    assert judged(1000, 0.995, 0.99, 0.999, (0.93, 0.97)) == "not met"
