"""A cause's share is what its cure is worth, averaged over all orders of curing: no more and no less."""

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.verdict.calibrated import stands_out
from armscope.verdict.contributions import contributions
from armscope.verdict.effects import FoundEffect
from armscope.verdict.importance import with_importance
from armscope.verdict.schema import Background
from armscope.verdict.sentences import headline
from tests.report import verdicts
from tests.verdict.test_contributions import verdict, world  # noqa: F401  (fixtures)


def test_a_share_is_what_curing_takes_away_averaged_over_all_orders(verdict) -> None:  # noqa: F811
    worth = contributions(verdict)
    count, squared = len(worth.causes), rms(worth.before) ** 2
    drops = np.zeros(count)
    orders = list(itertools.permutations(range(count)))
    for order in orders:
        for place, cause in enumerate(order):
            drops[cause] += worth.cured(order[:place]) ** 2 - worth.cured(order[: place + 1]) ** 2
    told = [cause.effects[0].share for cause in worth.causes]
    # what is left has a little to do with the contributions: it is shared among them, too
    assert told == pytest.approx(drops / len(orders) / squared, abs=2e-3)
    assert count >= 3


def test_shares_add_up_to_what_is_explained_and_stand_in_their_order(verdict) -> None:  # noqa: F811
    worth = contributions(verdict)
    shares = [effect.share for effect in verdict.effects]
    assert shares == sorted(shares, reverse=True)
    everything = sum(shares) + sum(family.share for family in verdict.background_families)
    assert everything == pytest.approx(1 - (rms(worth.left) / rms(worth.before)) ** 2, abs=1e-6)
    assert sum(cause.share for cause in verdict.causes) == pytest.approx(everything, abs=1e-3)
    again = with_importance(replace(verdict, effects=tuple(reversed(verdict.effects))))
    assert [e.title for e in again.effects] == [e.title for e in verdict.effects]
    assert [e.share for e in again.effects] == pytest.approx(shares)
    assert again.headline == verdict.headline


def test_small_errors_that_the_evidence_does_not_ask_for_are_told_with_their_share() -> None:
    """They are in the model, and so in what it explains, but in no cause: without them the shares would not add up."""
    held = (Background("geometric", True, 0.8, 0.04, 0.02), Background("transmission", False, 0.1, 0.3, 0.33))
    said = headline(replace(verdicts.single().verdict, background_families=held))
    assert "possibly small errors in all drives (33 %)" in said
    assert "possibly" not in headline(verdicts.single().verdict)


def test_small_errors_that_no_family_is_sure_of_have_their_share_where_it_is_large(verdict) -> None:  # noqa: F811
    """What gives way everywhere took a quarter of a real arm's error and no share, and so the shares did not add up."""
    named = verdict.model.parts
    unsure = replace(
        verdict,
        model=replace(verdict.model, parts=named[1:], background=(*verdict.model.background, named[0])),
        effects=tuple(e for e in verdict.effects if e.location != named[0].placed.location),
        background=replace(verdict.background, present=False),
        background_families=tuple(replace(each, present=False, share=0.0) for each in verdict.background_families),
    )
    told = with_importance(unsure)
    families = {each.family: each.share for each in told.background_families}
    worth = contributions(unsure)
    assert families[named[0].placed.family] > 0.05
    explained = 1 - (rms(worth.left) / rms(worth.before)) ** 2
    assert sum(e.share for e in told.effects) + sum(families.values()) == pytest.approx(explained, abs=0.01)
    assert rms(worth.left) == pytest.approx(verdict.residual_after_mm, rel=0.1)
    assert "ossibly" in told.headline


@pytest.mark.parametrize(("against", "small"), [(-0.05, True), (-0.5, False)])
def test_what_hides_what_another_does_is_major_where_it_is_large(verdict, against: float, small: bool) -> None:  # noqa: F811
    """Its share is below zero either way: alone its cure makes the error larger, but the place is off by as much."""
    offset = next(e for e in verdict.effects if e.effect == "joint_offset")
    assert not any(effect.minor for effect in verdict.effects)
    (whole,) = [part for part in verdict.model.parts if part.placed.key == (offset.effect, offset.location)]
    hidden, grown = replace(whole, values=against * whole.values), replace(whole, values=(1 - against) * whole.values)
    others = tuple(part for part in verdict.model.parts if part is not whole)
    model = replace(verdict.model, parts=(grown, hidden, *others))
    opposite = replace(offset, title="its opposite")

    def weigh(found: FoundEffect, background: Sequence[Background]) -> FoundEffect:
        return replace(found, minor=found.share < 0.01)

    told = with_importance(replace(verdict, effects=(*verdict.effects, opposite), model=model), weigh)
    (hiding,) = [effect for effect in told.effects if effect.share < 0]
    assert hiding.minor == small
    assert [e.effect for e in told.effects if not e.minor].count("joint_offset") == 2 - small


def test_one_measure_says_what_is_small(verdict) -> None:  # noqa: F811
    """Major and minor follow the shares that the page prints, of the whole or of what calibration leaves, no others."""
    least = sorted(effect.share for effect in verdict.effects)[1]
    told = with_importance(verdict, lambda found, _: replace(found, minor=found.share < least))
    small = [effect.share < least and not stands_out(effect) for effect in told.effects]
    assert [effect.minor for effect in told.effects] == small
    assert sum(effect.share < least for effect in told.effects) == 1
    assert {cause.minor for cause in told.causes if not cause.everywhere} >= {False}
