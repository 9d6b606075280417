"""What was found: a card per effect, minor ones in a table."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from armscope.core.averages import rms
from armscope.report.figures.effect_curve import effect_curves, worth_drawing
from armscope.report.sectioning import Section, Subject
from armscope.report.sections.effect_cards import Card, card
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import FoundEffect
from armscope.verdict.payload_place import carries_over
from armscope.verdict.wording import main_and_minor, millimetres, percent


def findings(verdict: Diagnosis) -> dict[str, Any]:
    """What several sections tell: cards of main and minor effects, the backgrounds, whether a main one is in doubt."""
    number = {id(effect): n for n, effect in enumerate(verdict.effects, start=1)}

    def as_card(effect: FoundEffect) -> Card:
        figure = f"curve_{number[id(effect)]}" if worth_drawing(effect) else ""
        told = replace(effect, carries_over=carries_over(effect, verdict))
        return card(told, number[id(effect)], figure, verdict.model.arm.has_masses)

    main, minor = main_and_minor(verdict.effects)
    return {
        "cards": [as_card(effect) for effect in main],
        "minor": [as_card(effect) for effect in minor],
        "minor_share": percent(sum(effect.share for effect in minor)),
        "background": verdict.background.present,
        "background_share": percent(verdict.background.share),
        "open_question": verdict.next_poses is not None and any(map(verdict.next_poses.ask_about, main)),
    }


def _context(subject: Subject) -> dict[str, Any]:
    # what does nothing by itself has no worth alone, nor has what scatters: nobody knows yet what cures it
    by_itself = [(n, c) for n, c in enumerate(subject.worth.causes) if not (c.requires or c.effects[0].scatters)]
    alone = {id(c.effects[0]): subject.worth.cured([n]) for n, c in by_itself}
    main, _ = main_and_minor(subject.verdict.effects)
    before = millimetres(subject.expected(rms(subject.worth.before)))
    worth = [f"{before} → {millimetres(subject.expected(alone[id(e)]))}" if id(e) in alone else "" for e in main]
    found = findings(subject.verdict)
    families: dict[str, list[tuple[Card, str]]] = {}
    for effect, its_card, its_worth in zip(main, found["cards"], worth, strict=True):
        families.setdefault(effect.family, []).append((its_card, its_worth))
    share = {family: sum(e.share for e in main if e.family == family) for family in families}
    ranked = sorted(families, key=lambda family: -share[family])
    cancel = {family: any(e.share < 0 for e in main if e.family == family) for family in families}
    return {
        **found,
        "cancel": cancel,
        "families": [(family, percent(share[family]), families[family]) for family in ranked],
    }


EFFECTS = Section("effects", "Causes", "What was found", _context, (effect_curves,))
