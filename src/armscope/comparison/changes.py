"""Which causes differ between recordings, each tested beside all that the recordings share.

Linear about the nominal arm. Shared by all recordings: every effect of the library that belongs to the arm, each held
by a prior of some millimetres at the tool (what no data tell apart stays small). Of each recording's own: base and
tool. A change is one effect more in some of the recordings. Its F statistic beside all that is shared says how likely
chance makes it; the smallest of all, times their number (Bonferroni), is the joint test that nothing changed. While it
is below the level, those are named that are sure beside each other and explain the rows best together
(`armscope.comparison.search`). What differs between halves of one recording, where nothing changed, makes all of them
less sure (`armscope.comparison.scoring`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri, stdtrit

from armscope.comparison.at_the_tool import moved_mm, taken_back_mm, worse_sigmas
from armscope.comparison.bad_shots import bad_shots
from armscope.comparison.constants import COMPARING, SHARED
from armscope.comparison.flange_load import ANOTHER_LOAD
from armscope.comparison.gained import more_or_less, more_sigmas, own_values, seen, stands
from armscope.comparison.measured_points import measured_points
from armscope.comparison.noisier import along_joints, noisier
from armscope.comparison.other_load import follows_loads, other_load
from armscope.comparison.result import SENSE, Change, Comparison, Kind, Left, Sense
from armscope.comparison.scoring import Possible, Scored
from armscope.comparison.search import as_steps, likeliest_changes
from armscope.comparison.sets import left_out_context, of_same_poses, stacked
from armscope.comparison.shared_model import SharedModel
from armscope.comparison.valued import Valued
from armscope.core.types import Array
from armscope.physics.effect import Term
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, INTERVAL
from armscope.verdict.wording import plain


def compare(arm: Arm, recordings: Mapping[str, Recordings], of_arms: bool = False) -> Comparison:
    """What changed between recordings of one arm, or which of several arms of a type is unlike the others.

    Args:
        arm: the nominal arm.
        recordings: two or more by name, in the order of time.
        of_arms: several arms: a change is in one recording alone; else it may hold from a recording on.

    Returns:
        The joint test, and every change with its interval.

    Raises:
        InputError: fewer than two recordings, or one that does not fit the arm.
    """
    table, group = stacked(arm, recordings)
    model = SharedModel(arm, table, group, of_arms)
    families = of_same_poses(list(recordings.values()))
    everything = model.possible_changes(_masks(families, of_arms))
    tried, names = len(everything), tuple(recordings)
    taken, changes = _named(model, everything, names, of_arms)
    between_rows = model.dispersion
    noisy = noisier(names, families, model.left_over(taken), between_rows)
    if taken and (along := along_joints(noisy)) > 1:
        model.dispersion *= along
        taken, changes = _named(model, everything, names, of_arms)
        noisy = noisier(names, families, model.left_over(taken), between_rows)
    joint = min([1.0, *(score.p * tried for score in model.scores(everything, ()))])
    return Comparison(
        arm=arm.name,
        names=names,
        rows=tuple(np.bincount(group).tolist()),
        noise_mm=float(np.sqrt(model.variance(taken))),
        p_nothing_changed=joint,
        level=COMPARING.level,
        tried=tried,
        same_poses=tuple(tuple(names[k] for k in family) for family in families),
        of_arms=of_arms,
        seen=seen(model, everything, taken),
        left=tuple(map(Left, *(each.tolist() for each in model.left_mm(taken)))),
        changes=changes,
        noisier=noisy,
        bad_shots=bad_shots(model, table, names),
        other_load=other_load(arm, table.motor_angles, changes, _worse_as_a_load(model, everything, taken)),
        points=measured_points(model, taken, names),
        left_out=left_out_context(recordings),
    )


def _named(
    model: SharedModel, everything: Sequence[Possible], names: Sequence[str], of_arms: bool
) -> tuple[list[Possible], tuple[Change, ...]]:
    """The changes that explain the rows best and can stand as they are told, the likeliest first.

    A name that cannot stand stood for others that did: without it, they are looked for again.
    """
    possible, tried = list(everything), len(everything)
    while True:
        taken = _settled_changes(model, possible, tried)
        taken = taken if of_arms else as_steps(taken, possible)
        ranked = []
        for each in taken:
            others = [other for other in taken if other is not each]
            rest = [other for other in possible if other not in others]
            scores = model.scores(rest, others)
            ranked.append((scores[rest.index(each)], each, _as_good(rest, scores, rest.index(each))))
        ranked.sort(key=lambda of: -of[0].nats)
        changes = [_change(model, each, score.p, alike, taken, names) for score, each, alike in ranked]
        cannot = [
            of[1] for of, change in zip(ranked, changes, strict=True) if not stands(model, of[1], change, taken, tried)
        ]
        if not cannot:
            return taken, tuple(changes)
        possible.remove(cannot[-1])


def _settled_changes(model: SharedModel, possible: Sequence[Possible], tried: int) -> list[Possible]:
    """The likeliest changes beside noise, and errors of each arm's own, that are as large as without these changes."""
    taken = likeliest_changes(model, possible, tried)
    if model.of_arms and not taken:
        taken = _one_that_hid(model, possible, tried)
    for _ in range(SHARED.weighings):
        if not taken or model.settled:
            break
        model.settle(taken)
        before, taken = set(taken), likeliest_changes(model, possible, tried)
        if set(taken) == before:
            break
    if model.of_arms and not taken:
        model.settle(())
    return taken


def _one_that_hid(model: SharedModel, possible: Sequence[Possible], tried: int) -> list[Possible]:
    """What is sure once an error does not count for what is usual of arms: it would make itself usual, and hide.

    First the likeliest beside what most arms have, then what is likeliest beside that.
    """
    model.settle((), of_most=True)
    seen: list[Possible] = []
    for _ in range(SHARED.hidden):
        rest = [each for each in possible if each not in seen]
        scores = model.scores(rest, ())
        seen.append(rest[int(np.argmax([score.nats for score in scores]))])
        model.settle(seen[-1:])
        if taken := likeliest_changes(model, possible, tried):
            return taken
    return []


def _masks(families: Sequence[tuple[int, ...]], of_arms: bool) -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Recordings that may have something otherwise, and those of the same poses that they are held against.

    In time: from one of them on, or in one alone, as where a crash was repaired before the next one. As two steps it
    would not be found: neither of them alone explains much, and the odd recording would count as a noisy one.
    """
    masks = []
    for family in families:
        later = [] if of_arms and len(family) > 2 else [family[first:] for first in range(1, len(family))]
        alone = [(each,) for each in (family if of_arms else family[1:-1])] if len(family) > 2 else []
        masks += [(inside, tuple(each for each in family if each not in inside)) for inside in (*later, *alone)]
    return masks


def _worse_as_a_load(model: SharedModel, everything: Sequence[Possible], taken: Sequence[Possible]) -> float | None:
    """Nats by which rows fit less well to another load at the flange in the place of the changes that follow loads.

    What its numbers cost does not count: one number of a link may be the likelier name of a faint load, and still it
    may be one.
    """
    beside = [each for each in taken if not follows_loads(each.placed.name, each.placed.variant)]
    alike = [each for each in taken if follows_loads(each.placed.name, each.placed.variant)]
    sets = {each.sets for each in alike}
    loads = [each for each in everything if each.placed.effect is ANOTHER_LOAD and each.sets in sets]
    if not loads or len(sets) > 1:  # a load that changed twice may look like changes in different recordings
        return None
    one_by_one = [model.scores([each], [*beside, *alike[:before]])[0] for before, each in enumerate(alike)]
    theirs = sum(score.better_fit_nats for score in one_by_one)
    return theirs - max(score.better_fit_nats for score in model.scores(loads, beside))


def _as_good(possible: Sequence[Possible], scores: Sequence[Scored], best: int) -> tuple[str, ...]:
    ranked = sorted(range(len(possible)), key=lambda each: -scores[each].nats)
    near = [each for each in ranked if scores[each].nats > scores[best].nats - INDISTINGUISHABLE_NATS and each != best]
    there = [possible[each].placed for each in near if possible[each].sets == possible[best].sets]
    # what is the change and something beside is no other one
    own = set(possible[best].placed.terms)
    return tuple(dict.fromkeys(plain(str(each)) for each in there if not own < set(each.terms)))


def _change(
    model: SharedModel,
    found: Possible,
    p: float,
    others: tuple[str, ...],
    taken: Sequence[Possible],
    names: Sequence[str],
) -> Change:
    """A change in words and file units: the effect with a value of its own in every recording."""
    alike = [other for other in taken if other.placed is found.placed and other is not found]
    # values of its own in every recording hold all changes of the effect: those beside them would be the same columns
    beside = [other for other in taken if other.placed is not found.placed]
    values, covariance, free = own_values(model, found.number, beside, len(names))
    q = len(found.placed.terms)
    there, against = _but_for_it_alike(found, alike)
    inside, outside = (np.isin(np.arange(len(names)), sets) for sets in (there, against))
    contrast = inside / inside.sum() - outside / outside.sum()
    parameters = []
    for number, term in enumerate(found.placed.terms):
        at = number + q * np.arange(len(names))
        difference = float(contrast @ values[at])
        error = float(np.sqrt(contrast @ covariance[np.ix_(at, at)] @ contrast))
        half = float(stdtrit(free, COMPARING.interval)) * error
        parameters.append(_valued(term, values[at], covariance[np.ix_(at, at)], (difference, half)))
    change = contrast @ values.reshape(len(names), q)
    rms, (left, back) = moved_mm(model, found, change), taken_back_mm(model, found, change)
    title, where, held = plain(str(found.placed)), *(tuple(names[k] for k in sets) for sets in (there, against))
    shares = inside / inside.sum(), outside / outside.sum()
    sense = more_or_less(found.placed, parameters, more_sigmas(model, found, beside, *shares))
    kind = _kind(parameters, inside, outside, sense)
    if kind in ("went", "shrank") and back < left:
        kind = "changed"  # it cannot be less where taking it back leaves less: how large it is, is told too surely
    until = next((names[k] for k in found.against if k > max(found.sets)), "")
    numbers = tuple(parameters)
    place = found.placed.name, found.placed.location, title
    beyond = worse_sigmas(model, found, change)
    variant = found.placed.variant
    return Change(*place, where, held, kind, rms, p, numbers, others, until, left, back, variant, sense, beyond)


def _but_for_it_alike(found: Possible, others: Sequence[Possible]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Recordings with and without a change that have the other changes of its effect in common.

    A zero that slipped and was set again changed twice; over all recordings the second change would hide in the first.
    """

    def state(number: int) -> tuple[bool, ...]:
        return tuple(number in other.sets for other in others)

    common = {state(number) for number in found.sets} & {state(number) for number in found.against}
    of_all, of_rest = (tuple(k for k in sets if state(k) in common) for sets in (found.sets, found.against))
    return (of_all, of_rest) if common else (found.sets, found.against)


def _valued(term: Term, values: Array, covariance: Array, change: tuple[float, float]) -> Valued:
    """A number in all recordings, in its file unit; the change with half its interval comes in SI units."""
    since = np.eye(len(values)) - np.eye(len(values))[0]
    errors, since_errors = (np.sqrt(np.diag(each)) for each in (covariance, since @ covariance @ since.T))
    value, error, change_since, error_since = (
        tuple((numbers / term.si).tolist()) for numbers in (values, errors, since @ values, since_errors)
    )
    difference, half = change[0] / term.si, change[1] / term.si
    interval = (difference - half, difference + half)
    plausible = float(term.plausible / term.si)
    return Valued(term.name, term.unit, value, error, change_since, error_since, difference, interval, plausible)


def _together_there(parameters: Sequence[Valued], where: NDArray[np.bool_]) -> bool:
    """Whether zero is outside the joint 95 % region of all numbers of a change, taken as independent."""
    values, errors = (np.array([getattr(each, name) for each in parameters]) for name in ("values", "stderrs"))
    means = np.mean(values[:, where], axis=1)
    spread = np.sqrt(np.mean(errors[:, where] ** 2, axis=1))
    return bool(np.sum((means / np.maximum(spread, 1e-300)) ** 2) > chdtri(len(parameters), 0.05))


def _kind(
    parameters: Sequence[Valued], inside: NDArray[np.bool_], outside: NDArray[np.bool_], sense: Sense | None = None
) -> Kind:
    """What became of the parameter that changed most surely; only that it changed where its sense is not that."""
    became = _became(parameters, inside, outside)
    return became if sense in (None, SENSE.get(became)) else "changed"


def _became(parameters: Sequence[Valued], inside: NDArray[np.bool_], outside: NDArray[np.bool_]) -> Kind:
    surest = max(parameters, key=lambda each: abs(each.difference) / (each.interval_95[1] - each.interval_95[0]))
    values, errors = np.array(surest.values), np.array(surest.stderrs)
    before, after = np.mean(values[outside]), np.mean(values[inside])
    was = abs(before) > INTERVAL * np.sqrt(np.mean(errors[outside] ** 2))
    is_now = abs(after) > INTERVAL * np.sqrt(np.mean(errors[inside] ** 2))
    is_now = is_now and _together_there(parameters, inside)  # one number of several stands out by chance
    more = abs(after) > abs(before)
    if was != is_now and is_now == more:
        return "came" if is_now else "went"
    if not (was and is_now) or before * after < 0:  # how large it is in all of them may be open where its change is not
        return "changed"
    return "grew" if more else "shrank"
