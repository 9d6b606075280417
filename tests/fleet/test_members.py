"""A fleet's arms one after the other: what can't be read loses no other arm's answer."""

from __future__ import annotations

from pathlib import Path

import pytest

from armscope.diagnosis import Settings
from armscope.fleet.members import FAILURE, Member, diagnose_members
from armscope.verdict.files import read_verdict

EXAMPLE = Path(__file__).parents[2] / "examples" / "clean"
QUICK = Settings(resamples=0, cross_validation=False)


@pytest.mark.long
def test_one_bad_table_leaves_the_others_their_verdicts(tmp_path: Path) -> None:
    good = Member("good", "six-axis", EXAMPLE / "robot.yaml", EXAMPLE / "recordings.csv")
    gone = Member("gone", "six-axis", EXAMPLE / "robot.yaml", tmp_path / "nothing.csv")
    other = Member("other", "six-axis", EXAMPLE / "robot.yaml", EXAMPLE / "recordings.csv", run="no such run")
    diagnose_members([gone, good, other], tmp_path / "verdicts", QUICK)
    assert read_verdict(tmp_path / "verdicts" / "good" / "verdict.json").answer == "nothing missing"
    assert "nothing.csv" in (tmp_path / "verdicts" / "gone" / FAILURE).read_text()
    assert "found no such run; no row has this run" in (tmp_path / "verdicts" / other.name / FAILURE).read_text()
