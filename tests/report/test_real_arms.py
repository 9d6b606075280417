"""docs/real-arms.md says what the tables say: which figure is above, which at or below, and where set-ups changed."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
import pytest

from armscope.core.files import write_json, write_table, write_yaml
from armscope.real.transfer import GEOMETRY_HERE, WITH_CURVES
from armscope.report.pages.real_arms import RealArm, write_real_arms
from armscope.report.pages.real_concealed import write_concealment
from armscope.verdict.schema import Background
from tests.report import verdicts


@pytest.fixture
def arm_(tmp_path):
    folder = tmp_path / "results"
    rows = [
        ("run a", "nominal", 1.2, 0.04), ("run a", "armscope", 0.25, 0.01), ("run a", "FDP(CI)", 0.9, 0.0),
        ("run b", "nominal", 3.0, 0.1), ("run b", "armscope", 2.0, 0.2), ("run b", "FDP(CI)", 2.9, 0.0),
    ]  # fmt: skip
    rows.insert(2, ("run a", "armscope, orientations too", 0.22, 0.02))
    table = pd.DataFrame(rows, columns=["run", "model", "mean_mm", "std_mm"]).assign(splits=5, turn_mrad=np.nan)
    table.loc[2, ["splits", "turn_mrad"]] = [2, 0.31]
    write_table(folder / "protocol.csv", table)
    splits = pd.DataFrame([{"run": "run a", "model": "armscope", "split": k, "rms_mm": 0.25} for k in range(5)])
    too = splits.iloc[:2].assign(model="armscope, orientations too")
    write_table(folder / "splits.csv", pd.concat([splits, too]))
    named = [("armscope", k, "joint_compliance", "joint 2", None) for k in range(4)]
    named += [("armscope", k, "base_shift", "base", 86 + k) for k in range(5)]
    named += [("armscope", 0, "gear_ratio", "joint 3", None)]
    named += [("armscope, orientations too", k, "bearing_compliance", "joint 5", None) for k in range(2)]
    names = pd.DataFrame(named, columns=["model", "split", "effect", "location", "row"]).assign(run="run a")
    write_table(folder / "names.csv", names)
    columns = ["learned", "applied", "refitted", "model", "rms_mm", "reference_mm"]
    carried = [("run a", "run b", "base and tool", "armscope", 0.38, 0.41)]
    write_table(folder / "transfer.csv", pd.DataFrame(carried, columns=columns))
    write_table(
        folder / "curves_by_run.csv", pd.DataFrame(columns=["run", "joint", "angle_rad", "turn_rad", "stderr_rad"])
    )
    effect = verdicts.compliance(title="joint compliance at joint 2", rms_at_tool_mm=0.5, share=0.8)
    background = Background("all", True, np.nan, 0.1, 0.1)
    said = verdicts.case(effects=(effect,), background=background, residual_before_mm=0.7).verdict
    write_json(folder / "verdict.json", said.to_json())
    reference = {
        "source": "here",
        "runs": [
            {
                "name": "run a",
                "run": "a",
                "figures_mm": {"nominal": [1.22, 0.05]},
                "best": {"mm": 0.27, "what": "one split"},
            },
            {"name": "run b", "run": "b", "figures_mm": {"nominal": [1.9, 0.1]}},
        ],
    }
    write_yaml(tmp_path / "reference.yaml", reference)
    return RealArm("arm", "An arm, a tracker", folder, tmp_path / "reference.yaml", ("a", None))


def page(arm_, tmp_path):
    write_real_arms(tmp_path / "page.md", [arm_], "figures", "commit abc")
    return (tmp_path / "page.md").read_text(encoding="utf-8")


def test_every_run_stands_beside_the_best_figure_of_others(arm_, tmp_path):
    text = page(arm_, tmp_path)
    assert (
        "| An arm, a tracker | run a | 0.250 ± 0.010 | 0.27 (one split) | at or below | 0.220 ± 0.020 (2 splits) |"
        in text
    )
    assert "| An arm, a tracker | run b | 2.00 ± 0.20 | 1.9 (nominal) | **above** | – |" in text


def test_the_largest_effect_and_what_becomes_of_the_error_are_told(arm_, tmp_path):
    text = page(arm_, tmp_path)
    assert "joint compliance at joint 2 (0.5 mm, 80 %)" in text
    learned = "learned from points – from orientations, too, 0.220 ± 0.020 mm"
    assert f"1.20 mm become 0.250 mm (3D, run a, 5 splits; {learned})" in text
    assert "| **0.250 ± 0.010** | 0.220 ± 0.020 (2 splits) | 0.310 | 0.27 |" in text


def test_effects_and_small_errors_stand_in_order_of_the_share_that_is_printed(arm_, tmp_path):
    effects = [
        verdicts.compliance(title=f"cause {share}", rms_at_tool_mm=size, share=share / 100, minor=False)
        for share, size in ((30, 0.2), (12, 0.4), (9, 0.1), (4, 0.1))
    ]
    background = Background("all", True, np.nan, 0.1, 0.25)
    said = verdicts.case(effects=effects, background=background, residual_before_mm=0.7).verdict
    write_json(arm_.folder / "verdict.json", said.to_json())
    text = page(arm_, tmp_path)
    told = re.search(r"is, the largest share first: (.*?)\. On configurations", text)[1].split("; ")
    assert [re.search(r"\d+(?= %)", each)[0] for each in told[:4]] == ["30", "25", "12", "9"]
    assert told[4:] == ["besides, 1 smaller effect"]
    assert text.count("share of the squared error\nthat base and tool leave") == 1


def test_names_of_most_splits_and_jumps_within_some_rows_of_each_other_are_told(arm_, tmp_path):
    text = page(arm_, tmp_path)
    assert "joint compliance joint 2 (4/5)" in text
    assert "gear ratio" not in text
    assert "run a, orientations too: bearing compliance joint 5 (2/2)" in text
    assert "bearing compliance joint 5 (2/5)" not in text
    assert "base at id 86–90 (5/5)" in text


def test_transfers_stand_beside_their_references(arm_, tmp_path):
    text = page(arm_, tmp_path)
    assert "| run a | run b | base and tool | 0.380 (0.41) |" in text
    assert "Curves of joints" not in text


def test_fewer_splits_than_the_reference_are_told(arm_, tmp_path):
    table = pd.read_csv(arm_.folder / "protocol.csv")
    table.loc[table["model"] == "armscope", "splits"] = [1, 3]
    write_table(arm_.folder / "protocol.csv", table)
    text = page(arm_, tmp_path)
    assert "| run a | 0.250 (one split) |" in text
    assert "| run b | 2.00 ± 0.20 (3 splits) |" in text


def test_what_was_concealed_is_told_with_what_was_not(arm_, tmp_path):
    proof = tmp_path / "proof"
    rate = {"half": "both", "size": 3.0, "score": "found", "cases": 4, "right": 3, "estimate": 0.75}
    rates = [rate | {"by": by, "of": of} for by, of in (("all", "all"), ("effect", "gear_mesh"), ("arm", "arm"))]
    write_table(proof / "rates.csv", pd.DataFrame(rates))
    skipped = {"set": "arm", "effect": "joint_compliance", "size": 3.0, "half": "fixed", "reason": "no load"}
    others = [skipped | {"half": "fresh"}, skipped | {"size": 0.5}]
    write_table(proof / "skipped.csv", pd.DataFrame([skipped, *others]))
    withheld = {
        "set": "arm", "rows": "run", "withheld": "torques withheld", "orientations": True, "load_found": False,
        "compliance_found": False, "follows_load": None, "background_mm": 0.4, "held_out_mm": 0.31,
    }  # fmt: skip
    write_table(proof / "withheld.csv", pd.DataFrame([withheld]))
    write_concealment(tmp_path / "page.md", proof, {"arm": "An arm", "other": "Other"}, "commit abc")
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "| An arm | 3 | 75 % (3/4) | – | – | – | – |" in text
    assert "| gear mesh | 3 | 75 % (3/4) |" in text
    assert "Not run for this page: Other." in text
    assert text.count("| joint compliance | An arm | 0.5, 3 | no load |") == 1
    assert (
        "| An arm | all joints move | points and orientations | torques withheld | nothing | no | 0.400 | 0.310 |"
        in text
    )


def test_curves_of_two_runs_are_told_with_what_they_are_worth(arm_, tmp_path):
    columns = ["learned", "applied", "refitted", "model", "rms_mm", "reference_mm"]
    carried = [
        ("run a", "run b", "base and tool", model, value, None)
        for model, value in ((GEOMETRY_HERE, 0.44), (WITH_CURVES, 0.11))
    ]
    write_table(arm_.folder / "transfer.csv", pd.DataFrame(carried, columns=columns))
    at = np.linspace(-1, 1, 200)
    curves = [
        pd.DataFrame({"run": run, "joint": "joint 3", "angle_rad": at, "turn_rad": np.sin(12 * at), "stderr_rad": 0.0})
        for run in ("run a", "run b")
    ]
    write_table(arm_.folder / "curves_by_run.csv", pd.concat(curves))
    text = page(arm_, tmp_path)
    assert "on run b with the curves of run a 0.440 mm become 0.110 mm" in text
    assert "joint 3 1.00 over 115°" in text
    assert "figures/real-arm-curves.png" in text


def test_runs_whose_compliances_do_not_agree_are_named(arm_, tmp_path):
    assert "say the same" not in page(arm_, tmp_path)
    value = {"learned": "points alone", "noise_mm": 0.1, "masses": 1.4, "stderr": 10.0, "low": 40.0, "high": 82.0}
    values = [value | {"run": run, "of": "joint 2", "value": 61.0} for run in "ab"]
    values += [value | {"run": run, "of": "drive 2 + 0.5 drive 4", "value": 90.0} for run in "abc"]
    values[0]["reference"] = 62.5
    write_table(arm_.folder / "compliances.csv", pd.DataFrame(values))
    pair = {"learned": "points alone", "directions": 2, "statistic": 1.0, "one_value": 90.0, "other_value": 50.0}
    pairs = [
        pair | {"one": "a", "other": other, "of": of, "probability": chance, "difference": 40.0, "stderr": stderr}
        for other, chance in (("b", 0.4), ("c", 1e-4))
        for of, stderr in (("drive 2 + 0.5 drive 4", 10.0), ("drive 3", 30.0))
    ]
    write_table(arm_.folder / "compliances_agree.csv", pd.DataFrame(pairs))
    simulated = {"learned": "points alone", "one": "a", "other": "b", "arms": 9, "numbers": 20, "held": 19}
    kinds = [simulated | {"arm": "the same arm", "agree": 8}, simulated | {"arm": "a softer one", "agree": 1}]
    write_table(arm_.folder / "compliances_simulated.csv", pd.DataFrame(kinds))
    text = page(arm_, tmp_path)
    assert "drives on a: joint 2 61 ± 21 (others: 62.5)." in text
    assert "1 of 2 pairs of runs agree, **these do not: a and c**" in text
    assert "| points alone | a, c | 2 | **1e-04** | drive 2 + 0.5 drive 4: 90 and 50, apart by 40 ± 21 |" in text
    assert "8 of 9 on the same arm, 1 of 9 on a softer one agree, 95 % of the drives' intervals" in text
    assert "figures/real-arm-compliances.png" in text


def test_regions_that_took_no_part_stand_beside_plain_calibrations(arm_, tmp_path):
    rows = [
        ("run a", "the last", "geometric", 70, 30, 0.5, 0.4), ("run a", "the last", "armscope", 70, 30, 0.25, 0.2),
        ("run a", "the highest", "geometric", 70, 30, 0.3, 0.2), ("run a", "the highest", "armscope", 70, 30, 0.6, 0.1),
    ]  # fmt: skip
    columns = ["run", "region", "model", "train", "test", "rms_mm", "median_mm"]
    write_table(arm_.folder / "regions.csv", pd.DataFrame(rows, columns=columns))
    write_real_arms(tmp_path / "page.md", [arm_], "figures", "commit abc")
    page = (tmp_path / "page.md").read_text()
    assert "| run a | the last (30 rows) | 0.500 (0.400) | **0.250** (0.200) |" in page
    assert "| run a | the highest (30 rows) | **0.300** (0.200) | 0.600 (0.100) |" in page
    assert "foretells 1 of 2 at least as well" in page
    assert "1.25 times that one's (median; at worst 2.00)" in page
