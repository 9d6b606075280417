"""Does it carry over? What was learned on one run, applied unchanged to another: only frames are placed anew."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from armscope.core.averages import rms_distance
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.fitting.constants import STEPS
from armscope.fitting.design_matrix import point_columns
from armscope.fitting.gauss_newton import NonlinearProblem, Quadratic, gauss_newton
from armscope.fitting.linearisation import linearised, point_residuals
from armscope.fitting.registration import fit_frames
from armscope.measurement import robust
from armscope.measurement.channel import retracted, supported
from armscope.physics.drivers import follows
from armscope.physics.effect import Part, Placed, Term
from armscope.physics.frames import free_frames
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings

Frame = Literal["base", "tool"]

BACKGROUND = "background"
"""Stands for the small errors that were allowed for everywhere and are not named."""


@dataclass(frozen=True, eq=False)
class Transferred:
    """How well a model holds on rows that took no part in its fit; RMS of the 3D distance over all rows, mm."""

    # the effects that were applied, in words, and "... background" for small errors of a family
    applied: tuple[str, ...]
    left_mm: float  # with them
    model: FittedModel  # the model with the frames that it has here


def transfer(
    model: FittedModel,
    recordings: Recordings,
    effects: Collection[str] | None = None,
    refitted: Iterable[Frame] = ("base", "tool"),
) -> Transferred:
    """Apply a fitted model's effects unchanged to other recordings of the arm.

    Args:
        model: learned on other rows.
        recordings: the rows to test on; a compliance learned with recorded torques needs them here, too.
        effects: which to apply: families ("elastic": its named effects and its background), effects
            ("joint_compliance"), effects at a place ("unknown at joint 2"), "background" (of all families) or
            "elastic background"; None applies all that belong to the arm: not drifts, shifts and what follows time or
            temperature, which belong to their run. Of none, only the frames stay.
        refitted: frames placed anew on these rows (base per run, tool per target); others stay as the model has them,
            and a run that it does not know stands on its last base. On a base placed anew, the small give that was
            allowed for in the last one is left out.

    Returns:
        The model on the other rows, and what it leaves of them.

    Raises:
        InputError: ``effects`` names nothing that the model has, or a kept tool is not known for a target.
    """
    frames = tuple(frame for frame in ("base", "tool") if frame in set(refitted))
    parts, background = _applied(model, effects)
    if "base" in frames:  # on another base the pedestal's small give is another; a named one is taken for the arm's
        background = tuple(part for part in background if part.placed.location != "base")
    if "tool" not in frames:
        _check_targets(model, recordings)
    own = _placed_anew(replace(model, parts=parts, background=background), recordings, frames)
    return Transferred(_words(parts, background), rms_distance(point_residuals(own, recordings)), own)


def belongs_to_the_arm(placed: Placed) -> bool:
    """Whether an effect may be expected on another run, too."""
    curve_of_a_run = placed.parametrisation == "curve" and any(
        follows("run", product.driver) for term in placed.terms for product in term.products
    )
    # since some moment: whoever compares recordings would take what changed between them for what all of them share
    return placed.family not in ("drift", "frame") and not curve_of_a_run and not placed.effect.jumps


def _applied(model: FittedModel, wanted: Collection[str] | None) -> tuple[tuple[Part, ...], tuple[Part, ...]]:
    """The effects and the parts of the background that are applied."""
    if wanted is None:
        of_the_arm = (
            tuple(part for part in some if belongs_to_the_arm(part.placed)) for some in (model.parts, model.background)
        )
        parts, background = of_the_arm
        return parts, background
    known = {name for part in model.parts for name in _names(part.placed)} | {BACKGROUND}
    known |= {name for part in model.background for name in _names_of_background(part.placed)}
    for name in wanted:
        if name not in known:
            allowed = f"one of {', '.join(sorted(known))}"
            raise InputError("effects", "", name, allowed, "The model holds nothing of that name.")
    return (
        tuple(part for part in model.parts if _names(part.placed) & set(wanted)),
        tuple(part for part in model.background if _names_of_background(part.placed) & set(wanted)),
    )


def _names(placed: Placed) -> set[str]:
    return {placed.family, placed.name, f"{placed.name} at {placed.location}", str(placed)}


def _names_of_background(placed: Placed) -> set[str]:
    return {placed.family, BACKGROUND, f"{placed.family} {BACKGROUND}"}


def _words(parts: Iterable[Part], background: Iterable[Part]) -> tuple[str, ...]:
    families = sorted({f"{part.placed.family} {BACKGROUND}" for part in background})
    return (*(str(part.placed) for part in parts), *families)


def _check_targets(model: FittedModel, recordings: Recordings) -> None:
    known = {str(part.placed.terms[0].products[0].driver.arguments[0]) for part in model.tools}
    for target in np.unique(recordings.target):
        if str(target) not in known:
            raise InputError(
                recordings.source,
                "target",
                str(target),
                f"the model knows {', '.join(sorted(known))}",
                "Refit the tool, or give the target the name of the one that it is.",
            )


def _placed_anew(model: FittedModel, recordings: Recordings, frames: Collection[Frame]) -> FittedModel:
    """The model with some frames fitted to the rows, its effects unchanged (Gauss-Newton, Huber weights)."""
    if not frames:
        return model
    start = fit_frames(model.arm, recordings)
    tools = start.tools if "tool" in frames else model.tools
    bases = start.bases if "base" in frames else {str(r): model.base_of(str(r)) for r in np.unique(recordings.run)}
    free = [p for p in free_frames(recordings, False) if p.location in frames]
    problem = _Frames(recordings, [term for placed in free for term in placed.terms])
    return gauss_newton(problem, replace(model, bases=dict(bases), tools=tools), STEPS.transfer).state


class _Frames(NonlinearProblem[FittedModel, Array]):
    """Some of the free frames' terms beside a model that stays: points, Huber weights."""

    least_damping = 1e-9
    """A held wrist leaves the tool's offset to the base: it then stays at its start."""

    def __init__(self, recordings: Recordings, terms: Sequence[Term]) -> None:
        self.recordings, self.terms = recordings, terms

    def residual(self, state: FittedModel) -> Array:
        return point_residuals(state, self.recordings)

    def quadratic(self, state: FittedModel, residual: Array) -> Quadratic:
        weight = robust.huber_weights(residual, np.ones(len(residual)), 0.0)
        G, b = np.zeros((len(self.terms), len(self.terms))), np.zeros(len(self.terms))
        for rows, posture in linearised(self.recordings).chunks(state):
            X = point_columns(posture, self.terms)
            weighted = X * np.repeat(weight[rows], 3)[:, None]
            G += weighted.T @ X
            b += weighted.T @ residual[rows].reshape(-1)
        return Quadratic(G, b, np.zeros(len(b)))

    def moved(self, state: FittedModel, step: Array) -> FittedModel:
        return retracted(supported(self.recordings), state, dict(zip(self.terms, step, strict=True)))

    def settled(self, before: Array, after: Array) -> bool:
        return float(np.abs(after - before).max()) < STEPS.negligible_mm
