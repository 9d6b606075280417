"""The README's numbers come from files, and nothing else of it changes."""

import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.report.pages.readme import _percent, fill_readme

TEXT = "# before\n<!-- results: begin (by a rule) -->\nold numbers\n<!-- results: end -->\nafter\n"
TEXT = TEXT.replace("# before\n", "# before\n<!-- proof: begin -->\nof a former proof\n<!-- proof: end -->\n")


@pytest.fixture
def results(tmp_path):
    claim = {"key": "alternative", "claim": "It works", "robots": 100, "depends_on": "", "share_least": 0.0}
    shares = {"share": 1.0, "share_low": 0.96, "share_high": 1.0, "share_most": 1.0}
    rows = [
        {**claim, **shares, "method": "improved", "verdict": "holds", "under_assumptions": "holds under all"},
        {**claim, **shares, "method": "as printed", "verdict": "fails", "under_assumptions": "fails under all"},
        {
            **claim,
            **shares,
            "key": "second_degree",
            "claim": "NOT FOR THE README",
            "method": "improved",
            "verdict": "holds",
        },
    ]
    pd.DataFrame(rows).to_csv(tmp_path / "claims.csv", index=False)
    searched = {"searched": "4096 sets of corners", "thorough": True}
    joint = {"trajectory": "test 1", "reading": "rss", "check": "all together", "possible": False, **searched}
    pd.DataFrame([joint]).to_csv(tmp_path / "audit.csv", index=False)
    names = ("identification", "test 1", "test 2", "test 3")
    rows = [
        ("FDP(CI)", name, axis, 3.0 if axis != "3D" else None, 6.0, 4.0, 9.0)
        for name in names
        for axis in ("x", "y", "z", "3D")
    ]
    columns = ["model", "trajectory", "axis", "printed", "rss_ensemble_median", "rss_ensemble_low", "rss_ensemble_high"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "table2.csv", index=False)
    aim = {
        "aim": "no name on clean arms",
        "seeds": "fresh",
        "cases": 24,
        "estimate": 1.0,
        "low": 0.86,
        "high": 1.0,
        "verdict": "met",
    }
    pd.DataFrame([aim, aim | {"seeds": "fixed", "verdict": "NOT TO BE SHOWN"}]).to_csv(
        tmp_path / "aims.csv", index=False
    )
    pd.DataFrame({"world": range(439)}).to_csv(tmp_path / "worlds.csv", index=False)
    return tmp_path


def test_numbers_between_the_marks_are_replaced_by_those_of_the_results(results):
    readme = results / "README.md"
    readme.write_text(TEXT)
    fill_readme(readme, results, results)
    text = readme.read_text()
    assert text.startswith("# before\n<!-- proof: begin -->\n")
    assert "<!-- proof: end -->\n<!-- results: begin (by a rule) -->\n" in text
    assert text.endswith("<!-- results: end -->\nafter\n")
    assert "old numbers" not in text
    assert "of a former proof" not in text
    assert "| It works | fails: 100 % (96–100) | holds: 100 % (96–100) | holds under all (0–100 %) |" in text
    assert "NOT FOR THE README" not in text
    assert "*No path that the text allows" in text
    assert "| FDP(CI) | 6.0 (4.0–9.0) / 5.2 |" in text  # 5.2 = sqrt(3) * 3, the length of the printed x, y, z
    assert "| no name on clean arms | 24 | 100 % (86–100) | met |" in text
    assert "NOT TO BE SHOWN" not in text


def test_filling_twice_gives_the_same_file(results):
    readme = results / "README.md"
    readme.write_text(TEXT)
    fill_readme(readme, results, results)
    once = readme.read_bytes()
    fill_readme(readme, results, results)
    assert readme.read_bytes() == once


def test_what_is_said_of_the_proof_stays_where_its_tables_are_missing(results):
    readme = results / "README.md"
    readme.write_text(TEXT)
    fill_readme(readme, results, results / "no proof here")
    text = readme.read_text()
    assert "of a former proof" in text
    assert "old numbers" not in text


def test_a_readme_without_marks_is_left_alone(results):
    readme = results / "README.md"
    readme.write_text("nothing here")
    with pytest.raises(InputError, match="no marks"):
        fill_readme(readme, results, results)
    assert readme.read_text() == "nothing here"


def test_rounding_does_not_hide_why_an_aim_is_not_met():
    assert [_percent(share) for share in (1.0, 0.998, 0.99999, 0.95, 0.004, 0.0004, 0.0)] == [
        "100", "99.8", "99.999", "95", "0.4", "0.04", "0",
    ]  # fmt: skip
