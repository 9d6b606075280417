"""Other assumptions: what a scenario changes and nothing else, unreachable geometries, and why a claim depends."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.errormodels.features import FDP_AI, FDP_CI, ModelSpec
from armscope.paper.decisive_errors import explain, meaning, reasons
from armscope.paper.enough_poses import COUNTS, enough_poses, smallest_sufficient
from armscope.paper.method import method_table
from armscope.paper.scenarios import JOINTLY, Varied, check_reach, scenarios
from armscope.paper.sensitivity import Fitting, judge_scenario, rank_of_anchored
from armscope.paper.virtual import PlannedPaths, PlannedPoses, Sizes, StudyPlan, measured
from armscope.swarm.settings import SwarmSettings
from armscope.world.of_the_paper import Tracker
from tests.paper.conftest import CORNERS_MM, STARTS_MM

LEVEL = ((1100, 800, 600), (1100, -800, 600), (1500, -800, 600), (1500, 800, 600))


@pytest.fixture(scope="module")
def plan(arm):
    paths = PlannedPaths(tuple(map(tuple, CORNERS_MM)), 50, tuple(map(tuple, STARTS_MM)), 20, 5, 200, 400)
    sizes = Sizes(1e-3, 1e-3, 3e-3, 3e-3)
    return StudyPlan(arm, sizes, paths, PlannedPoses(85, 400, 0.1, 3.1), Tracker((4.0, 0.0, 1.5)), 0.0, 8, 3)


@pytest.fixture(scope="module")
def varied():
    return Varied((), (0.5,), (0.3,), (0.5,), (LEVEL,), (100.0,), (0.2,), together=3, seed=1)


def test_each_scenario_changes_one_thing(plan, varied):
    every = {each.factor: each.plan for each in scenarios(plan, varied) if each.factor != JOINTLY}
    assert every["size of the tolerances"].sizes.base_m == pytest.approx(1.5e-3)
    assert every["range of theta6"].poses == replace(plan.poses, motor_6_rad=0.5)
    assert every["rise of II and III"].paths == replace(plan.paths, rise_mm=100.0)
    assert every["noise"].repeat_m == pytest.approx(0.2e-3)
    assert every["noise"].paths == plan.paths
    assert every["corners of trajectory I"].paths.corners_mm == LEVEL


def test_the_joint_design_changes_several(plan, varied):
    joint = [each for each in scenarios(plan, varied) if each.factor == JOINTLY]
    assert len(joint) == 3
    assert len({each.level for each in joint}) == 3


@pytest.mark.long
def test_a_geometry_that_cannot_reach_is_told_before_anything_runs(plan):
    far = replace(plan, paths=replace(plan.paths, corners_mm=((9000, 0, 0), *plan.paths.corners_mm[1:])))
    with pytest.raises(InputError, match=r"corners.*trajectory test 1: point 1"):
        check_reach([("configured study", plan), ("corners", far)])
    assert check_reach([("configured study", plan)])["points"].tolist() == [600]


def test_a_study_repeats_to_the_bit_and_noise_is_noise(plan):
    first, _ = measured(plan)
    again, _ = measured(plan)
    noisy, _ = measured(replace(plan, repeat_m=1e-3))
    path = "test 1"
    assert np.array_equal(first.measurements[path].errors_mm, again.measurements[path].errors_mm)
    apart = noisy.measurements[path].errors_mm[0] - first.measurements[path].errors_mm[0]
    rough = np.diff(apart, axis=0).std() / np.sqrt(2)  # the robots differ smoothly, the noise from point to point
    assert rough == pytest.approx(1.0, rel=0.15)


def test_a_scenario_judges_its_own_robots(plan, varied):
    scenario = next(each for each in scenarios(plan, varied) if each.factor == "range of theta6")
    fitting = Fitting((FDP_CI, FDP_AI), SwarmSettings(iterations=60), "qr", "per axis", [0])
    table = judge_scenario(scenario, fitting).set_index(["key", "method"])
    assert set(table["factor"]) == {"range of theta6"}
    assert table.loc["alternative", "improved"]["robots"] == 8
    assert table.loc["alternative", "improved"]["share"] == 1
    assert table.loc["alternative", "as printed"]["share"] == 0
    assert table["robots_drawn"].iloc[0] == 9


def test_the_rank_counts_those_that_are_smaller():
    columns = pd.MultiIndex.from_tuples([("FDP(CI)", "identification", "3D")])
    cells = pd.DataFrame([[2.0], [1.0], [3.0]], index=["anchored", "ensemble 1", "ensemble 2"], columns=columns)
    assert rank_of_anchored(cells) == (2, 3)


def test_more_poses_fit_the_paths_better_on_the_whole(plan):
    study, _ = measured(plan)
    table = enough_poses(plan, study)
    assert sorted(table["poses"].unique()) == list(COUNTS)
    medians = table.groupby("poses")["rms_mm"].median()
    assert medians[COUNTS[0]] > medians[COUNTS[-1]]
    enough = smallest_sufficient(table)
    robot = table[table["robot"] == "ensemble 3"].set_index("poses")["rms_mm"]
    assert robot[enough["ensemble 3"]] <= 1.1 * robot[COUNTS[-1]]


def test_the_method_table_has_every_combination_and_least_squares_below_all(study):
    robots = study.measurements.robots[1:3]
    table, claims = method_table(study.measurements, (FDP_CI, FDP_AI), robots, [0], SwarmSettings(iterations=50))
    assert len(table) == 2 * (3 * 2 * 3 + 1)
    assert (table["excess_median"] >= -1e-9).all()
    assert set(claims["key"]) == {"alternative", "iterations"}
    one = table.set_index(["basis", "layout", "update", "model"])["excess_median"]
    assert one["raw", "joint", "original", "FDP(CI)"] > 10 > one["qr", "per axis", "constriction", "FDP(CI)"]


def test_a_model_of_which_nothing_is_claimed_stands_in_the_method_table_alone(study):
    robots = list(study.measurements.robots[1:2])
    third = ModelSpec("polynomial", 3, "angular")
    table, claims = method_table(study.measurements, (third,), robots, [1], SwarmSettings(particles=10, iterations=5))
    assert set(table["model"]) == {third.name}
    assert claims.empty
    assert {"key", "share", "share_low"} <= set(claims.columns)


def test_planted_reasons_are_found_and_chance_is_none():
    random = np.random.default_rng(0)
    errors = random.standard_normal((100, 30))
    names = [f"a{k}" for k in range(30)]
    found = explain(errors, 2 * np.abs(errors[:, 7]) - errors[:, 3] + 0.3 * random.standard_normal(100), names)
    assert set(found.errors[:2]) == {"a7", "a3"}
    assert found.share > 0.8
    assert explain(errors, random.standard_normal(100), names).share < 0.1


def test_reasons_are_sought_where_robots_differ():
    random = np.random.default_rng(1)
    errors = pd.DataFrame(random.standard_normal((60, 4)), columns=["a2", "beta2", "theta3", "base rx"])
    errors.insert(0, "robot", [f"ensemble {k}" for k in range(60)])
    number = np.exp(errors["beta2"].to_numpy())
    rows = {"method": "improved", "robot": errors["robot"], "number": number}
    some = pd.DataFrame({"key": "one", "true": number > 1, **rows})
    outcome = pd.concat([some, pd.DataFrame({"key": "two", "true": True, **rows})])
    table = reasons(outcome, errors)
    assert table["key"].tolist() == ["one"]
    assert table["errors"].iloc[0].startswith("beta2")
    assert "tilt of axis 2" in table["sentence"].iloc[0]
    assert meaning("theta3") == "zero of joint 3"
    assert meaning("base rx") == "base about x"
    assert meaning("alpha2") == "twist α2"
