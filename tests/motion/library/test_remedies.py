"""Cures with sign and number, executed as printed: on another path the torque that was missing is gone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
import yaml
from scipy.interpolate import make_interp_spline

from armscope.core.types import Array
from armscope.motion.library import catalogue, twist_catalogue
from armscope.motion.library.remedies import Fitted, with_its_centre
from armscope.motion.pipeline import diagnose_motion
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm
from armscope.verdict.effects import Parameter
from tests.motion.cured import (
    DRIVES,
    JOINT,
    LONG,
    NOISE,
    SHORT,
    STATED,
    Motion,
    Spec,
    Torque,
    as_it_is,
    at_joint,
    diagnosed,
    edited,
    left,
    rigid,
    told,
)
from tests.motion.moving import ROBOT, behind_its_drive, path, robot

SEED = 12
Cured = tuple[Spec, Torque, Torque]
"""robot.yaml after the cure, what it adds to the simulated torque, and what it does to the recorded one."""


@dataclass(frozen=True)
class Case:
    """What is not as stated, under which name at which place, and what a reader does who has read the cure."""

    name: str
    place: str
    read: Callable[[str], Cured]
    spec: Spec | None = None
    planted: Torque = as_it_is
    paths: tuple[int, float] = SHORT

    @property
    def truth(self) -> tuple[Spec, Torque]:
        return self.spec or STATED, self.planted


def of_drive(key: str) -> Callable[[str], Cured]:
    def read(cure: str) -> Cured:
        (more,) = told(cure, "stated ")
        assert f"`{key}`" in cure
        return edited(lambda spec: spec["drives"][JOINT].update({key: DRIVES[JOINT][key] + more})), as_it_is, as_it_is

    return read


def offset(cure: str) -> Cured:
    (size,) = told(cure, "offset, ")
    assert "from the recorded torque" in cure
    return STATED, as_it_is, at_joint(lambda q, v, a, T: np.full_like(q, -size))


def by_direction(cure: str) -> Cured:
    first, size = cure.split("viscous friction ")[1].split(" ")[:2]
    forward = float(size) if first == "plus" else -float(size)
    assert f"forward, {'less' if forward > 0 else 'plus'} as much backward" in cure
    return STATED, at_joint(lambda q, v, a, T: np.where(v > 0, forward, -forward) * v), as_it_is


def rubbing_with_the_load(per: float) -> Torque:
    def more(motion: Motion, torque: Array) -> Array:
        found = torque.copy()
        found[:, JOINT] += per * np.abs(rigid(STATED, motion)[:, JOINT]) * np.sign(motion.dq[:, JOINT])
        return found

    return more


def with_load(cure: str) -> Cured:
    (per,) = told(cure, "of the joint: ")
    assert cure.endswith("× |torque| × sign of the speed.")
    return STATED, rubbing_with_the_load(per), as_it_is


def times(factor: float) -> Torque:
    def read(motion: Motion, torque: Array) -> Array:
        found = torque.copy()
        found[:, JOINT] *= factor
        return found

    return read


def later(seconds: float) -> Torque:
    def read(motion: Motion, torque: Array) -> Array:
        found = torque.copy()
        found[:, JOINT] = np.interp(motion.time - seconds, motion.time, torque[:, JOINT])
        return found

    return read


def shifted(cure: str) -> Cured:
    (ms,) = told(cure, "recorded torque ")
    assert ("earlier" in cure) is not ("later" in cure)
    return STATED, as_it_is, later(-1e-3 * ms if "earlier" in cure else 1e-3 * ms)


def heavier(by: float) -> Spec:
    def change(spec: Spec) -> None:
        link = spec["links"][1]
        share = (link["mass_kg"] + by) / link["mass_kg"]
        link["mass_kg"] *= share
        link["inertia_kg_m2"] = [share * each for each in link["inertia_kg_m2"]]

    return edited(change)


def mass(cure: str) -> Cured:
    assert "inertia in proportion" in cure
    return heavier(*told(cure, "stated ")), as_it_is, as_it_is


def heavier_alone(by: float) -> Spec:
    def change(spec: Spec) -> None:
        spec["links"][1]["mass_kg"] += by

    return edited(change)


def mass_alone(cure: str) -> Cured:
    assert "mass alone" in cure
    return heavier_alone(*told(cure, "stated ")), as_it_is, as_it_is


def centred(link: int, at: list[float]) -> Spec:
    return edited(lambda spec: spec["links"][link].update(com_mm=at))


def centre(link: int) -> Callable[[str], Cured]:
    return lambda cure: (centred(link, told(cure, "com_mm to ")), as_it_is, as_it_is)


def turning(more: float) -> Spec:
    def change(spec: Spec) -> None:
        own = spec["links"][1]["inertia_kg_m2"]
        spec["links"][1]["inertia_kg_m2"] = [*(each + more for each in own[:3]), *own[3:]]

    return edited(change)


def inertia(cure: str) -> Cured:
    assert "xx, yy and zz as stated and " in cure
    return turning(*told(cure, "as stated and ")), as_it_is, as_it_is


def carrying(mass: float, at: list[float]) -> Spec:
    return edited(lambda spec: spec.update(tool_load={"mass_kg": mass, "com_mm": at}))


def load(cure: str) -> Cured:
    """Typed into robot.yaml as printed."""
    content = yaml.safe_load(cure.partition("`tool_load` of robot.yaml to ")[2].partition(" (±")[0])
    return edited(lambda spec: spec.update(tool_load=content)), as_it_is, as_it_is


def gravity(cure: str) -> Cured:
    return edited(lambda spec: spec.update(gravity_m_s2=told(cure, "gravity_m_s2 to "))), as_it_is, as_it_is


LEANING = [0.36, 0.34, -9.797]
AT = f"joint {JOINT + 1}"
CASES = {
    "dry": Case("coulomb_friction", AT, of_drive("coulomb_nm"), None, at_joint(lambda q, v, a, T: -1.5 * np.sign(v))),
    "viscous": Case("viscous_friction", AT, of_drive("viscous_nm_s_rad"), None, at_joint(lambda q, v, a, T: 2.5 * v)),
    "rotor": Case("rotor_inertia", AT, of_drive("rotor_inertia_kg_m2"), None, at_joint(lambda q, v, a, T: -0.3 * a)),
    "offset": Case("torque_offset", AT, offset, None, at_joint(lambda q, v, a, T: np.full_like(q, -2.0))),
    "direction": Case("asymmetric_friction", AT, by_direction, None, at_joint(lambda q, v, a, T: -2.0 * np.abs(v))),
    "load": Case("load_friction", AT, with_load, None, rubbing_with_the_load(0.07)),
    "gain": Case("motor_constant", AT, lambda cure: (STATED, as_it_is, times(*told(cure, "by "))), None, times(0.88)),
    "delay": Case("torque_delay", AT, shifted, None, later(0.02), LONG),  # known to milliseconds by much data alone
    "mass": Case("link_mass", "link 2", mass, heavier(-1.2)),
    "mass alone": Case("link_mass", "link 2", mass_alone, heavier_alone(1.5)),
    "centre": Case("link_first_moment", "link 2", centre(1), centred(1, [-130, 60, 70])),
    "centre of the last": Case("link_first_moment", "link 3", centre(2), centred(2, [-90, -70, 50])),
    "inertia": Case("link_inertia", "link 2", inertia, turning(0.4)),
    "payload": Case("payload_error", "payload", load, carrying(1.5, [0, 0, 0])),
    "payload off the flange": Case("payload_error", "payload", load, carrying(1.5, [30, -60, 90])),
    "gravity": Case("gravity_direction", "base", gravity, edited(lambda spec: spec.update(gravity_m_s2=LEANING))),
}


AGAIN = {
    *("dry", "viscous", "offset", "load", "mass", "direction", "delay"),
    *("centre", "centre of the last", "payload", "inertia", "gravity"),
}
"""Cards like another's: as the rotor's, one more number of a drive; of an easier case; or a slow one."""


@pytest.mark.parametrize("kind", [pytest.param(kind, marks=[pytest.mark.long] * (kind in AGAIN)) for kind in CASES])
def test_who_does_what_the_card_says_has_the_torque(kind: str) -> None:
    case = CASES[kind]
    (cause,) = diagnosed(*case.truth, SEED, paths=case.paths)
    assert (cause.effect, cause.location) == (case.name, case.place)
    assert left(case.truth, case.read(cause.cure), SEED) < 0.04


@pytest.mark.long
def test_a_link_that_lags_as_the_card_says_needs_the_torque() -> None:
    arm, c = robot(), 5e-4
    table = behind_its_drive(arm, JOINT, c, noise=NOISE)
    (cause,) = diagnose_motion(arm, as_motions(table, "motions.csv", 3)).verdict.effects
    (mrad,) = told(cause.cure, "motor: ")
    assert "mrad per N m of torque" in cause.cure or "µrad per N m of torque" in cause.cure
    lag = mrad * (1e-3 if "mrad" in cause.cure else 1e-6)
    time, q, dq, ddq = path(np.random.default_rng(77), 3, 15.0, 200.0)
    of_links = _torque((q, dq, ddq))
    behind = make_interp_spline(time, of_links[:, JOINT], k=5)
    motors = [each.copy() for each in (q, dq, ddq)]
    for order, values in enumerate(motors):
        values[:, JOINT] += c * behind(time, order)
    links = [each.copy() for each in motors]
    for _ in range(3):
        pull = make_interp_spline(time, _torque(tuple(links))[:, JOINT], k=5)
        for order, (values, driven) in enumerate(zip(links, motors, strict=True)):
            values[:, JOINT] = driven[:, JOINT] - lag * pull(time, order)
    inside = slice(100, -100)
    missing = (of_links - _torque(tuple(motors)))[inside]
    assert np.linalg.norm((of_links - _torque(tuple(links)))[inside]) < 0.05 * np.linalg.norm(missing)


def _torque(motion: tuple[Array, ...]) -> Array:
    model = robot().model
    data = model.createData()
    return np.array([pin.rnea(model, data, *row).copy() for row in zip(*motion, strict=True)])


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_centre_is_told_in_the_frame_of_the_file(convention: str) -> None:
    rows = [{**row, "theta_offset_deg": 30.0, "alpha_deg": 40.0} for row in ROBOT["dh"]["joints"]]  # type: ignore[index]
    links: list[dict[str, Any]] = ROBOT["links"]  # type: ignore[assignment]
    moved = [links[0], {**links[1], "com_mm": [-100, 44, -31]}, links[2]]
    arms = [
        build_moving_arm(
            RobotDescription.model_validate(
                {"name": "turned", "dh": {"convention": convention, "joints": rows}, "links": bodies}
            )
        )
        for bodies in (links, moved)
    ]
    by = (arms[1].inertial - arms[0].inertial)[11:14]
    numbers = tuple(Parameter(f"m{axis}", "kg m", float(value), 1e-4) for axis, value in zip("xyz", by, strict=True))
    cure = with_its_centre(Fitted("Correct it.", numbers, arms[0], place="link 2"))
    assert told(cure, "com_mm to ") == pytest.approx([-100, 44, -31], abs=0.06)


@pytest.mark.parametrize(
    ("found", "words"),
    [(-1.1, "Take the body out"), (1.0, "once more: 1.00 ± 0.20 times"), (-0.3, "correct its mass: as stated, −0.30")],
)
def test_what_is_there_twice_is_not_taken_out(found: float, words: str) -> None:
    cause = catalogue.BODY
    assert cause.remedy is not None
    assert words in cause.remedy(Fitted(cause.cure, (Parameter("times", "", found, 0.1),), robot()))


def test_a_link_is_shifted_and_geared_against_what_was_found() -> None:
    late, more = Parameter("lag", "s", 0.002, 1e-5), Parameter("share", "", 0.004, 1e-5)
    lag, ratio = (each.remedy for each in (twist_catalogue.ENCODER_LAG, twist_catalogue.GEAR_RATIO))
    assert lag is not None
    assert ratio is not None
    time = np.arange(0, 1, 1e-3)
    turned = np.sin(5 * time)
    recorded = np.sin(5 * (time - late.value))
    cure = lag(Fitted("", (late,), robot()))
    (ms,) = told(cure, "position ")
    shifted = np.interp(time + 1e-3 * ms * (1 if "earlier" in cure else -1), time, recorded)
    assert np.abs(shifted - turned)[:-5].max() < 1e-5
    (factor,) = told(ratio(Fitted("", (more,), robot())), "by ")
    link = (1 + more.value) * turned  # by the stated reduction the motor's position is `turned`
    assert turned / factor == pytest.approx(link, abs=1e-6)
