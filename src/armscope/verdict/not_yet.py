"""What a verdict offers whose model makes the error larger: nothing to change, only what to confirm."""

from __future__ import annotations

from dataclasses import replace

from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.sentences import makes_worse

NOT_YET = (
    "Change nothing and correct no commands yet: the model with these names meets the rows worse than base and tool "
    "alone. Confirm each by itself at the arm, or measure more rows."
)
"""In place of every cure, where the whole model makes the error larger."""


def curing_only_what_helps(verdict: Diagnosis) -> Diagnosis:
    """The verdict; without any cause's or effect's cure where its model makes the error larger."""
    if not makes_worse(verdict):
        return verdict
    causes = tuple(replace(cause, cure=NOT_YET) for cause in verdict.causes)
    return replace(verdict, causes=causes, effects=tuple(replace(e, cure=NOT_YET) for e in verdict.effects))
