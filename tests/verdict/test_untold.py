"""Numbers that nobody could act on stand neither on a card nor in a table to enter."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.report.sections.effect_cards import reading_of
from armscope.verdict.corrections import zero_offsets
from armscope.verdict.tasks import _jump
from armscope.verdict.untold import absorbed, implausible, untold
from tests.report import verdicts

ROW = verdicts.Parameter("row", "", 14.0, 0.6)


def jumped(stderr: float, by: float = -4.66e-3) -> verdicts.FoundEffect:
    """A zero that jumped by milliradians, of which the tool shows 0.17 mm."""
    jump = verdicts.Parameter("jump", "rad", by, stderr)
    return replace(verdicts.found("zero_shift", "joint 6", jump, ROW), rms_at_tool_mm=0.17)


@pytest.mark.parametrize(("stderr", "told"), [(1e-5, True), (2e-3, False)])
def test_a_value_that_others_take_back_is_told_nowhere(stderr: float, told: bool) -> None:
    """The card said "undetermined", and the work order to set the zero by some degrees."""
    effect = jumped(stderr)
    jump = effect.parameters[0]
    assert absorbed(jump, effect) == untold(jump, effect) == (not told)
    assert not implausible(jump, effect)
    assert (reading_of(jump, effect).value == "undetermined") == (not told)
    zeros = zero_offsets(verdicts.case(effects=(effect,)).verdict).set_index("joint")
    assert (zeros.loc["joint 6", "actual_minus_commanded_mrad"] != 0) == told
    assert ("leave open" in _jump(effect)) == (not told)


def test_a_value_that_is_known_well_beside_its_size_is_told_however_little_it_moves() -> None:
    """Seen on a real arm: the zero of a last joint, whose axis passes by the tool, jumped by -46.6 mrad +- 4."""
    effect = jumped(2e-3, -46.6e-3)
    assert reading_of(effect.parameters[0], effect).value.startswith("−46.6")
    assert "leave open" not in _jump(effect)


def test_one_value_by_itself_takes_nothing_back() -> None:
    alone = replace(jumped(2e-3), parameters=jumped(2e-3).parameters[:1])
    assert not absorbed(alone.parameters[0], alone)
