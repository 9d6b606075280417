"""What poses are asked for, by the names of the command line: `armscope poses`, and `choose_poses` in Python."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.design.indices import SOURCES
from armscope.poses.choose import Choice, choose
from armscope.poses.constants import CHOOSING
from armscope.poses.obstacles import Surroundings
from armscope.poses.target_parameters import GEOMETRY
from armscope.robot import Arm


@dataclass(frozen=True)
class PoseOptions:
    """How poses are chosen.

    Attributes:
        effects: what they must show, names apart or with commas in one text: "geometry", or causes.
        criterion: how they are judged: O1 (D-optimal), O2, O3, O4 or O5.
        tracker: x, y, z, mm, base frame, of a tracker that must see the tool; as on the command line, or three numbers.
        floor_mm: height of the floor in the base frame; None: the arm may reach below its base.
        radius_mm: of the links; None: the URDF's shapes, or 4 % of the reach.
        payload_kg: that half of the poses may carry.
        candidates: possible poses to choose from.
        starts: that the search makes.
        seed: of candidates and starts.
    """

    effects: str | Sequence[str] = GEOMETRY
    criterion: str = "O1"
    tracker: str | Sequence[float] | None = None
    floor_mm: float | None = None
    radius_mm: float | None = None
    payload_kg: float = 0.0
    candidates: int = CHOOSING.candidates
    starts: int = CHOOSING.starts
    seed: int = 0

    @property
    def names(self) -> tuple[str, ...]:
        """What must show, name by name."""
        given = self.effects.split(",") if isinstance(self.effects, str) else self.effects
        return tuple(name.strip() for name in given if name.strip())

    def around(self) -> Surroundings:
        """Floor, tracker and body, SI units. Raises InputError: the tracker is nowhere."""
        radius, floor = (None if each is None else each * 1e-3 for each in (self.radius_mm, self.floor_mm))
        return Surroundings(radius, floor, None if self.tracker is None else _place(self.tracker))

    def choose(self, arm: Arm, count: int) -> Choice:
        """The poses; see `armscope.poses.choose.choose`.

        Raises:
            InputError: an option that can't be used, or too few possible poses.
        """
        if self.criterion not in SOURCES:
            rule = "O1, O2, O3, O4 or O5"
            raise InputError("--criterion", "", self.criterion, rule, nearest(self.criterion, SOURCES))
        around = self.around()
        return choose(
            arm, count, around, self.names, self.criterion, self.candidates, self.payload_kg, self.seed, self.starts
        )


def _place(tracker: str | Sequence[float]) -> Array:
    """(3,) m. Raises InputError: it is not three numbers."""
    parts = tracker.split(",") if isinstance(tracker, str) else tracker
    try:
        place = np.array([float(part) for part in parts]) * 1e-3
    except (TypeError, ValueError) as error:
        raise InputError("--tracker", "", tracker, "x,y,z in mm: three numbers") from error
    if place.shape != (3,) or not np.isfinite(place).all():
        raise InputError("--tracker", "", tracker, "x,y,z in mm: three numbers")
    return place
