"""Where the trouble is: the arm coloured by share, and the effects in their order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from armscope.report.figures.arm import arm_figure
from armscope.report.figures.arm_picture import NAMED_SHARE
from armscope.report.sectioning import Section, Subject
from armscope.report.sections.effects import findings
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import UNKNOWN
from armscope.verdict.importance import minor_and_told
from armscope.verdict.wording import SMALL, capitalised, main_and_minor, percent, places_in_words

LEAST_AGAINST = 5e-4  # Shares as far below zero are told to be so


@dataclass(frozen=True)
class Place:
    """A line of the ranking; a cause has a link to its card, what stands apart from the story is quiet.

    Of the rest is what it is of what calibration leaves, in words, where that is told.
    """

    name: str
    link: str
    share: float
    quiet: bool = False
    of_rest: str = ""

    @property
    def told(self) -> str:
        """The share in words."""
        return percent(self.share)

    @property
    def width(self) -> float:
        """Of its bar, per cent."""
        return 100 * min(1.0, abs(self.share))

    @property
    def against(self) -> bool:
        """Whether it partly cancels others."""
        return self.share < -LEAST_AGAINST


def _context(subject: Subject) -> dict[str, Any]:
    ranking = _ranking(subject.verdict)
    return {"ranking": ranking, "against": any(place.against for place in ranking), "arm": subject.arm}


def _ranking(verdict: Diagnosis) -> list[Place]:
    """Causes, minor effects together, and small errors by family, the largest share first."""
    found = findings(verdict)
    main, minor = main_and_minor(verdict.effects)
    places = [
        Place(card.title, f"#{card.anchor}", e.share, of_rest=card.of_rest)
        for card, e in zip(found["cards"], main, strict=True)
    ]
    for cause in minor_and_told(verdict.causes):
        those = [effect for effect in minor if effect.as_member in cause.members]
        minor = [effect for effect in minor if effect not in those]
        where = places_in_words(list(dict.fromkeys(effect.location for effect in those)))
        kind = "Unexplained curves" if cause.family == UNKNOWN else f"Minor {cause.family} effects"
        places.append(Place(f"{kind} at {where}", "#minor", sum(effect.share for effect in those), quiet=True))
    if minor:
        name = f"{len(minor)} minor effect{'s' if len(minor) > 1 else ''}"
        places.append(Place(name, "#minor", sum(effect.share for effect in minor), quiet=True))
    places += [
        Place(capitalised(SMALL[family.family]), "", family.share, quiet=True)
        for family in verdict.background_families
        if family.family in SMALL and family.share >= NAMED_SHARE
    ]
    return sorted(places, key=lambda place: -place.share)


LOCATIONS = Section("locations", "Where", "Where the trouble is", _context, (arm_figure,))
