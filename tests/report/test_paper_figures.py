"""Figures adapt to whichever models are configured, and nothing that is not seen stands in a legend."""

import numpy as np
import pandas as pd
import pytest

from armscope.errormodels.features import FDP_CI, ModelSpec
from armscope.errormodels.swarm_fit import fit_swarms
from armscope.paper.bands import TRUE, band_of, ensemble_bands
from armscope.paper.measurements import Measurements, PoseSet
from armscope.report.figures.paper import FIGURES, PaperResults, draw
from armscope.robot import load_arm
from tests.robot.arms import SK120

THIRD, THREE = ModelSpec("polynomial", 3, "angular"), ModelSpec("fourier", 3, "angular")


@pytest.fixture(scope="module")
def measurements():
    random = np.random.default_rng(0)
    sets = []
    for name, count in (("identification", 40), ("test 1", 12), ("test 2", 12), ("test 3", 12)):
        angles = random.uniform(-1, 1, (count, 6))
        angles[:, 3:5] = 0
        place = random.uniform(500, 1500, (count, 3))
        sets.append(PoseSet(name, angles, place, random.standard_normal((4, count, 3))))
    return Measurements(("anchored", "ensemble 1", "ensemble 2", "ensemble 3"), tuple(sets))


def shown(measurements, *specs):
    fits = fit_swarms(measurements.fit_problems(specs, ["anchored"]), [0])
    return PaperResults(measurements, fits, pd.DataFrame(), load_arm(SK120), np.array([4000.0, 0.0, 1500.0]))


@pytest.mark.parametrize("name", [name for name in FIGURES if name not in ("fig06", "fig10")])
def test_every_figure_is_drawn_for_other_models(measurements, name):
    assert draw(name, shown(measurements, THIRD, THREE)).axes


def test_one_model_is_enough_and_a_figure_without_models_says_so(measurements):
    alone = shown(measurements, FDP_CI)
    assert len(draw("fig06", alone).axes) == 3
    assert len(draw("fig04", alone).axes) == 1
    with pytest.raises(ValueError, match="fig07 needs a model of angular input"):
        draw("fig07", alone)


def test_joints_that_stand_still_together_are_one_line(measurements):
    joints = draw("fig05", shown(measurements, FDP_CI)).axes[1]
    labels = [line.get_label() for line in joints.get_lines()]
    assert r"$\theta_4$ = $\theta_5$" in labels
    assert len(labels) == 5


def test_bands_are_quantiles_of_the_robots_and_thin_ones_have_no_entry(measurements):
    drawn = Measurements(
        measurements.robots[1:],
        tuple(PoseSet(s.name, s.motor_angles, s.nominal_mm, s.errors_mm[1:]) for s in measurements.sets),
    )
    fits = fit_swarms(drawn.fit_problems((FDP_CI,), list(drawn.robots)), [0])
    bands = ensemble_bands(drawn, fits)
    low, high = band_of(bands, "test 1", TRUE)
    assert low == pytest.approx(np.percentile(drawn["test 1"].errors_mm, 5, axis=0))
    assert high == pytest.approx(np.percentile(drawn["test 1"].errors_mm, 95, axis=0))
    estimated = np.stack([fit.predict(drawn["test 1"].nominal_mm, seed=0) for fit in fits])
    assert band_of(bands, "test 1", "FDP(CI)")[1] == pytest.approx(np.percentile(estimated, 95, axis=0))
    thin = bands.copy()
    mine = thin["model"] == "FDP(CI)"
    for axis in "xyz":
        thin.loc[mine, f"high_{axis}_mm"] = thin.loc[mine, f"low_{axis}_mm"] + 1e-4
    for table, expected in ((bands, True), (thin, False)):
        figure = draw("fig06", PaperResults(measurements, shown(measurements, FDP_CI).fits, table))
        entries = [text.get_text() for text in figure.legends[0].get_texts()]
        assert ("estimated, 5–95 % of them" in entries) == expected
