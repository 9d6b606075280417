"""Links that are heavier or lighter than stated where all of them are: each has its name where motion tells its weight.

Where stated masses are off all over the arm, evidence asks for a share of them that is free without a name: a name for
one link would take on what the others are off by, with an interval that knows nothing of them. Beside that share a
link's own number is what is left for that link alone. It has its name where it is worth the price of one against none,
and where the link is rather heavier as a whole than off in some other way.
"""

from __future__ import annotations

from dataclasses import replace

from armscope.inference.constants import PRIORS
from armscope.inference.edits import by_posterior
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain
from armscope.motion.library import catalogue
from armscope.motion.summary.doubts import as_likely_without, determined, may_be_nothing
from armscope.motion.summary.intervals import Sureness, sureness
from armscope.motion.summary.judgement import cause_parameters
from armscope.motion.summary.no_bodies import no_link
from armscope.motion.summary.told_gains import with_gains_that_stand_out
from armscope.motion.summary.unnamed_masses import odds_of_weight
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def rather_all_links(selected: SelectedCauses, of_all: BackgroundSizes) -> SelectedCauses:
    """The selection with all links off a little in the place of names of masses, where that is about as likely.

    A search ends at one of the two as its rounds go. Names beside masses that are all as stated have intervals that
    know of nothing else, and what one link does in the place of others, a spring beside it puts right. A body of the
    model that is missing is no error of masses: it stays.

    Args:
        selected: what the evidence asks for.
        of_all: sizes of the backgrounds from which the other is looked for.

    Returns:
        The selection, or the other.
    """
    best, layout = selected.best, selected.rows.layout
    placed = [layout.placed[number] for number in best.candidates]
    weights = [family.name for family in selected.space.families].index("link masses")
    of_masses = [each for each in placed if each.inertial is not None and not each.runs]
    if best.background[weights] or all(each.cause is catalogue.BODY for each in of_masses):
        return selected
    other = Search.on(selected.problem).best([of_all])
    if other.background[weights] and other.log_posterior > best.log_posterior - INDISTINGUISHABLE_NATS:
        return at_own_gain(replace(selected, best=other))
    return selected


def with_links_that_weigh(selected: SelectedCauses) -> SelectedCauses:
    """The selection with names for links out of those that are off without one.

    Beside one name, the others are off by as much as they themselves ask for, which may be not at all: one link that
    stands out says nothing of them. Several do.

    Args:
        selected: a selection, all of whose names can stand.

    Returns:
        It, or the selection itself where no link's weight is told.
    """
    search, best, layout = Search.on(selected.problem), selected.best, selected.rows.layout
    named = []
    for number, (placed, columns) in enumerate(zip(layout.placed, layout.columns, strict=True)):
        of_link = placed.cause is catalogue.LINK_MASS and number not in best.candidates
        if not of_link or placed.variant or not search.in_background(best, number):
            continue
        worth = search.log_odds(best, number) >= PRIORS.sure_nats
        if worth and odds_of_weight(selected, number) >= INDISTINGUISHABLE_NATS:
            size = selected.problem.nearest_size(abs(float(best.means(columns)[0])))
            named.append(SelectedEffect(number, size, nested=True))
    if not named:
        return selected
    weights = [family.name for family in selected.space.families].index("link masses")
    beside = search.evaluated((*best.chosen, *named), best)
    smaller = range(best.background[weights] if len(named) == 1 else 0)
    others = [search.with_background(beside, weights, size) for size in smaller]
    return replace(selected, best=max([beside, *others], key=by_posterior))


def told_links(selected: SelectedCauses) -> tuple[SelectedCauses, Sureness]:
    """The selection with names for gains beyond what is stated, and for those links out of all whose weight is told.

    Args:
        selected: as of `tenable`.

    Returns:
        It, and how far it can be trusted. A link whose number is not determined, by gains that nobody has measured
        say, or that would weigh less than nothing, has no name.
    """
    selected = _without_what_may_be_nothing(with_gains_that_stand_out(selected))
    named = with_links_that_weigh(selected)
    sure = sureness(named)
    added = named.best.candidates - selected.best.candidates
    loose = [n for n in added if no_link(named, n) or not determined(cause_parameters(named, n, sure.factor))]
    if not loose:
        return named, sure
    kept = tuple(effect for effect in named.best.chosen if effect.candidate not in loose)
    named = replace(named, best=Search.on(named.problem).evaluated(kept, named.best))
    return named, sureness(named)


def _without_what_may_be_nothing(selected: SelectedCauses) -> SelectedCauses:
    """The selection without names of masses that are no likelier than none and whose intervals hold zero."""
    unsure = [n for n in selected.best.candidates if as_likely_without(selected, n)]
    factor = sureness(selected).factor if unsure else None
    nothing = [n for n in unsure if factor is not None and may_be_nothing(cause_parameters(selected, n, factor))]
    if not nothing:
        return selected
    search = Search.on(selected.problem)
    return at_own_gain(replace(selected, best=search.with_best_sizes(search.without(selected.best, nothing))))
