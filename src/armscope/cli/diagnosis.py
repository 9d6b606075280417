"""Commands of the diagnosis: diagnose, predict."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armscope.cli.commands import Commands
from armscope.cli.endings import MISMATCH, UNUSABLE, waiting_since

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from armscope.physics.model import FittedModel
    from armscope.recordings import Recordings

app = Commands()

PAGES = ("report.html", "work-order.html", "zero_offsets.csv", "corrected_dh.csv")


@app.command()
def diagnose(
    recordings: Annotated[Path, typer.Argument(help="recordings.csv: commanded angles and measured positions")],
    robot: Annotated[Path, typer.Option("--robot", "-r", help="robot.yaml: the nominal arm")],
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for report, verdict, model and figures")],
    run: Annotated[list[str] | None, typer.Option(help="only these runs (may be given several times)")] = None,
    first_id: Annotated[int | None, typer.Option(help="leave out rows with a smaller id")] = None,
    seed: Annotated[int, typer.Option(help="of folds and resampling")] = 0,
    resamples: Annotated[int, typer.Option(min=0, help="how often rows are resampled; 0 saves time")] = 10,
    cross_validation: Annotated[bool, typer.Option(help="repeat the whole diagnosis on held-out folds")] = True,
    tool_per_run: Annotated[bool, typer.Option(help="the tool was taken off between runs")] = False,
    estimate_gravity: Annotated[
        bool, typer.Option(help="gravity's direction in the base frame is not known (an arm on a wedge)")
    ] = False,
    orientation: Annotated[bool, typer.Option(help="use measured orientations (qw, qx, qy, qz), too")] = True,
    report: Annotated[bool, typer.Option(help="write report.html, work-order.html and their figures")] = True,
    anyway: Annotated[bool, typer.Option("--anyway", help="go on though the check says the table is unusable")] = False,
    exit_code: Annotated[
        bool, typer.Option("--exit-code", help="end with 0: nothing missing, 10: a mismatch, 2: cannot tell")
    ] = False,
) -> None:
    """Find where simulation and recordings differ, and which physics was left out.

    Ends with 0 when the diagnosis was made, whatever it found (see --exit-code), and with 2 when the recordings can't
    be used: then nothing is written, unless --anyway.
    """
    from armscope.check.preconditions import refuse_unusable
    from armscope.compensation.physical import FILE as DOMAIN
    from armscope.compensation.physical import identified_on, save_identified
    from armscope.core.files import writable
    from armscope.diagnosis import Settings, write_verdict
    from armscope.diagnosis import diagnose as diagnose_arm
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm
    from armscope.verdict.files import FILES

    started = waiting_since()
    arm = load_arm(robot)
    table = read_recordings(recordings, arm.n_motors)
    writable(output, *FILES, DOMAIN, *(PAGES if report else ()))
    for note in table.notes:
        print(f"note: {note}", file=sys.stderr)
    if run:
        table = table.rows(_rows_of_runs(table, run))
    if first_id is not None:
        table = table.rows(_rows_from(table, first_id))
    if not anyway:
        refuse_unusable(arm, table)
    settings = Settings(seed, tool_per_run, resamples, cross_validation, estimate_gravity, orientation)
    with _progress("diagnosing") as tell:
        verdict = diagnose_arm(arm, table, settings, tell)
        write_verdict(verdict, output)
        save_identified(output / DOMAIN, identified_on(verdict.model.arm, verdict.recordings))
        if report:
            from armscope.report.pages.diagnosis import write_report

            tell("drawing the report", 0.95)
            write_report(verdict, output, started)
    obstacle = verdict.notices[-1:] if verdict.mismatch is None else ()
    for notice in (*(each for each in verdict.notices if each.kind == "check"), *obstacle):
        print(f"note: {notice.text}", file=sys.stderr)
    print(verdict.headline)
    print(f"{output}/{'report.html' if report else 'verdict.json'}")
    if exit_code and verdict.mismatch is not False:
        raise typer.Exit(MISMATCH if verdict.mismatch else UNUSABLE)


def _rows_of_runs(table: Recordings, runs: list[str]) -> NDArray[np.bool_]:
    import numpy as np

    from armscope.core.inputs import InputError, nearest

    known = set(table.run.tolist())
    for name in runs:
        if name not in known:
            raise InputError("--run", "", name, f"{table.source} has no such run", nearest(name, known))
    return np.isin(table.run, runs)


def _rows_from(table: Recordings, first_id: int) -> NDArray[np.bool_]:
    import numpy as np

    from armscope.core.inputs import InputError

    kept = np.array([text.isdecimal() and int(text) >= first_id for text in table.id])
    if not kept.any():
        raise InputError("--first-id", "", first_id, f"{table.source} has no row with this id or a later one")
    return kept


@contextlib.contextmanager
def _progress(title: str) -> Iterator[Callable[[str, float], None]]:
    """A bar on a terminal's standard error; nothing where there is none."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(title, total=1.0)
        yield lambda text, share: bar.update(task, description=text, completed=share)


@app.command()
def predict(
    model: Annotated[
        Path,
        typer.Argument(
            help="model.yaml of `armscope diagnose`, errormodel.json, or a robot.yaml: the arm as it states"
        ),
    ],
    poses: Annotated[Path, typer.Argument(help="a table of motor angles and whatever context the model follows")],
    output: Annotated[Path, typer.Option("--output", "-o", help="table to write: id, run, x_mm, y_mm, z_mm")],
    pose: Annotated[bool, typer.Option(help="orientations qw, qx, qy, qz, too")] = False,
) -> None:
    """Predict where the tool point will be, in the measurement frame (by a robot.yaml: in the base frame)."""
    import pandas as pd
    from scipy.spatial.transform import Rotation

    from armscope.core.files import write_table
    from armscope.core.inputs import read_yaml

    if model.suffix == ".json":
        points, rotations, rows = _by_black_box(model, poses, pose)
    elif isinstance(content := read_yaml(model), dict) and {"dh", "urdf"} & set(content):
        points, rotations, rows = _by_description(model, poses, pose)
    else:
        points, rotations, rows = _by_physics(model, poses, pose)
    table = pd.DataFrame({"id": rows.id, "run": rows.run})
    table[["x_mm", "y_mm", "z_mm"]] = points * 1e3
    if rotations is not None:
        table[["qx", "qy", "qz", "qw"]] = Rotation.from_matrix(rotations).as_quat(canonical=True)
        table = table[["id", "run", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"]]
    write_table(output, table)


def _by_physics(
    model: Path, poses: Path, pose: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None, Recordings]:
    """Points (N, 3), m, and orientations (N, 3, 3) in the measurement frame, and the rows they are of."""
    from armscope.physics.model import predict as predicted_points
    from armscope.physics.model import predict_orientation
    from armscope.physics.model_file import load_model
    from armscope.recordings import read_recordings

    fitted = load_model(model)
    rows = read_recordings(poses, fitted.arm.n_motors, measured=False)
    _refuse_missing_context(model, fitted, rows)
    for run in fitted.unknown_runs(rows):
        print(f"run {run!r} is not in the model: its base is taken from run {list(fitted.bases)[-1]!r}")
    return predicted_points(fitted, rows), predict_orientation(fitted, rows) if pose else None, rows


def _refuse_missing_context(model: Path, fitted: FittedModel, rows: Recordings) -> None:
    """What an effect follows must be known in every row: nothing is taken for zero.

    Raises:
        InputError: it is not.
    """
    import numpy as np

    from armscope.compensation.physical import FILE, drivers_of, load_identified, missing_context
    from armscope.core.inputs import InputError
    from armscope.physics.drivers import KINDS

    beside = model.parent / FILE
    if not beside.is_file():
        if rows.payload is None and any("payload" in KINDS[kind].follows for kind in drivers_of(fitted)):
            print(f"note: no payload_kg, and no {FILE} beside the model: the arm carries nothing", file=sys.stderr)
        return
    for column, missing in missing_context(fitted, load_identified(beside), rows).items():
        place = "line 1" if missing.all() else f"row {int(np.argmax(missing)) + 2}, column {column}"
        cure = "Write 0 where the arm carries nothing." if column == "payload_kg" else "Add it to the table."
        rule = "an effect in the model follows it, so it must be known in every row"
        raise InputError(rows.source, place, f"no column {column}" if missing.all() else "nothing", rule, cure)


def _by_description(
    robot: Path, poses: Path, pose: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None, Recordings]:
    """As `_by_physics` for an arm that does what its robot.yaml says, nominal or calibrated; in its base frame."""
    from armscope.recordings import read_recordings
    from armscope.robot import chain, load_arm

    arm = load_arm(robot)
    rows = read_recordings(poses, arm.n_motors, measured=False)
    frames = chain(arm, rows.motor_angles)
    return frames.tool, frames.tool_rotation if pose else None, rows


def _by_black_box(
    model: Path, poses: Path, pose: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None, Recordings]:
    """As `_by_physics` for a black-box model; poses outside the identified range are named."""
    from armscope.compensation import load_error_model
    from armscope.compensation.black_box import domain_inputs
    from armscope.compensation.domain import ALLOWED
    from armscope.core.inputs import InputError
    from armscope.recordings import read_recordings

    fitted = load_error_model(model)
    rows = read_recordings(poses, fitted.arm.n_motors, measured=False)
    if pose and fitted.turning is None:
        raise InputError(
            model,
            "turning",
            "nothing",
            "the model was fitted to positions only",
            "Fit it to recordings with qw ... qz.",
        )
    points, rotations = fitted.as_measured(rows.motor_angles)
    outside = fitted.domain.outside(domain_inputs(fitted, rows.motor_angles))[0] > ALLOWED
    if outside.any():
        print(f"note: {outside.sum()} of {len(rows)} rows lie outside the identified range", file=sys.stderr)
    return points, rotations if pose else None, rows
