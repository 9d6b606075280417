"""The size of an effect is what the examples of the contract call rms_at_tool_mm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from armscope.core.averages import rms
from armscope.robot.description_file import load_description
from armscope.world.kinds import Concealed
from armscope.world.spec import KINDS
from armscope.world.statics import Session
from armscope.world.strength import Frames, carried, equilibrium, fit_frames, make_scene, rms_after_frames, sized
from tests.world.scenes import drawn, scene_of

EXAMPLES = Path(__file__).parents[3] / "shared" / "examples"


def test_frames_that_were_put_in_are_fitted_back_exactly():
    scene, tool = scene_of("six-axis")
    put = Frames(np.array([3e-3, -4e-3, 1e-3]), np.array([1e-3, -2e-3, 5e-4]), np.array([1e-3, -5e-4, 2e-3]))
    found = fit_frames(tool, scene.tool_turn, put.place(tool, scene.tool_turn))
    for name in ("translation", "rotation", "tool_error"):
        assert getattr(found, name) == pytest.approx(getattr(put, name), abs=1e-12)


def test_the_rms_after_frames_is_the_least_that_nine_free_parameters_leave():
    scene, tool = scene_of("parallelogram-120kg")
    bent = equilibrium(scene, [drawn(scene, "joint_compliance", "joint 2")]).tool

    def left(p):
        placed = (tool + scene.tool_turn @ p[6:]) @ Rotation.from_rotvec(p[3:6]).as_matrix().T + p[:3]
        return (placed - bent).ravel() * 1e3

    fitted = least_squares(left, np.zeros(9), x_scale=1e-3, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    assert rms_after_frames(bent, tool, scene.tool_turn) * 1e3 == pytest.approx(rms(fitted.fun), rel=1e-6)


@pytest.mark.parametrize("name", ["joint_compliance", "bearing_compliance", "gear_eccentricity", "unknown/local_bump"])
def test_an_effect_comes_out_as_strong_as_asked_for(name):
    scene, tool = scene_of("seven-axis", count=40)
    found = sized(scene, drawn(scene, name, "joint 4"), 1.5e-4)
    again = equilibrium(scene, [found.effect]).tool
    assert found.rms == pytest.approx(1.5e-4, rel=2e-3)
    assert found.rms == rms_after_frames(again, tool, scene.tool_turn)


@pytest.mark.parametrize("place", ["joint 1", "joint 6"])
def test_an_offset_that_the_frames_take_up_cannot_be_concealed(place):
    scene, _ = scene_of("six-axis", count=40)
    assert sized(scene, drawn(scene, "joint_offset", place), 1e-4) is None


def test_a_payload_error_gets_its_strength_from_what_gives_way_under_it():
    scene, _ = scene_of("six-axis", count=40)
    springs = [drawn(scene, "joint_compliance", f"joint {j}") for j in (2, 3)]
    error, alone = carried(scene, drawn(scene, "payload_error", "payload"), springs, 5e-5)
    assert error.rms == pytest.approx(5e-5, rel=2e-2)
    assert error.effect.values["mass"] == pytest.approx(0.3 * 20)
    assert all(spring.rms > error.rms for spring in alone)


@pytest.mark.shared
@pytest.mark.parametrize("name", ["one-effect", "five-effects", "seven-axes-modified-dh"])
def test_the_contracts_examples_come_out_as_their_truth_says(name):
    """Our engine with the stated numbers gives the stated RMS of each effect and leaves the stated noise."""
    if not EXAMPLES.is_dir():
        pytest.skip(f"the shared examples are not at {EXAMPLES}")
    table = pd.read_csv(EXAMPLES / name / "recordings.csv")
    truth = yaml.safe_load((EXAMPLES / name / "truth.yaml").read_text())
    description = load_description(EXAMPLES / name / "robot.yaml")
    motors = len(description.dh.joints)
    commanded = table[[f"q{m + 1}_rad" for m in range(motors)]].to_numpy()
    count, zero = len(table), np.zeros((len(table), motors))
    ones = np.ones(count)
    session = Session(commanded, table["payload_kg"].to_numpy(float), 0 * ones, 20 * ones, ones.astype(int), zero, zero)
    scene, tool = make_scene(description, session)
    effects = [as_concealed(effect, motors) for effect in truth["effects"]]
    for effect, stated in zip(effects, truth["effects"], strict=True):
        alone = rms_after_frames(equilibrium(scene, [effect]).tool, tool, scene.tool_turn)
        if stated["effect"] != "gear_eccentricity":  # its phase isn't stated
            assert alone * 1e3 == pytest.approx(stated["rms_at_tool_mm"], rel=3e-3)
    frames = truth["frames"]
    stated_frames = Frames(
        np.array(frames["translation_mm"]) / 1e3,
        np.array(frames["rotation_rad"]),
        np.array(frames["tool_error_mm"]) / 1e3,
    )
    left = (
        stated_frames.place(equilibrium(scene, effects).tool, scene.tool_turn) * 1e3
        - table[["x_mm", "y_mm", "z_mm"]].to_numpy()
    )
    assert rms(left) == pytest.approx(truth["sigma_mm"], rel=0.08)


def as_concealed(effect, motors):
    values = {p["name"]: p["value"] * (1e-3 if p["unit"] == "mm" else 1.0) for p in effect["parameters"]}
    if effect["effect"] == "gear_eccentricity":
        values |= {"phase": 0.0, "per_turn": 2.0 if motors == 7 else 1.0}
    return Concealed(KINDS[effect["effect"]], effect["location"], values)
