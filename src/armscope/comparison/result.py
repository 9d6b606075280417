"""What a comparison says: plain data and its words."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal

from armscope.comparison.bad_shots import BadShot, told_of_shots
from armscope.comparison.constants import COMPARING
from armscope.comparison.measured_points import MeasuredPoint, told_of_points
from armscope.comparison.noisier import Noisier, told_of
from armscope.comparison.valued import Valued, number_line
from armscope.core.files import plain_values
from armscope.core.told import InWords
from armscope.core.words import enumerated, size_of
from armscope.verdict.constants import WORDS
from armscope.verdict.wording import capitalised, places_in_words, spelled

UNLIKE = {
    "came": "is there in {where}, and not in {others}", "went": "is missing in {where}, and there in {others}",
    "grew": "is larger in {where} than in {others}", "shrank": "is smaller in {where} than in {others}",
    "changed": "differs{by} in {where} from {others}",
}  # fmt: skip
"""What a change is called where recordings are of several arms."""
MOMENT = "compliance_times_moment_"
Kind = Literal["came", "went", "grew", "shrank", "changed"]
Sense = Literal["more", "less", ""]
SENSE: dict[Kind, Sense] = {"came": "more", "grew": "more", "went": "less", "shrank": "less"}
"""Whether there is more of a cause where it changed, or less."""
FEW_ARMS = f" Of fewer than {spelled(COMPARING.enough_arms)} arms only one that is grossly off stands out."


@dataclass(frozen=True)
class Change:
    """A cause that is not the same in all recordings."""

    effect: str
    location: str
    title: str
    where: tuple[str, ...]  # the recordings that have it otherwise
    against: tuple[str, ...]  # than these, alike in the other changes of the effect
    kind: Kind  # what became of it
    rms_mm: float  # what the change moves the tool by there, RMS of the 3D distance beyond what frames absorb
    p: float  # by chance, as often as this or more extreme, for any of all causes that were tried
    parameters: tuple[Valued, ...]
    alternatives: tuple[str, ...]  # causes that explain the change as well (evidence within 20 to 1)
    until: str = ""  # the first recording that did not have it any more; empty where it lasts. Arms have no such order
    # what base and tool leave of the recordings that have it otherwise: RMS per axis; NaN where unknown
    left_mm: float = math.nan
    # the same if the change were taken back. Other errors may make that less or more by chance
    taken_back_mm: float = math.nan
    variant: str = ""  # which form of the effect it is (play: "approach" or "load"); empty where there is one only
    sense: Sense = ""  # whether there is more of it there or less; empty where these recordings leave it open
    worse_sigmas: float = math.nan  # by how many standard errors ``taken_back_mm`` is the larger one; NaN where unknown

    @property
    def known_sense(self) -> Sense:
        """Whether there is more or less of it, by how large it is, or as what became of it says it; "" where open."""
        return self.sense or SENSE.get(self.kind, "")

    @property
    def is_less(self) -> bool:
        """Whether there is less of the cause where it changed, so that taking the change back would bring it again."""
        return self.known_sense == "less"

    @property
    def is_hidden(self) -> bool:
        """Whether there is more of it, and still to take it back alone surely takes the tool farther away."""
        return self.known_sense == "more" and self.worse_sigmas > COMPARING.clearly_worse

    @property
    def is_better_back(self) -> bool:
        """Whether to take it back surely brings the tool nearer, be there more of it or less."""
        return self.worse_sigmas < -COMPARING.clearly_worse

    @property
    def title_with_doubt(self) -> str:
        """The title, and that it is one of several: what these recordings don't tell apart is no finding."""
        if (others := len(self.alternatives)) > COMPARING.many_alike:
            return f"something that these recordings do not tell ({self.title} or one of {others} others)"
        doubt = f" (or one of {others} others that explain it as well)" if others > 1 else " (or another)" * others
        return f"{self.title}{doubt}"


@dataclass(frozen=True)
class Seen:
    """How far a joint's zero must move to be seen."""

    location: str
    # of moves of this size a change is named, by this name or another, in `COMPARING.power` of cases; infinite where
    # these rows show none
    least_rad: float


@dataclass(frozen=True)
class Left:
    """What is left of a recording, RMS per axis in mm, on all its rows that could be used."""

    frames_mm: float  # once base and tool of its own are placed
    shared_mm: float  # with what all recordings share, too
    changes_mm: float  # with the changes, too


@dataclass(frozen=True, repr=False)
class Comparison(InWords):
    """What changed."""

    arm: str
    names: tuple[str, ...]  # of the recordings, in their order
    rows: tuple[int, ...]
    noise_mm: float  # per axis, of what the shared model and the changes leave
    # the joint test: how often chance alone gives a cause that differs as much as the most different one, all that were
    # tried counted (Bonferroni)
    p_nothing_changed: float
    level: float  # below which changes are named
    tried: int  # how many causes times places to change were tried
    changes: tuple[Change, ...]
    # recordings that cover the same ranges of joints and payload: only among them is a change told
    same_poses: tuple[tuple[str, ...], ...] = ()
    left: tuple[Left, ...] = ()  # what is left of each recording, by what is explained
    seen: tuple[Seen, ...] = ()  # how far the zero of each joint must move to be seen, where nothing else changed
    of_arms: bool = False  # the recordings are of several arms, and a change is what one of them has otherwise
    other_load: str = ""  # that another load at the flange would look like the changes; "" where it would not
    noisier: tuple[Noisier, ...] = ()  # recordings of which more is left than of others, whatever is fitted
    bad_shots: tuple[BadShot, ...] = ()  # rows that lie far off whatever is fitted, and count for little
    points: tuple[MeasuredPoint, ...] = ()  # where the measured point of each recording sits on the flange
    left_out: str = ""  # what only some recordings hold, which is not looked at; "" where there is none

    def to_json(self) -> dict[str, Any]:
        """As plain data, null for what is no number."""
        content: dict[str, Any] = plain_values({"format": "armscope comparison 1", **asdict(self)})
        return content

    def sentences(self) -> tuple[str, ...]:
        """The answer, on which rows, and what says more."""
        rows = ", ".join(f"{name} ({count} rows)" for name, count in zip(self.names, self.rows, strict=True))
        about = f"{self.arm}: {rows}; noise {self.noise_mm:.3g} mm per axis."
        return self.headline, about, "text() says every change with its numbers, to_json() gives them as plain data."

    @property
    def headline(self) -> str:
        """The answer in one sentence."""
        p = self.p_nothing_changed
        chance = f"p = {p:.2g}" if p else "p < 1e-300"  # below what numbers hold; nothing is certain
        nothing = "all are alike" if self.of_arms else "nothing changed"
        said = f"{self.told} ({chance} that {nothing})." if self.changes else ""
        moved, a_zero = self.told_of_points, any(each.is_moved and each.may_be_zero for each in self.points)
        among = "; ".join(", ".join(family) for family in self.same_poses or (self.names,) if len(family) > 1)
        if not said and among and self.p_nothing_changed <= self.level:
            differs = "These arms differ" if self.of_arms else "Something changed"
            said = f"{differs} ({among}; {chance} that {nothing}), and no cause that was tried can be what it was."
        elif not said and among:
            few = self.of_arms and len(self.names) < COMPARING.enough_arms
            alike = "No arm is unlike the others" if self.of_arms else f"Nothing{' of the arm' * bool(moved)} changed"
            alike = "No cause differs" if self.noisier or (moved and a_zero) else alike
            said = f"{alike} that these recordings show ({among}; {chance}).{FEW_ARMS * few}"
        return " ".join(filter(None, (said, self.told_beside)))

    @property
    def told_beside(self) -> str:
        """What stands beside the changes, or in their place."""
        noisier = f"{told_of(self.noisier)} {self.left_out}".strip() if self.noisier else ""
        return " ".join(filter(None, (noisier, self.other_load, self.told_of_points, self.not_comparable)))

    @property
    def told_of_points(self) -> str:
        """Which measured points moved on the flange; of several arms, whose targets differ, nothing."""
        return "" if self.of_arms else told_of_points(self.points)

    @property
    def told(self) -> str:
        """What changed, as a clause; empty where nothing did."""
        clauses = [f"{each.title_with_doubt} {self.became(each)}" for each in self.changes[: WORDS.causes]]
        more = len(self.changes) - len(clauses)
        return capitalised("; ".join([*clauses, *([f"and {more} more"] if more > 0 else [])]))

    @property
    def would_be_seen(self) -> str:
        """From which size on a joint's zero that moved would most likely have been named; empty where unknown."""
        shown = [each for each in self.seen if math.isfinite(each.least_rad)]
        if not shown:
            return ""
        least, most = (pick(shown, key=lambda each: each.least_rad) for pick in (min, max))
        hidden = [each.location for each in self.seen if each not in shown]
        sizes = [f"{size_of(each.least_rad, 'rad')} ({each.location})" for each in dict.fromkeys((least, most))]
        told = f"The zero of a joint that {'differs' if self.of_arms else 'moved'} by {' to '.join(sizes)} or more"
        told = f"{told} would be noticed in {100 * COMPARING.power:.0f} % of cases."
        hides = f" Moves of {places_in_words(hidden)} would not: base or tool take them up, or the joint stood still."
        return told + hides * bool(hidden)

    @property
    def not_comparable(self) -> str:
        """Between which recordings nothing can be told; empty where all are of the same poses."""
        if len(self.same_poses) < 2:
            return ""
        families = " / ".join(", ".join(family) for family in self.same_poses)
        return (
            f"Poses or payloads differ between {families}, so whether anything "
            f"{'differs' if self.of_arms else 'changed'} from one to the other cannot be told: "
            "record the same poses with the same payload again."
        )

    def became(self, change: Change) -> str:
        """What became of a cause, and where: "grew in after"; of arms, how one differs from the others."""
        later = len(change.where) - 1
        first, *_ = where = [f'"{name}"' for name in change.where]
        told_where = enumerated(where) if later < COMPARING.named else f"{first} and the {later} after it"
        if not self.of_arms:
            return f"{change.kind}{_by(change)} in {told_where}{' alone' * bool(self.over_in(change))}"
        told = f'"{change.against[0]}"' if len(change.against) == 1 else "the others"
        return UNLIKE[change.kind].format(where=told_where, others=told, by=_by(change))

    def over_in(self, change: Change) -> str:
        """The recording from which a change is over; empty where it lasts, and of arms."""
        return "" if self.of_arms else change.until

    def text(self) -> str:
        """In words, a line per cause and number."""
        lines = [self.headline, *([] if self.changes else [self.would_be_seen] * bool(self.would_be_seen))]
        lines.append(f"noise {self.noise_mm:.3g} mm per axis, {self.tried} possible changes tried")
        lines += filter(None, [told_of_shots(self.bad_shots), "" if self.noisier else self.left_out])
        for each in self.changes:
            kind = self.became(each) if self.of_arms else each.kind
            lines.append(f"{each.title}, {', '.join(each.where)}: {kind}, moves the tool by {each.rms_mm:.3g} mm")
            moments = moments_of(each)
            lines += [f"  {number_line(number)}" for number in each.parameters if number not in moments]
            lines += [f"  {moments_in_words(each.location, len(moments))}"] * bool(moments)
            if each.alternatives:
                lines.append(f"  these recordings do not distinguish it from: {', '.join(each.alternatives)}")
        return "\n".join(lines)


def _by(change: Change) -> str:
    """By how much, where one number says it."""
    if change.kind != "changed" or len(change.parameters) != 1:
        return ""
    return f" by {size_of(change.parameters[0].difference, change.parameters[0].unit, sign=True)}"


def moments_of(change: Change) -> tuple[Valued, ...]:
    """A drive's numbers that are told as one: of each it is not known how much is compliance and how much is mass."""
    numbers = tuple(each for each in change.parameters if each.name.startswith(MOMENT))
    return numbers if len(numbers) > 1 else ()


def moments_in_words(location: str, count: int) -> str:
    """What a drive's products of compliance and mass moments are."""
    return (
        f"{count} numbers tell how {location} gives way to what it carries, whose masses need not be as stated: each "
        "is the drive's compliance times the mass moment of one combination of links."
    )
