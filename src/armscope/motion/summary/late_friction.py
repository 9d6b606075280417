"""Friction that changes sides later than the speed by more than presliding and filters do: told, though it has no name.

Every joint's friction may turn over some milliseconds late unnamed (`layout.OWN_NAMES`), and where dry friction is most
of a joint's torque, nothing but that moment tells a delay of all torque. So no cause is named for it; but it is there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.words import rounded
from armscope.inference.evidence import Hypothesis, at_noise
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.space import OF_REVERSALS
from armscope.motion.library import catalogue
from armscope.motion.summary.constants import NAMING
from armscope.motion.summary.intervals import Sureness, level_of_gains
from armscope.verdict.effects import INTERVAL
from armscope.verdict.schema import Notice


def told_late(selected: SelectedCauses, sure: Sureness) -> list[Notice]:
    """What is said of joints whose friction changes sides late, or early, without a delay being named there.

    Args:
        selected: the selection.
        sure: how wide intervals are. Gains of all drives that are off alike make no moment later.

    Returns:
        A notice, or none. Of a joint that stands between its moves none that says "sooner".
    """
    layout, best = selected.rows.layout, _with_turns_free(selected)
    delays = [layout.placed[n] for n in selected.best.candidates if layout.placed[n].cause is catalogue.DELAY]
    named = {joint for delay in delays for joint in delay.joints}
    told: list[tuple[int, float, float]] = []
    level = level_of_gains(layout)
    for j, column in enumerate(layout.reversals[:, -1]):
        dry = selected.dry[j]
        if j in named or dry <= 0:
            continue
        slope = selected.told[column]
        error = float(np.sqrt(best.variances(np.array([column]))[0])) / selected.problem.scale[column]
        apart = np.sqrt(max((sure.factor[column] * error) ** 2 - (level * slope) ** 2, error**2))
        late, unsure = slope / dry, INTERVAL * apart / dry
        if abs(late) - unsure > PRIOR.turning_s and (late > 0 or not _stands(selected, j)):
            told.append((j, late, unsure))
    if not told:
        return []
    each = [f"joint {j + 1} {rounded(1e3 * late)} ± {rounded(1e3 * unsure)} ms" for j, late, unsure in told]
    text = (
        f"Friction changes sides later than the speed: {', '.join(each)} (below zero: sooner). It clings over a way, "
        "or torque is recorded so late (a delay); where friction is most of a joint's torque, motion does not tell "
        f"which: turn it to and fro at two speeds.{latest_in_words(told)}"
    )
    return [Notice("late friction", text)]


def latest_in_words(told: Sequence[tuple[int, float, float]]) -> str:
    """That one of several joints is later than all others by more than friction differs: its torque may be late.

    Args:
        told: joints (from 0), by how much each is late, and within what, s.

    Returns:
        A sentence with a space before it, or nothing.
    """
    if len(told) < 2:
        return ""
    next_to, latest = sorted(told, key=lambda each: each[1])[-2:]
    by = latest[1] - next_to[1]
    if latest[1] > PRIOR.longest_turning_s or by <= max(NAMING.later_than_all_s, latest[2] + next_to[2]):
        return ""
    joint = f"joint {latest[0] + 1}"
    return f" By {rounded(1e3 * by)} ms {joint} is later than any other: see whether its torque is recorded later."


def _with_turns_free(selected: SelectedCauses) -> Hypothesis:
    """The best hypothesis; where columns formed at the moment that friction turns need nothing more, with them free."""
    best, families = selected.best, selected.space.families
    free = tuple(
        size or (family.sizes - 1 if family.name in OF_REVERSALS else 0)
        for family, size in zip(families, best.background, strict=True)
    )
    return best if free == best.background else at_noise(selected.problem, best.chosen, free, best.noise)


def _stands(selected: SelectedCauses, joint: int) -> bool:
    """Whether a joint ever stays where it is: then a motor builds up what breaks it loose before it moves again."""
    return bool(selected.rows.still[:, joint].any() or selected.rows.pauses[joint].held)
