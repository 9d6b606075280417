"""Between which times and temperatures a diagnosed model is known, and what stands in for it beyond them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.compensation.constants import RANGE
from armscope.compensation.physical import Identified, kinds_of
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.physics.effect import Part
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings

HOURS, WARMTH = "hours", "warmth"


def beyond_time(model: FittedModel, identified: Identified, rows: Recordings) -> NDArray[np.bool_]:
    """(N,) rows at times at which nobody knows what moves with the time.

    A steady drift may be continued by a tenth of what was recorded; a curve ends with its recordings.

    Args:
        model: of a diagnosis.
        identified: what its recordings held.
        rows: of the path.

    Returns:
        (N,) whether a row's time is beyond; all False where nothing follows the time.
    """
    drifting = over_time(model)
    if not drifting or identified.time_s is None or rows.time is None:
        return np.zeros(len(rows), dtype=bool)
    first, last = identified.time_s
    curved = any(part.placed.parametrisation == "curve" for part in drifting)
    slack = 0.0 if curved else RANGE.time * (last - first)
    return np.asarray((rows.time < first - slack) | (rows.time > last + slack))


def over_time(model: FittedModel) -> list[Part]:
    """The effects of a model that go on with the time: drifts, and curves of it."""
    return [part for part in model.everything if HOURS in kinds_of(part)]


def held_in_time(model: FittedModel, identified: Identified, rows: Recordings) -> tuple[Recordings, list[str]]:
    """Rows whose drifts stand still at the end of what is known of them, and what to say of it.

    What moved with the time of the recordings need not have gone on: a base that drifted by a third of a millimetre
    per hour was foretold five millimetres away on the day after.

    Args:
        model: of a diagnosis.
        identified: what its recordings held.
        rows: to be predicted.

    Returns:
        The rows, those beyond at the nearest time of the recordings; and a note, or none.
    """
    beyond = beyond_time(model, identified, rows)
    if not beyond.any():
        return rows, []
    assert rows.time is not None
    assert identified.time_s is not None
    known = _from_to(np.array(identified.time_s))
    note = (
        f"{_rows(beyond)} at time_s {_from_to(rows.time[beyond])}, where nobody knows {_names(over_time(model))}: held "
        f"as at the nearest end of the recordings (time_s {known}). It need not have stood still since: measure again"
    )
    return replace(rows, time=np.where(beyond, np.clip(rows.time, *identified.time_s), rows.time)), [note]


def beyond_recorded(model: FittedModel, identified: Identified, rows: Recordings) -> list[str]:
    """What to say of rows outside the range of angles, payload and temperature of a model's recordings.

    Args:
        model: of a diagnosis.
        identified: what its recordings held.
        rows: to be predicted.

    Returns:
        A note, or none.
    """
    domain = identified.domain
    if domain.mean.size < rows.n_motors:
        return []
    distance, what = domain.outside(identified.inputs(rows.motor_angles, rows))
    beyond = distance > domain.allowed
    if not beyond.any():
        return []
    names, counts = np.unique(what[beyond].astype(str), return_counts=True)
    most = names[np.argmax(counts)]
    curves = [p for p in model.everything if p.placed.parametrisation == "curve" and WARMTH in kinds_of(p)]
    held = most == "temperature_c" and curves
    stands = f"{_names(curves)} held as at the nearest end of what was recorded" if held else "the model is continued"
    return [f"{_rows(beyond)} outside the range of the model's recordings (most of all by {most}): {stands}"]


def _names(parts: Iterable[Part]) -> str:
    """Effects, each with its place, once."""
    names = (f"{each.placed.name.replace('_', ' ')} at {each.placed.location}" for each in parts)
    return enumerated(list(dict.fromkeys(names)))


def _rows(which: NDArray[np.bool_]) -> str:
    count = int(which.sum())
    return f"{count} of {len(which)} rows {'is' if count == 1 else 'are'}"


def _from_to(values: Array) -> str:
    return f"{values.min():.6g} to {values.max():.6g}"
