"""The card of a cause of an arm in motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from armscope.motion.library.catalogue import cause_named
from armscope.motion.library.clauses import rms_of
from armscope.motion.summary.doubts import may_be_nothing
from armscope.motion.summary.words import clause
from armscope.motion.verdict import FoundCause
from armscope.report.figures.motion import KNOT, is_drawn
from armscope.report.sections.effect_cards import ShownAlternative, gap_in_words
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, Alternative, Parameter
from armscope.verdict.wording import Reading, capitalised, evidence_in_words, percent, read_parameter

BY_VALUES = "found by trying values"


@dataclass(frozen=True)
class MotionCard:
    """The texts of a cause's card; `figure` is the name of its curve's figure or ""."""

    anchor: str
    title: str
    said: str
    share: str
    share_width: float
    size: str
    readings: tuple[Reading, ...]
    physics: str
    confirm: str
    cure: str
    evidence: str
    alternatives: tuple[ShownAlternative, ...]
    paths: str
    doubt: str
    figure: str


def motion_card(cause: FoundCause, number: int | str) -> MotionCard:
    """The card of a cause. ``number``: of it among the causes of torque (from 1); other words make another anchor."""
    known = cause_named(cause.effect)
    labels = known.labels if known else {}
    return MotionCard(
        anchor=f"cause-{number}",
        title=capitalised(cause.title),
        said=f"{capitalised(clause(cause))}.",
        share=percent(cause.share),
        share_width=min(100.0, max(0.0, 100 * cause.share)),
        size=f"{rms_of(cause)} at {cause.joint}",
        readings=tuple(
            signed(each, labels) for each in cause.parameters if not (cause.nameless or each.name.startswith(KNOT))
        ),
        physics=cause.physics,
        confirm=cause.confirm,
        cure=cause.cure.replace("`", ""),
        evidence=_evidence(cause),
        alternatives=tuple(
            ShownAlternative(
                _named(other), gap_in_words(other), abs(other.discriminability_nats) < INDISTINGUISHABLE_NATS
            )
            for other in cause.alternatives
        ),
        paths=f"{capitalised(cause.carries_over)}." if cause.carries_over else "",
        doubt=cause.doubt,
        figure=f"curve_{number}" if is_drawn(cause) else "",
    )


def signed(parameter: Parameter, labels: Mapping[str, str]) -> Reading:
    """A parameter as a card shows it, by its cause's own label: departures carry their sign."""
    reading = read_parameter(parameter)
    reading = replace(reading, label=labels.get(parameter.name, reading.label))
    fitted = reading.interval != BY_VALUES
    return replace(reading, value=f"+{reading.value}") if fitted and parameter.value > 0 else reading


_NAMELESS = {"unknown_twist": "a twist"}


def _named(other: Alternative) -> str:
    follows = f" that follows the {other.driver}" if other.nameless and other.driver else ""
    name = _NAMELESS.get(other.effect, "an unknown torque") if other.nameless else other.effect.replace("_", " ")
    return f"{name} at {other.location}{follows}" if other.location != "payload" else name


def _evidence(cause: FoundCause) -> str:
    """How sure a cause is; of one whose interval holds zero, that what is sure is that something is there."""
    nats = f"{cause.evidence_nats:.0f} nats"
    if may_be_nothing(cause.parameters):
        return f"These torques ask for something here ({nats}); how large it is, and which way it goes, is open."
    return f"{capitalised(evidence_in_words(cause.evidence_nats))} ({nats})."
