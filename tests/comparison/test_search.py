"""Several causes that changed at once are named each, whichever recording comes first, and no others in their place."""

from pathlib import Path

import numpy as np
import pytest

from armscope.comparison import compare
from armscope.comparison.scoring import Possible
from armscope.comparison.search import as_steps
from armscope.recordings import read_recordings
from tests.comparison.test_changes import ARM, session

EXAMPLES = Path(__file__).parents[2] / "examples"


def named(found):
    return {(each.effect, each.location) for each in found.changes}


@pytest.mark.long
def test_arms_that_differ_in_five_causes_do_so_in_either_order():
    """Beside what both share, the one of 60 rows counted as a noisy one, whose rows showed nothing: p was 1."""
    tables = {
        name: read_recordings(EXAMPLES / name / "recordings.csv", ARM.n_motors)
        for name in ("one-effect", "five-effects")
    }
    found = [compare(ARM, {name: tables[name] for name in order}) for order in (tables, reversed(tables))]
    wanted = {
        ("link_geometry", "link 2"),
        ("joint_offset", "joint 3"),
        ("joint_compliance", "joint 2"),
        ("joint_compliance", "joint 3"),
        ("gear_eccentricity", "joint 1"),
    }
    assert [named(each) for each in found] == [wanted] * 2
    assert found[0].p_nothing_changed == pytest.approx(found[1].p_nothing_changed, rel=1e-3)
    for each in found[0].changes:
        other = next(one for one in found[1].changes if one.title == each.title)
        for ours, theirs in zip(each.parameters, other.parameters, strict=True):
            assert ours.difference == pytest.approx(-theirs.difference, rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 6))])
def test_zeros_that_were_set_at_once_are_named_each_and_nothing_else_is(seed):
    """The one that explained most by itself was a wave, a bearing or a load; it stayed when the zeros had come in."""
    off, rng = {2: 2e-3, 3: -1.5e-3, 5: 2.5e-3}, np.random.default_rng(seed)
    sign = rng.choice([-1, 1])
    before = session(8100 + seed, rows=110, offsets={joint: sign * size for joint, size in off.items()}, give=6e-7)
    found = compare(ARM, {"before": before, "after": session(8200 + seed, rows=110)})
    assert named(found) == {*(("joint_offset", f"joint {joint}") for joint in off), ("joint_compliance", "joint 2")}
    for each in found.changes:
        low, high = each.parameters[0].interval_95
        size = -sign * off[int(each.location[-1])] if each.effect == "joint_offset" else -6e-7
        assert low - (high - low) / 2 < size < high + (high - low) / 2


def change(number, sets, against):
    return Possible(None, number, np.ones(1), np.ones(3, dtype=bool), sets, against)  # type: ignore[arg-type]


STEPS = [change(0, (1, 2), (0,)), change(0, (2,), (0, 1))]
ALONE = change(0, (1,), (0, 2))


def test_from_the_third_on_and_in_the_second_alone_are_two_steps():
    other = change(7, (2,), (0, 1))
    assert as_steps([STEPS[1], other, ALONE], [*STEPS, ALONE, other]) == [other, *STEPS]


def test_what_came_and_was_put_right_stays_one_change_and_a_step_that_may_not_be_named_none():
    assert as_steps([ALONE], [*STEPS, ALONE]) == [ALONE]
    assert as_steps([STEPS[1], ALONE], [STEPS[1], ALONE]) == [STEPS[1], ALONE]


@pytest.mark.long
@pytest.mark.parametrize("zeros", [(0.0, 4e-4, 9e-4), (0.0, 3e-4, 6e-4, 9e-4)])
def test_a_zero_that_wears_on_came_or_grew_in_each_recording_and_shrank_in_none(zeros):
    tables = {str(n): session(7300 + n, rows=60, offsets={3: zero}) for n, zero in enumerate(zeros)}
    found = compare(ARM, tables).changes
    assert {(each.location, each.where) for each in found} == {("joint 3", (str(n),)) for n in range(1, len(zeros))}
    assert not {each.kind for each in found} & {"went", "shrank"}
    for each in found:
        step = zeros[int(each.where[0])] - zeros[int(each.where[0]) - 1]
        assert abs(each.parameters[0].difference - step) < 0.1e-3
