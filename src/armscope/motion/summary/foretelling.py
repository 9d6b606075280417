"""What causes and backgrounds foretell of blocks of motion that took no part in their fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.inference.evidence import Hypothesis, at_noise
from armscope.inference.normal_equations import total
from armscope.inference.problem import SelectedEffect
from armscope.motion.fitting.consistency import Weighed
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain, chosen
from armscope.motion.fitting.sides_by_all import fitted_beside
from armscope.motion.fitting.space import OF_MASSES, OF_REVERSALS, without_backgrounds
from armscope.motion.summary.constants import HELD_OUT


def with_backgrounds_that_foretell(selected: SelectedCauses) -> tuple[SelectedCauses, frozenset[str]]:
    """The selection without the backgrounds that foretell other motion worse than none would.

    A share of all masses, or how friction changes sides, fits what is left at the ends of moves, too. On another path
    it does harm, and beside it no name foretells anything.

    Args:
        selected: what the evidence asks for.

    Returns:
        A selection, and the families that it goes without.
    """
    best, families = selected.best, [family.name for family in selected.space.families]
    taken = {family for family, size in zip(families, best.background, strict=True) if size}
    choices = [held & taken for held in (frozenset[str](), OF_MASSES, OF_REVERSALS, OF_MASSES | OF_REVERSALS)]
    others = [
        replace(best, background=tuple(0 if f in held else n for f, n in zip(families, best.background, strict=True)))
        for held in choices
    ]
    missed = surprises(selected, [(other, best.chosen) for other in others])
    worse = np.median(missed[0] - missed, axis=1)
    most = int(np.argmax(worse))
    if worse[most] <= HELD_OUT.harm * selected.problem.n / (2 * len(selected.blocks)):
        return selected, frozenset()
    space = without_backgrounds(selected.space, choices[most])
    before = others[most], best.chosen
    again = chosen(selected.rows, selected.weights, selected.block, space, before, selected)
    return at_own_gain(again), choices[most]


def held_out_gains(selected: Weighed) -> dict[int, float]:
    """Nats by which each cause betters the middle one of the blocks that took no part in its fit.

    Not their sum: where one run has something of its own, a payload say, what that leaves there drowns all else.

    Args:
        selected: a selection.

    Returns:
        By number of each chosen cause.
    """
    best = selected.best
    without = [tuple(effect for effect in best.chosen if effect.candidate != number) for number in best.candidates]
    whole, *lesser = misfits(selected, [(best, effects) for effects in (best.chosen, *without)])
    return {n: float(np.median(each - whole)) for n, each in zip(best.candidates, lesser, strict=True)}


def misfits(selected: Weighed, asked: Sequence[tuple[Hypothesis, tuple[SelectedEffect, ...]]]) -> Array:
    """Nats that effects, with a hypothesis' background and noise and fitted to the other blocks, leave of each block.

    Beside those of nothing at all; how friction changes sides is what all blocks say, see `fitted_beside`.

    Args:
        selected: with B blocks.
        asked: A hypotheses, and the effects that are fitted.

    Returns:
        (A, B).
    """
    nats = np.zeros((len(asked), len(selected.blocks)))
    for held, block in enumerate(selected.blocks):
        rest = total([other for number, other in enumerate(selected.blocks) if number != held])
        trained, apart = selected.problem.with_equations(rest), block.scaled(selected.problem.scale)
        for row, (best, effects) in zip(nats, asked, strict=True):
            fitted = fitted_beside(selected.problem, trained, effects, best.background, best.noise)
            at = fitted.columns
            squares = fitted.mean @ apart.G[np.ix_(at, at)] @ fitted.mean - 2 * apart.b[at] @ fitted.mean
            row[held] = float(squares) / (2 * best.noise**2)
    return nats


def surprises(selected: Weighed, asked: Sequence[tuple[Hypothesis, tuple[SelectedEffect, ...]]]) -> Array:
    """Nats by which blocks surprise effects, with a hypothesis' background and noise, that know the other blocks.

    That is minus the log density of a block by all that the others leave open: their evidence less that of all. A slow
    run leaves open what a fast one has; by its best guess alone, as in `misfits`, what is free in every joint would be
    blamed for that.

    Args:
        selected: with B blocks.
        asked: A hypotheses of one noise, and the effects that are fitted.

    Returns:
        (A, B), each block beside what is the same of all hypotheses.
    """
    nats = np.zeros((len(asked), len(selected.blocks)))
    for row, (best, effects) in zip(nats, asked, strict=True):
        whole = at_noise(selected.problem, effects, best.background, best.noise).log_evidence
        for held in range(len(row)):
            rest = total([other for number, other in enumerate(selected.blocks) if number != held])
            trained = selected.problem.with_equations(rest)
            row[held] = at_noise(trained, effects, best.background, best.noise).log_evidence - whole
    return nats
