"""Figures and tables of the closed loop and of the paper's outlook, on a study of made-up errors."""

import numpy as np
import pytest

from armscope.compensation.closed_loop import NO_MODEL, cross_table
from armscope.errormodels.features import FDP_CI, FOURIER_2_AI
from armscope.errormodels.fitted import ModelSet
from armscope.errormodels.swarm_fit import fit_swarms
from armscope.paper.closed_loop import paper_closed_loop
from armscope.paper.measurements import Measurements, PoseSet
from armscope.paper.outlook import paper_products, paper_regions
from armscope.report.figures.compensation import cross_table_figure, regions_figure
from armscope.report.style import save_figure
from armscope.robot import chain
from armscope.world.tolerances import geometric_errors
from tests.compensation.arms import identification_angles, sk120


@pytest.fixture(scope="module")
def study():
    """An SK120 with random geometric errors: identification rows and one path of commands."""
    arm, truth = sk120(), geometric_errors(sk120())
    rng = np.random.default_rng(2)
    errors = rng.normal(size=len(truth.names)) * truth.sigmas
    path = identification_angles(2, 4)
    path = path[0] + np.linspace(0, 1, 40)[:, None] * (path[1] - path[0])
    sets = []
    for name, angles in (("identification", identification_angles(85, 6)), ("test 1", path)):
        nominal = chain(arm, angles).tool * 1e3
        true = truth.positions(angles, errors / truth.sigmas) * 1e3
        sets.append(PoseSet(name, angles, nominal, true - nominal + rng.normal(0, 0.01, true.shape)))
    return arm, Measurements(("anchored",), tuple(sets)), errors


def test_cross_table_and_its_figure_show_every_model(study, tmp_path):
    arm, measurements, errors = study
    fits = fit_swarms(measurements.fit_problems([FDP_CI], ["anchored"]), [0])
    table = cross_table(
        paper_closed_loop(arm, measurements, fits, errors, ModelSet(products=(FOURIER_2_AI,)), diagnosed=False)
    )
    rms = table[(table["axis"] == "3D") & (table["stage"] == "closed loop")].set_index("model")["rms_mm"]
    assert list(rms.index) == [NO_MODEL, "FDP(CI)", "Fourier 2 (AI) with products"]
    assert rms["Fourier 2 (AI) with products"] < 0.5 * rms["FDP(CI)"] < 0.25 * rms[NO_MODEL]
    figure = cross_table_figure(table)
    assert [label.get_text() for label in figure.axes[0].get_yticklabels()] == list(rms.index)
    assert save_figure(figure, tmp_path / "cross.png", ("png",))[0].stat().st_size > 5000


def test_products_beat_sums_where_errors_are_geometric(study):
    _, measurements, _ = study
    table = paper_products(measurements, [FOURIER_2_AI]).set_index("kind")
    assert table.loc["products", "held_out_rms_mm"] < 0.5 * table.loc["sums", "held_out_rms_mm"]
    assert table.loc["products", "test 1"] < table.loc["sums", "test 1"]
    assert table.loc["products", "candidates"] > table.loc["products", "terms"]


def test_regions_are_compared_on_the_paths_too(study, tmp_path):
    _, measurements, _ = study
    table = paper_regions(measurements, [FDP_CI])
    assert table["regions"].tolist() == [1, 2, 4, 8]
    assert table["chosen"].sum() == 1
    assert table["test 1"].notna().all()
    assert save_figure(regions_figure(table), tmp_path / "regions.png", ("png",))[0].stat().st_size > 5000
