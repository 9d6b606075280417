"""A cause with what was fitted of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import PlacedCause


@dataclass(frozen=True, eq=False)
class FittedCause:
    """A placed cause with the values (c,) of its parameters, SI, and their covariance (c, c)."""

    placed: PlacedCause
    values: Array
    covariance: Array

    @property
    def stderr(self) -> Array:
        """(c,) standard errors."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))
