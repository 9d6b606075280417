"""Chosen poses as a notebook shows them."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import pandas as pd

from armscope.core.told import InWords
from armscope.notebook.given import refuse_unknown
from armscope.poses.choose import Choice
from armscope.poses.compare import RivalOptions
from armscope.poses.obstacles import surroundings_notes
from armscope.poses.options import PoseOptions
from armscope.robot import Arm


@dataclass(frozen=True, eq=False, repr=False)
class ChosenPoses(InWords, Choice):
    """A `Choice` with what a notebook shows of it.

    Attributes:
        compared: the choice against random poses and a grid, a row per simulated arm and set; None if not asked for.
    """

    compared: pd.DataFrame | None = None

    def sentences(self) -> tuple[str, ...]:
        """How many of how many, for what, how well, and what to call next."""
        hidden = self.targets.hidden
        return (
            f"{len(self.rows)} poses of {self.targets.arm.name} out of {len(self.candidates.table)} possible ones.",
            f"They show {', '.join(self.effects)}: {len(self.targets.names)} parameters with base and tool, "
            f"observability index {self.index} {self.indices[self.index]:.3g} (the more, the better).",
            *([f"Not told apart by any poses: {', '.join(hidden)}."] if hidden else []),
            "table has them in the order to measure (motor_angles in rad), indices has O1 to O5"
            f"{', compared what they are worth' if self.compared is not None else ''}.",
        )


def poses_by_options(arm: Arm, count: int, options: dict[str, Any]) -> tuple[ChosenPoses, tuple[str, ...]]:
    """Poses by the names of the command line, and the notes that the command prints.

    Args:
        arm: the nominal arm.
        count: how many to measure.
        options: of `PoseOptions` and `RivalOptions`.

    Returns:
        The poses and the notes.

    Raises:
        InputError: an option that there is not, or that can't be used.
    """
    of_rivals = [each.name for each in fields(RivalOptions)]
    refuse_unknown("choose_poses", options, [*(each.name for each in fields(PoseOptions)), *of_rivals])
    rivals = RivalOptions(**{name: value for name, value in options.items() if name in of_rivals})
    asked = PoseOptions(**{name: value for name, value in options.items() if name not in of_rivals})
    choice = asked.choose(arm, count)
    found = ChosenPoses(**vars(choice), compared=rivals.compare(choice, asked))
    return found, tuple(surroundings_notes(arm, choice.around))
