"""The library as the inference sees it: causes as sets of columns, and masses and gains as joint_backgrounds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.inference.model_space import (
    BackgroundFamily,
    BackgroundSizes,
    Candidate,
    Exchange,
    ModelSpace,
    ToleranceFamily,
)
from armscope.motion.constants import PRIOR
from armscope.motion.library import catalogue
from armscope.motion.library.causes import Cause, PlacedCause
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.changes_catalogue import CHANGES, LOAD_CHANGE
from armscope.motion.library.laws import is_of_a_gain
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.linkage import BETWEEN_LINKS
from armscope.motion.library.warmth import is_while_running

OF_MASSES, OF_REVERSALS = frozenset({"masses", "link masses"}), frozenset({"reversals"})
"""Names of the families by which masses are off without a name, and by which friction changes sides."""
NEAR_THE_STATED = OF_MASSES | {"gains"}
"""Those that are held near what is stated; the others are every joint's own."""


def of_joints(space: ModelSpace, background: BackgroundSizes) -> BackgroundSizes:
    """A background without what is held near the stated: friction and rotors, and how friction changes sides."""
    sizes = zip(space.families, background, strict=True)
    return tuple(0 if family.name in NEAR_THE_STATED else size for family, size in sizes)


def build_space(layout: TorqueLayout, torque: Array, rate: float, barred: frozenset[int] = frozenset()) -> ModelSpace:
    """What may take part in the diagnosis of a motion.

    Offset, friction and rotor inertia of every joint are always free; inertial parameters are held near the stated ones
    by a share that competes, gains by their stated uncertainty. A link may besides be heavier as a whole: its shape is
    known from a drawing, and its weight is not.

    Args:
        layout: of the columns.
        torque: (m,) RMS torque of each joint.
        rate: samples per second.
        barred: numbers of causes that can't stand.

    Returns:
        Columns, priors, and what excludes what.
    """
    shares = PRIOR.inertial_shares
    shape = torque[:, None] * [PRIOR.reversal, PRIOR.turning_s**2, PRIOR.turning_s]
    reversals = ToleranceFamily("reversals", layout.reversals.ravel(), shape.ravel(), PRIOR.reversal_sizes)
    families: list[BackgroundFamily] = [
        ToleranceFamily("masses", layout.inertial, np.ones(len(layout.inertial)), shares),
        reversals,
        ToleranceFamily("response", layout.response, np.array([PRIOR.response / rate**2]), (0.0, 1.0)),
    ]
    heavier, stated = layout.link_masses
    families.append(ToleranceFamily("link masses", heavier, stated, PRIOR.link_masses, is_priced=True, takes_one=True))
    starts: list[tuple[int, ...]] = [
        (0, 1, 1, 0),
        (2, 1, 1, PRIOR.link_masses.index(0.1) if len(heavier) else 0),
        (4, 1, 1, 0),
    ]
    if layout.with_gains:
        unsure = layout.arm.gain_uncertainty
        sigma = np.where(np.isnan(unsure), PRIOR.gain, unsure)
        families.append(ToleranceFamily("gains", layout.gains, sigma, (0.0, 1.0)))
        starts = [(*start, 1) for start in starts]
    else:
        tolerance, shares = np.ones(layout.arm.n_motors), PRIOR.torque_gains
        families.append(ToleranceFamily("gains", layout.gains, tolerance, shares, is_priced=True, takes_one=True))
        starts = [(*start, 0) for start in starts]
    return ModelSpace(
        frames=layout.frames,
        families=tuple(families),
        candidates=_candidates(layout, barred),
        starts=tuple(starts),
        exchanges=(*_changes_for_payloads(layout, barred), *_one_delay_for_many(layout, barred)),
    )


def without_backgrounds(space: ModelSpace, names: Collection[str]) -> ModelSpace:
    """The space where some families hold nothing at any of their sizes."""
    families = tuple(
        replace(family, shares=(0.0,) * family.sizes)
        if isinstance(family, ToleranceFamily) and family.name in names
        else family
        for family in space.families
    )
    return replace(space, families=families)


def _changes_for_payloads(layout: TorqueLayout, barred: frozenset[int]) -> Iterator[Exchange]:
    """A load that comes and goes for one that is said to be there all the time, and is taken back while it is not."""
    standing = [n for n, cause in enumerate(layout.placed) if cause.cause is catalogue.PAYLOAD]
    changing = [n for n, cause in enumerate(layout.placed) if cause.cause is LOAD_CHANGE and n not in barred]
    for run in dict.fromkeys(layout.placed[n].runs for n in changing):
        taken_back = {n: None for n in standing if layout.placed[n].runs in ((), run)}
        yield Exchange(taken_back, tuple(n for n in changing if layout.placed[n].runs == run))


def _one_delay_for_many(layout: TorqueLayout, barred: frozenset[int]) -> Iterator[Exchange]:
    """One delay that all joints have in common for those of joints."""
    delays = [n for n, cause in enumerate(layout.placed) if cause.cause is catalogue.DELAY]
    common = tuple(n for n in delays if layout.placed[n].common and n not in barred)
    if common:
        yield Exchange({n: None for n in delays if not layout.placed[n].common}, common)


def _candidates(layout: TorqueLayout, barred: frozenset[int]) -> tuple[Candidate, ...]:
    placed = layout.placed
    beside: dict[str, list[int]] = {}
    for number, cause in enumerate(placed):
        beside.setdefault(cause.location, []).append(number)
    changing, candidates = [n for n, cause in enumerate(placed) if cause.cause in CHANGES], []
    opposite = list(_opposite_inertias(placed))
    for number, (cause, columns) in enumerate(zip(placed, layout.columns, strict=True)):
        excludes = frozenset(n for n in beside[cause.location] if n != number and _clash(cause, placed[n]))
        excludes |= frozenset(n for n in changing if _at_the_same_moments(cause, placed[n]))
        excludes |= frozenset(n for n, other in enumerate(placed) if _of_one_clock(cause, other))
        excludes |= frozenset(n for pair in opposite if number in pair for n in pair if n != number)
        special = frozenset(n for n in excludes - barred if _contains(cause, placed[n]))
        candidates.append(
            Candidate(
                kind=cause.cause.name,
                location=cause.location,
                columns=columns,
                prior_scale=np.array(cause.expected or np.ones(cause.width)),
                variant=cause.variant,
                driver=cause.driver,
                label=str(cause),
                family=cause.cause.family,
                region=region_of(cause),
                plausible=_plausible(cause, layout),
                usual=np.array(cause.usual) if cause.usual else None,
                multiplicity=cause.multiplicity,
                nonnegative=cause.cause.nonnegative and cause.width == 1,
                is_curve=cause.is_curve,
                competes=number not in barred,
                excludes=excludes,
                special_cases=special,
                side_by_side=2,
                common=frozenset(n for n in special if placed[n].of_background is not None),
            )
        )
    return tuple(candidates)


def _opposite_inertias(placed: Sequence[PlacedCause]) -> Iterator[tuple[int, int]]:
    """A link that turns with two joints of parallel axes, and what turns with their difference.

    Each takes back what the other has both joints say of one another; what they have of each joint alone is rotors.
    """
    coupled = {n: cause for n, cause in enumerate(placed) if cause.cause is catalogue.COUPLED_INERTIA}
    both = Counter(cause.joints for cause in coupled.values())  # two: neither is a link
    for number, cause in coupled.items():
        links = [n for n, other in enumerate(placed) if other.location == f"link {cause.joints[1] + 1}"]
        if both[cause.joints] == 1:
            yield from ((number, n) for n in links if placed[n].cause is catalogue.LINK_INERTIA)


def _contains(one: PlacedCause, other: PlacedCause) -> bool:
    """Whether a curve or a nameless cause holds one that has a name and clashes with it.

    How a spring between links is mounted was scanned until it suits: it stands for most of a cable as a curve does, and
    only evidence tells them apart.
    """
    if one.is_curve:
        return not other.is_curve and other.variant != BETWEEN_LINKS
    return one.cause is catalogue.CURVE and OWNED.get(one.driver) is other.cause


def _plausible(cause: PlacedCause, layout: TorqueLayout) -> Array | None:
    """How far a gain may be off, or what an arm picks up; of other causes anything is plausible.

    Where masses are far off and a joint carries little, a gain of thirty would be one more column of these masses.
    """
    if cause.cause is LOAD_CHANGE:
        usual = CHANGE.usual_load * float(layout.arm.inertial[::10].sum())
        return np.array([usual * (1.0 if unit == "kg" else layout.reach) for _, unit in cause.parameters])
    if not is_of_a_gain(cause.columns):
        return None
    return np.array([PRIOR.unsure_gain, *[np.inf] * (cause.width - 1)])


def region_of(cause: PlacedCause) -> str:
    """Coarser than the place: the joint's number, or the place itself."""
    words = cause.location.split()
    return words[1] if words[0] in ("joint", "link") else cause.location


CONTAINED = {
    "speed": (
        catalogue.ASYMMETRY,
        catalogue.STRIBECK,
        catalogue.VISCOUS_CURVE,
        catalogue.VISCOUS,
        catalogue.COULOMB,
        catalogue.OFFSET,
    ),
    "joint angle": (catalogue.BALANCER, catalogue.RIPPLE, catalogue.OFFSET),
    "load": (catalogue.GAIN, catalogue.OFFSET),
    "time": (catalogue.OFFSET,),
    "temperature": (catalogue.OFFSET,),
}
"""What a free curve at the same joint contains, by what it follows."""
OWNED = {
    catalogue.WAY: catalogue.COULOMB,
    catalogue.PLAY: catalogue.DELAY,
    catalogue.SCALE: catalogue.GAIN,
}
"""What a law outside the library contains, by what it follows."""
OWNS = {catalogue.BALANCER: catalogue.OFFSET}
"""A spring's rest is not known, so that its pull in the middle of the range is its own."""


def _clash(one: PlacedCause, other: PlacedCause) -> bool:
    """Whether causes at one place can't stand side by side: two forms of one, or a free curve and what it contains."""
    if one.is_curve and other.is_curve:
        return one.driver == other.driver
    if one.is_curve or other.is_curve:
        curve, special = (one, other) if one.is_curve else (other, one)
        return special.cause in CONTAINED[curve.driver]
    for owner, owned in ((one, other), (other, one)):
        own = (OWNS.get(owner.cause), OWNED.get(owner.driver) if owner.cause is catalogue.CURVE else None)
        if owned.cause in own or _at_all_temperatures(owner) is owned.cause:
            return True
    if one.cause in CHANGES and one.runs == other.runs:
        return one.cause is other.cause
    if one.cause is other.cause and one.cause.each_form and not is_while_running(one.columns):
        return one.variant == other.variant
    return one.cause is other.cause and not (one.runs or other.runs)


def _at_the_same_moments(one: PlacedCause, other: PlacedCause) -> bool:
    """Whether one is a load that comes and goes, and the other a reading that jumps with it: either is all there is."""
    return {one.cause, other.cause} == set(CHANGES) and one.runs == other.runs


def _of_one_clock(one: PlacedCause, other: PlacedCause) -> bool:
    """Whether one is a delay of all joints and the other a joint's own: where they differ, each has its own."""
    return one.cause is other.cause is catalogue.DELAY and one.common != other.common


def _at_all_temperatures(cause: PlacedCause) -> Cause | None:
    """What a friction that changes with temperature contains where it has a constant part."""
    if cause.cause is not catalogue.TEMPERATURE_FRICTION or cause.width == 1:
        return None
    return catalogue.VISCOUS if cause.variant == "viscous" else catalogue.COULOMB
