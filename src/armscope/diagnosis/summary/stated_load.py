"""What compliances owe to a load that never changes: rows tell only their product, and the load is as it was stated.

Drives under 4 kg that are in truth 6.5 kg come out half as soft again, with intervals that know nothing of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from armscope.check.constants import TABLE
from armscope.core.types import Array
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.another_payload import is_told, payload_as_alternative, with_another_payload
from armscope.diagnosis.summary.constants import TELLING
from armscope.inference.search import Search
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Direction, Part
from armscope.physics.loaded_arm import Misstated
from armscope.physics.loads import STATED_MASSES, givings
from armscope.physics.placing import varies
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.effects import FoundEffect


@dataclass(frozen=True, eq=False)
class StatedLoad:
    """A load that is the same in all rows."""

    kg: float  # its mass; 0 where none is stated
    off_kg: float  # by which it may plausibly be other than stated
    words: str  # who states it
    centre: Array | None = None  # (3,) m, off the tool point; None for there


def beside_the_stated_load(
    state: DiagnosisState, search: Search, found: Mapping[int, FoundEffect]
) -> dict[int, FoundEffect]:
    """Effects, those that give way with what their numbers would be under another load than the one that is stated.

    Args:
        state: the finished selection.
        search: its search.
        found: by candidate.

    Returns:
        The effects; as they are where loads change, where torques tell them, or where the payload has a name.
    """
    told = dict(found)
    load = stated_load(state.start.arm, state.recordings)
    if load is None or is_told(search, state.best):
        return told
    other = with_another_payload(search, state.best)
    rival = None if other is None else payload_as_alternative(search, state.best, other)
    for chosen, part in zip(state.best.chosen, state.fit.model.parts, strict=True):
        effect = told.get(chosen.candidate)
        changes = under_other_loads(part, state.start.arm, state.recordings, load)
        if effect is None or not changes or abs(changes[0]) < TELLING.same_size:
            continue
        others = effect.alternatives
        if rival is not None and all(other.effect != rival.effect for other in others):
            others = tuple(sorted((*others, rival), key=lambda each: each.evidence_gap_nats))
        confirm = f"{_in_words(load, changes)} {effect.confirm}"
        told[chosen.candidate] = replace(effect, alternatives=others, confirm=confirm)
    return told


def stated_load(arm: Arm, recordings: Recordings) -> StatedLoad | None:
    """The load at the flange that no row tells from what gives way under it.

    Args:
        arm: the arm, with its description.
        recordings: the rows.

    Returns:
        The load; None where it changes, where it is stated to be nothing, and where torques or no masses tell loads.
    """
    if not arm.has_masses or recordings.torque is not None:
        return None
    if recordings.payload is not None:
        payload = np.nan_to_num(recordings.payload)
        if varies(payload, TABLE.payload_varies) or not payload.max() > 0:
            return None
        kg = float(np.median(payload))
        return StatedLoad(kg, PLAUSIBLE.payload_share * kg, "payload_kg states in every row")
    carried = arm.description.tool_load
    if carried is not None:
        centre = 1e-3 * np.array(carried.com_mm) - arm.tool
        return StatedLoad(
            carried.mass_kg, PLAUSIBLE.payload_share * carried.mass_kg, "tool_load in the robot's file states", centre
        )
    return StatedLoad(0.0, TELLING.unstated_load_kg, "")


def under_other_loads(part: Part, arm: Arm, recordings: Recordings, load: StatedLoad) -> list[float]:
    """By which share what gives way would be another under a heavier load, and under a lighter one.

    Each by itself, so about: what a load does in all poses alike is a zero's or a frame's, and only its changes from
    pose to pose count.

    Args:
        part: of the fitted model.
        arm: the arm.
        recordings: the rows.
        load: as stated.

    Returns:
        Shares of its size; one where no load is stated, none where the part does not give way to a load.
    """
    if part.placed.effect is STATED_MASSES or part.placed.effect.requires:
        return []
    as_stated = _loads(part, Scene(arm, recordings))
    if not len(as_stated):
        return []
    changes = []
    for off in (load.off_kg, -load.off_kg)[: 2 if load.kg else 1]:
        other = _loads(part, Scene(arm, recordings, Misstated(payload_kg=off, payload_offset=load.centre)))
        changes.append(float(as_stated @ other / (other @ other)) - 1)
    return changes


def _loads(part: Part, scene: Scene) -> Array:
    """What a part turns and shifts, row by row and direction by direction, without what is so in all rows."""
    moved: dict[Direction, Array] = {}
    for product in givings([part], torques_recorded=False):
        moved[product.direction] = moved.get(product.direction, 0.0) + product.factor * scene.driver(product.driver)
    return np.concatenate([each - each.mean() for each in moved.values()]) if moved else np.empty(0)


def _in_words(load: StatedLoad, changes: list[float]) -> str:
    if not load.kg:
        return (
            f"No load at the flange is stated: with {load.off_kg:.3g} kg there this would be about "
            f"{_other(changes[0])}; see what hangs there, and weigh it."
        )
    share = f"{100 * load.off_kg / load.kg:.0f} %"
    return (
        f"It holds for the {load.kg:.3g} kg that {load.words}, and these rows can't tell whether that is right: were "
        f"it {share} more, this would be about {_other(changes[0])}, were it {share} less, {_other(changes[1])}; "
        "weigh it."
    )


def _other(change: float) -> str:
    return f"{abs(100 * change):.0f} % {'larger' if change > 0 else 'smaller'}"
