"""The figure that a person turns: its numbers against the package's, and its picture in a browser."""

import base64
import json
import re
import shutil
import subprocess
from pathlib import Path

import jinja2
import numpy as np
import pytest

from armscope.report.figures.error_field import MOST_ROWS, ErrorField, figure_data, turnable
from armscope.report.html import beside
from armscope.robot import forward_kinematics, load_arm

ROBOTS = Path(__file__).parents[2] / "config" / "robots"
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
TEMPLATES = jinja2.Environment(loader=jinja2.PackageLoader("armscope.report", "templates"), autoescape=True)
ALONE = """{% extends "base.html.j2" %}{% block head %}<style>{{ beside("error_field.css") }}</style>{% endblock %}
{% block content %}{{ field }}</figure><script>{{ beside("error_field.js") }}</script>{% endblock %}"""
ROWS = 60


def field_of(arm, rows=ROWS, seed=3, **changes):
    """Two models, three stages, two trajectories; the second was compensated but for its last row."""
    random = np.random.default_rng(seed)
    low, high = np.clip(arm.limits.T, -2.5, 2.5)
    angles = random.uniform(0.6 * low, 0.6 * high, (rows, arm.n_motors))
    before, after = random.normal(0, 1, (rows, 3)), random.normal(0, 0.2, (rows, 3))
    compensated = np.where(np.arange(rows)[:, None] < rows // 2, np.nan, 0.5 * after)
    compensated[-1] = np.nan
    content = {
        "points_mm": 1e3 * forward_kinematics(arm, angles),
        "motor_angles": angles,
        "ids": [f"<{n}>" for n in range(rows)],
        "groups": ["identification"] * (rows // 2) + ["test 1"] * (rows - rows // 2),
        "group_word": "trajectory",
        "row_word": "point",
        "stages": [("before", "measured minus nominal"), ("after", "minus model"), ("compensated", "closed loop")],
        "errors_mm": {"first": (before, after, compensated), "second": (before, 2 * after, compensated)},
        "missing": "not compensated",
        "paths": ["test 1"],
        "suspects": {7: "a bad shot"},
        "shares": {"joint 2": 0.6, "link 3": 0.2},
    }
    return ErrorField(**(content | changes))


def test_words_are_readable_on_their_ground_in_the_dark_too():
    """A ground of a fixed colour has words of a fixed colour: those of the page turn light in the dark."""
    for rule in re.findall(r"([^{}]+)\{([^{}]*)\}", beside("error_field.css")):
        stated = dict(each.strip().split(":", 1) for each in rule[1].split(";") if ":" in each)
        ground, words = stated.get("background", ""), stated.get(" color", stated.get("color", ""))
        if ground and words:
            assert ("var(" in ground) == ("var(" in words), rule


def unpacked(text):
    return np.frombuffer(base64.b64decode(text), dtype="<f4")


@pytest.mark.parametrize("name", ["six-axis", "seven-axis", "sk120", "parallelogram-120kg"])
def test_the_data_are_the_fields(name):
    arm = load_arm(ROBOTS / f"{name}.yaml")
    shown = field_of(arm)
    data = json.loads(json.dumps(figure_data(arm, shown)))
    assert unpacked(data["points"]).reshape(-1, 3) == pytest.approx(shown.points_mm, abs=1e-3)
    for model in data["models"]:
        for at, errors in zip(model["fields"], shown.errors_mm[model["name"]], strict=True):
            assert unpacked(data["fields"][at]).reshape(-1, 3) == pytest.approx(errors, abs=1e-5, nan_ok=True)
    assert len(data["fields"]) == 4  # what models share is not written twice
    assert data["suspects"] == [[7, "a bad shot"]]
    assert [len(data["arm"][part]) for part in ("before", "discs")] == [arm.n_joints] * 2


def test_a_long_table_is_thinned_but_keeps_its_suspects():
    arm = load_arm(ROBOTS / "six-axis.yaml")
    rows = MOST_ROWS + 5001
    data = figure_data(arm, field_of(arm, rows, suspects={11: "bad", rows - 2: "worse"}))
    assert MOST_ROWS <= len(data["ids"]) <= MOST_ROWS + 2
    assert [data["ids"][at] for at, _ in data["suspects"]] == ["<11>", f"<{rows - 2}>"]
    assert len(unpacked(data["points"])) == 3 * len(data["ids"])


def test_names_from_a_table_cannot_end_the_script():
    arm = load_arm(ROBOTS / "six-axis.yaml")
    html = turnable(arm, field_of(arm, ids=["</script><script>alert(1)</script>"] * ROWS))
    assert html.count("</script>") == 1
    assert "alert" in html


HOOK = f"<script>{Path(__file__).with_name('turn_the_field.js').read_text()}</script>"


def browsed(page, folder, hook):
    """What the hook left in <pre id=result>, from a browser without a network."""
    source = page.read_text()
    tried = folder / "tried.html"
    tried.write_text(source.replace("<head>", f"<head>{hook}", 1))
    done = subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=8000",
         f"--user-data-dir={folder}/b", "--host-resolver-rules=MAP * ~NOTFOUND", "--window-size=1200,900",
         "--dump-dom", tried.as_uri()],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    found = re.search(r'<pre id="result">(.*?)</pre>', done.stdout, re.S)
    assert found, done.stderr[-800:]
    return json.loads(found[1].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
@pytest.mark.parametrize("name", ["six-axis", "parallelogram-120kg"])
def test_a_person_turns_it_and_chooses_what_to_see(name, tmp_path):
    arm = load_arm(ROBOTS / f"{name}.yaml")
    shown = field_of(arm)
    page = tmp_path / "page.html"
    page.write_text(TEMPLATES.from_string(ALONE).render(field=turnable(arm, shown), beside=beside))
    found = browsed(page, tmp_path, HOOK)
    assert found["heard"] == []
    assert found["asked"] == []
    pictures = {name: picture for name, (picture, _) in found["seen"].items()}
    assert pictures["again"] == pictures["back"] == pictures["reset"] == pictures["start"]
    alike = [{"again", "start", "back", "reset"}]
    different = [name for name in pictures if name not in alike[0] - {"start"}]
    assert len({pictures[name] for name in different}) == len(different), pictures
    told = {name: text for name, (_, text) in found["seen"].items()}
    rms = np.sqrt(np.mean(np.sum(shown.errors_mm["second"][1] ** 2, axis=1)))
    assert f"second, after (minus model): RMS {rms:.3g} mm 3D distance" in told["second"]
    assert f"RMS {np.sqrt(np.mean(shown.errors_mm['first'][0][:, 1] ** 2)):.3g} mm along y" in told["y"]
    assert f"{ROWS // 2 + 1} points (grey) have no number: not compensated." in told["compensated"]
    assert f"{ROWS // 2} points" in told["path"]
    # the script's chain of joints is the package's
    assert np.array(found["tools"]) == pytest.approx(shown.points_mm, abs=0.01)
    assert found["chosen"] == found["front"]
    assert "mm" in found["tip"]
