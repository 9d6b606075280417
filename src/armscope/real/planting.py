"""A known effect added to real recordings: points, and orientations where measured, move by what it does to the arm.

What it does to the arm is simulated (`armscope.real.simulated_effects`). Nothing is concealed that nobody could find,
or that is none: errors larger than any real arm's, and motion that links and zeros which are off by a millimetre and a
milliradian make as well (an instrument's scale is all links longer by the same share).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from armscope.core.averages import rms
from armscope.core.location import Location
from armscope.core.types import Array
from armscope.real.constants import CONCEALING, LARGEST
from armscope.real.simulated_effects import SimulatedEffects
from armscope.world.effect_placement import LARGEST_FACTOR
from armscope.world.judge import ALTERNATIVE_NATS, Judge, Visibility
from armscope.world.kinds import LEAST_TORQUE, LOAD, Concealed, Kind, number, second_number
from armscope.world.spec import KINDS
from armscope.world.strength import LARGEST_RAW_M, SEEN_SHARE, Sized


@dataclass(frozen=True, eq=False)
class Planted:
    """An effect in real recordings."""

    effect: Concealed
    size: float  # RMS at the tool in multiples of what the arm leaves unexplained
    rms: float  # per axis, after the frames, over the training rows, m
    moved: Array  # (N, 3) displacement of every row, measurement frame, m
    turned: Array  # (N, 3, 3) turn of the tool in every row, measurement frame
    left: Array  # (N, 3) what frames fitted to the training rows leave of it, m
    visibility: Visibility  # noncentrality, and what else could stand in its place
    beyond_geometry: float  # the part of the noncentrality that links and zeros within their tolerances can't make


@dataclass(frozen=True)
class NotPlanted:
    """A size at which an effect has no place in an arm's recordings, and why."""

    size: float
    reason: str


class CannotPlantError(Exception):
    """Why an effect has no place in an arm's recordings."""


def plant(
    simulated: SimulatedEffects, judge: Judge, name: str, sizes: Sequence[float], level: float, rng: np.random.Generator
) -> Iterator[Planted | NotPlanted]:
    """One effect at one place at several sizes.

    Args:
        simulated: effects on the arm, at the prepared rows.
        judge: of what can be told apart there.
        name: the effect's key in the catalogue of worlds.
        sizes: RMS at the tool in multiples of the level.
        level: what the arm leaves unexplained, RMS per axis, m.
        rng: draws place and numbers.

    Yields:
        The recordings with the effect in them, and the truth, size by size; or why a size has no place there.

    Raises:
        CannotPlantError: the recordings have no place where this effect could be seen at any size.
    """
    kind = KINDS[name]
    places = rng.permutation(_places(simulated, kind)).tolist()
    effects = [Concealed(kind, place, kind.draw(rng, simulated.scenes[0], place)) for place in places]
    effect = _best_placed(simulated, judge, effects, sizes, level)
    for size in sizes:
        try:
            yield _sized(simulated, judge, effect, size, level)
        except CannotPlantError as error:
            yield NotPlanted(size, str(error))


def _best_placed(
    simulated: SimulatedEffects, judge: Judge, effects: Sequence[Concealed], sizes: Sequence[float], level: float
) -> Concealed:
    """The first that has the fewest alternatives at the largest size that any place allows. Raises CannotPlantError:
    none has a place at any size."""
    reasons: list[str] = []
    for size, largest_factor in itertools.product(sorted(sizes, reverse=True), (LARGEST_FACTOR, np.inf)):
        found: list[Planted] = []
        for effect in effects:
            try:
                found.append(_sized(simulated, judge, effect, size, level, largest_factor))
            except CannotPlantError as error:
                reasons += [str(error)] if largest_factor == np.inf else []
            if len(found) == CONCEALING.tries:
                break
        if found:
            return min(found, key=lambda each: len(each.visibility.alternatives)).effect
    raise CannotPlantError("; ".join(dict.fromkeys(reasons)))


def _places(simulated: SimulatedEffects, kind: Kind) -> list[str]:
    """Where the recordings could show it. Raises CannotPlantError: nowhere."""
    prepared = simulated.prepared
    torque = prepared.recordings.torque
    if kind.driver == LOAD and torque is None and not prepared.arm.has_masses:
        raise CannotPlantError("neither link masses nor torques are known: nothing to give way under")
    moves = np.ptp(prepared.recordings.motor_angles, axis=0) > CONCEALING.moves_rad
    load = np.abs(torque).max(axis=0) if torque is not None else simulated.scenes[0].torque_scale
    found = []
    for place in kind.places(prepared.arm.description):
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
    simulated: SimulatedEffects,
    judge: Judge,
    effect: Concealed,
    size: float,
    level: float,
    largest_factor: float = np.inf,
) -> Planted:
    """The effect scaled to its size. Raises CannotPlantError: frames or links take nearly all of it, or it would be
    absurd."""
    train, total = simulated.prepared.train, 1.0
    for _ in range(CONCEALING.rounds):
        moved = simulated.moved(effect)
        left = simulated.left(moved)
        raw, after = rms(moved[train]), rms(left[train])
        if raw < CONCEALING.unmoved_m or after < SEEN_SHARE * raw:
            raise CannotPlantError("frames absorb it")
        factor = size * level / after
        total *= factor
        if total > largest_factor or raw * factor > LARGEST_RAW_M:
            raise CannotPlantError("it would move the tool absurdly far")
        effect = effect.scaled(factor)
    _check_size(effect)
    moved, turned = simulated.motion(effect)
    left = simulated.left(moved)
    beyond_geometry = simulated.beyond_geometry(left, level)
    if beyond_geometry / 2 < ALTERNATIVE_NATS:
        raise CannotPlantError("links off by a millimetre or a milliradian move the tool alike")
    visibility = _visibility(simulated, judge, effect, moved, rms(left[train]), level)
    rotations = simulated.prepared.rotations
    in_measurement, left_there = (np.einsum("nij,nj->ni", rotations, each) for each in (moved, left))
    turned = rotations @ turned @ np.swapaxes(rotations, 1, 2)
    return Planted(effect, size, rms(left[train]), in_measurement, turned, left_there, visibility, beyond_geometry)


def _check_size(effect: Concealed) -> None:
    """Refuse numbers that no real arm has."""
    largest = LARGEST.of.get(effect.kind.effect)
    if largest is None:
        return
    name, limit, unit = largest
    if abs(effect.values[name]) > limit:
        raise CannotPlantError(f"its {name} would be above {limit:g} {unit}, which no real arm's is")


def _visibility(
    simulated: SimulatedEffects, judge: Judge, effect: Concealed, moved: Array, size: float, level: float
) -> Visibility:
    """How well it can be told from others; the first target stands for all, with its noise reduced accordingly."""
    sized = Sized(effect, size, moved[simulated.first_training()])
    return judge.visibility(sized, [], level / np.sqrt(len(simulated.rows)))


def truth_of(simulated: SimulatedEffects, planted: Planted) -> dict[str, Any]:
    """What is sealed about a planted effect, but where it came from."""
    prepared, effect = simulated.prepared, planted.effect
    content: dict[str, Any] = {
        "effect": effect.kind.effect,
        "location": effect.location,
        "driver": effect.kind.driver,
        "size": planted.size,
        "rms_mm": planted.rms * 1e3,
        "parameters": [each for each in effect.stated() if each["name"] != "time"],
        "alternatives": [[other.effect, other.location] for other in planted.visibility.alternatives],
        "noncentrality": planted.visibility.noncentrality,
        "beyond_geometry": planted.beyond_geometry,
    }
    if "time" in effect.values:
        order = prepared.configuration[prepared.train]
        ids = prepared.recordings.id[prepared.train].astype(float)
        before = order < effect.values["time"]
        content["jump_between_ids"] = [float(ids[before].max()), float(ids[~before].min())]
    return content
