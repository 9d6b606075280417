"""The velocity update, number by number."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.swarm.update import PRESETS, Coefficients, UpdateRule, clerc_constriction, velocity_update

AS_PRINTED = PRESETS["original"].coefficients(0, 200)


def one(value: float) -> np.ndarray:
    return np.full((1, 1, 1), value)


def test_the_printed_formula_by_hand():
    # v(t+1) = 0.5 + 2.05 x 0.5 x (2 - 1) + 2.05 x 0.25 x (4 - 1) = 0.5 + 1.025 + 1.5375
    updated = velocity_update(one(1.0), one(0.5), one(2.0), one(4.0), one(0.5), one(0.25), AS_PRINTED)
    assert updated.item() == pytest.approx(3.0625, rel=1e-15)


def test_constriction_multiplies_the_whole_printed_formula():
    constricted = PRESETS["constriction"].coefficients(0, 200)
    updated = velocity_update(one(1.0), one(0.5), one(2.0), one(4.0), one(0.5), one(0.25), constricted)
    assert updated.item() == pytest.approx(0.7298437881283576 * 3.0625, rel=1e-15)


def test_each_dimension_has_its_own_random_numbers():
    positions = np.array([[[1.0, 10.0]]])
    velocities = np.array([[[0.0, 1.0]]])
    own, best = np.array([[[3.0, 10.0]]]), np.array([[[1.0, 20.0]]])
    r1, r2 = np.array([[[0.5, 0.9]]]), np.array([[[0.9, 0.1]]])
    updated = velocity_update(positions, velocities, own, best, r1, r2, Coefficients(0.5, 1.0, 2.0))
    assert updated[0, 0].tolist() == pytest.approx([0.5 * 2.0, 0.5 + 2.0 * 0.1 * 10.0])


def test_a_particle_on_both_bests_only_coasts():
    here = one(7.0)
    updated = velocity_update(here, one(0.25), here, here, one(0.9), one(0.9), AS_PRINTED)
    assert updated.item() == 0.25


def test_nothing_passed_in_is_changed():
    generator = np.random.default_rng(1)
    given_arrays = [generator.random((2, 3, 4)) for _ in range(6)]
    copies = [array.copy() for array in given_arrays]
    velocity_update(*given_arrays, AS_PRINTED, 0.1)
    assert all(np.array_equal(array, copy) for array, copy in zip(given_arrays, copies, strict=True))


def test_the_clamp_limits_speed_in_both_directions_and_nothing_else():
    velocities = np.array([[[-9.0, -0.2, 0.2, 9.0]]])
    here = np.zeros_like(velocities)
    updated = velocity_update(here, velocities, here, here, here, here, AS_PRINTED, np.array([1.0, 1.0, 1.0, 2.0]))
    assert updated[0, 0].tolist() == [-1.0, -0.2, 0.2, 2.0]


def test_clercs_factor_undoes_the_growth_of_the_unconstricted_swarm():
    # unconstricted, without randomness and with p = g, a swarm's recurrence has the characteristic polynomial
    # lambda^2 + (phi - 2) lambda + 1: it grows by its larger root in each iteration, and the factor undoes just that
    growth = np.abs(np.roots([1.0, 4.1 - 2.0, 1.0])).max()
    assert clerc_constriction(2.05, 2.05) == pytest.approx(1.0 / growth, rel=1e-14)
    assert clerc_constriction(2.05, 2.05) == pytest.approx(0.729843788, abs=1e-9)


def test_constriction_is_a_constant_inertia_with_smaller_pulls():
    same = UpdateRule(inertia=0.7298437881283576, cognitive=1.496179765663133, social=1.496179765663133)
    assert same.coefficients(3, 200) == pytest.approx(PRESETS["constriction"].coefficients(3, 200), rel=1e-14)


def test_the_inertia_preset_falls_from_nine_tenths_to_four_tenths():
    rule = PRESETS["inertia"]
    assert rule.coefficients(0, 200).inertia == 0.9
    assert rule.coefficients(199, 200).inertia == pytest.approx(0.4)
    falling = [rule.coefficients(k, 200).inertia for k in range(200)]
    assert np.allclose(np.diff(falling), -0.5 / 199)


@pytest.mark.parametrize("sum_of_pulls", [4.0, 3.0, 0.0])
def test_clercs_factor_is_refused_where_it_is_not_defined(sum_of_pulls):
    with pytest.raises(ValueError, match="above 4"):
        clerc_constriction(sum_of_pulls / 2, sum_of_pulls / 2)


@pytest.mark.parametrize("name", ["inertia", "cognitive", "social", "constriction", "final_inertia"])
@pytest.mark.parametrize("value", [-0.1, float("nan"), float("inf")])
def test_a_rule_with_an_impossible_weight_is_refused_by_name(name, value):
    weights = {"inertia": 0.7, "cognitive": 1.5, "social": 1.5} | {name: value}
    with pytest.raises(ValueError, match=name):
        UpdateRule(**weights)


numbers = st.floats(-1e3, 1e3)


@given(st.tuples(*[numbers] * 4), st.floats(0, 1), st.floats(0, 1), numbers)
def test_the_update_does_not_depend_on_where_the_origin_is(values, r1, r2, shift):
    x, v, p, g = values
    here = velocity_update(one(x), one(v), one(p), one(g), one(r1), one(r2), AS_PRINTED)
    there = velocity_update(one(x + shift), one(v), one(p + shift), one(g + shift), one(r1), one(r2), AS_PRINTED)
    assert here.item() == pytest.approx(there.item(), abs=1e-9)
