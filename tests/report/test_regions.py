"""Regions that took no part, in words: what is lowest, what is missing, and the sentence over all arms."""

import pandas as pd

from armscope.report.text.regions import region_lines, regions_won

COLUMNS = ["run", "region", "model", "train", "test", "rms_mm", "median_mm"]


def _write(folder, *rows):
    folder.mkdir()
    pd.DataFrame(rows, columns=COLUMNS).to_csv(folder / "regions.csv", index=False)
    return folder


def test_without_regions_nothing_is_said(tmp_path):
    assert region_lines(tmp_path) == ""
    assert regions_won([tmp_path]) == ""


def test_a_model_that_a_run_does_not_have_is_a_dash(tmp_path):
    run = ("the last", "nominal", 7, 3, 2.0, 1.0), ("the last", "armscope", 7, 3, 1.0, 0.5)
    other = ("b", "the last", "compliance", 7, 3, 0.5, 0.25)
    folder = _write(tmp_path / "arm", *(("a", *row) for row in run), other)
    lines = region_lines(folder).splitlines()
    assert "| a | the last (3 rows) | 2.00 (1.00) | **1.00** (0.500) | – |" in lines
    assert "| b | the last (3 rows) | – | – | **0.500** (0.250) |" in lines
    assert any("+ compliance" in line for line in lines)


def test_the_sentence_counts_regions_of_all_arms(tmp_path):
    one = _write(tmp_path / "one", ("a", "r", "nominal", 7, 3, 2.0, 1.0), ("a", "r", "armscope", 7, 3, 1.0, 0.5))
    two = _write(tmp_path / "two", ("a", "r", "nominal", 7, 3, 1.0, 1.0), ("a", "r", "armscope", 7, 3, 3.0, 0.5))
    told = regions_won([one, two])
    assert "foretells 1 of 2 at least as well" in told
    assert "1.75 times that one's (median; at worst 3.00)" in told
