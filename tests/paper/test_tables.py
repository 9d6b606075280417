"""Residuals, Table 2, sub-volumes and claims, each recomputed here by a shorter way."""

import numpy as np
import pandas as pd
import pytest

from armscope.errormodels.features import FDP_CI, FOURIER_2_AI
from armscope.paper.beside_printed import cross_check, table2
from armscope.paper.outlook import _region, _split, outlook, sub_volumes
from armscope.paper.residuals import residual_table
from tests.paper.conftest import ENSEMBLE, rss


def cell(table, **keys):
    for column, value in keys.items():
        table = table[table[column] == value]
    assert len(table) == 1
    return table.iloc[0]


def test_uncompensated_cells_are_the_errors_themselves(study, residuals):
    errors = study.measurements["test 2"].errors_mm
    found = cell(residuals, robot="ensemble 3", model="Uncompensated", trajectory="test 2", axis="y")
    assert found["rss_mm"] == pytest.approx(rss(errors[3][:, 1]))
    assert found["rms_mm"] == pytest.approx(found["rss_mm"] / np.sqrt(200))
    whole = cell(residuals, robot="anchored", model="Uncompensated", trajectory="test 2", axis="3D")
    assert whole["rss_mm"] == pytest.approx(np.linalg.norm(errors[0]))


def test_residual_cells_are_measured_minus_predicted(study, fits, residuals):
    fit = next(f for f in fits if f.label == "anchored" and f.name == "FDP(AI)")
    poses = study.measurements["test 1"]
    left = poses.errors_mm[0] - fit.predict(poses.motor_angles, seed=2)
    found = cell(residuals, robot="anchored", model="FDP(AI)", trajectory="test 1", axis="z", method="swarm", seed=2)
    assert found["rss_mm"] == pytest.approx(rss(left[:, 2]))


def test_least_squares_is_at_least_as_good_where_it_was_fitted(residuals):
    rows = residuals[(residuals["trajectory"] == "identification") & (residuals["axis"] == "3D")]
    keys = ["robot", "model"]
    best = rows[rows["method"] == "least squares"].set_index(keys)["rms_mm"]
    swarms = rows[rows["method"] == "swarm"].groupby(keys)["rms_mm"].min()[best.index]
    assert len(best) == 6 * (1 + ENSEMBLE)
    assert (best <= swarms * (1 + 1e-12)).all()


def test_table2_has_the_median_seed_its_spread_and_the_printed_cell(residuals):
    table = table2(residuals)
    assert len(table) == 7 * 4 * 4
    row = cell(table, model="SDP(CI)", trajectory="test 1", axis="x")
    seeds = residuals.query("robot == 'anchored' and model == 'SDP(CI)' and trajectory == 'test 1' and axis == 'x'")
    swarm = seeds[seeds["method"] == "swarm"]["rss_mm"]
    assert row["printed"] == 2.5
    assert row["rss_median"] == pytest.approx(swarm.median())
    assert (row["rss_low"], row["rss_high"]) == (swarm.min(), swarm.max())
    assert row["rss_ratio"] == pytest.approx(row["rss_median"] / 2.5)
    assert row["rms_median"] == pytest.approx(row["rss_median"] / np.sqrt(200))
    assert row["rss_ensemble_low"] <= row["rss_ensemble_median"] <= row["rss_ensemble_high"]
    assert row["rss_ensemble_ratio"] == pytest.approx(row["rss_ensemble_median"] / 2.5)
    assert np.isnan(cell(table, model="Fourier 2 (AI)", trajectory="test 1", axis="x")["printed"])


def test_the_rank_of_the_anchored_robot_is_its_place_among_all(residuals):
    found = cell(table2(residuals), model="FDP(CI)", trajectory="identification", axis="3D")
    rows = residuals[(residuals["trajectory"] == "identification") & (residuals["axis"] == "3D")]
    by_robot = rows[(rows["model"] == "FDP(CI)") & (rows["method"] == "swarm")].groupby("robot")["rms_mm"].median()
    assert found["robots"] == 1 + ENSEMBLE
    assert found["rank"] == sorted(by_robot).index(by_robot["anchored"]) + 1


def test_table2_of_a_single_robot_has_no_ensemble(residuals):
    table = table2(residuals[residuals["robot"] == "anchored"])
    assert table["rss_ensemble_median"].isna().all()
    assert table["rss_median"].notna().all()


def test_identification_residual_is_of_the_printed_size(residuals):
    """Table 2 prints 2.3, 1.9, 2.9 for FDP(CI): as a root of the sum of squares the anchored robot's is of that size,
    as a root of the mean of squares it is nine times too small."""
    found = cell(table2(residuals), model="FDP(CI)", trajectory="identification", axis="3D")
    printed = np.sqrt(2.3**2 + 1.9**2 + 2.9**2)
    assert 0.5 < found["rss_median"] / printed < 2
    assert found["rms_median"] / printed < 0.25


def test_one_region_is_the_plain_fit(study, residuals):
    table = sub_volumes(study.measurements)
    found = cell(table, robot="ensemble 2", model="FDP(CI)", regions=1, trajectory="test 3")
    keys = {"robot": "ensemble 2", "model": "FDP(CI)", "trajectory": "test 3", "axis": "3D"}
    assert found["rms_mm"] == pytest.approx(cell(residuals, method="least squares", **keys)["rms_mm"])
    assert found["coefficients"] == 12
    assert cell(table, robot="anchored", model="SDP(CI)", regions=4, trajectory="test 1")["coefficients"] == 84


def test_more_regions_fit_their_own_poses_better(study):
    table = sub_volumes(study.measurements)
    own = table[table["trajectory"] == "identification"].pivot_table(
        index=["robot", "model"], columns="regions", values="rms_mm"
    )
    assert (own[2] <= own[1]).all()
    assert (own[4] <= own[2]).all()


def test_regions_halve_the_poses_at_their_medians():
    points = np.random.default_rng(0).uniform(size=(80, 3))
    tree = _split(points, np.arange(80), 2, 0)
    numbers = _region(tree, points)
    assert np.bincount(numbers).tolist() == [20, 20, 20, 20]
    low = points[numbers < 2, 1]
    assert low.max() < points[numbers >= 2, 1].min()


def test_a_region_with_its_own_law_is_found(study):
    """Where each half of the workspace has another linear law, two regions fit exactly and one does not."""
    measurements = study.measurements
    rows = measurements.identification
    cut = np.median(rows.nominal_mm[:, 1])
    sets = []
    for each in measurements.sets:
        law = np.where(each.nominal_mm[:, 1:2] < cut, 1.0, -2.0) * (1 + 1e-3 * each.nominal_mm)
        sets.append(type(each)(each.name, each.motor_angles, each.nominal_mm, law[None]))
    table = sub_volumes(type(measurements)(("toy",), tuple(sets)), specs=(FDP_CI,), splits=(0, 1))
    rms = table.set_index(["regions", "trajectory"])["rms_mm"]
    assert rms[1, "test 1"] > 0.1
    assert rms[2, "test 1"] < 1e-9


@pytest.fixture(scope="module")
def extended(study):
    return outlook(study.measurements)


@pytest.mark.long
def test_plain_models_of_the_outlook_are_least_squares(residuals, extended):
    found = cell(extended, robot="ensemble 2", model="SDP(CI)", kind="sums", trajectory="test 2")
    keys = {"robot": "ensemble 2", "model": "SDP(CI)", "trajectory": "test 2", "axis": "3D"}
    assert found["rms_mm"] == pytest.approx(cell(residuals, method="least squares", **keys)["rms_mm"])
    assert found["size"] == 7


def test_products_find_a_law_that_is_a_product_and_leave_sums_alone(study):
    """Planted: an error that is a product of two angles; and one that is a sum, where products bring nothing."""
    measurements, found = study.measurements, {}
    for law in ("product", "sum"):
        sets = []
        for each in measurements.sets:
            a, b = np.sin(each.motor_angles[:, 1]), np.cos(each.motor_angles[:, 2])
            errors = np.outer(a * b if law == "product" else a + b, [1.0, -2.0, 0.5])
            sets.append(type(each)(each.name, each.motor_angles, each.nominal_mm, errors[None]))
        toy = type(measurements)(("toy",), tuple(sets))
        table = outlook(toy, regions=(), products=(FOURIER_2_AI,))
        found[law] = table[table["trajectory"] == "test 1"].set_index("kind")["rms_mm"]
    assert found["product"]["products"] < 1e-6 < 1e-2 < found["product"]["sums"]
    assert found["sum"]["sums"] < 1e-9
    assert found["sum"]["products"] < 1e-6


def test_residuals_of_robots_without_fits_are_uncompensated_only(study, fits):
    table = residual_table(study.measurements, [f for f in fits if f.label == "anchored"])
    lonely = table[table["robot"] == "ensemble 1"]
    assert set(lonely["method"]) == {"none"}
    assert isinstance(table, pd.DataFrame)


def test_the_cross_check_compares_what_anchoring_was_not_told(fits, residuals):
    table = cross_check(residuals, fits)
    assert table["kind"].value_counts().to_dict() == {"slope": 12 + 18 + 24, "error": 60}
    assert not table["number"].str.contains("Eq. (15)", regex=False).any()
    row = cell(table, number="Eq. (9), x, theta3")
    fit = next(f for f in fits if f.label == "anchored" and f.name == "FDP(AI)")
    assert row["printed"] == 2.64
    assert row["anchored"] == pytest.approx(fit.least_squares[0, list(fit.features.term_names).index("theta3")])
    assert row["same_sign"] == 1  # told only Eqs. (15)-(17), every robot has the printed sign here
    assert row["inside"] == (row["low"] <= 2.64 <= row["high"])
    error = cell(table, number="FDP(CI), test 1, y")
    keys = {"model": "FDP(CI)", "trajectory": "test 1", "axis": "y", "method": "least squares", "robot": "anchored"}
    assert error["anchored"] == pytest.approx(cell(residuals, **keys)["rss_mm"], rel=1e-3)
