"""Errors on motion that was fitted and that was held out, with one cause after the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.problem import SelectedEffect
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.space import of_joints
from armscope.motion.summary.holding_out import Fold, missed_torque, modelled, moving_torque
from armscope.motion.verdict import Step, relative


def waterfall(
    selected: SelectedCauses, parts: Sequence[Fold], order: Sequence[int], labels: Sequence[str]
) -> tuple[Step, ...]:
    """Errors with one cause after the other, each fitted again.

    Args:
        selected: the selection.
        parts: what is held out.
        order: candidates in the order in which they come in.
        labels: their names.

    Returns:
        Nothing but friction; masses held near the stated ones; then each cause.
    """
    best = selected.best
    by_candidate = {effect.candidate: effect for effect in best.chosen}
    states: list[tuple[str, tuple[int, ...], bool]]
    states = [("friction and rotors", (), False), (_held_near(selected), (), True)]
    states += [(label, tuple(order[: n + 1]), True) for n, label in enumerate(labels)]
    steps, whole = [], Fold(selected.rows, np.arange(len(selected.rows)), selected.problem, best)
    for label, members, masses in states:
        background = best.background if masses else of_joints(selected.space, best.background)
        chosen = tuple(by_candidate[c] for c in members)
        fitted = relative(*_errors(whole, chosen, background))
        steps.append(Step(label, fitted, _error_with(parts, chosen, background)))
    return tuple(steps)


def error_with(parts: Sequence[Fold], hypothesis: Hypothesis) -> float:
    """Error on what is held out, with a hypothesis' causes and background fitted to the rest."""
    return _error_with(parts, hypothesis.chosen, hypothesis.background)


def _held_near(selected: SelectedCauses) -> str:
    """What takes part without a name, in words."""
    layout, used = selected.rows.layout, selected.best.columns
    gains = bool(np.isin(layout.gains, used).any())
    masses = bool(np.isin(layout.masses, used).any()) or not gains
    return f"{' and '.join(['masses'] * masses + [layout.of_gains] * gains)} near the stated"


def _error_with(parts: Sequence[Fold], chosen: tuple[SelectedEffect, ...], background: BackgroundSizes) -> float:
    held = [_errors(fold, chosen, background) for fold in parts]
    return relative(np.concatenate([error for error, _ in held]), np.concatenate([torque for _, torque in held]))


def _errors(fold: Fold, chosen: tuple[SelectedEffect, ...], background: BackgroundSizes) -> tuple[Array, Array]:
    """(residuals, torque) of the fold's rows with causes fitted on its sums."""
    fitted = evaluate(fold.problem, chosen, background, fold.found.noise)
    torque = fold.rows.torque[fold.which]
    left = torque - fold.rows.nominal[fold.which] - modelled(fold, fitted)
    return missed_torque(fold.rows, fold.which, left), moving_torque(fold.rows, fold.which, torque)
