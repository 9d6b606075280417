"""A table whose every row has a target of its own is told as that, by whatever looks at it."""

import re
from dataclasses import replace

import numpy as np
import pytest

from armscope.check.preconditions import refuse_unusable
from armscope.check.report import check
from armscope.compensation.fitting import fit_error_model
from armscope.core.inputs import InputError
from armscope.errormodels.features import FDP_CI
from tests.calibration.worlds import far_away, measured, poses

TOLD = "column target: 80 different names in 80 rows"


@pytest.fixture
def numbered(sound):
    return replace(sound, target=np.arange(80).astype(str))


def test_check_tells_that_targets_number_the_rows(numbered, arm):
    for report in (check(numbered), check(numbered, arm)):
        assert [each.text() for each in report.suspicions if TOLD in each.text()]
        assert report.has_problems
        assert "too few rows" not in report.text()
        assert "is it the point's number?" in report.text()


def test_a_diagnosis_and_an_error_model_refuse_them(numbered, arm):
    with pytest.raises(InputError, match=TOLD):
        refuse_unusable(arm, numbered)
    with pytest.raises(InputError, match=r"found '80 different names in 80 rows'.*is it the point's number\?"):
        fit_error_model(arm, numbered, FDP_CI)


@pytest.mark.parametrize("apart", [(0.06, -0.04, 0.02), (0.0, 0.0, 0.3)])
@pytest.mark.parametrize("share", [0.5, 0.35])
def test_two_reflectors_of_one_name_are_told_with_their_distance_and_rows(arm, apart, share):
    """As a tool that bends, a sign or another arm they sent people to look at the arm."""
    rng = np.random.default_rng(3)
    angles, base = poses(rng, 80, arm.n_motors), far_away(rng)
    first, second = (
        measured(arm, angles, base, {"": np.add([0.1, 0.02, 0.15], offset)}, noise=1e-4, rng=rng)
        for offset in ((0, 0, 0), apart)
    )
    other = rng.uniform(size=80) < share
    table = replace(first, positions=np.where(other[:, None], second.positions, first.positions))
    (told,) = [each for each in check(table, arm).suspicions if each.weight == "problem"]
    assert told.kind == "two reflectors"
    found = re.search(r"two places on the tool, ([\d.]+) mm apart", told.statement)
    assert float(found[1]) == pytest.approx(1e3 * np.linalg.norm(apart), abs=0.6)
    fewer = np.flatnonzero(other if 2 * other.sum() <= 80 else ~other)
    assert f": {table.id[fewer[0]]}, " in told.cure


def test_another_place_from_a_row_on_may_be_a_tool_that_moved(arm):
    """A diagnosis tells that with the row: it must not be refused."""
    rng = np.random.default_rng(3)
    angles, base = poses(rng, 80, arm.n_motors), far_away(rng)
    first, second = (
        measured(arm, angles, base, {"": [0.1 + offset, 0.02, 0.15]}, noise=1e-4, rng=rng) for offset in (0, 0.09)
    )
    later = np.arange(80) >= 41
    table = replace(first, positions=np.where(later[:, None], second.positions, first.positions))
    (told,) = [each for each in check(table, arm).suspicions if each.kind == "two reflectors"]
    assert told.weight == "hint"
    assert "Or did the tool move then?" in told.cure
    assert not [each for each in check(table, arm).suspicions if each.weight == "problem"]


def test_an_arm_that_fits_badly_has_no_second_reflector(arm):
    """A wrong sign spreads the points about the tool in no two places."""
    rng = np.random.default_rng(4)
    angles = poses(rng, 80, arm.n_motors)
    table = measured(arm, angles, far_away(rng), {"": [0.1, 0.02, 0.15]}, noise=1e-4, rng=rng)
    signs = np.where(np.arange(arm.n_motors) == arm.n_motors - 1, -1, 1)
    said = check(replace(table, motor_angles=angles * signs), arm).suspicions
    assert said
    assert not [each for each in said if each.kind == "two reflectors"]
