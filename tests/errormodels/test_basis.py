"""Three coordinate systems for one function, and the way back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.errormodels.basis import BasisKind, make_basis
from armscope.errormodels.features import FOURIER_2_AI, PAPER_MODELS, SDP_CI, ModelSpec
from tests.errormodels.rows import identification

ANGLES, POSITIONS, ERRORS = identification()
KINDS = list(BasisKind)


def columns_of(spec, rows=85):
    inputs = (ANGLES if spec.space == "angular" else POSITIONS)[:rows]
    features = spec.features(inputs)
    return features.matrix(inputs), features.term_names


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("spec", PAPER_MODELS, ids=lambda spec: spec.name)
def test_the_triangular_form_gives_the_rms_of_the_residuals_in_raw_terms(kind, spec):
    columns, names = columns_of(spec)
    basis = make_basis(kind, columns, names)
    coordinates = np.random.default_rng(1).normal(size=basis.dimensions) * basis.half_widths(ERRORS)[0]
    targets, rests = basis.targets(ERRORS)
    fitness = np.sqrt(np.sum((basis.triangular @ coordinates - targets[0]) ** 2) + rests[0])
    residuals = ERRORS[:, 0] - columns @ basis.raw_coefficients(coordinates)
    assert fitness == pytest.approx(np.sqrt(np.mean(residuals**2)), rel=1e-8)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(-10, 10), min_size=7, max_size=7))
def test_all_bases_span_the_same_functions(raw):
    columns, names = columns_of(SDP_CI)
    wanted = np.array(raw) / np.abs(columns).max(axis=0)
    values = columns @ wanted
    for kind in KINDS:
        basis = make_basis(kind, columns, names)
        coordinates = np.linalg.lstsq(columns @ basis.to_raw, values, rcond=None)[0]
        assert np.allclose(columns @ basis.raw_coefficients(coordinates), values, atol=1e-8)


def test_raw_coordinates_are_the_papers_coefficients():
    basis = make_basis("raw", *columns_of(SDP_CI))
    assert np.array_equal(basis.to_raw, np.eye(7))


def test_standardised_columns_have_mean_zero_and_deviation_one():
    columns, names = columns_of(SDP_CI)
    standardised = columns @ make_basis("standardised", columns, names).to_raw
    assert np.allclose(standardised[:, 0], 1)
    assert np.allclose(standardised[:, 1:].mean(axis=0), 0, atol=1e-9)
    assert np.allclose(standardised[:, 1:].std(axis=0), 1)


def test_qr_columns_are_orthonormal_and_their_factor_is_exactly_the_identity():
    columns, names = columns_of(FOURIER_2_AI)
    basis = make_basis("qr", columns, names)
    orthonormal = columns @ basis.to_raw
    assert np.allclose(orthonormal.T @ orthonormal / len(columns), np.eye(25), atol=1e-10)
    assert np.array_equal(basis.triangular, np.eye(25))


def test_in_the_qr_basis_the_box_holds_every_solution_and_is_the_rms_error():
    columns, names = columns_of(FOURIER_2_AI)
    basis = make_basis("qr", columns, names)
    box = basis.half_widths(ERRORS)
    rms = np.sqrt(np.mean(ERRORS**2, axis=0))
    assert np.allclose(box, rms[:, None])
    targets, _ = basis.targets(ERRORS)
    assert (np.abs(targets) <= box).all()
    # and no smaller box would do: errors that are one of the columns reach its wall
    reached, _ = basis.targets(basis.orthonormal[:, [3]])
    assert reached[0, 3] == pytest.approx(basis.half_widths(basis.orthonormal[:, [3]])[0, 3])


@pytest.mark.parametrize("kind", KINDS)
def test_a_term_that_works_alone_stays_in_the_box(kind):
    values = np.linspace(-3, 5, 20)
    columns = np.stack([np.ones(20), values], axis=1)
    basis = make_basis(kind, columns, ["const", "v"])
    only_this = basis.raw_coefficients(np.array([0.0, 1.0]))
    errors = (columns @ only_this)[:, None]
    assert basis.half_widths(errors)[0, 1] == pytest.approx(1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_a_column_that_repeats_earlier_ones_is_dropped_by_name_and_gets_zero(kind):
    generator = np.random.default_rng(2)
    a, b = generator.normal(size=(2, 30))
    columns = np.stack([np.ones(30), a, b, 2 * a - b + 5, a**2], axis=1)
    basis = make_basis(kind, columns, ["const", "a", "b", "both", "a^2"])
    assert basis.dropped == ("both",)
    assert basis.dimensions == 4
    coefficients = basis.raw_coefficients(generator.normal(size=(6, 4)))
    assert coefficients.shape == (6, 5)
    assert (coefficients[:, 3] == 0).all()
    assert (coefficients[:, 4] != 0).all()


def test_an_input_with_two_values_has_no_second_power():
    angles = np.where(np.arange(20) % 2, 0.3, -0.8)[:, None]
    features = ModelSpec("polynomial", 2, "angular").features(angles)
    assert make_basis("qr", features.matrix(angles), features.term_names).dropped == ("theta1^2",)


def test_fewer_rows_than_terms_keep_as_many_terms_as_rows():
    columns, names = columns_of(FOURIER_2_AI, rows=10)
    basis = make_basis("qr", columns, names)
    assert basis.dimensions == 10
    assert len(basis.dropped) == 15
    _, rests = basis.targets(ERRORS[:10])
    assert np.allclose(rests, 0, atol=1e-12)


def test_nothing_is_dropped_from_a_high_but_honest_degree_in_millimetres():
    assert make_basis("raw", *columns_of(ModelSpec("polynomial", 6, "cartesian"))).dropped == ()


def test_columns_without_constant_or_with_infinities_are_refused():
    with pytest.raises(ValueError, match="constant"):
        make_basis("qr", np.array([[2.0], [3.0]]), ["a"])
    with pytest.raises(ValueError, match="not finite"):
        make_basis("qr", np.array([[1.0, np.inf], [1.0, 3.0]]), ["const", "a"])
    with pytest.raises(ValueError, match="whitened"):
        make_basis("whitened", np.ones((2, 1)), ["const"])
