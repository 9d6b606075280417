"""Something in a table that a user should look at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


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
