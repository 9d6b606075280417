"""How far numbers may be off beyond one model's noise: paths that disagree, rival models, a level of gains unknown.

One model's standard error asks for all of its assumptions. Three of them are looked at here. A number that different
paths tell differently is widened by how much more they differ than noise lets them (the Birge ratio: Birge 1932), drawn
toward one where few paths tell. And a number that is another one in models that the evidence hardly tells from the best
holds these, too, each by its weight (model averaging: Hoeting et al. 1999). Where currents were recorded, a factor of
all gains is one of all masses and friction: no motion tells it, and masses that are held near the stated ones, each by
itself, would seem to.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr

from armscope.core.types import Array
from armscope.inference.evidence import Hypothesis
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.search import Search
from armscope.motion.constants import PRIOR, TELLING
from armscope.motion.fitting.linkages import mount_unsure
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.space import OF_MASSES
from armscope.motion.fitting.torque_delay import lag_step
from armscope.motion.library import catalogue
from armscope.motion.library.layout import CAUSES_OF_OWN, OWN, TorqueLayout
from armscope.motion.library.linkage import BETWEEN_LINKS
from armscope.motion.library.masses import has_its_own_inertia
from armscope.motion.summary.constants import INTERVALS
from armscope.motion.summary.unnamed_masses import SHARES, by_own_share
from armscope.verdict.effects import INTERVAL
from armscope.verdict.schema import Notice

Rivals = Mapping[int, Sequence[Hypothesis]]


@dataclass(frozen=True, eq=False)
class Sureness:
    """How far a selection can be trusted."""

    search: Search  # on the selection's problem
    rivals: Rivals  # by candidate: hypotheses with another cause in its place
    factor: Array  # (p,) by which the standard error of each column is larger than the best hypothesis says


def sureness(selected: SelectedCauses) -> Sureness:
    """What else would do, and how much wider intervals are for it."""
    search, rivals = Search.on(selected.problem), {}
    for number in selected.best.candidates:
        held = search.in_background(selected.best, number)  # its rivals explain what it does without it, there, too
        alone = search.holding(search.candidate(number).held) if held else search
        rivals[number] = [
            each
            for each in alone.additions(alone.without(selected.best, [number]), TELLING.looked_at, [number])
            if _at_its_joints(selected, number, each.chosen[-1].candidate)
        ]
    factor = _widened(selected, search, rivals)
    level = level_of_gains(selected.rows.layout)
    if level:
        columns = selected.best.columns
        error = factor[columns] * np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
        alike = level * np.abs(_whole(selected)[columns])
        factor[columns] *= np.hypot(1.0, alike / error)
    return Sureness(search, rivals, factor)


def _at_its_joints(selected: SelectedCauses, number: int, other: int) -> bool:
    """Whether a cause and another one are torque of a joint in common: else neither can stand for the other."""
    placed = selected.rows.layout.placed
    return bool(set(placed[number].joints) & set(placed[other].joints))


def level_of_gains(layout: TorqueLayout) -> float:
    """Share by which the gains of all drives may be off alike; 0 where torques were recorded or gains are sure."""
    if not layout.with_gains:
        return 0.0
    stated = layout.arm.gain_uncertainty
    return float(np.sqrt(np.mean(np.where(np.isnan(stated), PRIOR.level_of_gains, stated) ** 2)))


def level_told(layout: TorqueLayout) -> list[Notice]:
    """What an unsure level of gains means, where it is unsure."""
    level = level_of_gains(layout)
    if not level:
        return []
    text = (
        f"The drives' gains are taken to be known to {100 * level:.0f} %, all alike: so is every mass, load and "
        "friction, as intervals say. Weigh a load, or state `gain_uncertainty` of the drives in robot.yaml."
    )
    return [Notice("gains", text)]


def _whole(selected: SelectedCauses) -> Array:
    """(p,) what each column's number is with its stated part, SI, where it grows with the gain; else 0."""
    layout, whole = selected.rows.layout, np.zeros(selected.rows.layout.width)
    stated = np.column_stack(
        [np.nan_to_num(layout.arm.stated_background), np.zeros((layout.arm.n_motors, OWN - CAUSES_OF_OWN))]
    )
    whole[layout.own] = selected.coefficients[layout.own] + stated.ravel()
    for number in selected.best.candidates:
        cause, columns = layout.placed[number], layout.columns[number]
        if cause.of_background is not None:
            continue
        grows = [any(word in unit for word in ("N", "kg")) or name == "times" for name, unit in cause.parameters]
        whole[columns] = selected.coefficients[columns] * grows
        if cause.inertial is not None:
            of_load = cause.cause is catalogue.PAYLOAD
            own = selected.rows.stated_payload(cause.runs) * layout.arm.point_load() if of_load else layout.arm.inertial
            whole[columns] += np.linalg.lstsq(cause.inertial, own, rcond=None)[0] * (cause.cause is not catalogue.BODY)
    return whole


def covariance_of(selected: SelectedCauses, number: int, factor: Array) -> Array:
    """Covariance of a chosen cause's fitted numbers.

    Args:
        selected: the selection.
        number: of the cause.
        factor: (p,) on the standard error of every column.

    Returns:
        (c, c), SI.
    """
    columns = selected.rows.layout.columns[number]
    by = factor[columns] / selected.problem.scale[columns]
    covariance = np.asarray(selected.best.covariance(columns) * np.outer(by, by))
    if selected.rows.layout.placed[number].cause is catalogue.DELAY:  # told where friction has settled alone
        covariance[0, 0] = (factor[columns[0]] * lag_step(selected, number)[1]) ** 2
    return covariance


def errors_of(selected: SelectedCauses, number: int, factor: Array) -> tuple[Array, Array]:
    """Standard errors of a chosen cause's fitted numbers and of its scanned ones, each with all others free.

    Args:
        selected: the selection.
        number: of the cause.
        factor: (p,) on the standard error of every column.

    Returns:
        (c,) and (s,), SI; NaN of what was scanned, but for the mount of a spring.
    """
    placed, columns = selected.rows.layout.placed[number], selected.rows.layout.columns[number]
    variance, of_scanned = np.diag(covariance_of(selected, number, factor)), np.full(len(placed.scanned), np.nan)
    if placed.variant == BETWEEN_LINKS:
        by_mount, of_mount = mount_unsure(selected, number)
        by = factor[columns].max() ** 2
        variance, of_scanned = variance + by * by_mount, np.sqrt(by * of_mount)
    return np.sqrt(variance), of_scanned


def _widened(selected: SelectedCauses, search: Search, rivals: Rivals) -> Array:
    """By which the standard error of each column that takes part is to be multiplied.

    Args:
        selected: the selection.
        search: on its problem.
        rivals: by candidate, see `Sureness`.

    Returns:
        (p,), at least 1; 1 for what takes no part.
    """
    best = selected.best
    factor = np.ones(len(selected.problem.scale))
    own = np.sqrt(disagreeing(best, selected.problem.scale, selected.blocks))
    among, of_links = [best, *_near(selected, search, rivals)], _otherwise_off(selected)
    error = own * np.sqrt(best.variances(best.columns))
    for place, column in enumerate(best.columns):
        told = [each for each in among if each is best or _tells(selected, each, int(column))]
        told += of_links.get(int(column), [])
        at = np.array([each.at(np.array([column]))[0] for each in told])
        mean = np.array([each.mean[n] for each, n in zip(told, at, strict=True)])
        spread = own[place] * np.sqrt([each.variances(np.array([column]))[0] for each in told])
        weight = np.exp([min(each.log_posterior - best.log_posterior, 0.0) for each in told])
        reach = _half_width(mean - best.mean[place], spread, weight / weight.sum()) if len(told) > 1 else 0.0
        factor[column] = own[place] * max(reach / (INTERVAL * error[place]), 1.0)
    return factor


def disagreeing(best: Hypothesis, scale: Array, blocks: Sequence[NormalEquations]) -> Array:
    """Factor on the variance of each number of a hypothesis, by what each block makes of it.

    A block pulls the numbers by M X'r of its own rows, M the inverse of the whole information; squares of these pulls,
    to what noise lets them be, are the Birge ratio. What is known by its prior stays as it is.

    Args:
        best: the hypothesis.
        scale: (p,) by which its columns are divided.
        blocks: sums of parts of the rows, unscaled.

    Returns:
        (columns,), at least 1.
    """
    at = best.columns
    M = best.inverse.T @ best.inverse
    pulls, allowed, told = [], [], np.zeros(len(at))
    for block in blocks:
        own = block.scaled(scale)
        G = own.G[np.ix_(at, at)]
        A = M @ G
        whole = np.einsum("ij,ij->i", A, M)
        pulls.append((M @ (own.b[at] - G @ best.mean)) ** 2)
        allowed.append(best.noise**2 * np.maximum(whole - np.einsum("ij,ij->i", A @ A, M), 1e-12 * np.diag(M)))
        told += whole
    expected = np.sum(allowed, axis=0)
    freedom = np.clip(expected**2 / np.sum(np.square(allowed), axis=0) - 1, 0.0, None)
    ratio = np.sum(pulls, axis=0) / expected
    drawn = (INTERVALS.agreeing + freedom * ratio) / (INTERVALS.agreeing + freedom)
    of_data = np.clip(told / np.diag(M), 0.0, 1.0)
    return np.asarray(1 + (np.maximum(drawn, 1.0) - 1) * of_data)


def _otherwise_off(selected: SelectedCauses) -> dict[int, list[Hypothesis]]:
    """By column of each name of masses: the selection by every share of which its links may be off in other ways.

    Where the centre of one link lies elsewhere is one number among the ten of it, and how far any number of that link
    may be off is told by the nine others: shares within reach of the evidence count alike. A load with an inertia of
    its own is all that its link can be off by, and no evidence tells them apart: what a drawing leaves open is open.
    """
    layout, best = selected.rows.layout, selected.best
    least = best.log_posterior - INTERVALS.reach_nats
    found: dict[int, list[Hypothesis]] = {}
    for number in best.candidates:
        placed = layout.placed[number]
        if placed.inertial is None or placed.runs:
            continue
        as_known = has_its_own_inertia(placed)
        within = [
            replace(each, log_posterior=best.log_posterior)
            for share, each in zip(SHARES, by_own_share(selected, number), strict=True)
            if (share <= INTERVALS.link_known if as_known else each.log_posterior > least)
        ]
        found |= {int(column): within for column in layout.columns[number]}
    return found


def _near(selected: SelectedCauses, search: Search, rivals: Rivals) -> Iterable[Hypothesis]:
    """Hypotheses within reach of the evidence: one cause exchanged or left out, masses held closer or less so."""
    best = selected.best
    families = selected.space.families
    others = [
        (*best.background[:n], best.background[n] + step, *best.background[n + 1 :])
        for n, family in enumerate(families)
        for step in (-1, 1)
        if family.name in OF_MASSES and 0 <= best.background[n] + step < family.sizes
    ]
    found = [each for number in rivals for each in rivals[number]]
    found += [search.evaluated(best.chosen, best, background) for background in others]
    for number in best.candidates:
        kept = search.kept(best, [number])
        found += [search.evaluated(kept, best, background) for background in (best.background, *others)]
    return [each for each in found if each.log_posterior > best.log_posterior - INTERVALS.reach_nats]


def _tells(selected: SelectedCauses, other: Hypothesis, column: int) -> bool:
    """Whether another hypothesis has the number, and not a free curve at the joint that holds a part of it."""
    if column not in other.columns:
        return False
    layout = selected.rows.layout
    entered = [layout.placed[n] for n in other.candidates - selected.best.candidates]
    joint = column // OWN if column < len(layout.own) else -1
    return not any(each.cause is catalogue.CURVE and joint in each.joints for each in entered)


def _half_width(mean: Array, spread: Array, weight: Array) -> float:
    """Half of the interval about zero that holds 95 % of a mixture of normal distributions on either side's measure."""
    low, high = 0.0, float(np.max(np.abs(mean) + 4 * spread))
    for _ in range(40):
        middle = (low + high) / 2
        inside = weight @ (ndtr((middle - mean) / spread) - ndtr((-middle - mean) / spread))
        low, high = (middle, high) if inside < INTERVALS.held else (low, middle)
    return high
