"""What claims are judged on: the errors that one method's fits leave on every robot, and what needs no swarm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.measurements import Measurements
from armscope.paper.printed import PRINTED_MODELS, TEST_TRAJECTORIES, printed_table2
from armscope.paper.residuals import SPATIAL, spatial_rms

AS_PRINTED, IMPROVED, LEAST_SQUARES = "as printed", "improved", "least squares"
"""The paper's method as it prints it; with the configured swarm; and what needs no swarm."""


@dataclass(frozen=True)
class Judged:
    """One claim's outcome: yes or no and a number per robot, and the number that Table 2 itself gives."""

    per_robot: NDArray[np.bool_]
    numbers: Array
    printed: float = float("nan")


@dataclass(frozen=True, eq=False)
class Evidence:
    """Robots in the order of the rows of ``cells``."""

    cells: pd.DataFrame  # RMS errors by robot (rows) and (model, trajectory, axis), mm
    by_least_squares: pd.DataFrame  # the same of the least-squares fits
    fits: Sequence[SwarmFit]  # one per robot and model, by swarm
    random: Sequence[SwarmFit] = ()  # the same by random search with as many evaluations; empty where it was not run
    sub_volumes: pd.DataFrame = field(default_factory=pd.DataFrame)  # see `armscope.paper.outlook`
    outlook: pd.DataFrame = field(default_factory=pd.DataFrame)  # see `armscope.paper.outlook.outlook`
    poses: pd.DataFrame = field(default_factory=pd.DataFrame)  # see `armscope.paper.enough_poses`

    @staticmethod
    def of(measurements: Measurements, fits: Sequence[SwarmFit], random: Sequence[SwarmFit] = ()) -> Evidence:
        """From the fits of one method.

        Args:
            measurements: of a study.
            fits: of one method.
            random: of random search beside them.

        Returns:
            The evidence.
        """
        cells = spatial_rms(measurements, fits)
        return Evidence(cells, spatial_rms(measurements, fits, least_squares=True), fits, random)

    @property
    def robots(self) -> list[str]:
        """Their names."""
        return [str(name) for name in self.cells.index]

    @cached_property
    def models(self) -> tuple[str, ...]:
        """The fitted models."""
        return tuple(dict.fromkeys(fit.name for fit in self.fits))

    @property
    def papers_models(self) -> tuple[str, ...]:
        """Those that the paper fits by swarm, as far as they are among the models."""
        return tuple(name for name in PRINTED_MODELS if name in self.models)

    def spatial(self, model: str, trajectory: str, least_squares: bool = False) -> Array:
        """(R,) 3D RMS error, mm.

        Args:
            model: which.
            trajectory: which.
            least_squares: of the least-squares fit instead of the method's.

        Returns:
            (R,) mm, one per robot.
        """
        table = self.by_least_squares if least_squares else self.cells
        return np.asarray(table[model, trajectory, SPATIAL], dtype=float)

    def over_tests(self, model: str, least_squares: bool = False) -> Array:
        """(R,) 3D RMS over the held-out trajectories, each with the same weight (they have equally many points), mm."""
        squares = [self.spatial(model, name, least_squares) ** 2 for name in TEST_TRAJECTORIES]
        return np.asarray(np.sqrt(np.mean(squares, axis=0)))

    def by_robot(self, table: pd.DataFrame) -> pd.DataFrame:
        """A table's rows in the order of the robots."""
        return table.reindex(self.cells.index)


def printed_cells() -> pd.Series:
    """Table 2 by (model, trajectory, axis)."""
    return printed_table2().set_index(["model", "trajectory", "axis"])["printed"]


def printed_spatial() -> pd.Series:
    """3D length of Table 2's x, y, z errors by (model, trajectory)."""
    return (printed_cells() ** 2).groupby(["model", "trajectory"]).sum() ** 0.5
