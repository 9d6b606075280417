"""An exciting motion as files: trajectory.csv to play, trajectory.json to judge it by."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.files import read_json, write_json, write_table
from armscope.core.inputs import InputError
from armscope.core.streams import is_stream
from armscope.core.types import Array
from armscope.poses.exciting.columns import Motion, all_columns, stated_friction
from armscope.poses.exciting.criterion import MotionScore, Pair
from armscope.poses.exciting.search import Excitation, times_of_table
from armscope.poses.obstacles import body_notes
from armscope.robot import Arm
from armscope.robot.dynamics import inertial_parameters
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def trajectory_table(found: Excitation, rate: float) -> pd.DataFrame:
    """time_s, q1_rad ..., dq1_rad_s ..., ddq1_rad_s2 ..., and the stated model's torques tau1_nm ..., over a period."""
    time = times_of_table(found.path.period, rate)
    angle, speed, acceleration = found.path.at(time)
    numbers = np.concatenate([inertial_parameters(found.arm.model), stated_friction(found.arm)])
    torque = all_columns(found.arm, Motion(angle, speed, acceleration, 1 / rate)) @ numbers
    columns: dict[str, Any] = {"time_s": time}
    for pattern, values in (
        ("q{}_rad", angle), ("dq{}_rad_s", speed), ("ddq{}_rad_s2", acceleration), ("tau{}_nm", torque),
    ):  # fmt: skip
        columns |= {pattern.format(motor + 1): values[:, motor] for motor in range(values.shape[1])}
    return pd.DataFrame(columns)


def write_excitation(path: Path, found: Excitation, rate: float) -> None:
    """Write trajectory.csv, and trajectory.json beside it (a pipe gets the table alone).

    Args:
        path: of the table.
        found: the motion.
        rate: samples per second.
    """
    table = trajectory_table(found, rate)
    write_table(path, table, digits=9)
    if not is_stream(path):
        write_json(path.with_suffix(".json"), _content(found, table))


def _content(found: Excitation, table: pd.DataFrame) -> dict[str, Any]:
    limits, path = found.limits, found.path
    _, speed, acceleration = path.over_period()
    return {
        "robot": found.arm.name,
        "separates": [_words(pair) for pair in found.pairs] or "everything: all base parameters",
        "no_motion_separates": [_words(pair) for pair in found.inseparable],
        "not_planned_for": [_words(pair) for pair in found.lawless],
        "random_motion": _score(found.before),
        "this_motion": _score(found.after),
        "base_parameters": len(found.shown.base),
        "shows_nothing_of": list(found.shown.nothing),
        "shows_only_together_with_others": list(found.shown.together),
        "period_s": path.period,
        "harmonics": path.harmonics,
        "largest": {
            "speed_share": (_largest(table, "dq", np.abs(speed).max(axis=0)) / limits.path.speed).round(4),
            "acceleration_share": (
                _largest(table, "ddq", np.abs(acceleration).max(axis=0)) / limits.path.acceleration
            ).round(4),
            "torque_nm": _largest(table, "tau", found.torque).round(3),
            "torque_limit_nm": limits.torque,
        },
        "assumed": motion_notes(found),
        "motions_tried": found.tried,
        "motions_refused": found.refused,
        "fourier": {"centre_rad": path.centre, "sine_rad": path.sine, "cosine_rad": path.cosine},
    }


def _largest(table: pd.DataFrame, quantity: str, planned: Array) -> Array:
    """(m,) largest of each motor in the table that is played, which is finer than what was planned on, or on that."""
    played = [
        np.abs(table.filter(regex=rf"^{quantity}{motor}_").to_numpy()).max() for motor in range(1, len(planned) + 1)
    ]
    return np.asarray(np.maximum(played, planned))


def _score(score: MotionScore) -> dict[str, Any]:
    about: dict[str, Any] = {"condition_number": score.condition, "weakest": score.weakest}
    if score.separations:
        return about | {"share_not_imitated": list(score.separations)}
    return about | {"log_det_information": score.value}


def _words(pair: Pair) -> str:
    return " | ".join(" ".join(cause) for cause in pair)


ONLY_THESE_PAIRS = (
    "the share is of torque without noise, and of these pairs: what else could be (all masses off a little, say) was "
    "not planned for, and a verdict on this motion may still be open"
)
"""With --separate: more of what tells two causes apart is no promise that a third reading is excluded."""


def motion_notes(found: Excitation) -> list[str]:
    """What was assumed, what collisions were looked for with, and what was not looked at."""
    floor = "no floor" if found.around.floor is None else f"a floor at {found.around.floor * 1e3:g} mm"
    collisions = [f"collisions: {floor}", *body_notes(found.arm, found.around)]
    return [*found.limits.assumed, *collisions, *([ONLY_THESE_PAIRS] if found.pairs else [])]


def _too_close(alternative: object) -> bool:
    """Whether the motions hardly tell an alternative from its cause; so it is taken where a verdict does not say."""
    nats = alternative.get("discriminability_nats") if isinstance(alternative, dict) else None
    return not isinstance(nats, int | float) or nats < INDISTINGUISHABLE_NATS


def _cause(content: object, verdict: Path, place: str) -> tuple[str, str]:
    """Name and place of a cause of a verdict. Raises InputError: it has none."""
    if isinstance(content, dict):
        name, location = content.get("effect"), content.get("location")
        if isinstance(name, str) and isinstance(location, str):
            return name, location
    raise InputError(verdict, place, content, "a cause has its name in `effect` and its place in `location`")


def pairs_of(verdict: Path, arm: Arm | None = None) -> tuple[Pair, ...]:
    """The causes that a verdict on a motion could not tell apart, each with its alternative.

    Where it told all of them, what it told: each cause with each of its alternatives.

    Raises:
        InputError: it is no verdict, or one of an arm with another number of joints; or nothing in it has an
            alternative.
    """
    content = read_json(verdict, "verdict.json of a diagnosis of a motion")
    if not isinstance(content, dict) or not isinstance(content.get("effects"), list):
        raise InputError(verdict, "", "no list of effects", "verdict.json of a diagnosis of a motion is needed here")
    joints = content.get("background")
    if arm is not None and isinstance(joints, list) and len(joints) != arm.n_motors:
        rule = f"{arm.name} has {arm.n_motors}: the verdict is on another arm"
        raise InputError(verdict, "background", f"{len(joints)} joints", rule, "Give the arm that it was made of.")
    pairs: list[Pair] = []
    close: list[Pair] = []
    for number, effect in enumerate(content["effects"]):
        own = _cause(effect, verdict, f"effects[{number}]")
        others = effect.get("alternatives") or []
        if not isinstance(others, list):
            raise InputError(verdict, f"effects[{number}].alternatives", others, "a list of causes stands here")
        for n, other in enumerate(others):
            pairs.append((own, _cause(other, verdict, f"effects[{number}].alternatives[{n}]")))
            close += pairs[-1:] if _too_close(other) else []
    if not pairs:
        rule = "no cause in it has an alternative, so there is nothing to separate"
        raise InputError(verdict, "effects", "no alternatives", rule, "Leave --separate out: everything shall show.")
    return tuple(dict.fromkeys(close or pairs))
