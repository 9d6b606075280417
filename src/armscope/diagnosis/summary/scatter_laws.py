"""What scatter of a joint grows with: its load, or what the arm may carry unsaid.

A joint that gives way differently from row to row scatters by more the more it is loaded; one that is loose does not.
A load that nobody recorded moves whatever gives way, by what a kilogram does to it in that pose. All three differ in
how large the scatter is where, which the residuals tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.fitting.joint_scatter import Scattered, gain_of_law, motor_jacobians
from armscope.measurement.noise import relative_uncertainty
from armscope.physics.effect import Driver, Product, motor
from armscope.physics.payload import what_bears
from armscope.physics.scene import Posture
from armscope.recordings import Recordings
from armscope.verdict.effects import Parameter

CONFIRM_GIVE = (
    "Hang a known weight on the arm and take it off again, cold and warm, early and late: does {location} give way by "
    "the same each time?"
)
CURE_GIVE = (
    "Find what changes how {location} gives way (warmth, loose bolts, a clamp that slips) before it is compensated: a "
    "compliance that holds for some rows only corrects these only."
)
CONFIRM_LOAD = "Ask who recorded the rows what the arm carried in each (a workpiece, a gripper, a target's holder)."
CURE_LOAD = (
    "State in column payload_kg what the arm carried in each row, and diagnose again: it is no error of the arm."
)


@dataclass(frozen=True)
class ScatterLaw:
    """What scatter of a joint grows with."""

    told: tuple[Parameter, ...]  # its size
    title: str  # the name of what scatters so
    # physics, confirm, cure: for people
    physics: str
    confirm: str
    cure: str


def law_of_scatter(state: DiagnosisState, scattered: Scattered) -> ScatterLaw | None:
    """What the scatter of a joint grows with, where the residuals tell it clearly.

    Args:
        state: the finished selection.
        scattered: at which joint, and by how much.

    Returns:
        The law that suits best; None where scatter that is alike in all rows is as likely.
    """
    fit, model, rows = state.fit, state.fit.model, spread_evenly(len(state.recordings), LOOP.scatter_rows)
    recordings = state.recordings.rows(rows)
    posture = model.posture(model.scene(recordings))
    elastic = [part for part in model.parts if part.placed.parametrisation == "plain"]
    give = _moved(posture, [Product(motor(scattered.motor), Driver("torque", (scattered.motor,)))])
    bearing = what_bears(recordings, elastic)
    load = _moved(posture, [Product(p.direction, Driver("heavier", (p.driver,)), p.factor) for p in bearing])
    load[_load_is_said(recordings)] = 0.0
    relative = relative_uncertainty(recordings, fit.noise)[:, None]
    left, moved, least = fit.residuals[rows], motor_jacobians(model, recordings), state.noise.least_mm
    (more, by_give), (unsaid, by_load) = (
        gain_of_law(left / relative, moved / relative, state.scatter, scattered.motor, along / relative, least)
        for along in (give, load)
    )
    if max(more, unsaid) < TELLING.law_of_scatter_nats:
        return None
    place, uncertain = f"joint {scattered.motor}", 1 / np.sqrt(2 * len(rows))
    if unsaid > more:
        return ScatterLaw(
            (Parameter("unsaid_load", "kg", by_load, by_load * uncertain),),
            f"scatter at {place} as if the load changed from row to row",
            f"What {place} leaves grows with what a kilogram on the tool would do to it: the arm seems to carry "
            "something else from row to row, which no column of the table tells.",
            CONFIRM_LOAD,
            CURE_LOAD,
        )
    return ScatterLaw(
        (Parameter("give", "rad/(N m)", by_give, by_give * uncertain),),
        f"{place} gives way by more in some rows than in others",
        f"What {place} leaves grows with its load: it gives way by more in some rows than in others.",
        CONFIRM_GIVE.format(location=place),
        CURE_GIVE.format(location=place),
    )


def _load_is_said(recordings: Recordings) -> NDArray[np.bool_]:
    """(N,) rows of which the table tells what was carried; one load throughout may be a template's."""
    payload = np.full(len(recordings), np.nan) if recordings.payload is None else recordings.payload
    said = np.isfinite(payload)
    return said if len(np.unique(payload[said])) > 1 else np.zeros_like(said)


def _moved(posture: Posture, products: Sequence[Product]) -> Array:
    """(N, 3) mm by which one unit of some products together moves the tool, base axes."""
    moved = np.zeros((len(posture.scene), 3))
    for product in products:
        displacement = posture.displacement(product.direction)
        if displacement is not None:
            moved += displacement * (1e3 * product.factor * posture.scene.driver(product.driver))[:, None]
    return moved
