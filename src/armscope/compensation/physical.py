"""What diagnosed physics needs before it may be used: where it was identified, and the context that it follows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armscope.compensation.constants import MOMENTS
from armscope.compensation.domain import Domain
from armscope.compensation.file_contents import IdentifiedContent
from armscope.core.files import read_json, write_json
from armscope.core.inputs import InputError, mapping, validate
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.physics.drivers import KINDS, kinds_in
from armscope.physics.effect import Part
from armscope.physics.frames import TOOL_FRAME, tool_key
from armscope.physics.model import FittedModel
from armscope.physics.recorded_drivers import COLUMNS
from armscope.recordings import Recordings
from armscope.robot import Arm, Chain, chain
from armscope.robot.gravity import gravity_torques, mass_moment_regressor

FORMAT = "armscope domain 1"
FILE = "domain.json"
WHAT = "domain.json of `armscope diagnose`"


@dataclass(frozen=True, eq=False)
class Identified:
    """The recordings that a physical model was found on."""

    arm: str  # the arm's name
    domain: Domain  # range of motor angles, and of payload and temperature where recorded
    # whether rows carried a payload, and which one where it never changed: None for no column
    payload_kg: tuple[float, float] | None
    time_s: tuple[float, float] | None = None  # first and last, where recorded
    # (m, p) recorded torque of each motor by the static torque regressor, where recorded
    torque_weights: Array | None = None
    payload_left_out: bool = False  # whether some rows stated no payload where others did: the model took it for none
    # how well rows that took no part were met, RMS of the distance, noise included; None: not known
    held_out_mm: float | None = None
    many_fit_nothing: bool = False  # whether more of the rows fit nothing of the model than bad shots would

    def inputs(self, angles: Array, rows: Recordings) -> Array:
        """(N, k) the domain's inputs at motor angles (N, m) rad; context that is not stated counts as usual."""
        context = {"payload_kg": rows.payload, "temperature_c": rows.temperature}
        columns = [angles]
        for name in self.domain.inputs[angles.shape[1] :]:
            values = context[name]
            known = np.full(len(rows), np.nan) if values is None else values
            columns.append(np.where(np.isnan(known), self.domain.value(name), known)[:, None])
        return np.concatenate(columns, axis=1)

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "format": FORMAT,
            "robot": self.arm,
            "payload_kg": None if self.payload_kg is None else list(self.payload_kg),
            **({"payload_left_out": True} if self.payload_left_out else {}),
            "time_s": None if self.time_s is None else list(self.time_s),
            **({} if self.held_out_mm is None else {"held_out_mm": self.held_out_mm}),
            **({"many_fit_nothing": True} if self.many_fit_nothing else {}),
            "torque_weights": None if self.torque_weights is None else self.torque_weights.tolist(),
            "domain": self.domain.to_dict(),
        }


def identified_on(
    arm: Arm, recordings: Recordings, per_axis_mm: float = np.nan, many_fit_nothing: bool = False
) -> Identified:
    """What the recordings of a diagnosis say about where its model holds.

    Args:
        arm: the nominal arm.
        recordings: as the diagnosis used them.
        per_axis_mm: RMS per axis on rows that took no part; NaN where it is not known.
        many_fit_nothing: whether more of the rows fit nothing of the model than bad shots would.

    Returns:
        The range of angles and context, and how well the model foretells there.

    Raises:
        InputError: the recordings are of another arm.
    """
    recordings.check_motors(arm.name, arm.n_motors)
    names = [*(f"q{motor}" for motor in range(1, arm.n_motors + 1)), "payload_kg"]
    units = [*(["rad"] * arm.n_motors), "kg"]
    columns = [recordings.motor_angles, _payload(recordings)[:, None]]  # what was never recorded was never carried
    temperature = recordings.temperature
    if temperature is not None and not np.isnan(temperature).all():
        names, units = [*names, "temperature_c"], [*units, "degC"]
        columns.append(np.where(np.isnan(temperature), np.nanmean(temperature), temperature)[:, None])
    domain = Domain.of(np.concatenate(columns, axis=1), names, units)
    empty = np.zeros(1) if recordings.payload is None else np.isnan(recordings.payload)
    left_out = 0 < np.mean(empty) < 1
    known = float(np.sqrt(3) * per_axis_mm) if np.isfinite(per_axis_mm) else None
    spans, weights = (_span(recordings.payload), _span(recordings.time)), _torque_weights(arm, recordings)
    return Identified(arm.name, domain, *spans, weights, bool(left_out), known, many_fit_nothing)


def _span(values: Array | None) -> tuple[float, float] | None:
    """Smallest and largest value; None where nothing was recorded."""
    if values is None or np.isnan(values).all():
        return None
    return float(np.nanmin(values)), float(np.nanmax(values))


def save_identified(path: Path | str, identified: Identified) -> None:
    """Write domain.json."""
    write_json(path, identified.to_dict())


def load_identified(path: Path | str) -> Identified:
    """Read domain.json. Raises InputError: it is none."""
    content = validate(IdentifiedContent, mapping(read_json(path, WHAT), path, WHAT), path)
    return Identified(
        content.robot,
        Domain.from_dict(content.domain.model_dump()),
        content.payload_kg,
        content.time_s,
        None if content.torque_weights is None else np.array(content.torque_weights, dtype=float),
        content.payload_left_out,
        content.held_out_mm,
        content.many_fit_nothing,
    )


def identified_beside(model: Path) -> Identified | None:
    """What stands in domain.json beside a model.yaml; None where there is none. Raises InputError: it is none."""
    return load_identified(model.parent / FILE) if (model.parent / FILE).is_file() else None


def drivers_of(model: FittedModel) -> set[str]:
    """The kinds of drivers that a model's effects follow, nested ones included."""
    return set().union(*map(kinds_of, model.everything))


def kinds_of(part: Part) -> set[str]:
    """The kinds of drivers that an effect follows, nested ones included."""
    return {k for term in part.placed.terms for product in term.products for k in kinds_in(product.driver)}


def missing_context(model: FittedModel, identified: Identified, rows: Recordings) -> dict[str, NDArray[np.bool_]]:
    """By column that the model needs: (N,) which rows lack it.

    Args:
        model: of a diagnosis.
        identified: what its recordings held.
        rows: of the path.

    Returns:
        Masks (N,) by column.
    """
    used = [KINDS[kind] for kind in drivers_of(model)]
    needed = {kind.needs for kind in used} | {"payload" for kind in used if "payload" in kind.follows}
    # an arm that was never loaded: none is meant
    if identified.payload_kg is None or identified.payload_kg == (0.0, 0.0):
        needed.discard("payload")
    lacks = {}
    for field, column in COLUMNS.items():
        values = getattr(rows, field)
        missing = np.ones(len(rows), dtype=bool)
        if values is not None:
            missing = np.asarray(np.isnan(values).reshape(len(rows), -1).any(axis=1))
        if field in needed and missing.any():
            lacks[column] = missing
    return lacks


def with_empty_context(rows: Recordings) -> Recordings:
    """Rows with every context column, empty where there is none; rows that lack what they need are refused anyway."""
    # views of one number: a long path has room for them
    one, per_motor = (np.broadcast_to(np.nan, shape) for shape in (len(rows), rows.motor_angles.shape))

    def kept(values: Array | None, otherwise: Array) -> Array:
        return otherwise if values is None else values

    return replace(
        rows,
        payload=kept(rows.payload, one),
        temperature=kept(rows.temperature, one),
        time=kept(rows.time, one),
        approach=kept(rows.approach, per_motor),
        speed=kept(rows.speed, per_motor),
    )


def with_torques(model: FittedModel, identified: Identified, rows: Recordings, angles: Array) -> tuple[Recordings, str]:
    """Rows with the joint torques that the model follows, and what stands in for them where they are not recorded.

    Torques of a diagnosis may come from recordings. A path has none yet: gravity of mass moments fitted to the
    recorded torques gives them.

    Args:
        model: of a diagnosis.
        identified: what its recordings held, with the mass moments fitted to their torques.
        rows: of the path.
        angles: (N, m) rad, NaN where unknown.

    Returns:
        The rows, and the sentence; it is empty where none are needed, the path has its own, or no moments were fitted.
    """
    if (
        not any("torque" in KINDS[kind].follows for kind in drivers_of(model))
        or identified.torque_weights is None
        or rows.torque is not None
    ):
        return rows, ""
    known = np.flatnonzero(~np.isnan(angles).any(axis=1))
    torque, payload = np.full_like(angles, np.nan), _payload(rows)
    for start in range(0, len(known), MOMENTS.rows):
        at = known[start : start + MOMENTS.rows]
        torque[at] = _torques(model.arm, angles[at], payload[at], identified.torque_weights)
    return replace(rows, torque=torque), "joint torques: mass moments fitted to the recorded ones"


def _torque_weights(arm: Arm, recordings: Recordings) -> Array | None:
    torque = recordings.torque
    if torque is None or np.isnan(torque).any():
        return None
    rows = spread_evenly(len(recordings), MOMENTS.rows)
    columns = _torque_columns(arm, recordings.motor_angles[rows], _payload(recordings)[rows])
    fitted = [np.linalg.lstsq(columns[:, j], torque[rows, j], rcond=MOMENTS.unseen)[0] for j in range(arm.n_motors)]
    return np.array(fitted)


def _torque_columns(arm: Arm, angles: Array, payload: Array) -> Array:
    """(N, m, p) static torque regressor, payload at the tool point, and a constant."""
    frames = chain(arm, angles)
    regressor = mass_moment_regressor(arm, frames)
    at_tool = _payload_columns(arm, frames) * payload[:, None]
    return np.concatenate([regressor, at_tool[..., None], np.ones_like(at_tool)[..., None]], axis=2)


def _payload_columns(arm: Arm, frames: Chain) -> Array:
    """(N, m) torque of one kilogram at the tool point."""
    ones = np.ones(len(frames.tool))
    return gravity_torques(arm, frames, ones) - gravity_torques(arm, frames)


def _torques(arm: Arm, angles: Array, payload: Array, weights: Array) -> Array:
    torques: Array = np.einsum("nmp,mp->nm", _torque_columns(arm, angles, payload), weights)
    return torques


def _payload(rows: Recordings) -> Array:
    return np.zeros(len(rows)) if rows.payload is None else np.nan_to_num(rows.payload)


def with_measured_tool(model: FittedModel, rows: Recordings) -> Arm:
    """The nominal arm with the measured tool point: where on the tool one measured is no error of the arm. Raises
    InputError: the rows are of several points."""
    shift = np.zeros((len(rows), 3))
    for part in model.tools:
        if part.placed.name == TOOL_FRAME.name:
            target, run = tool_key(part.placed.terms[0].products[0].driver)
            shift[(rows.target == target) & ((rows.run == run) if run is not None else True)] = part.values[:3]
    other = np.flatnonzero(np.abs(shift - shift[:1]).max(axis=1, initial=0.0) > 0)
    if len(other):
        place, rule = f"line {other[0] + 2}, column target", "a path is of one measured point of the tool"
        raise InputError(rows.source, place, str(rows.target[other[0]]), rule, "Split it by target and run.")
    return replace(model.arm, tool=model.arm.tool + (shift[0] if len(rows) else 0.0))
