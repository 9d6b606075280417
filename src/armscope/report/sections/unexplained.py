"""What is left unexplained."""

from __future__ import annotations

from typing import Any

from armscope.report.sectioning import Section, Subject
from armscope.report.sections.effect_cards import card
from armscope.verdict.schema import Verdict
from armscope.verdict.wording import millimetres


def _context(subject: Subject) -> dict[str, Any]:
    verdict = subject.verdict
    return {
        "left_is_told": _left_is_told(verdict),
        "scatter": _scatters(verdict),
        "unexplained_rms": millimetres(verdict.unexplained.rms_mm),
    }


def _left_is_told(verdict: Verdict) -> str:
    """The anchor of the card that already shows what is left unexplained; empty where there is none."""
    left = verdict.unexplained
    for number, effect in enumerate(verdict.effects, start=1):
        if left.present and effect.nameless and effect.location == left.location:
            return card(effect, number).anchor
    return ""


def _scatters(verdict: Verdict) -> bool:
    """Whether what is left is scatter, which has no curve."""
    there = [each for each in verdict.effects if each.location == verdict.unexplained.location]
    return any(effect.scatters for effect in there)


UNEXPLAINED = Section("unexplained", "What is left", "What is left", _context, folded=True)
