"""How well torque is met on motion that took no part, and what that says of names."""

from __future__ import annotations

import math
from dataclasses import dataclass

from armscope.core.words import rounded
from armscope.motion.constants import PRIOR
from armscope.motion.summary.constants import HELD_OUT, NAMING

ON_HELD_OUT = "On held-out motion"
"""How the sentence of a headline begins that says how well torque is met."""


@dataclass(frozen=True)
class HeldOutErrors:
    """Of torque on motion that took no part, relative to it."""

    without: float  # with friction and rotors alone
    anew: float  # with causes found without that motion
    named: float  # with the causes that all of the motion names, their sizes found without it
    masses: float = 0.0  # share of a link's mass, and so on, by which those are off that have no name
    # share of what friction and rotors leave that these add to what has a name, in the motion fitted
    by_masses: float = 0.0
    fitted: float = 0.0  # with the causes, on the motion fitted; 0 where it plays no part
    # runs that the user held out and that are met far worse than that, each with its error
    badly: tuple[tuple[str, float], ...] = ()

    @property
    def worse(self) -> bool:
        """Whether causes that are found anew help nothing."""
        return self.anew >= self.without

    @property
    def only_unnamed(self) -> bool:
        """Whether masses that are off without a name help: what else is free of every name helps hardly at all.

        Where these add what anybody would look for, and are off by more than a drawing and a scale leave, any help will
        do: they may matter at one joint of three.
        """
        matter = self.by_masses >= HELD_OUT.little_share and self.masses >= NAMING.far_off * PRIOR.inertial_shares[1]
        least = HELD_OUT.any_better if matter else HELD_OUT.clearly_better
        return self.masses > 0 and self.named < least * self.without

    @property
    def foretells_nothing(self) -> bool:
        """Whether the model foretells the torque no better than a torque of zero would."""
        return self.anew >= 1

    @property
    def useless(self) -> bool:
        """Whether it makes no difference, found anew or not."""
        return self.worse and self._alike and self.named > HELD_OUT.any_better * self.without

    @property
    def no_answer(self) -> bool:
        """Whether the named ones don't clearly help either; at all, where found anew they do as well as none."""
        return self.useless if self._alike else self.worse and self.named > HELD_OUT.clearly_better * self.without

    @property
    def badly_words(self) -> str:
        """Which runs are met badly, without the end of a sentence."""
        (first, error), *others = self.badly
        runs = [f"run {first} is met to {rounded(100 * error)} %"]
        runs += [f"run {run} to {rounded(100 * error)} %" for run, error in others]
        return f"{', '.join(runs)}, where the motion that was fitted is met to {rounded(100 * self.fitted)} %"

    @property
    def _alike(self) -> bool:
        return self.anew <= HELD_OUT.as_good_anew * self.without

    def words(self, causes: bool = True) -> str:
        """How well torque is met, in a sentence; where no causes were told, not by them."""
        digits = 2 if _told_by(2, self.named) != _told_by(2, self.without) else 3
        without, anew, named = (_told_by(digits, error) for error in (self.without, self.anew, self.named))
        if named == without and (named == anew or not causes):
            return f"{ON_HELD_OUT} the torque is met to {_told_by(2, self.without)} by friction and rotors alone."
        if named == anew:
            return f"{ON_HELD_OUT} the torque is met to {named} instead of {without}."
        by, too = ("these causes", "the causes, too, are") if causes else ("what is fitted along", "that, too, is")
        told = f"{ON_HELD_OUT} the torque is met to {named} instead of {without} by {by}"
        return f"{told}; to {anew} where {too} found without it."


def _told_by(digits: int, error: float) -> str:
    if digits == 2 or error <= 0:
        return f"{rounded(100 * error)} %"
    return f"{100 * error:.{max(digits - 1 - math.floor(math.log10(100 * error)), 0)}f} %"
