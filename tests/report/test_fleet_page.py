"""A simulated fleet, diagnosed and told in one page; an arm without files costs only itself."""

from pathlib import Path

import pandas as pd
import pytest

from armscope.diagnosis import Settings
from armscope.fleet.members import FAILURE, diagnose_members, read_fleet
from armscope.fleet.simulation import simulate
from armscope.fleet.summary import arms, causes_of_arms, verdicts
from armscope.report.figures.fleet import fleet_figure
from armscope.report.html import render_page
from armscope.report.pages.fleet import write_fleet_page


@pytest.mark.long
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
    named = causes_of_arms(members, found)
    assert len(fleet_figure(named).axes) == 2
    heads = page[page.index("arms with it") :].split("</th>")
    assert heads[1].rpartition(">")[2].strip() == "of", "2 of 6 is read in one go"
    assert "No type has five arms" in page
    assert "no arm is far" not in page, "nobody was compared"


def test_a_large_fleet_is_as_wide_as_its_page_and_its_words_as_high_as_the_pages():
    causes = [f"{name} at joint {j}" for name in ("backlash", "joint_offset", "gear_ratio") for j in range(1, 7)]
    rows = [(cause, f"arm-{n:03d}") for n in range(40) for cause in causes[: 1 + n % 18]]
    table = pd.DataFrame(rows, columns=["cause", "arm"]).assign(minor=False, type="six-axis", date="2026-01", run="")
    figure = fleet_figure(table.assign(rms_at_tool_mm=0.1))
    assert figure.get_figwidth() * 96 <= 1016, "the page's own width"
    labels = [*figure.axes[0].get_xticklabels(), *figure.axes[0].get_yticklabels()]
    assert min(label.get_fontsize() for label in labels) >= 9


def test_the_fleets_page_keeps_what_its_colours_mean_and_gives_words_their_room(tmp_path):
    of = {"arm": ["a", "b"], "type": "six-axis", "answer": "mismatch", "headline": "Joint 2 gives way."}
    page = render_page(
        "fleet.html.j2", arms=pd.DataFrame(of), outliers=[], common=[], repeated=pd.DataFrame(of), failed=[],
        figure=None, wide_px=900, comparable=False, fewest="five", types="one", limit=3, share=0.3,
    )  # fmt: skip
    assert "figure.as-drawn img { filter: none;" in page
    assert "td.words:last-child { min-width: 22rem; }" in page
    assert "rows that were fitted" in page


@pytest.mark.parametrize("sizes", [[2.0, 5.5], [0.03, 3.1], [0.9, 1.2]])
def test_the_colour_bar_has_plain_numbers(sizes):
    of = {"minor": False, "type": "six-axis", "arm": ["a", "b"], "date": "", "run": "", "rms_at_tool_mm": sizes}
    figure = fleet_figure(pd.DataFrame({"cause": ["joint_offset at joint 1", "backlash at joint 2"], **of}))
    figure.canvas.draw()
    told = [each.get_text() for each in figure.axes[1].xaxis.get_ticklabels(which="both")]
    shown = [each for each in told if each]
    assert shown
    assert all(0.009 < float(each) < 11 for each in shown)
    assert not any("e" in each for each in shown), "no power of ten"
