"""The figures of the bench are counts by family, told the harder ones first, and the pages hold what was told."""

import json
from pathlib import Path

import numpy as np
import pytest
from tools import bench, why_a_name

from armscope.core.inputs import InputError

BENCH = Path(__file__).parents[3] / "shared" / "bench"


def case(family, right, **marks):
    return {"family": family, "right": right, "fp": 0, "ratio": 1.0, "pairs": [], **marks}


@pytest.fixture
def told():
    pairs = [[0.1, True], [0.2, False], [0.3, None]]
    cases = [case("control", True) for _ in range(3)]
    cases += [case("realistic", right, fp=2, ratio=ratio, pairs=pairs) for right, ratio in ((True, 1.2), (False, 1.4))]
    return bench.figures({"cases": cases}, "abc1234")


def test_a_case_is_diagnosed_and_predicted_without_what_was_measured(tmp_path, monkeypatch):
    seen, asked = tmp_path / "bench" / "cases" / "d001", []
    seen.mkdir(parents=True)
    (seen / "test.csv").write_text("q1_rad,x_mm,y_mm,z_mm,run\n0.10,1,2,3,a\n")

    def called(command, done, *arguments):
        asked.append((command, *arguments))
        if command == "diagnose" and done:
            (tmp_path / "out" / "d001" / "diagnosis").mkdir()
            (tmp_path / "out" / "d001" / "diagnosis" / "verdict.json").write_text("{}")
        return done

    for done, commands in ((False, ["diagnose"]), (True, ["diagnose", "predict"])):
        asked.clear()
        monkeypatch.setattr(bench, "_armscope", lambda command, *rest, done=done: called(command, done, *rest))
        bench.run(tmp_path / "bench", tmp_path / "out", ["d001"])
        assert [each[0] for each in asked] == commands
        assert (tmp_path / "out" / "d001" / "verdict.json").is_file() == done
    assert (tmp_path / "out" / "d001" / "poses.csv").read_text() == "q1_rad,run\n0.10,a\n"


def test_figures_are_counted_by_family(told):
    assert told["families"]["realistic"] == {
        "cases": 2, "right": 1, "false_names": 4, "held_out_ratio": pytest.approx(1.3), "intervals": 4, "covered": 2,
    }  # fmt: skip
    assert told["families"]["multi"]["cases"] == 0
    assert told["families"]["multi"]["held_out_ratio"] is None


def test_a_case_without_prediction_has_no_ratio():
    told = bench.figures({"cases": [case("multi", False, ratio=None)]}, "abc1234")
    assert " 0 | 0–98 % | 0 | – | – |" in bench.table(told)


def test_harder_families_come_first_with_exact_intervals(told):
    for text in (bench.table(told), bench.short_table(told)):
        rows = [line for line in text.splitlines() if line.startswith("| ")][1:]
        assert [row.split()[1].strip(":") for row in rows] == ["realistic", "control"]
        assert "1–99 %" in rows[0]  # Clopper-Pearson of 1 in 2: 1.3-98.7 %
        assert "29–100 %" in rows[1]  # of 3 in 3: 0.025 ** (1 / 3) = 0.292
        assert "not a blind measure" in text
        assert "abc1234" in text


def test_pages_are_filled_between_their_marks_and_stay_when_filled_again(told, tmp_path):
    (tmp_path / "docs").mkdir()
    (tmp_path / "figures.json").write_text(json.dumps(told))
    pages = [tmp_path / "README.md", tmp_path / "docs" / "why-a-name.md"]
    for page in pages:
        page.write_text(f"before\n{bench.BEGIN} (by whom) -->\nstale\n{bench.END}\nafter\n")
    bench.fill(tmp_path / "figures.json", tmp_path)
    once = [page.read_text() for page in pages]
    assert all("stale" not in text and text.startswith("before\n") and text.endswith("\nafter\n") for text in once)
    bench.fill(tmp_path / "figures.json", tmp_path)
    assert [page.read_text() for page in pages] == once


def test_a_page_without_marks_is_left_alone(tmp_path):
    with pytest.raises(InputError, match="no marks"):
        bench.filled(tmp_path / "page.md", "nothing here", "block")


def test_the_pages_tell_the_same_figures():
    def counts(page):
        text = (why_a_name.ROOT / page).read_text(encoding="utf-8")
        block = text.partition(bench.BEGIN)[2].partition(bench.END)[0]
        rows = [line.strip("| ").split(" | ") for line in block.splitlines() if line.startswith("| ")][1:]
        first = [row.index(next(cell for cell in row if cell.isdigit())) for row in rows]
        return [row[at : at + 4] for row, at in zip(rows, first, strict=True)]

    assert counts("README.md") == counts("docs/why-a-name.md") != []


def test_every_family_of_the_bench_is_told():
    if not (BENCH / "README.md").is_file():
        pytest.skip(f"{BENCH} is not there")
    text = (BENCH / "README.md").read_text(encoding="utf-8").partition("## Families")[2].partition("\n\nFour arms")[0]
    names = [name for line in text.splitlines()[4:] for name in line.split("|")[1].split("/")]
    assert {name.strip() for name in names} == set(bench.FAMILIES)


def test_the_arm_of_the_pictures_has_a_little_everywhere_and_a_story_that_stands_out():
    effects = why_a_name.world().effects
    assert effects[: len(why_a_name.STORY)] == why_a_name.STORY
    places = [(asked.kind, asked.location) for asked in effects]
    assert len(set(places)) == len(places)
    largest = {kind: max(w.strength for w in effects if w.minor and w.kind == kind) for kind in why_a_name.EVERYWHERE}
    assert all(asked.strength > largest.get(asked.kind, 0.0) for asked in why_a_name.STORY)


def test_a_picture_shows_what_did_not_pay():
    told = [why_a_name.Step("backlash", 9.9, 500.0), why_a_name.Step("too little?", 9.9, 4.0)]
    (panel,) = why_a_name.evidence_figure(told).axes
    assert [text.get_text() for text in panel.texts] == ["500", "4.0, price 9.9: stays out"]
    assert np.allclose([bar.get_width() for bar in panel.patches], [500.0, 4.0])
