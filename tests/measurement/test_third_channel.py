"""A kind of reading that armscope does not know - joint torques of static poses - enters by its own few lines.

Nothing outside this file knows it: not the inference, not the diagnosis, not the report.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.fitting.linearisation import LinearisedTable, residuals
from armscope.fitting.registration import fit_frames
from armscope.measurement.channel import CHANNELS, Channel
from armscope.physics import registry
from armscope.physics.effect import ONE, Cure, Direction, Driver, Effect, Part, Placed, Term, term
from armscope.physics.model import FittedModel
from armscope.physics.payload import PAYLOAD_MASS
from armscope.physics.scene import Posture
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics
from armscope.robot.gravity import gravity_torques
from armscope.verdict.diagnosis import Diagnosis

from ..diagnosis.planted import one_run, recorded
from ..physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
POINT_MM, TORQUE_NM = 0.02, 0.3
ROWS, JOINT, PER_TURN = 200, 3, 4


def torque_at(motor: int) -> Direction:
    """The reading of a motor's torque sensor: it moves no frame."""
    return Direction(f"motor {motor}", "torque")


def linear_response(channel: Channel, model: FittedModel, posture: Posture) -> Array:
    """(n, width) what a model's effects add up to in a channel that sees them linearly."""
    total = np.zeros((len(posture.scene), channel.width))
    for direction, amount in posture.scene.amounts(model.everything).items():
        seen = channel.sensitivity(posture, direction)
        if seen is not None:
            total += seen * amount[:, None]
    return total


class Torques(Channel):
    """Recorded minus modelled gravity torques, N m; every sensor has a zero of its own.

    Args:
        readings: (m,) N m by a row's id.
    """

    name, unit, floor = "torque", "N m", 1e-6

    def __init__(self, readings: Mapping[str, np.ndarray]) -> None:
        self.readings = readings
        self.width = len(next(iter(readings.values())))

    def measured(self, recordings: Recordings) -> NDArray[np.bool_]:
        return np.array([row in self.readings for row in recordings.id])

    def residual(self, model: FittedModel, posture: Posture) -> np.ndarray:
        nothing = np.full(self.width, np.nan)
        read = np.array([self.readings.get(row, nothing) for row in posture.scene.recordings.id])
        return read - posture.scene.gravity_torques - linear_response(self, model, posture)

    def sensitivity(self, posture: Posture, direction: Direction) -> np.ndarray | None:
        scene = posture.scene
        if direction == PAYLOAD_MASS:
            one = np.ones(len(scene))
            return gravity_torques(scene.arm, scene.loaded, one) - gravity_torques(scene.arm, scene.loaded)
        if direction.axis != "torque":
            return None
        seen = np.zeros((len(scene), self.width))
        seen[:, int(direction.location.split()[1]) - 1] = 1.0
        return seen

    def zeros(self) -> Placed:
        motors = range(1, self.width + 1)
        zeros = tuple(term(f"zero_{j}", "N m", (torque_at(j), ONE)) for j in motors)
        return Placed(SENSOR_ZERO, "torque sensors", zeros, (1.0,) * self.width, "nothing")

    def nuisance(self, recordings: Recordings, tool_per_run: bool) -> list[Placed]:
        return [self.zeros()]

    def retract(self, model: FittedModel, steps: Mapping[Term, float]) -> FittedModel:
        """The zeros stand beside the tools' offsets, which positions move by their steps once they are there."""
        if any(part.placed.effect is SENSOR_ZERO for part in model.tools):
            return model
        placed = self.zeros()
        values = np.array([steps.get(each, 0.0) for each in placed.terms])
        return replace(model, tools=(*model.tools, Part(placed, values)))


def _nowhere(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    return iter(())


SENSOR_ZERO = Effect("sensor_zero", "frame", _nowhere, "A sensor's zero.", "Unload it.", Cure("Nothing to cure."))


def _ripples(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in range(1, arm.n_motors + 1):
        terms = tuple(
            term(f"{kind}_{PER_TURN}", "N m", (torque_at(j), Driver(kind, (j, PER_TURN))))
            for kind in ("cosine", "sine")
        )
        yield Placed(
            RIPPLE, f"joint {j}", terms, (1.0, 1.0), f"angle of joint {j}", (("per_turn", "", float(PER_TURN)),),
            parametrisation="sine",
        )  # fmt: skip


RIPPLE = Effect(
    "torque_ripple",
    "transmission",
    _ripples,
    "The torque sensor reads a wave of its joint's angle.",
    "Turn the unloaded joint slowly and read its torque.",
    Cure("Take the wave off the reading."),
)


def gravity_by_pinocchio(arm: Arm, q: np.ndarray, payload: np.ndarray) -> np.ndarray:
    """(N, m) gravity's torques at motor angles (N, m), the payload's by virtual work, N m."""
    data, still = arm.model.createData(), np.zeros(arm.n_joints)
    torques = -np.array([pin.rnea(arm.model, data, row @ arm.actuation.T, still, still) @ arm.actuation for row in q])
    for motor, unit in enumerate(1e-6 * np.eye(arm.n_motors)):
        rise = (forward_kinematics(arm, q + unit) - forward_kinematics(arm, q - unit)) / 2e-6
        torques[:, motor] += payload * (rise @ arm.gravity)
    return torques


def read_torques(arm: Arm, table: Recordings, seed: int, compliance: Sequence[float] = ()) -> np.ndarray:
    """(N, m) torques where drives that give way (rad/(N m)) have come to rest, with noise and unknown zeros, N m."""
    assert table.payload is not None
    torques = gravity_by_pinocchio(arm, table.motor_angles, table.payload)
    for _ in range(2):
        torques = gravity_by_pinocchio(
            arm, table.motor_angles + np.array(compliance or [0.0] * arm.n_motors) * torques, table.payload
        )
    rng = np.random.default_rng(seed)
    return torques + rng.normal(size=arm.n_motors) + TORQUE_NM * rng.normal(size=torques.shape)


def channel(table: Recordings, torques: np.ndarray) -> Torques:
    return Torques({str(row): torque for row, torque in zip(table.id, torques, strict=True)})


def named(verdict: Diagnosis) -> set[tuple[str, str]]:
    return {(effect.effect, effect.location) for effect in verdict.effects}


@pytest.fixture
def with_ripples(monkeypatch: pytest.MonkeyPatch) -> None:
    """The library with the ripple, as an installed package would bring it."""
    known = (*registry.effects(), RIPPLE)
    monkeypatch.setattr(registry, "effects", functools.cache(lambda: known))


@pytest.mark.usefixtures("with_ripples")
def test_a_torque_ripple_is_found_by_torques_and_not_by_positions() -> None:
    arm = arm_named("four-axis")
    table = recorded(arm, one_run(arm, ROWS, 5), {("joint_offset", "joint 2"): [3e-4]}, POINT_MM, 6)
    torques = read_torques(arm, table, 7)
    torques[:, JOINT - 1] += 0.5 * np.cos(PER_TURN * table.motor_angles[:, JOINT - 1] + 0.4)
    alone = diagnose(arm, table, QUICK)
    both = diagnose(arm, table, QUICK, channels=(*CHANNELS, channel(table, torques)))
    assert named(alone) == {("joint_offset", "joint 2")}
    assert named(both) == {("joint_offset", "joint 2"), ("torque_ripple", f"joint {JOINT}")}
    ripple = next(effect for effect in both.effects if effect.effect == "torque_ripple")
    amplitude = ripple.parameters[0]
    assert abs(amplitude.value - 0.5) < 3 * amplitude.stderr
    assert amplitude.stderr == pytest.approx(TORQUE_NM * np.sqrt(2 / ROWS), rel=0.2)


@pytest.mark.long
def test_a_payload_error_is_told_more_narrowly_with_torques() -> None:
    arm = arm_named("six-axis")
    stated = one_run(arm, ROWS, 5)
    assert stated.payload is not None
    error = 3.0
    compliance = (0.0, 3e-6, 4e-6, 0.0, 0.0, 0.0)
    springs = {("joint_compliance", f"joint {j}"): [compliance[j - 1]] for j in (2, 3)}
    table = recorded(arm, replace(stated, payload=stated.payload + error), springs, POINT_MM, 6)
    torques = read_torques(arm, table, 7, compliance)
    table = replace(table, payload=stated.payload)
    alone = diagnose(arm, table, QUICK)
    both = diagnose(arm, table, QUICK, channels=(*CHANNELS, channel(table, torques)))
    widths = []
    for verdict in (alone, both):
        assert named(verdict) == {*springs, ("payload_error", "payload")}
        mass = next(e for e in verdict.effects if e.effect == "payload_error").parameters[0]
        assert abs(mass.value - error) < 3 * mass.stderr
        widths.append(mass.stderr)
    assert widths[1] < 0.7 * widths[0]


@pytest.mark.long
def test_a_true_arm_with_torques_misses_nothing() -> None:
    arm = arm_named("four-axis")
    table = recorded(arm, one_run(arm, ROWS, 15), {}, POINT_MM, 16)
    verdict = diagnose(arm, table, QUICK, channels=(*CHANNELS, channel(table, read_torques(arm, table, 17))))
    assert verdict.answer == "nothing missing"
    assert not verdict.effects


def test_modelled_torques_are_pinocchios() -> None:
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 30, 5), {}, 0.0, 6)
    torques = read_torques(arm, table, 7)
    seen = channel(table, torques)
    left = residuals(fit_frames(arm, table), LinearisedTable(table, (*CHANNELS[:1], seen)))["torque"]
    off = left - left.mean(axis=0)
    assert off.std() == pytest.approx(TORQUE_NM, rel=0.15)
