"""What a card says of how sure its cause is."""

from __future__ import annotations

from dataclasses import replace

from armscope.report.sections.motion_cards import _evidence as evidence
from armscope.verdict.effects import Parameter
from tests.motion.summary.test_judgement import beside


def test_no_evidence_is_overwhelming_beside_an_interval_that_holds_zero() -> None:
    sure = replace(beside(), evidence_nats=2798.0)
    open_size = replace(sure, parameters=(Parameter("mass", "kg", -8.05, 6.4),))
    assert evidence(sure).startswith("Overwhelming evidence")
    assert "Overwhelming" not in evidence(open_size)
    assert "2798 nats" in evidence(open_size)
    assert "which way it goes, is open" in evidence(open_size)
