"""A fleet's table, and what all verdicts together show; made of arms whose weaknesses are known."""

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.fleet.members import Member, read_fleet
from armscope.fleet.simulation import WEAKNESSES, arm_spec
from armscope.fleet.summary import outliers, priors, repeated, verdicts
from armscope.report.pages.fleet import write_fleet_page

HEADER = "arm,type,robot,recordings\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("arm,type,robot\na,b,c\n", "no column recordings"),
        (HEADER + "a,,c,d\n", "line 2, column type"),
        (HEADER + "a,b,c,d\na,b,c,e\n", "one diagnosis per arm"),
        (HEADER + "../a,b,c,d\n", "no slash"),
    ],
)
def test_a_table_that_is_no_fleet_is_one_clear_error(tmp_path, text, expected):
    path = tmp_path / "fleet.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=expected):
        read_fleet(path)


def test_an_arm_far_from_its_type_is_an_outlier_and_no_other():
    rng = np.random.default_rng(3)
    sizes = np.exp(rng.normal(0, 0.2, 40))
    sizes[7] *= 10
    table = pd.DataFrame({"arm": [f"a{k}" for k in range(40)], "type": "one", "before_mm": sizes, "after_mm": 1.0})
    from armscope.fleet.summary import _apart

    for name in ("before", "after"):
        table[f"{name}_apart"] = table.groupby("type")[f"{name}_mm"].transform(_apart)
    assert list(outliers(table)["arm"]) == ["a7"]


def test_what_repeats_is_counted_by_arm_not_by_diagnosis():
    named = pd.DataFrame(
        [
            ("a", "one", "x", 1.0, False),
            ("a", "one", "x", 3.0, False),
            ("b", "one", "x", 2.0, False),
            ("c", "one", "y", 9.0, True),
        ],
        columns=["arm", "type", "cause", "rms_at_tool_mm", "minor"],
    )
    often = repeated(named, pd.DataFrame({"arm": ["a", "b", "c"], "type": "one"}))
    assert often[["cause", "arms", "of"]].to_dict("records") == [{"cause": "x", "arms": 2, "of": 3}]
    learned = pd.DataFrame(columns=["type", "cause", "parameter", "unit", "rms", "arms"])
    assert priors(often, learned)["types"]["one"]["causes"]["x"] == {"share": 0.6, "rms_at_tool_mm": 2.0}


def test_a_diagnosis_that_was_not_made_has_a_row_that_says_why(tmp_path):
    members = [Member("gone", "one", tmp_path / "no.yaml", tmp_path / "no.csv", "2026-01")]
    found, failed = verdicts(members, [tmp_path])
    write_fleet_page(members, [tmp_path], tmp_path / "page")
    rows = pd.read_csv(tmp_path / "page" / "arms.csv")
    assert (found, failed) == ({}, {"gone_2026-01": "not diagnosed"})
    assert rows[["arm", "date", "answer", "headline"]].values.tolist() == [
        ["gone", "2026-01", "no verdict", "not diagnosed"]
    ]
    assert rows[["before_mm", "after_mm", "before_apart"]].isna().all(axis=None)


def test_simulated_arms_have_the_weakness_of_their_type_as_a_rule():
    specs = [arm_spec(number, 300, 5) for number in range(299)]
    share = np.mean([any((w.kind, w.location) == WEAKNESSES[s.arm] for w in s.effects) for s in specs])
    assert 0.6 < share < 0.8
