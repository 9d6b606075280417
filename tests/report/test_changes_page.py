"""The page of a comparison: what changed, by how much and what to do about it, from whatever names the files hold."""

import json
import subprocess
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.comparison import Change, Comparison, Left, Seen, Valued, compare
from armscope.comparison.bad_shots import BadShot
from armscope.comparison.constants import SHARED
from armscope.comparison.noisier import Noisier, Scatter
from armscope.report.pages.changes import first_to_last, in_odds, recordings_table, write_changes
from tests.comparison.test_changes import ARM, session
from tests.report.test_dark_pages import CHROMIUM
from tests.report.test_hostile_names import EVIL, STEERING, parsed

SINCE = (0.0, 8.7e-4), (0.0, 1e-5)
NUMBER = Valued("offset", "rad", (9e-4, 1.77e-3), (1e-4,) * 2, *SINCE, 8.7e-4, (8.5e-4, 8.9e-4))
CHANGE = Change(
    "joint_offset", "joint 3", "joint offset at joint 3", ("after",), ("before",), "grew", 0.296, 1e-9, (NUMBER,), ()
)
FOUND = Comparison(
    "arm", ("before", "after"), (70, 71), 0.03, 1e-9, 0.05, 100, (CHANGE,), (("before", "after"),),
    (Left(1.37, 0.121, 0.031), Left(1.41, 0.133, 0.032)),
)  # fmt: skip


def page_of(found, folder):
    return write_changes(found, folder).read_text()


def words_of(found, folder):
    return " ".join(
        parsed(page_of(found, folder).replace("<td", " <td").replace("<br", " <br")).text.replace("\u00a0", " ").split()
    )


def test_a_change_is_told_with_its_numbers_and_what_to_do(tmp_path):
    said = words_of(FOUND, tmp_path)
    assert 'Joint offset at joint 3 grew in "after".' in said
    assert "0.296 mm" in said
    assert "0.900 mrad 1.770 mrad +0.870 mrad +0.0498° 0.850 … 0.890 mrad" in said
    assert 'between "before" and "after"' in said
    assert "Reset the zero of joint 3: it moved by +0.0498° (+0.870 mrad ± 0.020)." in said
    assert "commanded = wanted - offset" in said
    assert "Here offset = +0.0498°" in said, "by the change, not by all that is off"
    assert "less than 1 in a million" in said
    assert json.loads((tmp_path / "comparison.json").read_text())["changes"][0]["kind"] == "grew"
    assert (tmp_path / "history.png").is_file()
    assert '<img src="data:image/svg+xml' in (tmp_path / "changes.html").read_text()


@pytest.mark.parametrize("changes", [(CHANGE,), ()])
def test_a_recording_of_which_more_is_left_is_told_with_its_joint(changes, tmp_path):
    grown = Noisier("after", "before", 0.18, 0.03, 1e-20, (Scatter("joint 5", 3e-4),))
    said = words_of(replace(FOUND, changes=changes, noisier=(grown,), p_nothing_changed=0.4), tmp_path)
    assert '"after" is left with 0.18 mm per axis whatever is fitted, "before" with 0.03 mm, as if joint 5' in said
    assert "by 300 µrad or more" in said
    assert "Nothing changed" not in said
    assert ('as much is left of "after" as of "before"' in said) == ("6 times" in said) == (not changes)
    assert "in which nothing changed look like this one" not in said
    assert json.loads((tmp_path / "comparison.json").read_text())["noisier"][0]["scatter"][0]["location"] == "joint 5"


def test_what_cannot_be_told_apart_is_to_be_confirmed_first(tmp_path):
    rivals = ("link geometry at link 3", "link geometry at link 2", "base compliance at base")
    said = words_of(replace(FOUND, changes=(replace(CHANGE, alternatives=rivals),)), tmp_path)
    assert 'Joint offset at joint 3 (or one of 3 others that explain it as well) grew in "after".' in said
    assert "link geometry at links 2 and 3; base compliance." in said
    assert "Once it is confirmed: Reset the zero" in said


@pytest.mark.parametrize(
    ("p", "told"), [(1.0, "100 %"), (0.474, "47 %"), (5.3e-5, "1 in 19\u00a0000"), (1e-99, "less than 1 in a million")]
)
def test_a_probability_is_told_as_one_reads_it(p, told):
    assert in_odds(p) == told


def test_where_nothing_changed_the_page_says_so_and_draws_nothing(tmp_path):
    said = words_of(replace(FOUND, changes=(), p_nothing_changed=0.4), tmp_path)
    assert "Nothing changed that these recordings show (before, after; p = 0.4)." in said
    assert "no change seen" in said
    assert "History" not in said
    assert not (tmp_path / "history.png").exists()


def test_recordings_of_other_poses_are_not_called_unchanged(tmp_path):
    apart = (("before",), ("after",))
    said = words_of(replace(FOUND, changes=(), tried=0, p_nothing_changed=1.0, same_poses=apart), tmp_path)
    assert "cannot be told" in said
    assert "no change seen" not in said


def test_hostile_names_are_shown_and_never_obeyed(tmp_path):
    names = (EVIL, f"{EVIL}{STEERING}")
    change = replace(CHANGE, where=names[1:], against=names[:1], alternatives=(EVIL,))
    evil = replace(FOUND, arm=EVIL, names=names, changes=(change,), same_poses=(names,))
    html = page_of(evil, tmp_path)
    page = parsed(html)
    assert not set("\x1b\x9b\u202e") & set(html)
    assert page.scripts == page.handlers == []
    assert page.text.count(EVIL) > 5


@pytest.mark.long
def test_the_same_input_gives_the_same_bytes_and_no_file_of_an_earlier_run_stays(tmp_path):
    import pandas as pd

    files = {}
    for name, table in {"a": session(1, rows=40), "b": session(2, rows=40, offsets={3: 9e-4})}.items():
        columns = {f"q{j + 1}_rad": table.motor_angles[:, j] for j in range(6)}
        columns |= {f"{axis}_mm": table.positions[:, k] * 1e3 for k, axis in enumerate("xyz")}
        files[name] = tmp_path / f"{name}.csv"
        pd.DataFrame(columns).to_csv(files[name], index=False)
    robot = "examples/five-effects/robot.yaml"

    def run(output, *tables):
        words = ["compare", *map(str, tables), "-r", robot, "-o", str(output)]
        done = CliRunner().invoke(app, words)
        assert done.exit_code == 0, done.exception
        assert done.stdout.splitlines()[-1] == str(output / "changes.html")
        return {path.name: path.read_bytes() for path in output.iterdir() if path.is_file()}

    words = ["compare", *map(str, files.values()), "-r", robot, "-o", str(tmp_path / "0")]
    told = CliRunner().invoke(app, [*words, "--json"])
    assert json.loads(told.stdout) == json.loads((tmp_path / "0" / "comparison.json").read_text()), "and nothing else"
    assert CliRunner().invoke(app, [*words, "--quiet"]).stdout == ""
    once, again = run(tmp_path / "1", *files.values()), run(tmp_path / "2", *files.values())
    assert once == again
    assert {"changes.html", "comparison.json", "history.csv", "history.png", "history.svg"} == set(once)
    same = tmp_path / "c.csv"
    pd.DataFrame(columns).iloc[:20].to_csv(same, index=False)
    pd.DataFrame(columns).iloc[20:].to_csv(files["a"], index=False)
    left = run(tmp_path / "1", files["a"], same)
    assert {"changes.html", "comparison.json", "history.csv"} == set(left), "no figure of an earlier comparison"


def test_a_planted_change_reaches_the_page(tmp_path):
    found = compare(ARM, {"before": session(3, rows=40), "after": session(4, rows=40, offsets={3: 9e-4})})
    said = words_of(found, tmp_path)
    assert found.told in said
    assert found.changes[0].location == "joint 3"
    assert "zero is off by" in said


def test_every_recording_has_its_rows_and_what_is_left_of_it(tmp_path):
    said = words_of(FOUND, tmp_path)
    assert "before 70 after 1.37 0.121 0.0310" in said
    assert "after 71 before 1.41 0.133 0.0320" in said
    apart = recordings_table(replace(FOUND, changes=(), same_poses=(("before",), ("after",))))
    assert apart["compared with"].tolist() == ["none: other poses or payload"] * 2
    assert "and the changes (mm)" not in apart, "nothing changed, so it is the column before"
    assert f"prior of {SHARED.prior_mm:g} mm" in said


def test_of_many_recordings_the_first_and_the_last_are_named():
    assert first_to_last("abcd") == "a, b, c and d"
    assert first_to_last("abcdefg") == "a … g (7 recordings)"
    names = tuple("abcdefg")
    later = replace(CHANGE, where=names[2:], against=names[:2])
    long = replace(FOUND, names=names, changes=(later,), rows=(70,) * 7, same_poses=(names,), left=())
    assert long.told.endswith('grew in "c" and the 4 after it')
    assert recordings_table(long)["compared with"].tolist() == ["all others"] * 7


def test_of_several_arms_the_page_says_which_is_unlike_the_others(tmp_path):
    names, since = ("A", "B", "C"), (0.0, 8.7e-4, 0.0)
    number = replace(NUMBER, values=(9e-4, 1.77e-3, 9e-4), stderrs=(1e-4,) * 3, since_first=since)
    number = replace(number, since_first_stderrs=(0.0, 1e-5, 1e-5))
    change = replace(CHANGE, where=("B",), against=("A", "C"), parameters=(number,))
    arms = replace(FOUND, names=names, rows=(70,) * 3, changes=(change,), same_poses=(names,), left=(), of_arms=True)
    said = words_of(arms, tmp_path)
    assert 'Joint offset at joint 3 is larger in "B" than in the others.' in said
    assert "unlike the others" in said
    assert "0.900 mrad 1.770 mrad +0.870 mrad" in said, "the mean of the others, and B"
    assert "how B was assembled" in said
    assert "it differs by +0.0498°" in said
    for of_time in ("crash", "History", "before", "What changed", "nothing changed"):
        assert of_time not in said.partition("What was assumed")[0].partition("}")[2].rpartition("}")[2]
    alike = replace(arms, changes=(), p_nothing_changed=0.4)
    assert "No arm is unlike the others" in words_of(alike, tmp_path)
    assert "Of fewer than five arms" in alike.headline
    many = replace(alike, names=(*"ABCDE",), rows=(70,) * 5, same_poses=((*"ABCDE",),))
    assert "Of fewer than" not in many.headline


def test_where_nothing_changed_the_page_says_what_would_have_been_seen(tmp_path):
    seen = (Seen("joint 1", float("inf")), Seen("joint 2", 4e-5), Seen("joint 3", 1.2e-3))
    quiet = replace(FOUND, changes=(), p_nothing_changed=0.4, seen=seen)
    said = words_of(quiet, tmp_path)
    assert "moved by 40 µrad (joint 2) to 1.2 mrad (joint 3) or more would be noticed in 90 % of cases" in said
    assert "Moves of joint 1 would not" in said
    assert "joint 2 0.0400 0.00229" in said
    assert quiet.would_be_seen in quiet.text()
    assert FOUND.would_be_seen == "", "not known, so not said"
    assert "What would be seen" not in words_of(replace(quiet, seen=()), tmp_path)


@pytest.mark.parametrize(("name", "told"), [("cosine_2", "2 per turn"), ("sine_rx", "about x"), ("cosine", "the wave")])
def test_parts_of_a_wave_are_told_in_words(tmp_path, name, told):
    wave = replace(CHANGE, effect="gear_eccentricity", parameters=(replace(NUMBER, name=name),))
    said = words_of(replace(FOUND, changes=(wave,)), tmp_path)
    label = said.partition("its 95 % interval")[2].partition(" 0.900 mrad")[0]
    assert label.strip().startswith(f"{name.partition('_')[0]} part of the wave")
    assert label.endswith(told)


def test_moments_of_masses_are_told_in_a_sentence_and_folded(tmp_path):
    """Ten rows of "compliance times moment 7" in mrad per m/s^2 said nothing to anyone."""
    moments = [replace(NUMBER, name=f"compliance_times_moment_{n}", unit="rad/(m/s^2)") for n in range(1, 11)]
    give = replace(NUMBER, name="compliance", unit="rad/(N m)")
    soft = replace(CHANGE, effect="joint_compliance", location="joint 2", parameters=(*moments, give))
    html = page_of(replace(FOUND, changes=(soft,)), tmp_path)
    _, _, folded = html.partition("<details><summary>10 numbers tell how joint 2 gives way to what it carries")
    inside, _, after = folded.partition("</details>")
    assert inside.count("compliance times moment") == 10
    assert "compliance times moment" not in after
    said = replace(FOUND, changes=(soft,)).text()
    assert "compliance times moment" not in said
    assert "10 numbers tell how joint 2 gives way" in said
    assert "compliance: " in said
    assert "numbers tell how" not in FOUND.text()


def test_what_differs_without_a_name_is_not_called_unchanged(tmp_path):
    nameless = replace(FOUND, changes=(), p_nothing_changed=1e-9)
    said = words_of(nameless, tmp_path)
    assert "Something changed (before, after; p = 1e-09 that nothing changed), and no cause" in said
    assert "Nothing changed" not in said
    assert "no cause found" in said
    assert "no change seen" not in said


def test_where_nothing_is_named_no_tile_counts_to_zero(tmp_path):
    page_of(replace(FOUND, changes=(), p_nothing_changed=1.0), tmp_path)
    html = (tmp_path / "changes.html").read_text().replace("</b><span>", " ").replace("\u00a0", " ")
    said = " ".join(parsed(html).text.split())
    assert "none of 100 possible changes stands out" in said
    assert "100 % of comparisons in which nothing changed look like this one" in said
    assert " 0 changes" not in said
    assert "named where p is below" not in said


def test_what_was_repaired_has_no_cure_on_the_page(tmp_path):
    less = replace(CHANGE, kind="went", alternatives=("link geometry at link 3",), left_mm=0.8, taken_back_mm=0.97)
    less = replace(less, worse_sigmas=9.0)
    said = words_of(replace(FOUND, changes=(less,)), tmp_path)
    assert "To do: Nothing is to be corrected: there is less of it in after than in before" in said
    assert "Cure" not in said
    assert "before anything is mended" not in said
    assert "Taken back, 0.97 mm in place of 0.8 mm per axis would be left in after." in said


def test_bad_shots_are_listed_on_the_page(tmp_path):
    shots = (BadShot("after", "", "45", 5.1), BadShot("after", "monday", "59", 4.9))
    said = words_of(replace(FOUND, bad_shots=shots), tmp_path)
    assert "Rows that look like bad shots, and count for little: 45 of" in said
    assert "59 of &quot;after&quot;, monday (4.9 mm off)." in said.replace('"', "&quot;")


def test_numbers_of_the_file_carry_their_unit(tmp_path):
    """SI, or mm, as the unit beside each says; the page shows them in mrad."""
    page_of(FOUND, tmp_path)
    content = json.loads((tmp_path / "comparison.json").read_text())
    numbers = [number for change in content["changes"] for number in change["parameters"]]
    assert [(each["unit"], each["difference"]) for each in numbers] == [("rad", 8.7e-4)]


FRAME = """<iframe src="changes.html" style="width:420px;height:900px;border:0"></iframe><script>
onload = () => { document.title = frames[0].document.documentElement.scrollWidth; };</script>"""


WIDTH = "frames[0].document.documentElement.scrollWidth"
CUT = """(all => `${all.filter(e => e.scrollWidth > e.clientWidth).length} of ${all.length}`)(
  [...frames[0].document.querySelectorAll(".effect .scroll, #recordings .scroll")])"""


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_the_page_is_no_wider_than_a_telephone(tmp_path):
    names = tuple(f"2026-{month:02d}-03_after_maintenance_of_the_cell_in_hall_4" for month in range(1, 13))
    ends = {"values": (9e-4,) * 12, "stderrs": (1e-4,) * 12, "since_first": (0.0,) * 12}
    number = replace(NUMBER, **ends, since_first_stderrs=(1e-5,) * 12)
    change = replace(
        CHANGE, where=names[6:], against=names[:6], parameters=(number,), alternatives=("link geometry at link 3",) * 9
    )
    left = (Left(1.37, 0.121, 0.031),) * 12
    page_of(replace(FOUND, names=names, rows=(70,) * 12, changes=(change,), same_poses=(names,), left=left), tmp_path)
    (tmp_path / "frame.html").write_text(FRAME)
    look = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files", "--dump-dom"]
    look += [f"--user-data-dir={tmp_path}/b", (tmp_path / "frame.html").as_uri()]
    seen = subprocess.run(look, check=True, capture_output=True, text=True, timeout=120).stdout
    assert int(seen.partition("<title>")[2].partition("<")[0]) <= 420
    (tmp_path / "frame.html").write_text(FRAME.replace(WIDTH, CUT))
    seen = subprocess.run(look, check=True, capture_output=True, text=True, timeout=120).stdout
    assert seen.partition("<title>")[2].partition("<")[0] == "0 of 2", "no table of a card or of recordings is cut"
