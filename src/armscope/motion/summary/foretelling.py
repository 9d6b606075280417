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
    missed = misfits(selected, [(other, best.chosen) for other in others])
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
    """Nats by which effects, with a hypothesis' background and noise and fitted to the other blocks, miss each block.

    That is minus the log density of a block by all that the others leave open, which is evidence of the whole less
    that of the others. Only what the others are sure of can be wrong there: a slow run leaves open what a fast one has,
    and by its best guess alone all that is free would be blamed for that.

    Args:
        selected: with B blocks.
        asked: A hypotheses, and the effects that are fitted.

    Returns:
        (A, B), beside those of any other hypothesis of the same noise.
    """
    nats = np.zeros((len(asked), len(selected.blocks)))
    for held in range(len(selected.blocks)):
        rest = total([other for number, other in enumerate(selected.blocks) if number != held])
        trained = selected.problem.with_equations(rest)
        for row, (best, effects) in zip(nats, asked, strict=True):
            of_rest, of_all = (
                at_noise(problem, effects, best.background, best.noise).log_evidence
                for problem in (trained, selected.problem)
            )
            row[held] = of_rest - of_all
    return nats
