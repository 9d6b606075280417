"""Verdicts of every kind that a report must be able to show, made up around simulated recordings."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.fitting.registration import fit_frames
from armscope.physics.registry import effect_named
from armscope.recordings.table import Recordings, as_recordings
from armscope.robot import Arm, forward_kinematics, load_arm
from armscope.verdict.diagnosis import Atlas, Diagnosis, NextPoses, Residuals
from armscope.verdict.effects import Alternative, Curve, FoundEffect, Parameter
from armscope.verdict.schema import Background, HeldOut, Notice, SuspectRow, Unexplained, WaterfallStep
from armscope.verdict.sentences import headline

ROBOTS = Path(__file__).parents[2] / "config" / "robots"
DRIVERS = ("constant", "angle", "waves", "load", "side of approach", "temperature", "time", "free curve")
NOISE_MM = 0.03


@dataclass(frozen=True)
class Case:
    """A verdict with what it was made from."""

    verdict: Diagnosis
    arm: Arm
    recordings: Recordings


def case(
    robot: str = "six-axis",
    effects: tuple[FoundEffect, ...] = (),
    answer: str = "explained",
    rows: int = 120,
    seed: int = 5,
    **changes: object,
) -> Case:
    """A verdict about an arm of config/robots with these effects; ``changes`` replace fields of it."""
    random = np.random.default_rng(seed)
    arm = load_arm(ROBOTS / f"{robot}.yaml")
    low, high = np.clip(arm.limits.T, -2.8, 2.8)
    angles = random.uniform(0.7 * low, 0.7 * high, (rows, arm.n_motors))
    points = forward_kinematics(arm, angles)
    size = 10 * NOISE_MM if effects else NOISE_MM
    wave = np.column_stack([np.sin(angles[:, 1]), np.cos(angles[:, 0]), np.sin(angles[:, 2])])
    before = size * np.sqrt(2) * wave * bool(effects) + random.normal(0, NOISE_MM, (rows, 3))
    after = random.normal(0, NOISE_MM, (rows, 3))
    recordings = _recordings(angles, points + 1e-3 * before)
    rms_before, rms_after = (float(np.sqrt(np.mean(values**2))) for values in (before, after))
    verdict = Diagnosis(
        arm=arm.name,
        source="/home/somebody/recordings.csv",
        recordings=recordings,
        rows=rows,
        runs=("",),
        answer=answer,  # type: ignore[arg-type]
        headline="",
        mismatch=None if answer == "cannot tell" else bool(effects),
        noise_mm=NOISE_MM,
        noise_source="stated in robot.yaml",
        residual_before_mm=rms_before,
        residual_after_mm=rms_after,
        effects=effects,
        background=Background("all", bool(effects), float("nan"), 0.04, 0.02),
        background_families=(
            Background("geometric", bool(effects), 0.8, 0.04, 0.02),
            Background("elastic", False, 0.01, 0.0, 0.0),
        ),
        unexplained=Unexplained(False),
        held_out=HeldOut(rms_before, 1.03 * rms_after, 5, "configuration"),
        waterfall=_waterfall(effects, rms_before, rms_after),
        atlas=_atlas(arm, random),
        residuals=Residuals(1e3 * points, before, after, np.ones(rows), recordings.id, recordings.run),
        suspects=(),
        next_poses=None,
        notices=(),
        model=fit_frames(arm, recordings),
        seconds=1.7,
        settings={"seed": 0, "folds": 5},
    )
    verdict = replace(verdict, **changes)  # type: ignore[arg-type]
    return Case(replace(verdict, headline=headline(verdict)), arm, recordings)


def found(effect: str, location: str, *parameters: Parameter, **changes: object) -> FoundEffect:
    """An effect with its definition's sentences."""
    definition = effect_named(effect)
    assert definition is not None
    plain = FoundEffect(
        effect=effect,
        location=location,
        family=definition.family,
        driver=f"load of {location}" if definition.family == "elastic" else "constant",
        named_as="effect",
        title=f"{effect.replace('_', ' ')} at {location}",
        minor=False,
        parameters=parameters,
        rms_at_tool_mm=0.2,
        share=0.3,
        evidence_nats=84.0,
        alternatives=(),
        inclusion=0.97,
        curve=None,
        physics=definition.physics,
        confirm=definition.confirm,
        cure=definition.cure.words,
    )
    return replace(plain, **changes)  # type: ignore[arg-type]


def compliance(location: str = "joint 2", **changes: object) -> FoundEffect:
    """A joint that gives way, with rivals near and far."""
    rivals = (
        Alternative("base_compliance", "base", "elastic", 1.2, "moment on the base", 1.2),
        Alternative("link_bending", "link 2", "elastic", 14.0, "load at the end of link 2", 14.0),
    )
    return found(
        "joint_compliance", location, Parameter("compliance", "rad/(N m)", 2.1e-7, 1e-8),
        **{"share": 0.55, "rms_at_tool_mm": 0.22, "alternatives": rivals, **changes},
    )  # fmt: skip


def unknown_curve(location: str = "joint 4", **changes: object) -> FoundEffect:
    """A free curve that nothing in the library explains."""
    at = np.linspace(-np.pi, np.pi, 181)
    curve = Curve(
        "angle of joint 4", "rad", at, 1.5e-4 * np.exp(-((at - 0.8) ** 2) / 0.1), np.full(181, 1.2e-5), "rad",
        "a local bump of 150 µrad near 46 degrees, 30 degrees wide",
    )  # fmt: skip
    parameters = tuple(Parameter(f"cosine_{k}", "rad", 1e-5 / k, 2e-6) for k in range(1, 13))
    return found(
        "unknown", location, *parameters,
        **{"title": "an unexplained curve at joint 4 over its angle", "driver": "angle of joint 4", "share": 0.2,
           "rms_at_tool_mm": 0.11, "curve": curve, **changes},
    )  # fmt: skip


def single() -> Case:
    return case(
        effects=(compliance(),),
    )


def five() -> Case:
    effects = (
        compliance(),
        found("joint_offset", "joint 3", Parameter("offset", "rad", 8.6e-4, 2e-5), share=0.2, rms_at_tool_mm=0.15),
        found("link_geometry", "link 2", Parameter("alpha", "rad", 7.6e-4, 1e-5), Parameter("a", "mm", 0.76, 0.02),
              Parameter("d", "mm", 0.01, 0.02), share=0.15, rms_at_tool_mm=0.12),
        found("gear_eccentricity", "joint 1", Parameter("amplitude", "rad", 2.4e-4, 1e-5),
              Parameter("phase", "rad", 1.2, 0.05), Parameter("per_turn", "1/turn", 1.0, 0.0), share=0.07,
              rms_at_tool_mm=0.08, driver="angle of joint 1", inclusion=None),
        found("joint_coupling", "joint 6 from joint 5", Parameter("coupling", "rad/rad", -3e-4, 1e-5), share=0.004,
              rms_at_tool_mm=0.012, minor=True, evidence_nats=7.0, driver="angle of joint 5"),
    )  # fmt: skip
    return case(
        "parallelogram-120kg",
        effects,
        suspects=(SuspectRow("17", "", 0.43, 0.06), SuspectRow("80", "", 0.21, 0.3)),
        rows=250,
    )


def clean() -> Case:
    return case("parallelogram-120kg", (), "nothing missing", rows=150)


def unknowns() -> Case:
    return case(
        effects=(unknown_curve(), compliance(share=0.1, named_as="region", title="elastic, near joints 1-2")),
        answer="partly explained",
        unexplained=Unexplained(True, "base", "time", 0.05, "a slow trend over the recording"),
    )


def cannot_tell() -> Case:
    random = np.random.default_rng(2)
    poses = NextPoses(
        random.uniform(-1, 1, (8, 7)), np.zeros(8), np.linspace(0.4, 0.2, 8), "joint compliance, joint 2",
        "gear eccentricity, joint 2", 3.0,
    )  # fmt: skip
    return case(
        "seven-axis",
        (),
        "cannot tell",
        rows=40,
        next_poses=poses,
        notices=(Notice("too few rows", "40 rows are fewer than the full library needs; <no name> is given."),),
        held_out=HeldOut(float("nan"), float("nan")),
        waterfall=(),
    )


def long_table() -> Case:
    return case("seven-axis", (compliance("joint 4"),), rows=12_000)


def _recordings(angles: np.ndarray, points: np.ndarray) -> Recordings:
    table = pd.DataFrame(angles, columns=[f"q{j}_rad" for j in range(1, angles.shape[1] + 1)])
    table[["x_mm", "y_mm", "z_mm"]] = 1e3 * points
    return as_recordings(table)


def _waterfall(effects: tuple[FoundEffect, ...], before: float, after: float) -> tuple[WaterfallStep, ...]:
    heights = np.geomspace(before, after, len(effects) + 1)
    labels = ["free frames", *(f"{effect.effect} at {effect.location}" for effect in effects)]
    return tuple(WaterfallStep(label, h, 1.03 * h) for label, h in zip(labels, heights, strict=True))


def _atlas(arm: Arm, random: np.random.Generator) -> Atlas:
    places = [f"{kind} {j}" for j in range(1, arm.n_joints + 1) for kind in ("joint", "link")]
    locations = ("base", *places, "tool")
    share = 0.6 * random.random((len(locations), 6, len(DRIVERS))) ** 8
    share[:, :, 4] = np.nan
    share[random.random((len(locations), 1, len(DRIVERS))).repeat(6, 1) < 0.3] = np.nan
    return Atlas(locations, ("tx", "ty", "tz", "rx", "ry", "rz"), DRIVERS, share, 0.1 * share)


CASES = {
    "single": single,
    "five": five,
    "clean": clean,
    "unknowns": unknowns,
    "cannot_tell": cannot_tell,
    "long_table": long_table,
}
