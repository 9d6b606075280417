"""What may be the instrument's own error is not commanded away: that would move a good arm wrongly."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.verdict.contributions import contributions
from armscope.verdict.doubts import MAY_BE_READ_SO, MEANWHILE, doubt_of
from armscope.verdict.effects import Alternative, FoundEffect, Parameter
from armscope.verdict.instruments_own import SETTLE_FIRST, beside_the_instrument, instrument_is_open
from armscope.verdict.schema import Verdict
from armscope.verdict.tasks import task_of
from armscope.verdict.work_order import WorkOrder
from tests.report import verdicts

WOBBLE = verdicts.found("axis_wobble", "joint 5", named_as="region", title="geometric, around joints 5 and 6")
SCALE = verdicts.found("instrument_scale", "instrument", Parameter("scale", "m/m", 2e-4, 1e-5), title="instrument")
OPEN_SCALE = replace(SCALE, named_as="region", title="instrument, around instrument")
DRIFTS = verdicts.found("base_drift", "base")


def rival(effect: str, location: str, family: str) -> Alternative:
    return Alternative(effect, location, family, 1.5, "constant", 1.5, False)


@pytest.mark.parametrize(
    ("alternative", "commands_hold"),
    [
        (rival("link_geometry", "link 6", "geometric"), True),
        (rival("instrument_scale", "instrument", "instrument"), False),
        (rival("base_shift", "base", "drift"), False),
    ],
)
def test_commands_hold_only_where_each_reading_is_the_arms(alternative: Alternative, commands_hold: bool) -> None:
    doubt = doubt_of(replace(WOBBLE, alternatives=(alternative,)))
    assert doubt
    assert doubt.meanwhile == (MEANWHILE if commands_hold else MAY_BE_READ_SO)
    assert ("hold whichever" in doubt.meanwhile) == commands_hold


def test_an_instrument_that_is_itself_in_doubt_is_not_commanded_away() -> None:
    doubt = doubt_of(OPEN_SCALE)
    assert doubt
    assert "move a good arm wrongly" in doubt.meanwhile


@pytest.mark.parametrize(
    ("others", "commands_hold", "is_open"),
    [((), True, False), ((SCALE,), False, False), ((OPEN_SCALE,), False, True), ((DRIFTS,), True, False)],
)
def test_beside_an_error_of_the_instrument_nothing_that_is_open_is_commanded_away(
    others: tuple[FoundEffect, ...], commands_hold: bool, is_open: bool
) -> None:
    """A tracker's error with the azimuth looked like a gear of joint 1: a perfect arm went from 0.006 to 0.099 mm."""
    verdict: Verdict = verdicts.case(effects=(WOBBLE, *others)).verdict
    cause = contributions(verdicts.case(effects=(WOBBLE,)).verdict).causes[0]
    task = task_of(verdict.model.scene(verdict.recordings), cause, WOBBLE)
    told = beside_the_instrument(task, verdict)
    assert ("hold whichever" in told.cure) == commands_hold
    assert instrument_is_open(verdict) == is_open
    order = WorkOrder((told,), (), instrument_is_open(verdict))
    assert (order.caution == SETTLE_FIRST) == is_open
