"""Names that the evidence asks for and that still can't stand: impossible sizes, names that cancel, no other path.

Evidence compares what the library has. Where the truth is not in it, the best of its names fit by numbers that no arm
has, by taking each other's torque back, on one path only, or only where a joint turns back; each of these shows that
the name is wrong.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.evidence import Hypothesis
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.consistency import agreement
from armscope.motion.fitting.constants import CONSISTENCY
from armscope.motion.fitting.near_reversals import told_by_reversals_alone
from armscope.motion.fitting.preferred import named_first, plain_first
from armscope.motion.fitting.refining import is_anywhere
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain, chosen, settled
from armscope.motion.fitting.space import build_space, without_backgrounds
from armscope.motion.library import catalogue
from armscope.motion.library.changes_catalogue import CHANGES
from armscope.motion.library.laws import Law, is_of_a_gain
from armscope.motion.library.layout import OWN, TorqueLayout
from armscope.motion.library.linkage import BETWEEN_LINKS, pushes_one_way
from armscope.motion.summary.constants import PLAUSIBLE
from armscope.motion.summary.doubts import motion_hz, swing_hz
from armscope.motion.summary.foretelling import held_out_gains, misfits, with_backgrounds_that_foretell
from armscope.motion.summary.in_proportion import rather_in_proportion
from armscope.motion.summary.names_of_masses import NameOfMasses, far_off, likeliest_name, likely_names
from armscope.motion.summary.no_bodies import no_link, no_load, no_place, not_at_the_flange
from armscope.motion.summary.of_own_torque import of_another_model
from armscope.motion.summary.rather_carried import rather_carried
from armscope.motion.summary.unnamed_masses import is_of_masses, odds_of_name, off_without_a_name
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def tenable(selected: SelectedCauses, rate: float) -> SelectedCauses:
    """The selection without names that can't stand; what takes their place is judged alike, and must foretell motion.

    Args:
        selected: what the evidence asks for.
        rate: samples per second.

    Returns:
        A selection, all of whose names can stand.
    """
    barred = frozenset(n for n, each in enumerate(selected.space.candidates) if not each.competes)
    torque = np.sqrt(np.mean(selected.rows.torque**2, axis=0))
    selected, without = with_backgrounds_that_foretell(selected)
    for number in itertools.count():  # ends: from some round on names only go
        wrong = _untenable(selected, rate)
        if not wrong:
            break
        barred |= wrong | _alike(selected.rows.layout, wrong)
        space = without_backgrounds(build_space(selected.rows.layout, torque, rate, barred), without)
        kept = [effect for effect in selected.best.chosen if effect.candidate not in barred]
        again = chosen(selected.rows, selected.weights, selected.block, space, (selected.best, kept), selected)
        alone = _alone(again, kept)
        others = number + 1 < CONSISTENCY.judged and _foretells_more(again, alone.best)
        selected = at_own_gain(again if others else alone)
    told = _told_apart(rather_in_proportion(selected), rate)
    carried = rather_carried(told)
    return told if carried is told or _untenable(at_own_gain(carried), rate) else at_own_gain(carried)


def _untenable(selected: SelectedCauses, rate: float) -> frozenset[int]:
    """Numbers of the names that can't stand."""
    own = {*_impossible(selected), *_between_samples(selected, rate), *told_by_reversals_alone(selected)}
    return frozenset({*own, *of_another_model(selected), *_cancelling(selected), *_of_one_path(selected)})


def _alike(layout: TorqueLayout, wrong: frozenset[int]) -> frozenset[int]:
    """Powers of the speed that are as wrong as one that is: all above the first, or all below it, at its joint."""
    curves = {n: each for n, each in enumerate(layout.placed) if each.cause is catalogue.VISCOUS_CURVE}
    sides = {(curves[n].joints, curves[n].scanned[0][2] > 1) for n in wrong & curves.keys()}
    return frozenset(n for n, each in curves.items() if (each.joints, each.scanned[0][2] > 1) in sides)


def _alone(selected: SelectedCauses, kept: Sequence[SelectedEffect]) -> SelectedCauses:
    """What was kept and is still worth its price, with nothing in the place of what was struck out.

    Beside it a curve may be worth its price that says more than a name; where most of it is one, it has that name now.
    """
    search = Search.on(selected.problem)
    best = search.with_best_sizes(search.evaluated(kept, selected.best))
    return replace(selected, best=plain_first(search, settled(search, named_first(search, settled(search, best)))))


def _foretells_more(selected: SelectedCauses, alone: Hypothesis) -> bool:
    """Whether a selection meets the middle one of the blocks that took no part better than another hypothesis does."""
    hypotheses = (selected.best, replace(alone, noise=selected.best.noise))
    found, other = misfits(selected, [(best, best.chosen) for best in hypotheses])
    return bool(np.median(other - found) > 0)


def _impossible(selected: SelectedCauses) -> Iterator[int]:
    """Friction or rotors below zero, the stated part counted in, by more than two standard errors; links that swing;
    gains that no drive has; loads that are no body.

    A link that swings on its drive more slowly than its motor moves is not where motor and torque put it.
    """
    layout, stated = selected.rows.layout, np.nan_to_num(selected.rows.layout.arm.stated_background)
    most = PRIOR.largest_gain
    for number in selected.best.candidates:
        placed, columns = layout.placed[number], layout.columns[number]
        least = np.full(len(columns), -np.inf)
        if placed.of_background is not None and placed.of_background[1] > 0:
            least[:] = -stated[placed.of_background]
        elif placed.cause is catalogue.COUPLED_FRICTION:
            least[:] = 0.0
        elif (
            placed.cause is catalogue.TEMPERATURE_FRICTION and len(columns) > 1
        ):  # beside its slope what is stated is off
            least[1] = -stated[placed.joints[0], 1 if placed.parameters[1][0] == "dry" else 2]
        elif placed.cause in (catalogue.STRIBECK, catalogue.VISCOUS_CURVE):
            least[0] = 0.0
        elif is_of_a_gain(placed.columns) and not 1 / most < 1 + selected.coefficients[columns[0]] < most:
            yield number
        error = np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
        below = np.any(selected.coefficients[columns] < least - CONSISTENCY.below * error)
        nothing = no_load(selected, number) or no_link(selected, number) or _pulls_and_pushes(selected, number)
        nothing = nothing or not_at_the_flange(selected, number)
        if below or nothing or (is_anywhere(placed) and no_place(selected, number)):
            yield number
        elif (swing := swing_hz(selected, number)) is not None and swing < motion_hz(selected, placed.joints[0]):
            yield number  # no link follows a motor that moves to and fro faster than it swings itself
    yield from _in_place_of_friction(selected)


def _between_samples(selected: SelectedCauses, rate: float) -> Iterator[int]:
    """Friction near rest at speeds that a joint which turns back passes between two samples: none of them shows it.

    What is left there is where in a sample friction changed sides.
    """
    for number in selected.best.candidates:
        placed = selected.rows.layout.placed[number]
        if placed.cause is not catalogue.STRIBECK:
            continue
        (_, _, speed), j = placed.scanned[0], placed.joints[0]
        between = np.concatenate([samples_near_rest(each.signals.dq[:, j], speed) for each in selected.rows.samples])
        if len(between) and np.median(between) < PLAUSIBLE.samples_near_rest:
            yield number


def samples_near_rest(speeds: Array, slow: float) -> Indices:
    """How many samples each reversal has between a speed one way and that speed the other way.

    Args:
        speeds: (N,) rad/s (m/s) of a joint over time.
        slow: rad/s (m/s).

    Returns:
        (k,) of the k reversals between faster motion; a joint that stays slow has not turned back yet.
    """
    fast = np.flatnonzero(np.abs(speeds) >= slow)
    turned = np.diff(np.sign(speeds[fast])) != 0
    return np.asarray(np.diff(fast)[turned] - 1)


def _pulls_and_pushes(selected: SelectedCauses, number: int) -> bool:
    """Whether a spring between links is none: its force would have to change its sign."""
    layout, placed = selected.rows.layout, selected.rows.layout.placed[number]
    if placed.variant != BETWEEN_LINKS or not isinstance(placed.columns, Law):
        return False
    phase, ratio, middle = placed.columns.numbers
    angle = selected.rows.q[:, placed.joints[0]] + phase
    return not pushes_one_way(selected.coefficients[layout.columns[number]], angle, ratio, middle + phase)


def _in_place_of_friction(selected: SelectedCauses) -> Iterator[int]:
    """Laws of a joint's own torque beside which its dry friction would have to be below zero: it is that friction."""
    layout, best = selected.rows.layout, selected.best
    for number in best.candidates:
        placed, column = layout.placed[number], np.array([OWN * layout.placed[number].joints[0] + 1])
        if placed.driver not in (catalogue.SCALE, catalogue.PLAY) or column[0] not in best.columns:
            continue
        error = float(np.sqrt(best.variances(column)[0])) / selected.problem.scale[column[0]]
        stated = np.nan_to_num(layout.arm.stated_background[placed.joints[0], 1])
        if selected.coefficients[column[0]] + stated < -CONSISTENCY.below * error:
            yield number


def _cancelling(selected: SelectedCauses) -> Iterator[int]:
    """The lesser of two names at one joint of which each takes back most of the other's torque."""
    layout = selected.rows.layout
    named = [n for n in selected.best.candidates if layout.placed[n].cause is not catalogue.CURVE]
    at_joint = [n for n in named if len(layout.placed[n].joints) == 1]
    for one, other in itertools.combinations(at_joint, 2):
        if layout.placed[one].joints != layout.placed[other].joints:
            continue
        first, second = _torque(selected, one), _torque(selected, other)
        least = min(np.linalg.norm(first), np.linalg.norm(second))
        if np.linalg.norm(first + second) < CONSISTENCY.cancelled * least:
            yield one if np.linalg.norm(first) < np.linalg.norm(second) else other


def _torque(selected: SelectedCauses, number: int) -> Array:
    """(K,) that a cause makes at its joint."""
    layout = selected.rows.layout
    coefficients, columns = np.zeros(layout.width), layout.columns[number]
    coefficients[columns] = selected.coefficients[columns]
    return selected.rows.modelled(coefficients)[:, layout.placed[number].joints[0]]


def _of_one_path(selected: SelectedCauses) -> Iterator[int]:
    """Whose size differs from path to path, or that makes the motion of paths that took no part no better known.

    Of several of the latter kind only the least goes where all together foretell something: one may say what another
    does. A name of masses foretells what masses near the stated ones do without it, a little better or worse by chance;
    where every path tells its size it stands, and whether it is a name at all, `_told_apart` asks.
    """
    best, gains = selected.best, held_out_gains(selected)
    agree = {number: agreement(selected, number).consistent for number in best.candidates}
    stands = {n for n in best.candidates if selected.rows.layout.placed[n].cause is catalogue.ROCKING_BASE}
    yield from (number for number in best.candidates if agree[number] is False and number not in stands)
    masses = {n for n in best.candidates if is_of_masses(selected.rows.layout.placed[n])}
    spared = {n for n in best.candidates if (agree[n] and n in masses) or _untold(selected, n, agree[n])}
    useless = [n for n in best.candidates if gains[n] <= 0 and n not in spared]
    if not useless:
        return
    kept = tuple(effect for effect in best.chosen if effect.candidate not in useless)
    without, with_them = misfits(selected, [(best, kept), (best, best.chosen)])
    lost = float(np.median(without - with_them))
    yield from useless if lost <= 0 else [min(useless, key=gains.__getitem__)]


def _untold(selected: SelectedCauses, number: int, agree: bool | None) -> bool:
    """Whether a cause changes within one run, and no two blocks tell it: other motion never has it; or is a stand's.

    A stand rings on the paths that start and stop. Smooth ones hardly shake it, and tell of it how the base leans, from
    where somebody levelled it; that it rings, its line has shown before it competed.
    """
    cause = selected.rows.layout.placed[number].cause
    return cause is catalogue.ROCKING_BASE or (agree is None and cause in CHANGES)


def _without_the_name(selected: SelectedCauses, number: int) -> SelectedCauses:
    """The selection without a name of masses; where the share of all links can't say what it said, by a share of its
    own links, which made it no surer than none.
    """
    kept = [effect for effect in selected.best.chosen if effect.candidate != number]
    by_all = _alone(selected, kept)
    if by_all.best.log_posterior > selected.best.log_posterior - INDISTINGUISHABLE_NATS:
        return by_all
    by_own = off_without_a_name(selected, number)
    return max(_alone(by_own, by_own.best.chosen), by_all, key=lambda each: each.best.log_posterior)


def _told_apart(selected: SelectedCauses, rate: float) -> SelectedCauses:
    """The selection without names of masses that are hardly likelier than none, the least of them first.

    Another name takes the place of one that goes if it is likelier than none and can stand; of masses that are far off
    without any name, one that says all of it. Not of what is there in some runs only: no link is otherwise there.
    """
    gone: set[int] = set()
    while True:
        masses = [n for n in selected.best.candidates if is_of_masses(selected.rows.layout.placed[n])]
        names = [NameOfMasses(selected, number, odds_of_name(selected, number)) for number in masses]
        unsure = [each for each in names if not each.is_told]
        if not unsure:
            return selected if masses else _all_by_one_name(selected, gone, rate)
        least = min(unsure, key=lambda each: each.nats).number
        gone.add(least)
        selected = at_own_gain(_without_the_name(selected, least))
        another = likeliest_name(selected, gone)
        if another is not None and another.is_told:
            instead = at_own_gain(another.selected)
            selected = selected if _untenable(instead, rate) else instead


def _all_by_one_name(selected: SelectedCauses, gone: Collection[int], rate: float) -> SelectedCauses:
    """The selection with the one name that says what masses far off all over the arm say; itself where none does."""
    if not far_off(selected, selected.best):
        return selected
    for name in likely_names(selected):
        if name.number not in gone and name.is_told:
            instead = at_own_gain(name.selected)
            return selected if _untenable(instead, rate) else instead
    return selected
