"""Plant an effect, find it - and only it; plant nothing, hear nothing."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose, write_verdict
from armscope.physics.model import predict
from armscope.physics.model_file import load_model
from armscope.poses.obstacles import Surroundings, refusals
from armscope.recordings import read_recordings
from armscope.robot import load_arm
from armscope.verdict.schema import Verdict
from tests.seeds import seeds

from ..physics.scenes import arm_named
from .planted import joined, one_run, planted, recorded

QUICK = Settings(resamples=0, cross_validation=False)

# not in the quick run, which plants several together below; what is planted alone there: joint offsets and waves in
# test_orientation.py, play in test_hardening.py, compliances in test_parts.py, warm links in test_wander.py, bars in
# scans/test_linkage.py, drifts in test_pauses.py
SINGLES = [
    ("six-axis", ("joint_offset", "joint 3"), [2e-4]),
    ("seven-axis", ("gear_ratio", "joint 4"), [2e-4]),
    ("parallelogram-120kg", ("gear_eccentricity", "joint 1"), [1e-4, -1e-4]),
    ("six-axis", ("backlash", "joint 2"), [4e-4]),
    ("seven-axis", ("servo_lag", "joint 1"), [1e-3]),
    ("six-axis", ("joint_coupling", "joint 5 from joint 4"), [1e-3]),
    ("six-axis", ("joint_compliance", "joint 3"), [2e-6]),
    ("parallelogram-120kg", ("bearing_compliance", "joint 4"), [1e-6]),
    ("parallelogram-120kg", ("link_bending", "link 2"), [3e-7]),
    ("six-axis", ("axis_wobble", "joint 2"), [1e-4, 0.0, 0.0, 2e-4]),
    ("six-axis", ("link_geometry", "link 3"), [3e-4, 2e-4, 0.0]),
    ("parallelogram-120kg", ("thermal_expansion", "link 2"), [3e-5]),
    ("parallelogram-120kg", ("parallelogram_geometry", "parallelogram"), [5e-4, -3e-4]),
    ("seven-axis", ("base_drift", "base"), [2e-4, 0.0, -1e-4, 0.0, 2e-4, 0.0]),
    ("seven-axis", ("instrument_scale", "instrument"), [3e-4]),
]


def names(verdict: Verdict) -> set[tuple[str, str]]:
    return {(effect.effect, effect.location) for effect in verdict.effects}


TOGETHER = {
    "seven-axis": {
        ("gear_ratio", "joint 4"): [2e-4],
        ("servo_lag", "joint 1"): [1e-3],
        ("instrument_scale", "instrument"): [3e-4],
    },
    "parallelogram-120kg": {("bearing_compliance", "joint 4"): [1e-6], ("link_bending", "link 2"): [3e-7]},
    "six-axis": {
        ("joint_coupling", "joint 5 from joint 4"): [1e-3],
        ("axis_wobble", "joint 2"): [1e-4, 0.0, 0.0, 2e-4],
        ("link_geometry", "link 3"): [3e-4, 2e-4, 0.0],
    },
}
"""The same by arms: each is asked for alone by the long run."""


@pytest.mark.parametrize("name", seeds(*TOGETHER))
def test_what_was_planted_together_is_found_and_nothing_else(name: str) -> None:
    arm, table = planted(name, TOGETHER[name], 100, 0.02, seed=21)
    verdict = diagnose(arm, table, QUICK)
    assert names(verdict) == set(TOGETHER[name])
    assert verdict.mismatch is True
    assert verdict.residual_after_mm < 0.022


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "key", "values"), SINGLES, ids=lambda v: " ".join(v) if isinstance(v, tuple) else None
)
def test_a_planted_effect_is_found_and_nothing_else(name: str, key: tuple[str, str], values: list[float]) -> None:
    arm, table = planted(name, {key: values}, 100, 0.02, seed=21)
    verdict = diagnose(arm, table, QUICK)
    assert names(verdict) == {key}
    assert verdict.mismatch is True
    assert verdict.residual_after_mm < 0.022


def test_the_size_of_what_was_planted_is_inside_its_interval() -> None:
    arm, table = planted("four-axis", {("joint_compliance", "joint 2"): [4e-7]}, 120, 0.02, seed=5)
    (found,) = diagnose(arm, table, QUICK).effects
    (compliance,) = found.parameters
    low, high = compliance.interval
    assert low < 4e-7 < high
    assert compliance.stderr < 0.1 * 4e-7


@pytest.mark.parametrize("seed", seeds(1, 0, 2, 3, 4, 5))
def test_a_clean_arm_is_called_clean(seed: int) -> None:
    arm, table = planted(("six-axis", "seven-axis", "parallelogram-120kg")[seed % 3], {}, 80, 0.03, seed=100 + seed)
    verdict = diagnose(arm, table, QUICK)
    assert verdict.effects == ()
    assert verdict.mismatch is False
    assert verdict.answer == "nothing missing"
    assert verdict.noise_mm == pytest.approx(0.03, rel=0.2)


def test_bad_shots_are_listed_and_mislead_nobody() -> None:
    arm, table = planted("four-axis", {("joint_offset", "joint 3"): [3e-4]}, 100, 0.02, seed=8)
    bad = [4, 50, 77]
    table.positions[bad] += np.array([3e-3, -4e-3, 2e-3])
    verdict = diagnose(arm, table, QUICK)
    assert names(verdict) == {("joint_offset", "joint 3")}
    assert {row.id for row in verdict.suspects} == {str(row + 1) for row in bad}


def test_what_no_effect_explains_is_located_described_and_not_misnamed() -> None:
    arm, table = planted("four-axis", {}, 150, 0.02, seed=12)
    angle = table.motor_angles[:, 1]
    bump = 6e-4 * np.exp(-0.5 * ((angle - 0.2) / 0.12) ** 2)
    shifted = table.motor_angles.copy()
    shifted[:, 1] += bump
    hidden = recorded(arm, replace(table, motor_angles=shifted), {}, 0.02, seed=13)
    verdict = diagnose(arm, replace(table, positions=hidden.positions), QUICK)
    (found,) = verdict.effects
    assert (found.effect, found.location, found.driver) == ("unknown", "joint 2", "angle of joint 2")
    assert verdict.unexplained.present
    assert verdict.unexplained.location == "joint 2"
    assert "bump" in verdict.unexplained.description
    assert found.curve is not None
    assert found.curve.at[np.argmax(found.curve.value)] == pytest.approx(0.2, abs=0.1)


@pytest.mark.long
def test_play_without_a_record_of_the_side_is_located_and_not_explained_by_chance() -> None:
    arm, table = planted("four-axis", {("backlash", "joint 2"): [6e-4]}, 120, 0.02, seed=30)
    verdict = diagnose(arm, replace(table, approach=None), QUICK)
    assert names(verdict) == {("unknown", "joint 2")}
    assert verdict.effects[0].driver == "nothing in the table"


@pytest.mark.long
def test_two_effects_that_look_alike_are_both_named() -> None:
    """Without payload changes motor 2's load on a parallelogram arm is a once-per-turn wave of its angle."""
    arm = arm_named("parallelogram-120kg")
    table = replace(one_run(arm, 120, seed=40), payload=np.full(120, 10.0))
    table = recorded(arm, table, {("joint_compliance", "joint 2"): [2e-7]}, 0.03, seed=41)
    verdict = diagnose(arm, table, QUICK)
    (found,) = verdict.effects
    both = {(found.effect, found.location), *((a.effect, a.location) for a in found.alternatives)}
    assert {("joint_compliance", "joint 2"), ("gear_eccentricity", "joint 2")} <= both
    assert found.named_as != "effect"
    poses = verdict.next_poses
    assert poses is not None
    assert (poses.payload_kg != 10).any(), "only another payload tells them apart"
    assert set(refusals(arm, poses.motor_angles, Surroundings())) == {""}
    # measuring what was asked for, as often as was asked for, settles it, whatever the noise of the day
    repeats = int(poses.repeats_needed)
    asked = one_run(arm, len(poses.payload_kg) * repeats, seed=42)
    asked = replace(
        asked, motor_angles=np.tile(poses.motor_angles, (repeats, 1)), payload=np.tile(poses.payload_kg, repeats)
    )
    for seed in range(200, 204):
        more = recorded(arm, asked, {("joint_compliance", "joint 2"): [2e-7]}, 0.03, seed=seed)
        (settled,) = diagnose(arm, joined(table, more), QUICK).effects
        assert (settled.effect, settled.location) == ("joint_compliance", "joint 2")
        assert settled.named_as == "effect"


def test_the_same_seed_gives_the_same_verdict_and_files_follow_the_contract(tmp_path: Path) -> None:
    wanted = {("joint_compliance", "joint 2"): [4e-7], ("joint_offset", "joint 3"): [3e-4]}
    arm, table = planted("four-axis", wanted, 100, 0.02, seed=50)
    settings = Settings(seed=3, resamples=2)
    heard: list[float] = []
    first = diagnose(arm, table, settings, lambda text, share: heard.append(share))
    second = diagnose(arm, table, settings)
    write_verdict(first, tmp_path)
    content = json.loads((tmp_path / "verdict.json").read_text(encoding="utf-8"))
    assert content == json.loads(json.dumps(json.loads(_json(second, tmp_path / "again"))))
    assert heard == sorted(heard)
    assert heard[-1] == 1.0
    assert {"mismatch", "noise_mm", "effects", "unexplained", "held_out_rms_mm"} <= set(content)
    assert [e["rms_at_tool_mm"] for e in content["effects"]] == sorted(
        (e["rms_at_tool_mm"] for e in content["effects"]), reverse=True
    )
    for effect in content["effects"]:
        assert {"effect", "location", "family", "minor", "parameters", "share", "evidence_nats", "alternatives"} <= set(
            effect
        )
        assert effect["inclusion"] == 1.0
    held = content["held_out_rms_mm"]
    assert held["after"] < 0.025 < held["before"]
    steps = content["waterfall"]
    assert steps[0]["label"] == "free frames"
    assert steps[-1]["held_out_mm"] < steps[0]["held_out_mm"]
    model = load_model(tmp_path / "model.yaml")
    np.testing.assert_allclose(predict(model, table), predict(first.model, table), atol=1e-12)


def _json(verdict: Verdict, folder: Path) -> str:
    write_verdict(verdict, folder)
    return (folder / "verdict.json").read_text(encoding="utf-8")


SHARED = Path(__file__).parents[2] / ".." / "shared" / "examples"
TRUTH = {
    "clean": set(),
    "one-effect": {("joint_compliance", "joint 2")},
    "five-effects": {
        ("link_geometry", "link 2"),
        ("joint_offset", "joint 3"),
        ("joint_compliance", "joint 2"),
        ("joint_compliance", "joint 3"),
        ("gear_eccentricity", "joint 1"),
    },
    "seven-axes-modified-dh": {
        ("link_geometry", "link 4"),
        ("joint_compliance", "joint 2"),
        ("gear_eccentricity", "joint 4"),
    },
}


@pytest.mark.shared
@pytest.mark.parametrize(
    "example",
    # the others are named in tests/golden as well
    [pytest.param(name, marks=[pytest.mark.long] * (name != "seven-axes-modified-dh")) for name in TRUTH],
)
def test_the_four_examples_are_diagnosed_and_predicted(example: str) -> None:
    folder = SHARED / example
    if not folder.is_dir():
        pytest.skip("the folder ../shared/examples is not here")
    arm = load_arm(folder / "robot.yaml")
    verdict = diagnose(arm, read_recordings(folder / "recordings.csv", arm.n_motors), QUICK)
    assert names(verdict) == TRUTH[example]
    test = read_recordings(folder / "test.csv", arm.n_motors)
    rms = np.sqrt(np.mean((predict(verdict.model, test) - test.positions) ** 2)) * 1e3
    noise = {"clean": 0.047, "one-effect": 0.026, "five-effects": 0.029, "seven-axes-modified-dh": 0.011}
    assert rms < 1.08 * noise[example]
