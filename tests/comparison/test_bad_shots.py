"""Bad shots are found as those that they are, count for little, and hide no change."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison import compare
from armscope.comparison.bad_shots import BadShot, from_the_others, told_of_shots
from armscope.comparison.sets import stacked
from armscope.comparison.shared_model import SharedModel
from tests.comparison.test_changes import ARM, session
from tests.comparison.test_remedies import FOUND
from tests.seeds import seeds


def spoilt(table, rng, size_m, count=2):
    """Some rows shifted by as much, and which."""
    rows = rng.choice(len(table), count, replace=False)
    points = table.positions.copy()
    points[rows] += size_m * rng.choice([-1, 1], (count, 1)) * [0, 0, 1]
    return replace(table, positions=points), {str(table.id[row]) for row in rows}


@pytest.mark.parametrize("seed", seeds(2, 8))
@pytest.mark.parametrize("size_m", [5e-3, 25e-3])
def test_two_bad_shots_hide_no_crash_and_are_listed(size_m, seed):
    """Seen: from p = 6e-60 to 1, intervals up to 35 times as wide, and the instrument was blamed."""
    before, after = session(8500 + seed), session(8600 + seed, offsets={4: 6e-4})
    bad, rows = spoilt(after, np.random.default_rng(seed), size_m)
    clean, found = (compare(ARM, {"a": before, "b": each}) for each in (after, bad))
    assert {(each.recording, each.id) for each in found.bad_shots} == {("b", row) for row in rows}
    assert all(each.residual_mm == pytest.approx(1e3 * size_m, rel=0.2) for each in found.bad_shots)
    assert not clean.bad_shots
    assert not found.noisier
    (change,), (without,) = found.changes, clean.changes
    assert change.title == without.title == "joint offset at joint 4"
    wide, usual = (np.ptp(each.parameters[0].interval_95) for each in (change, without))
    assert wide < 1.3 * usual
    assert change.parameters[0].difference == pytest.approx(6e-4, abs=wide)


@pytest.mark.parametrize("seed", seeds(1, 4))
def test_rows_of_clean_recordings_all_count(seed):
    found = compare(ARM, {"a": session(8700 + seed), "b": session(8800 + seed, noise_mm=0.1)})
    assert found.bad_shots == ()
    assert "bad shots" not in found.text()


def test_how_far_a_row_lies_from_the_others_does_not_depend_on_its_own_weight():
    model = SharedModel(ARM, *stacked(ARM, {"a": session(1), "b": session(2)}))
    alone = model.alone(0)
    off, _ = from_the_others(alone)
    base = alone.base(())
    for row in (3, 40):
        kept = np.arange(len(alone.residual)) // 3 != row
        gram = base.columns[kept].T @ base.columns[kept] + np.diag(base.penalty)
        values = np.linalg.solve(gram, base.columns[kept].T @ alone.residual[kept])
        left = (alone.residual - base.columns @ values)[~kept] / alone.weight[~kept]
        np.testing.assert_allclose(off[row], left, rtol=0.02, atol=1e-3)


def test_many_are_told_by_the_farthest():
    found = [BadShot("b", "", str(row), 5.0) for row in range(7)]
    told = told_of_shots(found)
    assert told.startswith('rows that look like bad shots, and count for little: 0 of "b" (5.0 mm off), 1 of "b"')
    assert told.endswith("... (7 in all: comparison.json)")
    assert told_of_shots(()) == ""
    assert told in replace(FOUND, bad_shots=tuple(found)).text()
