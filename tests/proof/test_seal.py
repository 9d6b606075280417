"""What the diagnosing side can see: recordings and robots, never the truth."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

from armscope.cli.studies import every_nth
from armscope.core.inputs import InputError
from armscope.core.provenance import sources
from armscope.proof.making import batch, make
from armscope.proof.reading import ALLOWED, check_seal
from armscope.proof.truth import unseal
from armscope.world.catalogue import catalogue

REPOSITORY = Path(__file__).parents[2]
RULES = (REPOSITORY / "workflow" / "rules" / "proof.smk").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Two worlds, twice."""
    folder = tmp_path_factory.mktemp("made")
    specs = [spec for spec in catalogue(3) if spec.category in ("clean", "single")][:5:4]
    for attempt in ("first", "second"):
        make(specs, REPOSITORY / "config" / "robots", folder / attempt / "visible", folder / attempt / "sealed.tar.gz")
    return folder


def test_the_visible_tree_holds_what_is_allowed_and_no_readings_of_test_rows(made):
    files = [path for path in (made / "first" / "visible").rglob("*") if path.is_file()]
    assert {path.name for path in files} == ALLOWED
    for path in files:
        if path.name == "test_poses.csv":
            columns = pd.read_csv(path).columns
            assert "q1_rad" in columns
            assert not {"x_mm", "y_mm", "z_mm"} & set(columns)


def test_the_archive_gives_the_truth_back_and_the_same_worlds_give_the_same_bytes(made):
    first, second = (made / attempt / "sealed.tar.gz" for attempt in ("first", "second"))
    assert first.read_bytes() == second.read_bytes()
    truths = unseal(first)
    assert len(truths) == 2
    clean, single = truths.values()
    assert (clean.category, len(clean.effects)) == ("clean", 0)
    assert (single.category, len(single.story)) == ("single", 1)
    assert len(single.test) == 100
    assert single.story[0].noncentrality > 0


def test_the_diagnosing_side_knows_neither_how_worlds_are_made_nor_what_a_truth_is():
    used = {path.as_posix() for path in sources("armscope.proof.diagnosing")}
    assert any("/diagnosis/" in path for path in used)
    assert not [path for path in used if "/world/" in path or path.endswith(("proof/truth.py", "proof/scoring.py"))]


def test_the_diagnosing_rule_gets_visible_folders_only_in_a_folder_of_its_own():
    rule = re.search(r"rule proof_diagnose:.*?(?=\nrule )", RULES, re.S)
    assert rule is not None
    assert "sealed" not in rule.group()
    assert "shadow:" in rule.group()
    inputs = re.search(r"input:\n(.*?)output:", rule.group(), re.S)
    assert inputs is not None
    assert re.findall(r"/(\w+)/", inputs.group(1)) == ["visible"]


@pytest.mark.parametrize("seen", ["./a/recordings.csv\n./a/truth.yaml\n", "./sealed/fixed-0.tar.gz\n", ""])
def test_scoring_refuses_verdicts_of_a_job_that_saw_more_or_did_not_say(seen, tmp_path):
    (tmp_path / "seen.txt").write_text(seen)
    with pytest.raises(InputError):
        check_seal(tmp_path / "seen.txt")


def test_batches_share_the_worlds_out_and_fixed_ones_do_not_need_the_seed():
    for fresh in (False, True):
        ids = [spec.id for part in range(3) for spec in batch(5, "full", fresh)[every_nth(f"{part}/3")]]
        assert sorted(ids) == [spec.id for spec in catalogue(5, "full") if spec.fresh == fresh]
    assert batch(5, "full", False) == batch(6, "full", False)
