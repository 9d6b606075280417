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
    """The verdict; without any cause's or effect's cure where its model makes the error larger.

    What scatters keeps its own: it changes nothing but what is recorded, and no model foretells scatter anyway.
    """
    if not makes_worse(verdict):
        return verdict
    loose = {each.as_member for each in verdict.effects if each.scatters}
    causes = tuple(each if loose.issuperset(each.members) else replace(each, cure=NOT_YET) for each in verdict.causes)
    effects = tuple(each if each.scatters else replace(each, cure=NOT_YET) for each in verdict.effects)
    return replace(verdict, causes=causes, effects=effects)
