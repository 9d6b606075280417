"""Whether there is more of a cause since it changed, or less: by what it was before and is, as far as that is known.

How far a zero moved is known far better than where it stands: other errors of the arm look like a part of it. Those
decide by chance, too, whether less is left of the recording when the change is taken back, so that this says nothing of
what the cause did: a crash may make up for a part of them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import fdtri, nctdtrinc, stdtrit

from armscope.comparison.at_the_tool import beyond_frames
from armscope.comparison.constants import COMPARING, SHARED
from armscope.comparison.penalised import HeldColumns
from armscope.comparison.result import Change, Seen, Sense
from armscope.comparison.scoring import Possible, numbers_behind
from armscope.comparison.shared_model import SharedModel
from armscope.comparison.valued import Valued
from armscope.core.types import Array
from armscope.physics.effect import Placed
from armscope.physics.geometric import JOINT_OFFSET
from armscope.physics.registry import effect_named
from armscope.verdict.effects import INTERVAL


def own_values(
    model: SharedModel, number: int, beside: Sequence[Possible], count: int, prior_mm: float = SHARED.prior_mm
) -> tuple[Array, Array, float]:
    """An effect with a value of its own in every recording.

    Args:
        model: what recordings share.
        number: the effect's, of q terms.
        beside: changes of other effects.
        count: of the recordings.
        prior_mm: how large other effects that are shared are at the tool.

    Returns:
        Values (count q), SI units, their covariance, and how many numbers are free.
    """
    at = model.at(number)
    others = model.scale > 0
    others[at] = False
    base = model.base(beside, others, model.own.other_than(model.effects[:, at]), prior_mm)
    own = np.hstack([model.columns_of(number, (k,)) for k in range(count)])
    # what one recording alone does not tell stays at the prior
    scale = np.tile(model.scale[at], count)
    scale = np.where(scale > 0, scale, 1.0)
    held = np.concatenate([base.penalty, model.noise / (SHARED.widened * scale) ** 2])
    whole = HeldColumns(np.hstack([base.columns, own]), held, base.drawn)
    inverse = np.linalg.inv(whole.gram + np.diag(held))
    values = (inverse @ (whole.columns.T @ model.residual))[-own.shape[1] :]
    variance, free = model.left(whole)
    return values, np.asarray(model.dispersion * variance * inverse[-own.shape[1] :, -own.shape[1] :]), free


NOT_NEGATIVE = ("backlash",)  # Beside what gives way: a gap that is less than none is none


def cannot_be_negative(effect: str, numbers: int) -> bool:
    """Whether a cause is told by one number that is not below zero; mass moments carry their sign."""
    known = effect_named(effect)
    return numbers == 1 and (effect in NOT_NEGATIVE or (known is not None and known.nonnegative))


def more_or_less(placed: Placed, numbers: Sequence[Valued], sigmas: float) -> Sense:
    """Whether there is more of a cause where it changed, or less; "" where that is not known.

    Args:
        placed: the cause.
        numbers: how it changed.
        sigmas: by how many standard errors there is more of it, of a cause that may have either sign.

    Returns:
        By the sign of the change where that says it: who cannot be below zero has more than nothing before and after.
    """
    if cannot_be_negative(placed.name, len(numbers)):
        low, high = numbers[0].interval_95
        return "more" if low > 0 else "less" if high < 0 else ""
    return "more" if sigmas > INTERVAL else "less" if sigmas < -INTERVAL else ""


def more_sigmas(
    model: SharedModel, found: Possible, beside: Sequence[Possible], there: Array, elsewhere: Array
) -> float:
    """By how many standard errors there is more of a cause where it changed than elsewhere; below zero: less.

    With d the change and m the middle of before and after, the squares of what both do at the tool, beyond base and
    tool, differ by 2 d'Gm. The other errors that recordings share are taken to be as large as what the best of the
    recordings is left with: a cause that came or went is in one of them only.

    Args:
        model: what recordings share.
        found: the change.
        beside: changes of other effects.
        there: (sets,) the share of each recording in what it is with the change, and
        elsewhere: without it.

    Returns:
        d'Gm in its own standard errors.
    """
    best = np.sqrt(3) * min(model.left_mm(())[0])
    count, q = len(there), len(found.placed.terms)
    values, covariance, _ = own_values(model, found.number, beside, count, min(SHARED.prior_mm, float(best)))
    change, middle = (np.kron(part, np.eye(q)) for part in (there - elsewhere, (there + elsewhere) / 2))
    columns = beyond_frames(model, model.columns_of(found.number, tuple(range(count))))
    along = columns.T @ (columns @ (change @ values)) @ middle
    return float(along @ values / np.sqrt(along @ covariance @ along))


def stands(model: SharedModel, found: Possible, change: Change, taken: Sequence[Possible], tried: int) -> bool:
    """Whether a change's own numbers say that it is one, and one that this cause can make.

    Args:
        model: what recordings share.
        found: the change.
        change: as it would be told.
        taken: all changes, this one included.
        tried: how many there were to choose from.

    Returns:
        False where each number may be as it was, where one is below zero that cannot be, or where all of it moves the
        tool by less than the noise lets anyone see.
    """
    surely = any(low > 0 or high < 0 for low, high in (number.interval_95 for number in change.parameters))
    return surely and not _impossible(change) and change.rms_mm >= least_seen_mm(model, found, taken, tried)


def _impossible(change: Change) -> bool:
    """Whether what cannot be below zero is."""
    if not cannot_be_negative(change.effect, len(change.parameters)):
        return False
    (number,) = change.parameters
    return any(
        value < -COMPARING.surely_negative * stderr for value, stderr in zip(number.values, number.stderrs, strict=True)
    )


def least_seen_mm(model: SharedModel, found: Possible, taken: Sequence[Possible], tried: int) -> float:
    """What a change must move the tool by to be told from noise if nothing else could look like it.

    Args:
        model: what recordings share.
        found: the change, of q numbers.
        taken: all changes: what they do is no noise.
        tried: how many there were to choose from.

    Returns:
        RMS of the distance, mm: of it chance makes as much, on these rows, as often as the level says.
    """
    points = [np.sum(model.weight[rows] ** 2) / 3 for rows in (found.there, ~found.there)]
    q, variance = len(found.placed.terms), model.variance(taken)
    least = fdtri(q, len(model.weight) - q, 1 - COMPARING.level / tried)
    return float(np.sqrt(q * least * model.dispersion * variance * sum(1 / each for each in points)))


def seen(model: SharedModel, possible: Sequence[Possible], found: Sequence[Possible]) -> tuple[Seen, ...]:
    """How far the zero of each joint must move to be seen, whichever of the recordings it moves in.

    Args:
        model: what recordings share.
        possible: all changes that are tried.
        found: what changed, and is no noise.

    Returns:
        One for each joint.
    """
    zeros = [each for each in possible if each.placed.effect is JOINT_OFFSET]
    if not zeros:
        return ()
    least: dict[str, float] = {}
    sizes = _smallest(model, zeros, COMPARING.level / len(possible), found)
    for each, size in zip(zeros, sizes, strict=True):
        least[each.placed.location] = max(float(size), least.get(each.placed.location, 0.0))
    return tuple(Seen(location, size) for location, size in least.items())


def _smallest(model: SharedModel, zeros: Sequence[Possible], level: float, found: Sequence[Possible]) -> Array:
    """(n,) rad, of zeros each alone beside all that is shared; infinite where the rows tell nothing of it."""
    base = model.base(())
    variance, free = model.left(model.base(found))
    columns = np.column_stack([model.columns(each)[:, 0] for each in zeros])
    square = np.array([model.size(each)[0] ** 2 for each in zeros])
    beyond = base.beyond(columns)
    information = np.sum(columns * beyond, axis=0)
    usual = np.array([each.plausible[0] for each in zeros])
    unseen = (square <= variance / usual**2) | (base.fixed.information(columns).diagonal() <= SHARED.unseen * square)
    # F of one number is the square of t, of which a change makes a noncentral one
    known = numbers_behind(base, beyond, free, model.own) - 1
    least = nctdtrinc(known, 1 - COMPARING.power, stdtrit(known, 1 - level / 2))
    return np.where(unseen, np.inf, least * np.sqrt(model.dispersion * variance / np.where(unseen, 1, information)))
