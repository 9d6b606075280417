"""False targets: the commands under which the real arm reaches the wanted points, row by row, or why there are none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.compensation.black_box import ErrorModel, domain_inputs
from armscope.compensation.forward import BlackBoxArm, Forward, PhysicalArm
from armscope.compensation.known_range import beyond_time
from armscope.compensation.path import WantedPath
from armscope.compensation.physical import (
    Identified,
    missing_context,
    with_empty_context,
    with_measured_tool,
    with_torques,
)
from armscope.compensation.result import Compensated
from armscope.compensation.task import Options, PathTask, refuse
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.physics.instrument import INSTRUMENT_SCALE
from armscope.physics.loose_target import HOLDER_SAG, LOOSE_TARGET
from armscope.physics.model import FittedModel
from armscope.physics.payload_change import PAYLOAD_CHANGE, carrying_as_stated
from armscope.recordings import Recordings


def compensate_black_box(model: ErrorModel, path: WantedPath, options: Options | None = None) -> Compensated:
    """Commands by a black-box error model.

    Motors that stood still when the model was identified keep their angles. With ``pose`` the orientation is corrected,
    too, if the model was fitted to orientations; otherwise it says nothing about them, and the nominal one is kept.

    Args:
        model: fitted by `fit_error_model`, or read from a file.
        path: wanted points, or angles that stand for them.
        options: frame, pose and limits; None takes the defaults.

    Returns:
        Commands (N, m), rad, with what they will reach, which rows can't be had, and why.

    Raises:
        InputError: a path of another arm, or options that the path can't serve.
    """
    options = options or Options()
    path.table.check_motors(model.arm.name, model.arm.n_motors)
    rotation, translation = np.eye(3), np.zeros(3)
    if options.frame == "measurement":
        rotation, translation = model.base.rotation, model.base.translation
    task = PathTask(
        model.arm,
        model.arm,
        path,
        options,
        model.domain,
        forward=lambda nominal: (BlackBoxArm(model), ""),
        domain_inputs=lambda angles, at: domain_inputs(model, angles),
        to_base=lambda points: (points - translation) @ rotation,
        to_frame=lambda points: points @ rotation.T + translation,
        turn=np.tile(rotation, (len(path), 1, 1)),
    )
    result = task.run(np.full(len(path), "", dtype=object))
    result = replace(result, notes=(*result.notes, *_left(model)))
    if options.pose and model.turning is None:
        note = "the model was fitted to positions only: orientations are kept as the nominal arm has them"
        return replace(result, notes=(*result.notes, note))
    return result


def _left(model: ErrorModel) -> tuple[str, ...]:
    """What the model's own rows say of its corrections: the predicted rest is what it thinks of itself."""
    left = f"{model.left_mm:.3g} mm RMS of the distance"
    return (f"corrected, the arm will miss about what the model leaves of the rows that it was fitted to: {left}",)


def compensate_physical(
    model: FittedModel, identified: Identified, path: WantedPath, options: Options | None = None
) -> Compensated:
    """Commands by diagnosed physics, every effect in place, in the context of each row.

    In the base frame the point that is brought to the wanted one is the real place of the measured tool point; in the
    measurement frame it is what the instrument would read there (its scale error included).

    Args:
        model: of a diagnosis.
        identified: the rows on which it was identified: ranges and context.
        path: wanted points with the context that the model follows, or angles that stand for them.
        options: frame, pose and limits; None takes the defaults.

    Returns:
        Commands (N, m), rad, with what they will reach, which rows can't be had, and why.

    Raises:
        InputError: a path of another arm, or options that the path can't serve.
    """
    options = options or Options()
    path.table.check_motors(model.arm.name, model.arm.n_motors)
    if identified.arm != model.arm.name:
        rule = f"the model is of {model.arm.name!r}"
        raise InputError("domain", "robot", identified.arm, rule, "These files do not belong together.")
    measured = options.frame == "measurement"
    untold = _of_untold_loads(model)
    model = carrying_as_stated(model if measured else model.in_its_own_base())
    rows, refused, notes = _named(model, path.table)
    for column, missing in missing_context(model, identified, rows).items():
        refuse(refused, missing, f"no {column}, which the model follows")
    late = "outside the identified range: time_s, which a drift or a curve follows"
    refuse(refused, beyond_time(model, identified, rows), late)
    rows = with_empty_context(rows)

    def forward(nominal: Array) -> tuple[Forward, str]:
        with_load, note = with_torques(model, identified, rows, nominal)
        return PhysicalArm(model, with_load, measured), note

    task = PathTask(
        with_measured_tool(model, rows),
        model.arm,
        replace(path, table=rows),
        options,
        identified.domain,
        forward=forward,
        domain_inputs=lambda angles, at: identified.inputs(angles, rows.rows(at)),
        to_base=(lambda points: model.to_base(points, rows.run)) if measured else _same,
        to_frame=(lambda points: model.to_measurement(points, rows.run)) if measured else _same,
        turn=model.base_turns(rows.run) if measured else np.broadcast_to(np.eye(3), (len(rows), 3, 3)),
    )
    result = task.run(refused)
    said = (
        *notes,
        *untold,
        *result.notes,
        *_resting_on_the_tool(model, options),
        *_of_the_target(model),
        *_foretold(identified, measured),
    )
    return replace(result, notes=said, turn_open=options.pose)


def _resting_on_the_tool(model: FittedModel, options: Options) -> tuple[str, ...]:
    """What the recordings do not tell of the tool, and commands rest on."""
    notes = [
        f"these poses do not tell {each.tool} from {each.base}: commands in the base frame rely on tool_mm as stated, "
        "and are off by as much as it is; --frame measurement does not"
        for each in model.undetermined
        if options.frame == "base"
    ]
    if options.pose:
        notes.append(
            "recordings do not tell how the tool sits turned on the flange (its mounting, the zero of the last joint): "
            "orientations are right but for one turn about the flange's axes, the same at all points"
        )
    return tuple(notes)


def _of_untold_loads(model: FittedModel) -> tuple[str, ...]:
    """Loads that recorded runs carried and nobody stated are not in the commands: the arm may have put them down."""
    loads = [part for part in model.parts if part.placed.effect is PAYLOAD_CHANGE]
    told = enumerated([f"{float(part.values[0]):+.3g} kg {part.placed.variant}" for part in loads])
    stated = "these commands are for what payload_kg states (state those loads, and diagnose again, to carry them)"
    return (f"some recorded runs carried more than stated, {told}: {stated}",) if loads else ()


def _of_the_target(model: FittedModel) -> tuple[str, ...]:
    """What the instrument reads wrongly moves no arm, and what moves the target only a tool that is held as it was."""
    held = {
        LOOSE_TARGET: "the target is loose: these commands bring it where it was meant to go, a tool that is not loose "
        "they do not; --frame base leaves that out",
        HOLDER_SAG: "what held the target bends under its own weight: these commands are right for a tool that bends "
        "as much, and off by that for one that does not",
        INSTRUMENT_SCALE: "the model has the instrument's scale off: what else it holds may be the instrument's, too, "
        "and moves a good arm wrongly; check it first (a scale bar), measure and diagnose again",
    }
    effects = [part.placed.name for part in model.parts]
    return tuple(note for effect, note in held.items() if effect.name in effects)


def _foretold(identified: Identified, measured: bool) -> tuple[str, ...]:
    """What the arm will miss though the model expects nothing: what rows that took no part were missed by.

    These were measured, so that a constant shift, which counts as the base's, is in none of them.
    """
    if identified.held_out_mm is None:
        return ()
    missed = f"{identified.held_out_mm:.3g} mm RMS of the distance"
    told = f"rows that took no part were missed by {missed}, the instrument's noise included"
    shifted = (
        "; in the base frame all points may be off by one more shift and turn, the same for all: recordings do not "
        "tell an error of the first axis from where the base stands (touch a known point to find it)"
    )
    doubt = (
        "more of the recorded rows fit nothing of this model than bad shots would, and they are in that number: "
        "measure some of them again, and diagnose anew, before these commands are used"
    )
    missing = f"the arm will miss by what the model misses: {told}{'' if measured else shifted}"
    return (missing, *([doubt] if identified.many_fit_nothing else []))


def _same(points: Array) -> Array:
    return points


def _named(model: FittedModel, rows: Recordings) -> tuple[Recordings, NDArray[np.object_], tuple[str, ...]]:
    """Rows whose run and target the model knows, refusals for the others, and what was filled in.

    A path without runs is meant for the set-up as it was last; without targets, for the only one there is.
    """
    refused, notes = np.full(len(rows), "", dtype=object), []
    run, target = rows.run.astype(object), rows.target.astype(object)
    if "" not in model.bases and (run == "").any():
        last = list(model.bases)[-1]
        run[run == ""] = last
        notes += [f"rows without a run are taken as of run {last!r}"] if len(model.bases) > 1 else []
    for name in sorted(set(run) - set(model.bases)):
        refuse(refused, np.flatnonzero(run == name), f"run {name!r} is not in the model")
    targets = sorted({str(part.placed.variant) for part in model.tools})
    if targets and "" not in targets and (target == "").any():
        if len(targets) == 1:
            target[target == ""] = targets[0]
        else:
            refuse(refused, np.flatnonzero(target == ""), f"no target; the model knows {', '.join(targets)}")
    for name in sorted(set(target) - set(targets)) if targets else ():
        refuse(refused, np.flatnonzero(target == name), f"target {name!r} is not in the model")
    known = np.isin(run, list(model.bases))
    filled = np.where(known, run, list(model.bases)[-1])
    return replace(rows, run=filled.astype(str), target=target.astype(str)), refused, tuple(notes)
