"""A fleet's table, and what all verdicts together show; made of arms whose weaknesses are known."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.diagnosis import Settings
from armscope.fleet.diagnosing import FAILURE, diagnose_members
from armscope.fleet.members import read_fleet
from armscope.fleet.simulation import WEAKNESSES, _spec, simulate
from armscope.fleet.summary import arms, outliers, priors, repeated, verdicts
from armscope.report.pages.fleet import write_fleet_page

HEADER = "arm,type,robot,recordings\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("arm,type,robot\na,b,c\n", "no column recordings"),
        (HEADER + "a,,c,d\n", "row 2, column type"),
        (HEADER + "a,b,c,d\na,b,c,e\n", "one diagnosis per arm"),
        (HEADER + "../a,b,c,d\n", "no slash"),
    ],
)
def test_a_table_that_is_no_fleet_is_one_clear_error(tmp_path, text, expected):
    path = tmp_path / "fleet.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=expected):
        read_fleet(path)


def test_diagnoses_of_a_simulated_fleet_end_in_one_page(tmp_path):
    simulate(2, 1, Path("config/robots"), tmp_path / "made")
    table = tmp_path / "made" / "fleet.csv"
    with table.open("a") as stream:
        stream.write("gone,six-axis,2026-01,nothing.yaml,nothing.csv\n")
    members = read_fleet(table)
    diagnose_members(members, tmp_path / "verdicts", Settings(resamples=0, cross_validation=False))
    assert (tmp_path / "verdicts" / "gone_2026-01" / FAILURE).is_file()
    found, failed = verdicts(members, [tmp_path / "verdicts"])
    assert (len(found), list(failed)) == (2, ["gone_2026-01"])
    write_fleet_page(members, [tmp_path / "verdicts"], tmp_path / "page")
    page = (tmp_path / "page" / "report.html").read_text()
    assert "1 without a verdict" in page
    assert len(arms(members, found)) == 2


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
    assert priors(often)["types"]["one"]["causes"]["x"] == {"share": 0.6, "rms_at_tool_mm": 2.0}


def test_simulated_arms_have_the_weakness_of_their_type_as_a_rule():
    specs = [_spec(number, 300, 5) for number in range(299)]
    share = np.mean([any((w.kind, w.location) == WEAKNESSES[s.arm] for w in s.wishes) for s in specs])
    assert 0.6 < share < 0.8
