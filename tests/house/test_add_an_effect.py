"""docs/add-an-effect.md, followed to the letter: its own code blocks, in a package of their own, add an effect."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.core.words import size_of
from armscope.physics import registry
from armscope.physics.drivers import KINDS
from armscope.physics.scene import Scene
from armscope.recordings.table import unmeasured
from armscope.report.pages.diagnosis import ORDER, write_report
from armscope.robot import load_arm
from armscope.verdict.sentences import exact_phrase, headline

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "add-an-effect.md").read_text(encoding="utf-8")
MODULE, SCRIPT = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
PROJECT = tomllib.loads(re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)[0])["project"]
POINTS = PROJECT["entry-points"]["armscope.effects"]


def installed(folder: Path, module: str, points: dict[str, str]) -> None:
    """What `pip install` leaves of the page's package: its module, its name, its entry points."""
    (folder / "hose_pull.py").write_text(module, encoding="utf-8")
    info = folder / f"hose_pull-{PROJECT['version']}.dist-info"
    info.mkdir()
    metadata = f"Metadata-Version: 2.1\nName: {PROJECT['name']}\nVersion: {PROJECT['version']}\n"
    (info / "METADATA").write_text(metadata, encoding="utf-8")
    lines = [f"{name} = {value}" for name, value in points.items()]
    (info / "entry_points.txt").write_text("\n".join(["[armscope.effects]", *lines, ""]), encoding="utf-8")


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of packages; what armscope learnt from it is forgotten afterwards."""
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.chdir(ROOT)
    known = dict(KINDS)
    registry.effects.cache_clear()
    yield tmp_path
    registry.effects.cache_clear()
    KINDS.clear()
    KINDS.update(known)
    sys.modules.pop("hose_pull", None)


def test_the_pages_effect_is_found_by_name_with_its_clause_its_atlas_column_and_its_card(
    site: Path, tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    installed(site, MODULE, POINTS)
    names: dict[str, object] = {}
    exec(SCRIPT, names)
    promised = re.findall(r"It prints `(.*)`", PAGE)[0]
    assert capsys.readouterr().out.strip() == promised
    verdict = names["verdict"]
    assert [effect.effect for effect in verdict.effects] == ["hose_pull"]
    found = verdict.effects[0]
    pull = found.parameters[0]
    assert abs(pull.value + 1e-3) < 4 * pull.stderr
    assert exact_phrase(found) == f"the hose pack pulls joint 3 by {size_of(pull.value, 'rad/rad^2')}"
    assert headline(verdict).startswith("The hose pack pulls joint 3 by ")
    atlas = verdict.atlas
    column = atlas.share[:, -1, atlas.drivers.index("hose pull")]
    assert atlas.locations[np.nanargmax(column)] == "joint 3"
    assert np.nanmax(column) > 0.9
    written = write_report(verdict, tmp_path_factory.mktemp("report"))
    page = written.read_text(encoding="utf-8")
    assert "pull of the hoses" in page
    assert "commanded = wanted - pull x wanted x |wanted|" in page
    order = written.with_name(ORDER).read_text(encoding="utf-8")
    assert "Joint 3.</p>" in order, "no change is named: nothing stands in its place"
    assert "<b>Joint 3</b>" in page


def test_a_name_that_is_taken_is_refused_with_the_packages_name(site: Path) -> None:
    installed(site, MODULE.replace('"hose_pull"', '"joint_offset"'), POINTS)
    with pytest.raises(InputError, match=r"hose-pull: entry point armscope.effects.*'joint_offset'.*must be new"):
        registry.effects()


def test_a_driver_that_is_taken_is_refused(site: Path) -> None:
    installed(site, MODULE.replace('"hose pull"', '"angle"'), POINTS)
    with pytest.raises(InputError, match=r"'angle'.*must be new"):
        registry.effects()


@pytest.mark.parametrize("value", ["hose_pull:NOTHING", "no_such_module:HOSE_PULL", "hose_pull:place"])
def test_an_entry_point_that_leads_to_no_effect_is_refused(site: Path, value: str) -> None:
    installed(site, MODULE, {"hose_pull": value})
    with pytest.raises(InputError, match=r"hose-pull: entry point armscope\.effects: hose_pull = "):
        registry.effects()


def placed_and_evaluated() -> None:
    """What a diagnosis asks of the effect."""
    arm = load_arm("config/robots/six-axis.yaml")
    poses = unmeasured(np.random.default_rng(1).uniform(-1, 1, (120, arm.n_motors)))
    for placed in registry.library(arm, poses):
        if placed.name == "hose_pull":
            Scene(arm, poses).driver(placed.terms[0].products[0].driver)


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        (
            '    "transmission",',
            '    "transmision",',
            r"effect 'hose_pull': family: .*Did you mean 'transmission'",
        ),
        ("by {pull}", "by {pul}", r"hose-pull: effect 'hose_pull': clauses: found '{pul}'.*Did you mean 'pull'"),
        ("by {pull}", "by {pull", r"hose-pull: effect 'hose_pull': clauses: .*a template"),
        (
            "angle * abs(angle)",
            "angle[:-1]",
            r"'hose_pull': driver 'hose pull': found 'shape \(119,\)'.*\(120,\)",
        ),
        (
            "angle * abs(angle)",
            "angle * float('nan')",
            r"driver 'hose pull': found 'NaN or infinity in 120 rows'.*Give",
        ),
        ("angle * abs(angle)", "angel", r"driver 'hose pull', .*hose_pull.py, line 9: found .NameError: name 'angel'"),
        ('f"joint {j}"', 'f"joint {jj}"', r"'hose_pull': place, .*hose_pull.py, line 15: found .NameError: name 'jj'"),
        ("= Effect(", "= Efect(", r"entry point armscope\.effects: .*NameError: name 'Efect' is not defined"),
    ],
)
def test_what_is_wrong_with_an_effect_is_one_clear_error(site: Path, right: str, wrong: str, told: str) -> None:
    """It names effect, place, what was found and what is wanted: numpy's own words named none of them."""
    assert right in MODULE
    installed(site, MODULE.replace(right, wrong), POINTS)
    with pytest.raises(InputError, match=told):
        placed_and_evaluated()
