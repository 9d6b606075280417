"""The pages of arms in motion are filled from the library and from results."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.report.pages.motion_docs import cause_lines, fill_motion_pages

DOCS = Path(__file__).parents[2] / "docs"
PAGES = ("motion-causes.md", "motion-measured.md")
VERDICT = Path(__file__).parents[1] / "fuzz" / "corpus" / "motion-verdict" / "moving-arm.json"


def test_the_page_names_every_cause_of_the_library_as_it_is() -> None:
    text = (DOCS / PAGES[0]).read_text(encoding="utf-8")
    assert "\n".join(cause_lines()) in text


def test_rates_and_real_arms_come_from_results(tmp_path: Path) -> None:
    for name in PAGES:
        (tmp_path / name).write_text((DOCS / name).read_text(encoding="utf-8"), encoding="utf-8")
    rates = [("clean silent", "all", 8, 0.875, 0.4, 0.99, "not met"), ("clean silent", "fresh", 4, 1, 0.4, 1, "x")]
    names = ["aim", "seeds", "cases", "estimate", "low", "high", "verdict"]
    pd.DataFrame(rates, columns=names).to_csv(tmp_path / "summary.csv", index=False)
    pd.DataFrame({"world": range(12)}).to_csv(tmp_path / "proof.csv", index=False)
    (tmp_path / "arm").mkdir()
    content = json.loads(VERDICT.read_text(encoding="utf-8"))
    content["held_out"] |= {"stated": 0.5, "background": 0.1, "model": 0.034, "what": "each run in turn"}
    content["headline"] = "Nothing. On held-out motion"
    (tmp_path / "arm" / "verdict.json").write_text(json.dumps(content), encoding="utf-8")
    fill_motion_pages(tmp_path, tmp_path, tmp_path, "commit abc")
    text = (tmp_path / PAGES[1]).read_text(encoding="utf-8")
    assert "| clean silent | 8 | 88 % (40 %–99 %) | not met |" in text
    assert "commit abc, 12 worlds" in text
    assert "| arm | each run in turn | 50 % | 10 % | 3.4 % | Nothing. |" in text
    assert text.count("clean silent") == 1


def test_a_page_without_marks_is_refused(tmp_path: Path) -> None:
    for name in PAGES:
        (tmp_path / name).write_text("nothing\n", encoding="utf-8")
    with pytest.raises(InputError, match="marks"):
        fill_motion_pages(tmp_path, None, None, "")
