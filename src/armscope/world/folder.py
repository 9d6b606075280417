"""A world as two folders: what the diagnosis may see, and the sealed truth.

    visible/  robot.yaml, recordings.csv
    sealed/   truth.yaml, test.csv (100 further rows of the same session)

truth.yaml has the layout of the examples (sigma_mm, effects, frames, rms_on_test_mm) and, under `scoring`, what a
scoring rule needs: category, arm, seed, rows, noise and bad rows, whether an effect is outside the library, and what
was left out of the table. Each effect has its `strength` in multiples of the noise; whether its values can be compared
with a fit's; the `alternatives` that are as good in these poses, with the gap of evidence in nats; and the `oracle`:
noncentrality and columns of the F test by one who knows what to look for, and how many numbers his free frames have.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from armscope.core.averages import rms
from armscope.core.files import write_table, write_yaml
from armscope.world.effect_placement import visibilities
from armscope.world.effects import linear_numbers
from armscope.world.judge import D_H_VALUES, Visibility
from armscope.world.kinds import CONSTANT, LOAD, PAYLOAD
from armscope.world.oracle import Oracle, evidence_of_causes, oracle_of, oracle_rms
from armscope.world.rough import NOT_WRONG, as_stated
from armscope.world.spec import WorldSpec
from armscope.world.strength import Sized, fit_frames
from armscope.world.virtual_arm import Measured, VirtualArm, conceal, measure_session, seen_in_runs

CONTEXT = ("run", "time_s", "temperature_c", "payload_kg", "approach", "speed", "torque")
SHOWN = {
    "run": 0.4, "time_s": 0.7, "temperature_c": 0.6, "payload_kg": 1.0, "approach": 0.6, "speed": 0.3, "torque": 0.2,
}  # fmt: skip
"""How often a column is there that nothing concealed needs."""


def build(spec: WorldSpec, folder: Path, robots: Path) -> Path:
    """Make a world; the same spec gives the same bytes.

    Args:
        spec: what to make.
        folder: where its folder (named by its id) goes.
        robots: folder of the arms' descriptions.

    Returns:
        the world's folder, with `visible` and `sealed`.
    """
    arm = conceal(spec, robots)
    measured = measure_session(arm)
    table_rng, robot_rng = (np.random.default_rng([spec.seed, part]) for part in (1, 2))
    home = folder / spec.id
    columns, left_out = _columns(arm, table_rng)
    table = _table(arm, measured, columns, table_rng)
    write_table(home / "visible" / "recordings.csv", table.iloc[arm.recorded])
    write_table(home / "sealed" / "test.csv", table.iloc[arm.held_out])
    write_yaml(home / "visible" / "robot.yaml", _visible_robot(robots / f"{spec.arm}.yaml", spec, robot_rng))
    write_yaml(home / "sealed" / "truth.yaml", _truth(arm, measured, columns, left_out))
    return home


def _rms_on_test(arm: VirtualArm, measured: Measured) -> dict[str, float]:
    """What the nominal arm misses on the test rows with frames from the recorded rows, and what the truth misses, m."""
    readings, turn, test = measured.readings, arm.scene.tool_turn, arm.held_out
    frames = fit_frames(arm.nominal[arm.recorded], turn[arm.recorded], readings[arm.recorded])
    frames_only = frames.place(arm.nominal[test], turn[test]) - readings[test]
    return {"frames_only": rms(frames_only), "true_model": rms(readings[test] - measured.points[test])}


def _columns(arm: VirtualArm, rng: np.random.Generator) -> tuple[list[str], list[str]]:
    """Context columns of the table, and those that the concealed effects would need but don't get."""
    spec, chosen = arm.spec, arm.chosen
    needed = {column for size in chosen if not size.minor for column in size.effect.kind.needs}
    drawn = {column: bool(rng.random() < SHOWN[column]) for column in CONTEXT}
    if spec.columns == "irrelevant":
        drawn = dict.fromkeys(CONTEXT, True)
    shown = [column for column in CONTEXT if drawn[column] or column in needed]
    moves = [size for size in chosen if size.effect.location == "base" and size.effect.kind.driver == "time"]
    if any(not size.minor for size in moves):
        shown = [column for column in shown if column != "run"]  # free base frames per run would hide it
    if any(size.effect.kind.driver == PAYLOAD and not size.minor for size in chosen):
        shown = [column for column in shown if column != "torque"]  # recorded torques hold the true payload already
    left_out = sorted(needed) if spec.columns == "missing" else []
    return [column for column in shown if column not in left_out], left_out


def _table(arm: VirtualArm, measured: Measured, columns: list[str], rng: np.random.Generator) -> pd.DataFrame:
    session = arm.scene.session
    motors = range(arm.scene.geometry.n_motors)
    content: dict[str, Any] = {f"q{m + 1}_rad": session.commanded[:, m] for m in motors}
    readings = (measured.readings * 1e3).round(4)
    content |= {f"{axis}_mm": readings[:, k] for k, axis in enumerate("xyz")}
    whole = {
        "run": session.run, "time_s": session.time, "temperature_c": session.temperature, "payload_kg": session.payload,
    }  # fmt: skip
    content |= {name: values for name, values in whole.items() if name in columns}
    if "approach" in columns:
        content |= {f"approach{m + 1}": session.approach[:, m].astype(int) for m in motors}
    if "speed" in columns:
        content |= {f"dq{m + 1}_rad_s": session.speed[:, m] for m in motors}
    if "torque" in columns:
        recorded = measured.torque * (1 + 0.01 * rng.normal(size=measured.torque.shape))
        content |= {f"tau{m + 1}_nm": recorded[:, m].round(3) for m in motors}
    if arm.spec.columns == "irrelevant":
        count = len(session)
        content["humidity_percent"] = (45 + 5 * np.sin(session.time / 2000) + rng.normal(0, 0.3, count)).round(1)
        content["operator"] = rng.choice(["A", "B"], count)
        content["battery_v"] = (12.6 - 1e-5 * session.time).round(3)
    return pd.DataFrame(content)


def _visible_robot(source: Path, spec: WorldSpec, rng: np.random.Generator) -> dict[str, Any]:
    """robot.yaml as the diagnosis gets it: masses right, wrong or absent."""
    content: dict[str, Any] = yaml.safe_load(source.read_text(encoding="utf-8"))
    if spec.masses == "wrong":
        for link in content["links"]:
            link["mass_kg"] = round(link["mass_kg"] * float(np.exp(rng.normal(0, 0.35))), 2)
            link["com_mm"] = [
                round(c + float(rng.normal(0, 40 if link["mass_kg"] > 50 else 15)), 1) for c in link["com_mm"]
            ]
    if spec.masses == "absent":
        del content["links"]
    content = as_stated(content, spec.rough, rng)
    if spec.noise_stated:
        content["instrument"] = {"sigma_mm": spec.sigma_mm}
    return content


def _truth(arm: VirtualArm, measured: Measured, columns: list[str], left_out: list[str]) -> dict[str, Any]:
    spec, frames, chosen = arm.spec, arm.frames, arm.chosen
    story = [size for size in chosen if not size.minor]
    seen = seen_in_runs(arm) if "run" in columns else arm.seen
    known = dict(zip(map(id, story), seen, strict=True)) | (_seen_beside(arm) if spec.rough else {})
    oracle = oracle_of(arm, measured, columns) if spec.rough else None
    nats = evidence_of_causes(oracle) if oracle is not None else {}
    ordered = sorted(chosen, key=lambda size: -size.rms)
    return {
        "sigma_mm": spec.sigma_mm,
        "effects": [_effect(size, spec, known.get(id(size)), nats.get(id(size))) for size in ordered],
        "frames": {
            "translation_mm": (frames.translation * 1e3).round(4),
            "rotation_rad": frames.rotation.round(7),
            "tool_error_mm": (frames.tool_error * 1e3).round(4),
        },
        "rms_on_test_mm": {name: round(value * 1e3, 5) for name, value in _rms_on_test(arm, measured).items()},
        "scoring": {
            "category": spec.category,
            "arm": spec.arm,
            "rows": spec.rows,
            "seed": spec.seed,
            "fresh": spec.fresh,
            "poses": spec.poses,
            "noise": spec.noise,
            "noise_stated": spec.noise_stated,
            "noise_rms_mm": round(rms(measured.noise[arm.recorded]) * 1e3, 5),
            "bad_rows": (np.flatnonzero(measured.bad[arm.recorded]) + 1).tolist(),
            "outside_library": any(size.effect.kind.outside for size in chosen),
            "masses": spec.masses,
            "columns_left_out": left_out,
            "mismatch": bool(chosen),
            **(_roughness(arm, measured, columns, oracle) if oracle is not None else {}),
        },
    }


def _seen_beside(arm: VirtualArm) -> dict[int, Visibility]:
    """What could stand in the place of the larger ones among small errors everywhere, by their id."""
    sigma = arm.spec.sigma_mm * 1e-3
    large = [size for size in arm.chosen if size.minor and size.rms > sigma / 2]
    return dict(zip(map(id, large), visibilities(arm.judge, large, arm.chosen, sigma), strict=True))


def _roughness(arm: VirtualArm, measured: Measured, columns: list[str], oracle: Oracle) -> dict[str, Any]:
    """What is rough, what naming it isn't wrong, what frames and D-H values leave, and what an oracle on test rows."""
    placed = arm.frames.place(arm.nominal, arm.scene.tool_turn)[arm.recorded]
    free = np.concatenate([arm.judge.frames, *(r.columns for r in arm.judge.rivals if r.effect in D_H_VALUES)], axis=1)
    missing = (measured.readings[arm.recorded] - placed).reshape(-1)
    left = missing - free @ np.linalg.lstsq(free, missing, rcond=1e-9)[0]
    return {
        "rough": list(arm.spec.rough),
        "also_allowed": [list(NOT_WRONG[name]) for name in NOT_WRONG if name in arm.spec.rough],
        "left_mm": round(rms(left) * 1e3, 5),
        "oracle_on_test_mm": round(oracle_rms(oracle, columns) * 1e3, 5),
    }


def _comparable(size: Sized, spec: WorldSpec, visibility: Visibility | None) -> bool:
    """Whether a fit's numbers are those of the effect alone.

    Not those of what a rough arm has everywhere, nor of what is the same as that; bars that aren't stated are told in
    shares; and an axis that leans about y is as well told by the neighbours' D-H values.
    """
    kind = size.effect.kind
    if not spec.rough:
        return spec.masses == "right" or kind.driver != LOAD
    twins = kind.driver == LOAD and visibility is not None and bool(visibility.alternatives)
    in_shares = size.effect.location == "parallelogram" and "bars" in spec.rough
    leaning = kind.driver == CONSTANT and "geometry" in spec.rough
    return not (size.minor or twins or in_shares or leaning)


def _effect(size: Sized, spec: WorldSpec, visibility: Visibility | None, nats: float | None) -> dict[str, Any]:
    kind = size.effect.kind
    content: dict[str, Any] = {
        "effect": kind.effect,
        "location": size.effect.location,
        "parameters": size.effect.stated(),
        "rms_at_tool_mm": round(size.rms * 1e3, 5),
        "strength": round(size.rms * 1e3 / spec.sigma_mm, 3),
        "driver": kind.driver,
        "minor": size.minor,
        "values_comparable": _comparable(size, spec, visibility),
    }
    parts = linear_numbers(size.effect)
    if parts:
        content["linear"] = [
            {"name": name, "unit": "rad", "value": float(f"{part:.6g}")} for name, part in parts.items()
        ]
    if kind.outside:
        content |= {"shape": kind.variant, "what": kind.sentence}
    elif kind.variant:
        content["variant"] = kind.variant
    if nats is not None:
        content["oracle_nats"] = round(nats, 1)
    if visibility is not None:
        content["oracle"] = {
            "noncentrality": round(visibility.noncentrality, 2),
            "columns": visibility.columns,
            "frame_numbers": visibility.frame_numbers,
        }
        content["alternatives"] = [
            {"effect": other.effect, "location": other.location, "gap_nats": other.gap_nats}
            for other in visibility.alternatives
        ]
    return content
