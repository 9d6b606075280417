"""A simulated fleet, diagnosed and told in one page; an arm without files costs only itself."""

from pathlib import Path

import pandas as pd
import pytest

from armscope.diagnosis import Settings
from armscope.fleet.diagnosing import FAILURE, diagnose_members
from armscope.fleet.members import read_fleet
from armscope.fleet.simulation import simulate
from armscope.fleet.summary import arms, causes_of_arms, verdicts
from armscope.report.figures.fleet import fleet_figure
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


@pytest.mark.parametrize("sizes", [[2.0, 5.5], [0.03, 3.1], [0.9, 1.2]])
def test_the_colour_bar_has_plain_numbers(sizes):
    of = {"minor": False, "type": "six-axis", "arm": ["a", "b"], "date": "", "run": "", "rms_at_tool_mm": sizes}
    figure = fleet_figure(pd.DataFrame({"cause": ["joint_offset at joint 1", "backlash at joint 2"], **of}))
    figure.canvas.draw()
    told = [each.get_text() for each in figure.axes[1].yaxis.get_ticklabels(which="both")]
    shown = [each for each in told if each]
    assert shown
    assert all(0.009 < float(each) < 11 for each in shown)
    assert not any("e" in each for each in shown), "no power of ten"
