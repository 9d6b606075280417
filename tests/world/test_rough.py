"""Arms as rough as real ones: every blemish does what it says, by itself, and in a world."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pandas as pd
import pytest
import yaml
from scipy.stats import multivariate_normal

from armscope.core.averages import rms
from armscope.world.constants import ROUGH
from armscope.world.folder import build
from armscope.world.imperfections import BEARING, DRIVE, OF, PAYLOAD_SHARE, PEDESTAL, RUNS, WANDER, lagging, waves
from armscope.world.kinds import Concealed
from armscope.world.oracle import evidence_of_causes, oracle_of, oracle_rms
from armscope.world.rough import BLEMISHES, as_stated, blemishes, draw_broken, rough_noise
from armscope.world.spec import WorldSpec
from armscope.world.strength import equilibrium
from armscope.world.virtual_arm import conceal, measure_session
from tests.world.by_hand import ROBOTS, HandArm
from tests.world.scenes import scene_of

TURN = np.linspace(0, 2 * np.pi, 512, endpoint=False)


def test_waves_have_their_numbers_and_size_and_a_spectrum_that_falls():
    values = {"rms": 5e-5, "first": 3.0, "last": 60.0, "slope": 1.0, "seed": 4.0}
    error = waves(TURN, values)
    assert np.sqrt(np.mean(error**2)) == pytest.approx(5e-5, rel=1e-6)
    spectrum = np.abs(np.fft.rfft(error))
    assert spectrum[:3].max() < 1e-9 * spectrum.max() > spectrum[61:].max()
    assert 30 < np.sum(spectrum > 1e-3 * spectrum.max()) < 50  # two thirds of 58
    assert np.mean(spectrum[3:15] ** 2) > 4 * np.mean(spectrum[45:61] ** 2)


def test_what_lags_follows_a_step_exponentially():
    time = np.linspace(0, 6000, 301)
    followed = lagging(np.where(time > 0, 24.0, 20.0), time, 2000.0)
    # the first interval already counts as warm
    assert followed[1:] == pytest.approx(24 - 4 * np.exp(-time[1:] / 2000))


def test_a_pedestal_alike_about_both_axes_is_a_base_that_gives_way():
    scene, _ = scene_of("six-axis")
    alike = Concealed(PEDESTAL, "base", {"soft": 1e-7, "stiff": 1e-7, "direction": 0.4})
    base = Concealed(OF["base_compliance"], "base", {"compliance": 1e-7})
    assert equilibrium(scene, [alike]).tool == pytest.approx(equilibrium(scene, [base]).tool, abs=1e-8)


def test_a_pedestal_that_is_soft_about_one_axis_moves_the_tool_across_it():
    scene, rigid = scene_of("six-axis")
    moved = (
        equilibrium(scene, [Concealed(PEDESTAL, "base", {"soft": 1e-7, "stiff": 1e-13, "direction": 0.4})]).tool - rigid
    )
    along = np.array([np.cos(0.4), np.sin(0.4), 0])
    assert np.abs(moved @ along).max() < 1e-3 * np.abs(moved).max()


def test_a_bearing_that_is_soft_about_one_axis_tilts_about_it_alone():
    scene, rigid = scene_of("six-axis")
    arm, per_nm = HandArm.named("six-axis"), 1e-9
    bearing = Concealed(BEARING, "joint 3", {"about_x": per_nm, "about_y": 1e-15})
    by_hand = []
    for q, payload, point in zip(scene.session.commanded, scene.session.payload, rigid, strict=True):
        frame = arm.frames(arm.actuation @ q)[0][2]
        origin, x = frame[:3, 3], frame[:3, 0]
        by_hand.append(np.cross(per_nm * (arm.moment(q, payload, origin, 2) @ x) * x, point - origin))
    moved = equilibrium(scene, [bearing]).tool - rigid
    assert np.abs(moved - by_hand).max() < 2e-3 * np.abs(by_hand).max()


def test_a_drive_that_hardens_turns_in_two_sections_with_a_bend_at_its_knee():
    scene, rigid = scene_of("six-axis", count=40)
    soft, knee, stiff = 2e-5, 0.3, 1e-9
    drive = Concealed(DRIVE, "joint 3", {"compliance": stiff, "soft": soft, "knee": knee})
    load = scene.torque[:, 2] / scene.largest_torque(2)
    turn = stiff * scene.torque[:, 2] + soft * np.clip(load / knee, -1, 1)
    assert (np.abs(load) < knee).any()
    assert (np.abs(load) > knee).any()
    arm, angles = HandArm.named("six-axis"), scene.session.commanded
    by_hand = [arm.point(q + e * np.eye(6)[2]) - arm.point(q) for q, e in zip(angles, turn, strict=True)]
    assert np.abs(equilibrium(scene, [drive]).tool - rigid - np.array(by_hand)).max() < 0.02 * np.abs(by_hand).max()


def test_a_payload_off_by_a_share_weighs_that_much_more():
    scene, _ = scene_of("six-axis")
    spring = Concealed(OF["joint_compliance"], "joint 2", {"compliance": 1e-6})
    share = Concealed(PAYLOAD_SHARE, "payload", {"share": 0.2})
    at = {payload: equilibrium(scene, [spring]).tool[scene.session.payload == payload] for payload in (0.0,)}
    off = equilibrium(scene, [spring, share]).tool
    assert off[scene.session.payload == 0] == pytest.approx(at[0.0], abs=1e-12)
    heavier = scene.session.payload > 0
    assert np.abs(off - equilibrium(scene, [spring]).tool)[heavier].max() > 1e-5


@pytest.mark.parametrize("kind", [WANDER, RUNS])
def test_a_set_up_moves_about_as_much_as_stated_and_runs_stand_still(kind):
    scene, rigid = scene_of("six-axis", count=120)
    moved = equilibrium(scene, [Concealed(kind, "base", {"size": 2e-5, "seed": 3.0})]).tool - rigid
    assert 5e-6 < np.sqrt(np.mean(moved**2)) < 1e-4
    if kind is RUNS:
        turned = Concealed(kind, "base", {"size": 2e-5, "seed": 3.0})
        again = equilibrium(scene.rows(np.arange(60)), [turned]).tool
        assert again == pytest.approx((rigid + moved)[:60], abs=1e-12)


def test_a_rough_instruments_noise_has_tails_and_grows_and_sees_distances_better():
    rng = np.random.default_rng(1)
    points = rng.uniform(-1, 1, (20000, 3))
    noise = rough_noise(points, np.random.default_rng(2))
    spread = np.linalg.eigvalsh(np.cov(noise.T))
    assert spread[0] < 0.35 * spread[1]
    assert np.mean(np.abs(noise) > 4 * np.std(noise)) > 5 * 6.3e-5  # more than Gauss has
    sizes = np.linalg.norm(noise, axis=1)
    nearest = np.linalg.norm(points - points[np.argmax(sizes)], axis=1)
    assert np.mean(sizes[nearest > 1.5]) != pytest.approx(np.mean(sizes[nearest < 0.7]), rel=0.02)


def test_masses_are_stated_10_to_30_percent_wrong_each_its_own_way_and_bars_are_left_out():
    right = yaml.safe_load((ROBOTS / "parallelogram-120kg.yaml").read_text())
    stated = as_stated(yaml.safe_load(yaml.safe_dump(right)), ("masses", "bars"), np.random.default_rng(3))
    share = np.array(
        [told["mass_kg"] / true["mass_kg"] - 1 for told, true in zip(stated["links"], right["links"], strict=True)]
    )
    assert ROUGH.mass_share == (0.1, 0.3)
    assert np.all((np.abs(share) > 0.099) & (np.abs(share) < 0.301))
    assert {*np.sign(share)} == {-1, 1}
    assert "parallelogram" not in stated


def test_an_offset_stated_on_the_next_row_is_missing_from_its_own_and_too_much_there():
    scene, _ = scene_of("six-axis")
    sizes = []
    for seed in range(20):
        own, following = BLEMISHES["row"][1](np.random.default_rng(seed), scene)
        assert int(following.location.split()[1]) == int(own.location.split()[1]) + 1
        assert following.values["a"] == -own.values["a"]
        sizes.append(own.values["a"])
    assert ROUGH.row_m[0] <= min(sizes) < max(sizes) <= ROUGH.row_m[1]


def test_each_assumption_is_broken_on_its_own_as_often_as_stated():
    draws = [draw_broken(np.random.default_rng(seed)) for seed in range(1000)]
    counts = Counter(name for broken in draws for name in broken)
    for name, (share, _) in BLEMISHES.items():
        assert counts[name] == pytest.approx(1000 * share, abs=60)
    both = sum({"gears", "play"} <= set(broken) for broken in draws)
    assert both == pytest.approx(1000 * 0.8 * 0.5, abs=60)


def test_everything_that_can_be_rough_is_of_the_size_of_the_noise():
    """Seen over all arms: nothing that is everywhere dwarfs what is to stand out of it."""
    scene, _ = scene_of("six-axis", count=40)
    names = tuple(name for name in BLEMISHES if name not in ("row", "geometry"))
    sizes = [size.rms for size in blemishes(scene, names, np.random.default_rng(5))]
    assert len(sizes) > 25
    assert 1e-4 > max(sizes) > 1e-5


def test_an_oracle_pays_for_what_it_fits_and_more_where_waves_are_many():
    """25 D-H errors and frames in 60 rows leave it near the noise; waves of unknown phase don't."""
    made = {"id": "o", "category": "rough", "arm": "six-axis", "seed": 8, "fresh": False, "rows": 60, "sigma_mm": 0.02}
    arms = {
        name: conceal(WorldSpec.model_validate({**made, "rough": [name]}), ROBOTS) for name in ("geometry", "gears")
    }
    ratio = {}
    for name, arm in arms.items():
        measured = measure_session(arm)
        ratio[name] = oracle_rms(oracle_of(arm, measured, []), []) / rms(measured.noise[arm.held_out])
    assert 0.99 < ratio["geometry"] < 1.1 < ratio["gears"] < 3


def test_an_oracle_foretells_no_wander_of_rows_whose_time_is_not_recorded():
    """With times it is as good as without a wander; without, it is left with all of the wander but its mean."""
    made = {"id": "o", "category": "rough", "arm": "six-axis", "seed": 8, "fresh": False, "rows": 60, "sigma_mm": 0.002}
    arm = conceal(WorldSpec.model_validate({**made, "rough": ["wander"]}), ROBOTS)
    (wander,) = arm.chosen
    measured = measure_session(arm)
    noise = rms(measured.noise[arm.held_out])
    assert oracle_rms(oracle_of(arm, measured, ["time_s"]), ["time_s"]) < 1.1 * noise
    assert 0.7 * wander.rms < oracle_rms(oracle_of(arm, measured, []), []) < 1.5 * wander.rms


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A parallelogram arm with everything rough and one cause."""
    spec = WorldSpec.model_validate(
        {
            "id": "rough", "category": "rough", "arm": "parallelogram-120kg", "seed": 5, "fresh": False, "rows": 40,
            "sigma_mm": 0.03, "effects": [{"kind": "joint_compliance", "strength": 4.0}], "noise": "rough",
            "rough": ["masses", "bars", "springs", "gears", "wander", "runs", "day"],
        }
    )  # fmt: skip
    home = build(spec, tmp_path_factory.mktemp("rough"), ROBOTS)
    truth = yaml.safe_load((home / "sealed" / "truth.yaml").read_text())
    return (
        truth,
        yaml.safe_load((home / "visible" / "robot.yaml").read_text()),
        pd.read_csv(home / "sealed" / "test.csv"),
    )


@pytest.mark.long
def test_a_cause_stands_out_of_what_is_everywhere_and_takes_the_place_of_its_like(built):
    truth, *_ = built
    (bars,) = [effect for effect in truth["effects"] if effect["location"] == "parallelogram"]
    (cause,) = [effect for effect in truth["effects"] if not effect["minor"] and effect != bars]
    assert not bars["minor"]
    alike = [e for e in truth["effects"] if e["minor"] and e["effect"] == cause["effect"]]
    assert cause["effect"] == "joint_compliance"
    assert cause["strength"] > 3.9
    assert cause["rms_at_tool_mm"] > 2.4 * np.median([effect["rms_at_tool_mm"] for effect in alike])
    assert cause["rms_at_tool_mm"] > 1.4 * max(effect["rms_at_tool_mm"] for effect in alike)
    assert cause["location"] not in {effect["location"] for effect in alike}


@pytest.mark.long
def test_a_rough_world_tells_what_is_rough_and_shows_none_of_it(built):
    truth, visible, test = built
    assert "parallelogram" not in visible
    assert truth["scoring"]["also_allowed"] == [["payload_error", "payload"], ["instrument_scale", "instrument"]]
    assert {"gear_mesh", "base_drift", "base_shift", "thermal_expansion"} <= {e["effect"] for e in truth["effects"]}
    assert 0.03 < truth["scoring"]["left_mm"] < 1
    assert truth["rms_on_test_mm"]["true_model"] == pytest.approx(0.03, rel=0.4)
    assert len(test) == 100


def test_the_oracles_evidence_is_the_log_bayes_factor_of_all_readings_written_out():
    """By the density of all readings under the priors of all unknowns, one Gaussian, and not by normal equations."""
    story = [{"kind": "joint_offset", "strength": 4.0}]
    made = {"id": "o", "category": "rough", "arm": "six-axis", "seed": 8, "fresh": False, "rows": 60, "sigma_mm": 0.02}
    arm = conceal(WorldSpec.model_validate({**made, "rough": ["geometry"], "effects": story}), ROBOTS)
    oracle = oracle_of(arm, measure_session(arm), [])
    readings = oracle.missing[oracle.seen]

    def density(displaced):
        unknown = np.concatenate([oracle.frames, *displaced], axis=1)[oracle.seen]
        covariance = oracle.variance * np.eye(len(readings)) + unknown @ unknown.T
        return multivariate_normal(cov=covariance).logpdf(readings)

    ((cause, nats),) = evidence_of_causes(oracle).items()
    without = [d for size, d in zip(oracle.known, oracle.displaced, strict=True) if id(size) != cause]
    assert nats == pytest.approx(density(oracle.displaced) - density(without), rel=1e-6, abs=1e-3)
    assert nats > 3
