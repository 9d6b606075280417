"""Chosen poses as a notebook shows them."""

from __future__ import annotations

from armscope.core.told import InWords
from armscope.poses.choose import Choice


class ChosenPoses(InWords, Choice):
    """A `Choice` with what a notebook shows of it."""

    def sentences(self) -> tuple[str, ...]:
        """How many of how many, for what, how well, and what to call next."""
        hidden = self.targets.hidden
        return (
            f"{len(self.rows)} poses of {self.targets.arm.name} out of {len(self.candidates.table)} possible ones.",
            f"They show {', '.join(self.effects)}: {len(self.targets.names)} parameters with base and tool, "
            f"observability index {self.index} {self.indices[self.index]:.3g} (the more, the better).",
            *([f"Not told apart by any poses: {', '.join(hidden)}."] if hidden else []),
            "table has them in the order to measure (motor_angles in rad), indices has O1 to O5.",
        )
