"""Recordings of an arm with planted effects: the exact model, random frames, Gaussian noise; all from one seed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel, predict, predict_orientation
from armscope.physics.registry import library
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..physics.scenes import arm_named, full_table

Wanted = Mapping[tuple[str, str], list[float]]


def recorded(
    arm: Arm,
    table: Recordings,
    wanted: Wanted,
    noise_mm: float,
    seed: int,
    far: bool = False,
    turn_noise_mrad: float | None = None,
) -> Recordings:
    """``table`` with measured positions; ``wanted`` gives SI values of the terms by (effect, location).

    With ``turn_noise_mrad`` also with orientations, of a tool that is turned on the flange anyhow.
    """
    rng = np.random.default_rng(seed)
    parts = []
    for key, values in wanted.items():
        forms = [p for p in library(arm, table) if p.key == key and len(p.terms) >= len(values)]
        placed = min(forms, key=lambda p: len(p.terms))  # what is not given is right
        parts.append(Part(placed, np.array([*values, *[0.0] * (len(placed.terms) - len(values))])))
    turn = (
        Rotation.random(1, rng).as_matrix()[0] if far else Rotation.from_rotvec(1e-3 * rng.normal(size=3)).as_matrix()
    )
    base = Base(turn, (8.0 if far else 4e-3) * rng.normal(size=3))
    model = FittedModel(arm, {str(run): base for run in np.unique(table.run)}, (), tuple(parts))
    points = predict(model, table)
    measured = replace(table, positions=points + 1e-3 * noise_mm * rng.normal(size=points.shape))
    if turn_noise_mrad is None:
        return measured
    tool = Rotation.random(1, rng)[0]
    tool_turns = Rotation.from_matrix(predict_orientation(model, table)) * tool
    noise = Rotation.from_rotvec(1e-3 * turn_noise_mrad * rng.normal(size=points.shape))
    return replace(measured, orientation=(noise * tool_turns).as_quat(scalar_first=True))


def one_run(arm: Arm, rows: int, seed: int) -> Recordings:
    """Random poses in one run with one target and all context."""
    table = full_table(arm, rows, seed)
    return replace(table, run=np.full(rows, "1"), target=np.full(rows, ""))


def planted(name: str, wanted: Wanted, rows: int, noise_mm: float, seed: int) -> tuple[Arm, Recordings]:
    """An arm and its recordings."""
    arm = arm_named(name)
    return arm, recorded(arm, one_run(arm, rows, seed), wanted, noise_mm, seed + 1)


def joined(first: Recordings, second: Recordings) -> Recordings:
    """Two tables of one arm as two runs of one table."""
    fields = {}
    for name, value in vars(first).items():
        other = getattr(second, name)
        if isinstance(value, np.ndarray):
            fields[name] = np.concatenate([value, other])
    run = np.repeat(["1", "2"], [len(first), len(second)])
    count = len(first) + len(second)
    numbers = np.arange(1, count + 1)
    return replace(first, **{**fields, "run": run, "id": numbers.astype(str), "number": numbers.astype(float)})
