"""Recordings count by their own noise, and what their rows cannot show is not seen to change."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison.sets import stacked
from armscope.comparison.shared_model import SharedModel
from armscope.robot import chain
from tests.comparison.test_changes import ARM, OWN, session


def test_a_noisy_recording_counts_by_its_noise():
    """0.03 and 0.3 mm: its rows count for a tenth."""
    model = SharedModel(ARM, *stacked(ARM, {"quiet": session(51), "noisy": session(52, noise_mm=0.3)}))
    quiet, noisy = (np.median(model.weight[model.group == k]) for k in (0, 1))
    assert 0.07 < noisy / quiet < 0.14


def test_a_recording_that_has_a_change_is_no_noisy_one():
    """All have 0.03 mm. Weighed with the change as noise, the others were too sure of changes that are none."""
    series = {f"{k}": session(7000 + k, offsets={4: 1e-3} if k == 1 else {}) for k in range(4)}
    model = SharedModel(ARM, *stacked(ARM, series))
    weights = [np.median(model.weight[model.group == k]) for k in range(4)]
    assert 0.8 < weights[1] / np.mean([weights[0], *weights[2:]]) < 1.25
    taken = [
        each for each in model.possible_changes([((1,), (0, 2, 3))]) if str(each.placed) == "joint_offset at joint 4"
    ]
    assert len(taken) == 1
    assert np.sqrt(model.variance(taken)) == pytest.approx(0.03, rel=0.15)


def test_a_change_is_as_sure_on_either_side_of_it():
    """Which recording comes first says nothing of whether they differ, and neither does which is the noisier one."""
    tables = {"a": session(71, rows=45, noise_mm=0.2), "b": session(72, offsets={2: 1e-3, 3: 2e-3}, give=2e-7)}
    found = {}
    for order in ("ab", "ba"):
        model = SharedModel(ARM, *stacked(ARM, {name: tables[name] for name in order}))
        possible = model.possible_changes([((1,), (0,))])
        found[order] = {
            (str(each.placed), each.placed.driver): (score.nats, score.statistic.q)
            for each, score in zip(possible, model.scores(possible, ()), strict=True)
        }
    assert found["ab"].keys() == found["ba"].keys()
    for name, score in found["ab"].items():
        assert score == pytest.approx(found["ba"][name], rel=1e-4, abs=1e-3), name


def test_a_joint_that_stands_still_shows_no_change_of_its_ratio():
    table = session(53)
    table.motor_angles[:, 4] = 1e-6 * np.sin(np.arange(len(table)))  # an encoder's last bit
    points = chain(ARM, table.motor_angles + OWN).tool
    held = replace(table, positions=points + np.random.default_rng(3).normal(0, 3e-5, points.shape))
    model = SharedModel(ARM, *stacked(ARM, {"a": session(51), "b": held}))
    possible = [each for each in model.possible_changes([((1,), (0,))]) if each.placed.name == "gear_ratio"]
    unseen = [
        each.placed.location
        for each, score in zip(possible, model.scores(possible, ()), strict=True)
        if not score.statistic.q
    ]
    assert unseen == ["joint 5"]


@pytest.mark.parametrize("rows", [60, 150])
def test_the_noise_of_short_tables_is_what_it_is(rows):
    """The numbers that a fit takes up are not counted as quiet rows."""
    model = SharedModel(ARM, *stacked(ARM, {"a": session(61, rows=rows), "b": session(62, rows=rows)}))
    assert np.sqrt(model.variance(())) == pytest.approx(0.03, rel=0.15)


def test_a_recording_that_is_too_short_to_be_fitted_alone_is_no_quiet_one():
    """45 rows hold fewer numbers than base, tool and all effects: alone, they left a tenth of their noise or less."""
    for seed in range(4):
        tables = {"a": session(31000 + 2 * seed), "b": session(31001 + 2 * seed, rows=45)}
        model = SharedModel(ARM, *stacked(ARM, tables))
        long, short = (np.median(model.weight[model.group == k]) for k in (0, 1))
        assert not model.weighed_alone
        assert 0.7 < long / short < 1.4
