"""A known effect added to real recordings: points, and orientations where measured, move by what it does to the arm.

The motion is the difference between the nominal arm with and without the effect, both simulated by the engine of the
virtual worlds (`armscope.world`) at the recorded joint angles, and turned into the measurement frame. Where joint
torques were recorded, they are what a compliant joint gives way under; elsewhere it is gravity's torque by the mass
table, in equilibrium.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armscope.core.averages import rms
from armscope.core.location import Location
from armscope.core.types import Array
from armscope.real.staging import Stage
from armscope.world.effect_placement import LARGEST_FACTOR
from armscope.world.kinds import LEAST_TORQUE, LOAD, Concealed, Kind, number, second_number
from armscope.world.rivals import Judge, Visibility
from armscope.world.spec import KINDS
from armscope.world.statics import Hidden, Session, balance
from armscope.world.strength import LARGEST_RAW_M, SEEN_SHARE, Sized, frame_columns, make_scene

MOVES_RAD = 0.05
"""A joint that moves less than this cannot show what follows its angle."""
ROUNDS = 3
TRIES = 4
"""Places among which that with the fewest alternatives is taken."""


SPRING = KINDS["joint_compliance"]
"""What gives way under the recorded torque where there is one."""


@dataclass(frozen=True, eq=False)
class Planted:
    """An effect in real recordings.

    Attributes:
        effect: with its numbers.
        size: RMS at the tool in multiples of what the arm leaves unexplained.
        rms: per axis, after the frames, over the training rows, m.
        moved: (N, 3) displacement of every row, measurement frame, m.
        turned: (N, 3, 3) turn of the tool in every row, measurement frame.
        left: (N, 3) what frames fitted to the training rows leave of it, m.
        visibility: noncentrality, and what else could stand in its place.
    """

    effect: Concealed
    size: float
    rms: float
    moved: Array
    turned: Array
    left: Array
    visibility: Visibility


class CannotPlantError(Exception):
    """Why an effect has no place in an arm's recordings."""


class Theatre:
    """A stage with the nominal arm simulated on it, one scene per target."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.rows = [np.flatnonzero(stage.target == k) for k in range(len(stage.targets))]
        self.scenes, self.nominal = [], np.empty((len(stage.table), 3))
        self.turns, self.straight = np.empty((2, len(stage.table), 3, 3))
        session = _session(stage)
        for rows, tool in zip(self.rows, stage.tools, strict=True):
            x, y, z = (float(value) for value in tool * 1e3)
            description = stage.arm.description.model_copy(update={"tool_mm": (x, y, z)})
            scene, points = make_scene(description, session.rows(rows))
            self.scenes.append(scene)
            self.nominal[rows], self.turns[rows] = points, scene.tool_turn
            true = balance(scene.geometry, scene.session, Hidden.nothing(scene.geometry, scene.session))
            self.straight[rows] = true.tool_turn

    def moved(self, effect: Concealed) -> Array:
        """(N, 3) displacement of the tool point by an effect, base axes, m."""
        return self.motion(effect)[0]

    def motion(self, effect: Concealed) -> tuple[Array, Array]:
        """(N, 3) displacement of the tool point by an effect, m, and (N, 3, 3) turn of the tool, base axes."""
        points, turns = np.empty_like(self.nominal), np.empty_like(self.straight)
        torque = self.stage.recordings.torque
        for rows, scene in zip(self.rows, self.scenes, strict=True):
            hidden = Hidden.nothing(scene.geometry, scene.session)
            if effect.kind is SPRING and torque is not None:
                joint = number(effect.location)
                hidden.motor[:, joint] += effect.values["compliance"] * np.nan_to_num(torque[rows, joint])
            else:
                effect.hide(hidden, scene)
            stands = balance(scene.geometry, scene.session, hidden)
            points[rows], turns[rows] = stands.tool, stands.tool_turn
        return points - self.nominal, turns @ np.swapaxes(self.straight, 1, 2)

    def left(self, moved: Array) -> Array:
        """(N, 3) what base and tools, fitted to the training rows, leave of a displacement."""
        columns = self._frames
        train = np.concatenate([3 * self.stage.train + axis for axis in range(3)])
        step = np.linalg.lstsq(columns[train], moved.ravel()[train], rcond=None)[0]
        return np.asarray(moved - (columns @ step).reshape(-1, 3))

    @property
    def _frames(self) -> Array:
        columns = frame_columns(self.nominal, self.turns)
        tools = [
            np.where((self.stage.target == k).repeat(3)[:, None], columns[:, 6:], 0) for k in range(len(self.rows))
        ]
        return np.concatenate([columns[:, :6], *tools], axis=1)

    def judge(self) -> Judge:
        """Compares an effect with all others at the training rows of the first target."""
        of_first = np.isin(self.rows[0], self.stage.train)
        return Judge(self.scenes[0].rows(np.flatnonzero(of_first)), self.nominal[self.rows[0][of_first]])

    def first_training(self) -> NDArray[np.intp]:
        """The rows that `judge` sees."""
        return self.rows[0][np.isin(self.rows[0], self.stage.train)]


def _session(stage: Stage) -> Session:
    """The recorded rows as the engine takes them; time is the number of the configuration."""
    rows, count = stage.recordings, len(stage.recordings)
    assert rows.temperature is not None
    assert rows.approach is not None
    return Session(
        commanded=rows.motor_angles,
        payload=np.zeros(count) if rows.payload is None else np.nan_to_num(rows.payload),
        time=stage.configuration.astype(float),
        temperature=rows.temperature,
        run=np.ones(count, dtype=np.int64),
        approach=rows.approach,
        speed=np.zeros_like(rows.motor_angles),
    )


def plant(
    theatre: Theatre, judge: Judge, name: str, sizes: Sequence[float], level: float, rng: np.random.Generator
) -> Iterator[Planted]:
    """One effect at one place at several sizes.

    Args:
        theatre: the stage, simulated.
        judge: of what can be told apart there.
        name: the effect's key in the catalogue of worlds.
        sizes: RMS at the tool in multiples of the level.
        level: what the arm leaves unexplained, RMS per axis, m.
        rng: draws place and numbers.

    Yields:
        The recordings with the effect in them, and the truth, size by size.

    Raises:
        CannotPlantError: the recordings have no place where this effect could be seen.
    """
    kind = KINDS[name]
    places = rng.permutation(_places(theatre, kind)).tolist()
    effects = [Concealed(kind, place, kind.draw(rng, theatre.scenes[0], place)) for place in places]
    for largest_factor in (LARGEST_FACTOR, np.inf):
        tried = (_sized(theatre, judge, effect, max(sizes), level, largest_factor) for effect in effects)
        found = list(itertools.islice((planted for planted in tried if planted is not None), TRIES))
        if found:
            best = min(found, key=lambda each: len(each.visibility.alternatives))
            break
    else:
        raise CannotPlantError("frames absorb it, or it would move the tool absurdly far, wherever it sits")
    for size in sizes:
        planted = _sized(theatre, judge, best.effect, size, level)
        if planted is not None:
            yield planted


def _places(theatre: Theatre, kind: Kind) -> list[str]:
    """Where the recordings could show it.

    Raises:
        CannotPlantError: nowhere.
    """
    stage = theatre.stage
    torque = stage.recordings.torque
    if kind.driver == LOAD and torque is None and not stage.arm.has_masses:
        raise CannotPlantError("neither link masses nor torques are known: nothing to give way under")
    moves = np.ptp(stage.recordings.motor_angles, axis=0) > MOVES_RAD
    load = np.abs(torque).max(axis=0) if torque is not None else theatre.scenes[0].torque_scale
    found = []
    for place in kind.places(stage.arm.description):
        if kind.driver == LOAD and load[number(place)] <= LEAST_TORQUE * load.max():
            continue
        if Location.of(place).kind == "joint" and kind.driver != LOAD and not moves[number(place)]:
            continue
        if Location.of(place).source and not moves[second_number(place)]:
            continue
        found.append(place)
    if not found:
        raise CannotPlantError("no joint moves or carries load enough")
    return found


def _sized(
    theatre: Theatre, judge: Judge, effect: Concealed, size: float, level: float, largest_factor: float = np.inf
) -> Planted | None:
    """The effect scaled to its size; None if the frames take nearly all of it, or it would be absurd."""
    train, total = theatre.stage.train, 1.0
    for _ in range(ROUNDS):
        moved = theatre.moved(effect)
        left = theatre.left(moved)
        raw, after = rms(moved[train]), rms(left[train])
        if raw < 1e-9 or after < SEEN_SHARE * raw:
            return None
        factor = size * level / after
        total *= factor
        if total > largest_factor or raw * factor > LARGEST_RAW_M:
            return None
        effect = effect.scaled(factor)
    moved, turned = theatre.motion(effect)
    left = theatre.left(moved)
    visibility = _visibility(theatre, judge, effect, moved, rms(left[train]), level)
    rotations = theatre.stage.rotations
    in_measurement, left_there = (np.einsum("nij,nj->ni", rotations, each) for each in (moved, left))
    turned = rotations @ turned @ np.swapaxes(rotations, 1, 2)
    return Planted(effect, size, rms(left[train]), in_measurement, turned, left_there, visibility)


def _visibility(
    theatre: Theatre, judge: Judge, effect: Concealed, moved: Array, size: float, level: float
) -> Visibility:
    """How well it can be told from others; the first target stands for all, with its noise reduced accordingly."""
    sized = Sized(effect, size, moved[theatre.first_training()])
    return judge.visibility(sized, [], level / np.sqrt(len(theatre.rows)))


def truth_of(theatre: Theatre, planted: Planted) -> dict[str, Any]:
    """What is sealed about a planted effect, but where it came from."""
    stage, effect = theatre.stage, planted.effect
    content: dict[str, Any] = {
        "effect": effect.kind.effect,
        "location": effect.location,
        "driver": effect.kind.driver,
        "size": planted.size,
        "rms_mm": planted.rms * 1e3,
        "parameters": [each for each in effect.stated() if each["name"] != "time"],
        "alternatives": [[other.effect, other.location] for other in planted.visibility.alternatives],
        "noncentrality": planted.visibility.noncentrality,
    }
    if "time" in effect.values:
        order = stage.configuration[stage.train]
        ids = stage.recordings.id[stage.train].astype(float)
        before = order < effect.values["time"]
        content["jump_between_ids"] = [float(ids[before].max()), float(ids[~before].min())]
    return content
