"""The best prediction that one can make of a rough arm who knows what is in it, where, and about how large."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from armscope.core.averages import rms
from armscope.core.types import Array, Indices
from armscope.world.imperfections import FINE_WAVES, LOW_WAVES
from armscope.world.kinds import APPROACH, LOAD, PAYLOAD, SPEED, TEMPERATURE, TIME, Concealed, Scene, number
from armscope.world.rivals import Patterns
from armscope.world.strength import Sized, equilibrium, free_frames
from armscope.world.virtual_arm import Measured, VirtualArm

DRIVERS = {APPROACH: "approach", TEMPERATURE: "temperature_c", SPEED: "speed"}
"""Columns without which nobody can know how an effect went; of the recorded rows, time is in their order, too."""


@dataclass(frozen=True, eq=False)
class Oracle:
    """One who knows every effect of a session but its size; see `oracle_rms`."""

    frames: Array  # (3 N, f) what free frames can do, each column of length one
    known: list[Sized]  # effects of which a column of the table says how they went
    displaced: list[Array]  # (3 N, k) of each of them, m, per unit of what the oracle takes to be of a size of one
    missing: Array  # (3 N,) readings less the nominal arm's, m
    # seen, unseen: numbers of the coordinates of recorded and of held-out rows
    seen: Indices
    unseen: Indices
    variance: float  # of the noise, m^2

    def fitted(self, without: int | None = None) -> tuple[Array, Array, float]:
        """The columns, their values, and the log evidence of the recorded rows, nats, but for what is the same for
        all. ``without``: an effect that is taken to be absent, by its number in ``known``."""
        matrix = np.concatenate([self.frames, *(d for k, d in enumerate(self.displaced) if k != without)], axis=1)
        seen = matrix[self.seen]
        # the frames' columns have a length of one, so a size of one of theirs, too, is as good as anywhere
        precision = seen.T @ seen / self.variance + np.eye(matrix.shape[1])
        projected = seen.T @ self.missing[self.seen] / self.variance
        values = np.linalg.solve(precision, projected)
        return matrix, values, float(0.5 * projected @ values - 0.5 * np.linalg.slogdet(precision)[1])


def oracle_of(arm: VirtualArm, measured: Measured, columns: list[str]) -> Oracle:
    """The oracle of a session.

    Args:
        arm: the virtual arm.
        measured: its session.
        columns: context of the table; where it tells runs apart, each has a base of its own.

    Returns:
        What it knows.
    """
    scene, turn = arm.scene, arm.scene.tool_turn
    frames = free_frames(arm.nominal, turn, scene.session.run if "run" in columns else None)
    known = [size for size in arm.chosen if DRIVERS.get(size.effect.kind.driver, "time") in (*columns, "time")]
    missing = (measured.readings - arm.frames.place(arm.nominal, turn)).reshape(-1)
    axes = np.arange(len(missing)).reshape(-1, 3)
    return Oracle(
        frames=frames / np.linalg.norm(frames, axis=0),
        known=known,
        displaced=list(_displacements([size.effect for size in known], scene)),
        missing=missing,
        seen=axes[arm.recorded].ravel(),
        unseen=axes[arm.held_out].ravel(),
        variance=(arm.spec.sigma_mm * 1e-3) ** 2,
    )


def oracle_rms(oracle: Oracle, columns: list[str]) -> float:
    """Held-out RMS per axis of the oracle, m.

    It fits free frames, and to every concealed effect its own displacement, of a size that it believes to be the true
    one give or take all of it; of a gear's many waves it knows the numbers and how their sizes fall, not the phases.
    What follows a column that the table doesn't show it can't predict either: where times are not recorded, the order
    of the recorded rows tells it how they went, and held-out rows are predicted as the recorded ones were on average.
    """
    matrix, values, _ = oracle.fitted()
    frames, missing, seen, unseen = oracle.frames, oracle.missing, oracle.seen, oracle.unseen
    if "time_s" not in columns:
        timeless = np.concatenate(
            [
                np.zeros(frames.shape[1]),
                *(
                    np.full(d.shape[1], k.effect.kind.driver != TIME)
                    for k, d in zip(oracle.known, oracle.displaced, strict=True)
                ),
            ]
        )
        missing = missing - matrix @ (timeless * values)
        matrix, values = frames, np.asarray(np.linalg.lstsq(frames[seen], missing[seen])[0])
    return rms(missing[unseen] - matrix[unseen] @ values)


def evidence_of_causes(oracle: Oracle) -> dict[int, float]:
    """How surely the oracle itself can say that each cause is there, nats: the log Bayes factor against its absence.

    A cause may be large at the tool and still be nothing that poses could tell from the small errors beside it.

    Returns:
        By the id of the cause; those that follow a column which the table doesn't show are left out.
    """
    whole = oracle.fitted()[2]
    return {
        id(size): whole - oracle.fitted(without=number)[2] for number, size in enumerate(oracle.known) if not size.minor
    }


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
