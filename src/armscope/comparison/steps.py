"""What changed more than once, told from recording to recording: each change against the recording just before."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.comparison.dispersion import Possible


def as_steps(taken: Sequence[Possible], possible: Sequence[Possible]) -> list[Possible]:
    """The same changes, those of one effect as steps from one of the recordings on where these are as many.

    A zero that wears on is larger in each recording than in the one before. "From the third on" and "in the second
    alone" say the same of three recordings, but the second has less of it than the third, and seemed repaired.
    """
    told = list(taken)
    for number in dict.fromkeys(each.number for each in taken):
        alike = [each for each in taken if each.number == number]
        steps = _steps(alike, [each for each in possible if each.number == number])
        if len(alike) > 1 and len(steps) == len(alike):
            told = [each for each in told if each.number != number] + steps
    return told


def _steps(alike: Sequence[Possible], possible: Sequence[Possible]) -> list[Possible]:
    """From each recording on that has not what the one before it has; none where one of them may not be named."""
    family = sorted({*alike[0].sets, *alike[0].against})
    if any(sorted({*each.sets, *each.against}) != family for each in alike):
        return []
    states = [tuple(k in each.sets for each in alike) for k in family]
    later = [tuple(family[at:]) for at in range(1, len(family)) if states[at] != states[at - 1]]
    found = {each.sets: each for each in possible if each.sets in later}
    return [found[sets] for sets in later] if len(found) == len(later) else []
