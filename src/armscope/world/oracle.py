"""The best prediction that one can make of a rough arm who knows what is in it, where, and about how large."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.world.imperfections import FINE_WAVES, LOW_WAVES
from armscope.world.kinds import APPROACH, LOAD, PAYLOAD, SPEED, TEMPERATURE, TIME, Concealed, Scene, number
from armscope.world.rivals import Patterns
from armscope.world.strength import equilibrium, free_frames
from armscope.world.virtual_arm import Measured, VirtualArm

DRIVERS = {APPROACH: "approach", TEMPERATURE: "temperature_c", SPEED: "speed"}
"""Columns without which nobody can know how an effect went; of the recorded rows, time is in their order, too."""


def oracle_rms(arm: VirtualArm, measured: Measured, columns: list[str]) -> float:
    """Held-out RMS per axis of the oracle, m.

    It fits free frames, and to every concealed effect its own displacement, of a size that it believes to be the true
    one give or take all of it; of a gear's many waves it knows the numbers and how their sizes fall, not the phases.
    What follows a column that the table doesn't show it can't predict either: where times are not recorded, the order
    of the recorded rows tells it how they went, and held-out rows are predicted as the recorded ones were on average.

    Args:
        arm: the virtual arm.
        measured: its session.
        columns: context of the table; where it tells runs apart, each has a base of its own.

    Returns:
        Over the held-out rows' readings.
    """
    scene, turn = arm.scene, arm.scene.tool_turn
    frames = free_frames(arm.nominal, turn, scene.session.run if "run" in columns else None)
    frames = frames / np.linalg.norm(frames, axis=0)
    known = [size.effect for size in arm.chosen if DRIVERS.get(size.effect.kind.driver, "time") in (*columns, "time")]
    displaced = list(_displacements(known, scene))
    matrix = np.concatenate([frames, *displaced], axis=1)
    missing = (measured.readings - arm.frames.place(arm.nominal, turn)).reshape(-1)
    axes = np.arange(len(missing)).reshape(-1, 3)
    seen, unseen = axes[arm.recorded].ravel(), axes[arm.held_out].ravel()
    variance = (arm.spec.sigma_mm * 1e-3) ** 2
    # the frames' columns have a length of one, so a size of one of theirs, too, is as good as anywhere
    precision = matrix[seen].T @ matrix[seen] / variance + np.eye(matrix.shape[1])
    values = np.linalg.solve(precision, matrix[seen].T @ missing[seen] / variance)
    if "time_s" not in columns:
        timeless = np.concatenate(
            [
                np.zeros(frames.shape[1]),
                *(np.full(d.shape[1], k.kind.driver != TIME) for k, d in zip(known, displaced, strict=True)),
            ]
        )
        missing = missing - matrix @ (timeless * values)
        matrix, values = frames, np.linalg.lstsq(frames[seen], missing[seen])[0]
    return rms(missing[unseen] - matrix[unseen] @ values)


def _displacements(known: list[Concealed], scene: Scene) -> Iterator[Array]:
    """(3 N, k) displacement by each effect, m, per unit of what the oracle takes to be of a size of one."""
    rigid = equilibrium(scene, []).tool
    patterns = Patterns(scene)
    springs = [effect for effect in known if effect.kind.driver == LOAD]
    for effect in known:
        if effect.kind in (LOW_WAVES, FINE_WAVES):
            yield _waves(patterns, effect)
        elif effect.kind.driver == PAYLOAD:
            yield (equilibrium(scene, [*springs, effect]).tool - equilibrium(scene, springs).tool).reshape(-1, 1)
        else:
            yield (equilibrium(scene, [effect]).tool - rigid).reshape(-1, 1)


def _waves(patterns: Patterns, effect: Concealed) -> Array:
    motor, values = number(effect.location), effect.values
    count = np.arange(values["first"], values["last"] + 1)
    usual = count ** -values["slope"]
    usual *= values["rms"] / np.sqrt(np.sum(usual**2))
    turned = np.outer(patterns.scene.session.commanded[:, motor], count)
    amounts = np.concatenate([usual * np.cos(turned), usual * np.sin(turned)], axis=1)
    return np.asarray((patterns.motor_jacobian[:, :, motor, None] * amounts[:, None, :]).reshape(-1, 2 * len(count)))
