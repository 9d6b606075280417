"""What is left of motion that took no part when the numbers that were told are entered, one cause after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array
from armscope.inference.evidence import evaluate
from armscope.motion.fitting.gains import gain_of
from armscope.motion.fitting.selected import SelectedCauses, coefficients_of
from armscope.motion.library.layout import CAUSES_OF_OWN, OWN
from armscope.motion.summary.holding_out import Fold, missed_torque, moving_torque
from armscope.motion.verdict import relative


@dataclass(frozen=True)
class Entered:
    """An error on held-out motion once some numbers are entered: of all torque, and of each joint's own."""

    whole: float
    by_joint: tuple[float, ...]


def as_entered(selected: SelectedCauses, parts: Sequence[Fold], order: Sequence[int]) -> tuple[Entered, ...]:
    """Errors when the whole model's numbers are entered into a simulator one after the other, nothing fitted again.

    No simulator knows how friction changes sides here, nor takes friction below zero: both are left out.

    Args:
        selected: the selection.
        parts: what is held out; the numbers are fitted to the rest.
        order: candidates in the order in which they are entered.

    Returns:
        With friction and rotors; then with masses and gains as fitted; then with each cause more.
    """
    layout, best = selected.rows.layout, selected.best
    own = layout.own.reshape(-1, OWN)[:, 1:CAUSES_OF_OWN]
    causes = [layout.columns[number] for number in order]
    friction = np.setdiff1d(own, np.concatenate([np.empty(0, dtype=np.intp), *causes]))
    masses = np.setdiff1d([*layout.masses, *layout.gains], np.concatenate([np.empty(0, dtype=np.intp), *causes]))
    states = [friction, *(np.concatenate([friction, masses, *causes[:n]]) for n in range(len(causes) + 1))]
    missed: list[list[Array]] = [[] for _ in states]
    torques: list[Array] = []
    for fold in parts:
        fitted = coefficients_of(fold.problem, evaluate(fold.problem, best.chosen, best.background, fold.found.noise))
        stated = np.nan_to_num(layout.arm.stated_background[:, 1:3])
        fitted[own[:, :2]] = np.maximum(fitted[own[:, :2]], -stated)
        torque = fold.rows.torque[fold.which]
        torques.append(moving_torque(fold.rows, fold.which, torque))
        for columns, found in zip(states, missed, strict=True):
            entered = np.zeros_like(fitted)
            entered[columns] = fitted[columns]
            rows = replace(fold.rows, gain=gain_of(layout, entered))
            said = rows.nominal[fold.which] + rows.modelled(entered, fold.which)
            found.append(missed_torque(fold.rows, fold.which, torque - said))
    torque = np.concatenate(torques)
    return tuple(_entered(np.concatenate(found), torque) for found in missed)


def _entered(left: Array, torque: Array) -> Entered:
    return Entered(relative(left, torque), tuple(map(relative, left.T, torque.T)))
