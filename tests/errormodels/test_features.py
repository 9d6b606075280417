"""The paper's terms, counted and named as it does."""

import numpy as np
import pytest

from armscope.errormodels.features import (
    FDP_AI,
    FDP_CI,
    FOURIER_2_AI,
    PAPER_MODELS,
    POLYNOMIAL_4_AI,
    SDP_AI,
    SDP_CI,
    FeatureSet,
    ModelSpec,
)
from tests.errormodels.rows import identification

ANGLES, POSITIONS, _ = identification()
STILL_ANGLES, *_ = identification(still_wrist=True)


@pytest.mark.parametrize("spec", [POLYNOMIAL_4_AI, FOURIER_2_AI])
def test_fourth_degree_and_two_harmonics_of_six_joints_have_75_coefficients_for_three_axes(spec):
    features = spec.features(ANGLES)
    assert 3 * features.coefficients_per_axis == 75
    assert features.matrix(ANGLES).shape == (85, 25)
    assert len(features.term_names) == 25


def test_the_paper_names_fifteen_coefficients_of_the_first_degree_in_angles():
    assert 3 * FDP_AI.features(STILL_ANGLES).coefficients_per_axis == 15


@pytest.mark.parametrize(
    ("spec", "inputs", "printed"),
    [
        (FDP_CI, POSITIONS, "const px py pz"),  # Eq. (15)
        (SDP_CI, POSITIONS, "const px px^2 py py^2 pz pz^2"),  # Eq. (18)
        (FDP_AI, STILL_ANGLES, "const theta1 theta2 theta3 theta6"),  # Eq. (9)
        (SDP_AI, STILL_ANGLES, "const theta1 theta1^2 theta2 theta2^2 theta3 theta3^2 theta6 theta6^2"),  # Eq. (12)
    ],
)
def test_the_terms_are_those_of_the_printed_equations_in_their_order(spec, inputs, printed):
    assert spec.features(inputs).term_names == tuple(printed.split())


def test_joints_that_do_not_move_are_left_out_and_named():
    features = SDP_AI.features(STILL_ANGLES)
    assert features.moving == (True, True, True, False, False, True)
    assert not any("theta4" in name or "theta5" in name for name in features.term_names)
    assert all(SDP_AI.features(ANGLES).moving)


def test_equation_eighteen_by_hand():
    # delta x at p = (1000, -500, 600) mm with the printed coefficients
    printed = {
        "const": 1.34244,
        "px": -0.00126,
        "px^2": -0.0000002,
        "py": 0.00141,
        "py^2": -0.0000004,
        "pz": -0.00108,
        "pz^2": -0.0000003,
    }
    features = SDP_CI.features(POSITIONS)
    coefficients = [printed[name] for name in features.term_names]
    by_hand = 1.34244 - 1.26 - 0.2 - 0.705 - 0.1 - 0.648 - 0.108
    assert (features.matrix([[1000, -500, 600]]) @ coefficients).item() == pytest.approx(by_hand, rel=1e-12)


def test_fourier_terms_by_hand():
    features = FOURIER_2_AI.features(ANGLES[:, :2])
    values = dict(zip(features.term_names, features.matrix([[0.3, -0.4]])[0], strict=True))
    assert values == pytest.approx(
        {
            "const": 1.0,
            "cos(theta1)": np.cos(0.3),
            "sin(theta1)": np.sin(0.3),
            "cos(2 theta1)": np.cos(0.6),
            "sin(2 theta1)": np.sin(0.6),
            "cos(theta2)": np.cos(-0.4),
            "sin(theta2)": np.sin(-0.4),
            "cos(2 theta2)": np.cos(-0.8),
            "sin(2 theta2)": np.sin(-0.8),
        }
    )


def test_a_fourier_series_in_millimetres_has_a_wavelength_of_twice_the_range_and_says_so():
    positions = np.array([[0.0, 10.0, 7.0], [500.0, 40.0, 7.0]])
    features = ModelSpec("fourier", 2, "cartesian").features(positions)
    assert features.moving == (True, True, False)
    assert features.wavelengths_mm == (1000.0, 60.0, 0.0)
    assert features.term_names[1] == "cos(2 pi px / 1000 mm)"
    assert features.term_names[3] == "cos(2 pi px / 500 mm)"
    at_the_ends = features.matrix(positions)[:, 1]
    assert at_the_ends.tolist() == pytest.approx([1.0, -1.0])


def test_names_are_the_papers_where_it_has_some():
    assert [spec.name for spec in PAPER_MODELS] == [
        "FDP(CI)",
        "FDP(AI)",
        "SDP(CI)",
        "SDP(AI)",
        "4th-degree polynomial (AI)",
        "Fourier 2 (AI)",
    ]
    assert ModelSpec("polynomial", 3, "cartesian").name == "3rd-degree polynomial (CI)"


def test_a_feature_set_survives_the_way_through_a_file():
    for spec in (FOURIER_2_AI, ModelSpec("fourier", 3, "cartesian"), SDP_CI):
        features = spec.features(STILL_ANGLES if spec.space == "angular" else POSITIONS)
        assert FeatureSet.from_dict(features.to_dict()) == features


@pytest.mark.parametrize(
    ("wrong", "rule"),
    [
        (("polynom", 1, "angular"), "polynomial, fourier"),
        (("fourier", 1, "joint"), "cartesian, angular"),
        (("fourier", 0, "angular"), "1 or more"),
        (("fourier", 1.0, "angular"), "whole number"),
    ],
)
def test_a_model_that_does_not_exist_is_refused(wrong, rule):
    with pytest.raises(ValueError, match=rule):
        ModelSpec(*wrong)


@pytest.mark.parametrize(
    ("inputs", "rule"),
    [
        (ANGLES, "must be 3"),
        (POSITIONS[:, 0], "rows x inputs"),
        (np.full((4, 3), np.nan), "row 0, column 0"),
        (np.empty((0, 3)), "at least one"),
    ],
)
def test_inputs_that_do_not_suit_are_refused(inputs, rule):
    with pytest.raises(ValueError, match=rule):
        FDP_CI.features(inputs)


def test_predicting_for_another_number_of_joints_is_refused():
    with pytest.raises(ValueError, match="takes 6"):
        FDP_AI.features(ANGLES).matrix(ANGLES[:, :5])
