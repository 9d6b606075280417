"""Something in a table that a user should look at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from armscope.core.inputs import InputError

GRAVITY = "gravity"  # Kind of a suspicion about which way gravity is stated to point

APPROACH = "approach"  # Kind of a suspicion about the sign of a column of the side of approach

SETTLED = "settling"  # Kind of a suspicion that angles and points were not taken at one moment

ORIENTED = "orientations"
"""Kind of a suspicion about measured orientations: nobody needs them, and what is not the tool's is left out."""

BESIDE = (GRAVITY, APPROACH, SETTLED, ORIENTED)  # Kinds of what stands above a diagnosis, which is made all the same

TOO_SHORT = "too short"  # Kind of a problem with which nothing can be diagnosed, whatever a user asks for


@dataclass(frozen=True)
class Suspicion:
    """A "problem" makes results meaningless, a "hint" may be as it should; ``kind``: what a notice of it is called."""

    weight: Literal["problem", "hint"]
    statement: str
    cure: str = ""
    kind: str = "check"

    def text(self) -> str:
        """In words."""
        return f"{self.statement}. {self.cure}".strip() if self.cure else f"{self.statement}."


def verdict_lines(suspicions: tuple[Suspicion, ...]) -> list[str]:
    """Suspicions in words, problems first."""
    if not suspicions:
        return ["nothing looks wrong"]
    ordered = sorted(suspicions, key=lambda each: each.weight != "problem")
    return [f"{each.weight}: {each.text()}" for each in ordered]


SAYS_MORE = "text() says all that was seen, to_json() gives it as plain data."


def first_of_suspicions(suspicions: tuple[Suspicion, ...]) -> str:
    """The gravest one in a sentence, and how many there are beside it."""
    first, *others = verdict_lines(suspicions)
    told = f"{first[0].upper()}{first[1:]}"
    told = told if told.endswith((".", "?")) else f"{told}."
    return f"{told} And {len(others)} more." if others else told


def refuse_problems(suspicions: Sequence[Suspicion], source: object, anyway: str = "diagnoses") -> None:
    """Where something makes results meaningless, none are made.

    Args:
        suspicions: what looks wrong.
        source: in which table.
        anyway: what --anyway does with it all the same.

    Raises:
        InputError: there is a problem among them.
    """
    problems = [each for each in suspicions if each.weight == "problem"]
    if problems:
        more = f" ({len(problems) - 1} more: see `armscope check`)" if len(problems) > 1 else ""
        go_on = "" if problems[0].kind == TOO_SHORT else f"--anyway {anyway} it all the same."
        cure = f"{problems[0].cure} {go_on}".strip()
        raise InputError(source, "", problems[0].statement, f"no result of it would hold{more}", cure)
