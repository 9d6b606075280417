"""Try before you cure: the page's switches show what the package calculates."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.diagnosis import Settings, diagnose
from armscope.recordings import read_recordings
from armscope.report.pages.diagnosis import write_report
from armscope.robot import load_arm
from armscope.verdict.contributions import contributions
from armscope.verdict.schema import HeldOut
from tests.report.test_error_field import browsed

EXAMPLE = Path(__file__).parents[2] / "examples" / "five-effects"
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
LISTEN = """<script>
const heard = [];
addEventListener("error", e => heard.push(e.message));
addEventListener("securitypolicyviolation", e => heard.push("asked for " + e.blockedURI));
addEventListener("load", () => {
  const field = document.querySelector("figure.field").field, boxes = [...document.querySelectorAll("[data-cure]")];
  const told = () => ({ rms: parseFloat(document.getElementById("cured-rms").textContent),
    field: document.querySelector(".field-told").textContent,
    bars: document.getElementById("cured-histogram").innerHTML });
  const tick = (n, on) => { boxes[n].checked = on; boxes[n].dispatchEvent(new Event("change")); };
  const before = told();
  const alone = boxes.map((_, n) => { tick(n, true); const said = told(); tick(n, false); return said; });
  const again = told();
  document.querySelector('[data-all="1"]').click();
  const result = { heard, before, alone, again, after: told(), count: field.count,
    words: document.getElementById("switches").textContent };
  const node = Object.assign(document.createElement("pre"), { id: "result", textContent: JSON.stringify(result) });
  document.body.replaceChildren(node);
});</script>"""


@pytest.fixture(scope="module")
def verdict():
    arm = load_arm(EXAMPLE / "robot.yaml")
    table = read_recordings(EXAMPLE / "recordings.csv", arm.n_motors)
    return diagnose(arm, table, Settings(resamples=0, cross_validation=False))


@pytest.fixture(scope="module")
def worth(verdict):
    return contributions(verdict)


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_switching_a_cause_off_shows_what_curing_it_leaves(verdict, worth, tmp_path):
    page = write_report(verdict, tmp_path / "out")
    assert page.stat().st_size < 500_000
    seen = browsed(page, tmp_path, LISTEN)
    assert seen["heard"] == []
    assert seen["count"] == len(worth.rows)
    wanted = [rms(worth.before - moved) for _, moved in worth.switches]
    assert [said["rms"] for said in seen["alone"]] == pytest.approx(wanted, rel=5e-3)
    assert all(f" {value:.3g}" in seen["words"] for value in wanted), "what each alone leaves stands beside its switch"
    assert seen["again"] == seen["before"]
    assert len({said["bars"] for said in seen["alone"]}) == len(wanted)
    for name, errors in (("before", worth.before), ("after", worth.left)):
        assert seen[name]["rms"] == pytest.approx(rms(errors), rel=5e-3)
        distance = float(seen[name]["field"].split("RMS ")[1].split(" mm")[0])
        assert distance == pytest.approx(np.sqrt(3) * rms(errors), rel=5e-3)


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_switches_tell_what_cards_and_work_order_tell(verdict, worth, tmp_path):
    """On poses that took no part: one number for what a cure alone leaves, wherever on the page it stands."""
    held = HeldOut(1.4 * rms(worth.before), 2 * rms(worth.left))
    page = write_report(replace(verdict, held_out=held), tmp_path / "out")
    seen = browsed(page, tmp_path, LISTEN)
    assert seen["before"]["rms"] == pytest.approx(held.before, rel=5e-3)
    assert seen["after"]["rms"] == pytest.approx(held.after, rel=5e-3)
    told = [float(number) for number in re.findall(r"→\s*([0-9.]+)", seen["words"])]
    assert told == pytest.approx([said["rms"] for said in seen["alone"]], rel=5e-3)
    cards = page.read_text().split("What was found")[1]
    assert re.search(rf"cured alone: [^→]*→[^0-9]*{told[0]:g}\b", cards)
