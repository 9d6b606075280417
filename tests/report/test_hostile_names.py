"""Whatever names a user's files hold, the page shows them and obeys none of them."""

from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest
import yaml
from typer.testing import CliRunner

from armscope.cli import app
from armscope.report.html import html_table

EXAMPLE = Path(__file__).parents[2] / "examples" / "clean"
EVIL = '<img src=x onerror="alert(1)"></script><script>alert(2)</script>&amp;\'$\\frac{$'


class Page(HTMLParser):
    """The scripts and attributes that a browser would find."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.scripts, self.handlers, self.text, self._inside = [], [], "", None

    def handle_starttag(self, tag, attributes):
        self._inside = tag
        self.handlers += [name for name, _ in attributes if name.startswith("on")]
        if tag == "script":
            self.scripts.append("")

    def handle_data(self, data):
        if self._inside == "script":
            self.scripts[-1] += data
        self.text += data


def parsed(html):
    page = Page()
    page.feed(html)
    return page


def test_a_table_shows_names_and_headings_as_they_are():
    page = parsed(str(html_table(pd.DataFrame({EVIL: [EVIL, "b"], "n": [1.0, 2.0]}))))
    assert page.scripts == page.handlers == []
    assert page.text.count(EVIL) == 2


@pytest.fixture(scope="module")
def reported(tmp_path_factory):
    """A report on recordings whose every name is hostile, and one on the same with harmless names."""
    folder, pages = tmp_path_factory.mktemp("hostile"), {}
    for kind, word in (("harmless", "plain"), ("hostile", EVIL)):
        table = pd.read_csv(EXAMPLE / "recordings.csv", dtype={"run": str}).head(60)
        table["run"] = word + table["run"].astype(str)
        table["id"] = [f"{word} {row}" for row in range(len(table))]
        table["target"] = word
        table.loc[5, "x_mm"] += 30  # a suspect row, which is listed by its id
        table[word] = 1.0
        table.to_csv(folder / f"{kind}.csv", index=False)
        robot = yaml.safe_load((EXAMPLE / "robot.yaml").read_text())
        (folder / f"{kind}.yaml").write_text(yaml.safe_dump(robot | {"name": word}))
        line = ["diagnose", folder / f"{kind}.csv", "-r", folder / f"{kind}.yaml", "-o", folder / kind]
        done = CliRunner().invoke(app, [*map(str, line), "--resamples", "0", "--no-cross-validation"])
        assert done.exit_code == 0, done.exception
        pages[kind] = parsed((folder / kind / "report.html").read_text())
    return pages


@pytest.mark.long
def test_a_report_on_hostile_names_has_the_scripts_of_one_on_harmless_names(reported):
    hostile, harmless = reported["hostile"], reported["harmless"]
    assert len(hostile.scripts) == len(harmless.scripts)
    assert hostile.handlers == harmless.handlers
    assert EVIL in hostile.text


NAME = EVIL.replace("/", "|").replace("\\", "|")
"""A folder of a fleet's verdicts may have this name."""
STEERING = "\x1b[31m\x9b31m\u202e"
"""A file's name may hold any of these; names inside tables are refused if they do."""


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """All pages of a diagnosis of motions and of a fleet whose names are hostile, those of files included."""
    folder, word = tmp_path_factory.mktemp("pages"), NAME
    moving = EXAMPLE.parent / "moving-arm"
    motions = pd.read_csv(moving / "test.csv.gz").assign(**{"run": word, word: 1.0})
    motions.to_csv(folder / f"{STEERING}{word}.csv", index=False)
    arm = folder / "arm.yaml"
    arm.write_text(yaml.safe_dump(yaml.safe_load((moving / "robot.yaml").read_text()) | {"name": word}))
    points = pd.read_csv(EXAMPLE / "recordings.csv").head(60)
    points.to_csv(folder / f"{STEERING}{word} points.csv", index=False)
    files = {"robot": str(EXAMPLE / "robot.yaml"), "recordings": str(folder / f"{STEERING}{word} points.csv")}
    rows = [{"arm": word + "1", "type": word, **files}, {"arm": word, "type": word, "robot": "no", "recordings": "no"}]
    pd.DataFrame(rows).to_csv(folder / "fleet.csv", index=False)
    table = folder / f"{STEERING}{word}.csv"
    words = [["diagnose", table, "-r", arm, "-o", folder / "motions", "--anyway"]]
    words += [["fleet", "diagnose", folder / "fleet.csv", "-o", folder / "verdicts"]]
    words += [["fleet", "page", folder / "fleet.csv", "--verdicts", folder / "verdicts", "-o", folder / "fleet"]]
    for line in words:
        done = CliRunner().invoke(app, [str(each) for each in line])
        assert done.exit_code == 0, done.exception
    found = {path.relative_to(folder).as_posix(): path.read_text() for path in folder.rglob("*.html")}
    assert {"motions/report.html", "motions/work-order.html", "fleet/report.html"} <= set(found)
    return found


@pytest.mark.long
def test_pages_of_motions_and_fleets_run_nothing_that_a_name_holds(pages):
    for name, html in pages.items():
        page = parsed(html)
        assert page.handlers == page.scripts == [], name
        assert NAME in page.text, name
        assert not set("\x1b\x9b\u202e") & set(html), name


def test_what_a_command_says_of_a_file_can_not_steer_a_terminal(tmp_path):
    table = tmp_path / f"{STEERING}.csv"
    table.write_text((EXAMPLE / "recordings.csv").read_text())
    said = CliRunner().invoke(app, ["check", str(table)])
    assert said.exit_code == 0
    assert "\\x1b[31m\\x9b31m\\u202e.csv" in said.output
    assert not set("\x1b\x9b\u202e") & set(said.output)


def test_a_name_can_not_steer_a_terminal(tmp_path):
    (tmp_path / "a.csv").write_text("q1_rad,x_mm,y_mm,z_mm,\x1b[31mred\n1,2,3,4,5\n")
    (tmp_path / "b.csv").write_text("q1_rad,x_mm,y_mm,z_mm,run\n1,2,3,4,\x1b]0;title\x07\n")
    (tmp_path / "\x1b[31m.csv").write_text("nothing\n")
    for name in ("a.csv", "b.csv", "\x1b[31m.csv"):
        error = str(CliRunner().invoke(app, ["check", str(tmp_path / name)]).exception)
        assert "\x1b" not in error
        assert "\x07" not in error
        assert "\\x1b" in error
