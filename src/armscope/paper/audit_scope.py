"""What the audit searches, in words, and whether that is enough to say that there is no path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Corner = tuple[float, float, float]


@dataclass(frozen=True)
class LeastSearch:
    """Below any of these nothing found does not mean that there is nothing."""

    corner_samples: int = 1000  # sets of corners; measured: 4,096 and 40,000 of them give the same answers
    # between rises; measured: steps of 750 mm miss paths on trajectory III that steps of 20 mm find
    step_mm: float = 50.0
    # up and down; judgement: a path that rises as far as an arm of this size reaches to one side
    rise_mm: float = 1000.0
    side_mm: float = 3000.0  # of the box; judgement: the same to either side


LEAST = LeastSearch()


@dataclass(frozen=True)
class AuditScope:
    """What is scanned, mm. The box bounds where a tool of this arm can be at all (`assumed`; see `armscope.robot`)."""

    # values tried for the change of the third coordinate of trajectories II and III
    rises: tuple[float, ...] = tuple(float(rise) for rise in np.arange(-1500, 1501, 20))
    # low, high: box of the corners of trajectory I and of the identification poses
    low: Corner = (-2500.0, -2500.0, -1500.0)
    high: Corner = (2500.0, 2500.0, 3000.0)
    corner_samples: int = 4096  # sets of three corners tried for trajectory I
    first_corner: Corner = (1100.0, 800.0, 600.0)
    spiral_starts: tuple[Corner, ...] = ((1200.0, -600.0, 600.0), (500.0, 500.0, 1400.0))
    seed: int = 2006  # of the corner sets
    search_generations: int = 100  # of the search for the best corners, where none of the samples obeys

    @property
    def in_words(self) -> str:
        """Box, sets of corners, and rises."""
        box = " to ".join(f"({', '.join(f'{value:.0f}' for value in corner)})" for corner in (self.low, self.high))
        rises = f"{len(self.rises)} rises from {min(self.rises):.0f} to {max(self.rises):.0f} mm"
        sets = f"{self.corner_samples} {'set' if self.corner_samples == 1 else 'sets'} of corners"
        return f"{sets} in a box from {box} mm, and {rises}"

    @property
    def thorough(self) -> bool:
        """Whether it is at least the least search, and its box holds what is printed."""
        low, high, printed = np.array(self.low), np.array(self.high), np.array([self.first_corner, *self.spiral_starts])
        rises = np.sort(self.rises)
        return bool(
            self.corner_samples >= LEAST.corner_samples
            and min(-rises[0], rises[-1]) >= LEAST.rise_mm
            and np.diff(rises).max() <= LEAST.step_mm
            and (high - low).min() >= LEAST.side_mm
            and ((low <= printed) & (printed <= high)).all()
        )
