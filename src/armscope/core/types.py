"""Names of types that every room uses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, WithJsonSchema

Array: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]
Progress: TypeAlias = Callable[[str, float], None]  # Called with a sentence and the share of the work done, 0 ... 1


def unheard(*told: object) -> None:
    """Progress that nobody listens to."""


Number = Annotated[
    float,
    BeforeValidator(lambda value: np.nan if value is None else value),
    WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "null"}]}),
]
"""A number that may not be known: NaN, null in a file."""
