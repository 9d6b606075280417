"""Several causes that changed at once are named each, whichever recording comes first, and no others in their place."""

from pathlib import Path

import numpy as np
import pytest

from armscope.comparison import compare
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
