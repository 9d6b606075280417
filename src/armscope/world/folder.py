"""A world as two folders: what the diagnosis may see, and the sealed truth.

    visible/  robot.yaml, recordings.csv
    sealed/   truth.yaml, test.csv (100 further rows of the same session)

truth.yaml has the layout of the examples (sigma_mm, effects, frames, rms_on_test_mm) and, under `scoring`, what a
scoring rule needs: category, arm, seed, rows, noise and bad rows, whether an effect is outside the library, and what was
left out of the table. Each effect has its `strength` in multiples of the noise; whether its values can be compared with a
fit's; the `alternatives` that are as good in these poses, with the gap of evidence in nats; and the `oracle`: noncentrality
and columns of the F test by one who knows what to look for.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml
from numpy.typing import NDArray

from armscope.files import write_table, write_yaml
from armscope.robot.description import load_description
from armscope.world.catalogue import LARGEST_PAYLOAD_KG, WorldSpec
from armscope.world.choice import choose, visibilities
from armscope.world.kinds import LOAD, Scene
from armscope.world.rivals import Judge, Visibility
from armscope.world.session import random_session
from armscope.world.statics import Hidden, Session, balance
from armscope.world.strength import Frames, Sized, fit_frames, make_scene, rms

Array = NDArray[np.float64]

TEST_ROWS = 100
CONTEXT = ("run", "time_s", "temperature_c", "payload_kg", "approach", "speed", "torque")
SHOWN = {
    "run": 0.4,
    "time_s": 0.7,
    "temperature_c": 0.6,
    "payload_kg": 1.0,
    "approach": 0.6,
    "speed": 0.3,
    "torque": 0.2,
}
"""How often a column is there that nothing concealed needs."""
BAD_SHARE = 0.02


@dataclass(frozen=True, eq=False)
class Measured:
    """All rows of a world as measured, before they are split; m.

    Attributes:
        points: (N, 3) true places in the measurement frame, m.
        noise: (N, 3) m; bad shots included.
        bad: rows that are bad shots.
    """

    points: Array
    noise: Array
    bad: NDArray[np.bool_]

    @property
    def readings(self) -> Array:
        """(N, 3) what the instrument says, m, to 0.1 micrometre."""
        return (self.points + self.noise).round(7)


def build(spec: WorldSpec, folder: Path, robots: Path) -> Path:
    """Make a world; the same spec gives the same bytes.

    Args:
        spec: what to make.
        folder: where its folder (named by its id) goes.
        robots: folder of the arms' descriptions.

    Returns:
        the world's folder, with `visible` and `sealed`.
    """
    poses, effects, noise, table = (np.random.default_rng(seed) for seed in np.random.SeedSequence(spec.seed).spawn(4))
    source = robots / f"{spec.arm}.yaml"
    description = load_description(source)
    warming = 8.0 if any(wish.kind == "thermal_expansion" for wish in spec.wishes) else 2.0
    session = random_session(
        description,
        poses,
        spec.rows + TEST_ROWS,
        spec.poses,
        LARGEST_PAYLOAD_KG[spec.arm],
        warming * poses.uniform(1, 2),
    )
    scene, nominal = make_scene(description, session)
    recorded, held_out = _split(poses, spec.rows)
    judge = Judge(scene.rows(recorded), nominal[recorded])
    sigma = spec.sigma_mm * 1e-3
    chosen = choose(scene.rows(recorded), judge, spec.wishes, sigma, spec.category == "inseparable", effects)
    seen = visibilities(judge, [size for size in chosen if not size.minor], sigma)

    frames = _random_frames(effects)
    measured = _measure(spec, scene, chosen, frames, recorded, noise)
    home = folder / spec.id
    columns, left_out = _columns(spec, chosen, table)
    everything = _table(scene, session, measured, columns, spec, table)
    write_table(home / "visible" / "recordings.csv", everything.iloc[recorded])
    write_table(home / "sealed" / "test.csv", everything.iloc[held_out])
    write_yaml(home / "visible" / "robot.yaml", _visible_robot(source, spec, table))
    on_test = _rms_on_test(nominal, scene, measured, recorded, held_out)
    write_yaml(
        home / "sealed" / "truth.yaml", _truth(spec, chosen, seen, frames, on_test, measured, recorded, left_out)
    )
    return home


def _split(rng: np.random.Generator, rows: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows that are recorded and rows that test, both from the whole session, in order of time."""
    order = rng.permutation(rows + TEST_ROWS)
    return np.sort(order[:rows]), np.sort(order[rows:])


def _random_frames(rng: np.random.Generator) -> Frames:
    """Instrument set up to a few mm and mrad, tool point known to about 1 mm."""
    return Frames(rng.uniform(-5e-3, 5e-3, 3), rng.uniform(-1.2e-3, 1.2e-3, 3), rng.uniform(-1e-3, 1e-3, 3))


def _measure(
    spec: WorldSpec,
    scene: Scene,
    chosen: list[Sized],
    frames: Frames,
    recorded: NDArray[np.intp],
    rng: np.random.Generator,
) -> Measured:
    hidden = Hidden.nothing(scene.geometry, scene.session)
    for size in chosen:
        size.effect.hide(hidden, scene)
    hidden.layout = replace(hidden.layout, tool_error=frames.tool_error)
    tool = balance(scene.geometry, scene.session, hidden).tool
    points = replace(frames, tool_error=np.zeros(3)).place(tool, scene.tool_turn)
    sigma = spec.sigma_mm * 1e-3
    count = len(points)
    noise = rng.normal(0, sigma, (count, 3))
    if spec.noise == "heavy_tails":
        noise = sigma * rng.standard_t(3, (count, 3))
    bad = np.zeros(count, dtype=bool)
    if spec.noise == "outliers":
        struck = rng.choice(recorded, max(1, round(BAD_SHARE * len(recorded))), replace=False)
        bad[struck] = True
        direction = rng.normal(size=(len(struck), 3))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        noise[struck] += direction * rng.uniform(1e-3, 10e-3, (len(struck), 1))
    return Measured(points, noise, bad)


def _rms_on_test(
    nominal: Array, scene: Scene, measured: Measured, recorded: NDArray[np.intp], held_out: NDArray[np.intp]
) -> dict[str, float]:
    """What the nominal arm misses on the test rows with frames from the recorded rows, and what the truth misses, m."""
    readings = measured.readings
    frames = fit_frames(nominal[recorded], scene.tool_turn[recorded], readings[recorded])
    frames_only = frames.place(nominal[held_out], scene.tool_turn[held_out]) - readings[held_out]
    return {"frames_only": rms(frames_only), "true_model": rms(readings[held_out] - measured.points[held_out])}


def _columns(spec: WorldSpec, chosen: list[Sized], rng: np.random.Generator) -> tuple[list[str], list[str]]:
    """Context columns of the table, and those that the concealed effects would need but don't get."""
    needed = {column for size in chosen for column in size.effect.kind.needs}
    drawn = {column: bool(rng.random() < SHOWN[column]) for column in CONTEXT}
    if spec.columns == "irrelevant":
        drawn = dict.fromkeys(CONTEXT, True)
    shown = [column for column in CONTEXT if drawn[column] or column in needed]
    if any(size.effect.location == "base" and size.effect.kind.driver == "time" for size in chosen):
        shown = [column for column in shown if column != "run"]  # free base frames per run would hide it
    left_out = sorted(needed) if spec.columns == "missing" else []
    return [column for column in shown if column not in left_out], left_out


def _table(
    scene: Scene, session: Session, measured: Measured, columns: list[str], spec: WorldSpec, rng: np.random.Generator
) -> pd.DataFrame:
    motors = range(session.commanded.shape[1])
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
        gain = 1 + 0.01 * rng.normal(size=scene.torque.shape)
        content |= {f"tau{m + 1}_nm": (scene.torque * gain)[:, m].round(3) for m in motors}
    if spec.columns == "irrelevant":
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
    if spec.noise_stated:
        content["instrument"] = {"sigma_mm": spec.sigma_mm}
    return content


def _truth(
    spec: WorldSpec,
    chosen: list[Sized],
    seen: list[Visibility],
    frames: Frames,
    on_test: dict[str, float],
    measured: Measured,
    recorded: NDArray[np.intp],
    left_out: list[str],
) -> dict[str, Any]:
    story = [size for size in chosen if not size.minor]
    known = dict(zip(map(id, story), seen, strict=True))
    ordered = sorted(chosen, key=lambda size: -size.rms)
    return {
        "sigma_mm": spec.sigma_mm,
        "effects": [_effect(size, spec, known.get(id(size))) for size in ordered],
        "frames": {
            "translation_mm": (frames.translation * 1e3).round(4),
            "rotation_rad": frames.rotation.round(7),
            "tool_error_mm": (frames.tool_error * 1e3).round(4),
        },
        "rms_on_test_mm": {name: round(value * 1e3, 5) for name, value in on_test.items()},
        "scoring": {
            "category": spec.category,
            "arm": spec.arm,
            "rows": spec.rows,
            "seed": spec.seed,
            "fresh": spec.fresh,
            "poses": spec.poses,
            "noise": spec.noise,
            "noise_stated": spec.noise_stated,
            "noise_rms_mm": round(rms(measured.noise[recorded]) * 1e3, 5),
            "bad_rows": (np.flatnonzero(measured.bad[recorded]) + 1).tolist(),
            "outside_library": any(size.effect.kind.outside for size in chosen),
            "masses": spec.masses,
            "columns_left_out": left_out,
            "mismatch": bool(chosen),
        },
    }


def _effect(size: Sized, spec: WorldSpec, visibility: Visibility | None) -> dict[str, Any]:
    kind = size.effect.kind
    content: dict[str, Any] = {
        "effect": kind.effect,
        "location": size.effect.location,
        "parameters": size.effect.stated(),
        "rms_at_tool_mm": round(size.rms * 1e3, 5),
        "strength": round(size.rms * 1e3 / spec.sigma_mm, 3),
        "driver": kind.driver,
        "minor": visibility is None,
        "values_comparable": spec.masses == "right" or kind.driver != LOAD,
    }
    if kind.outside:
        content |= {"shape": kind.variant, "what": kind.sentence}
    elif kind.variant:
        content["variant"] = kind.variant
    if visibility is not None:
        content["oracle"] = {"noncentrality": round(visibility.noncentrality, 2), "columns": visibility.columns}
        content["alternatives"] = [
            {"effect": other.effect, "location": other.location, "gap_nats": other.gap_nats}
            for other in visibility.alternatives
        ]
    return content
