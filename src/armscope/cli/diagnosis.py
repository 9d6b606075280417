"""Commands of the diagnosis: diagnose, predict."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from armscope.cli.commands import ArmOrFolders, Commands, Threads
from armscope.cli.endings import exit_code_of
from armscope.core.types import unheard

if TYPE_CHECKING:
    from armscope.recordings import Recordings
    from armscope.robot import Arm
    from armscope.verdict.schema import Verdict

app = Commands()

MOST_NAMED = 5  # Suspect rows that the console names

PAGES = (
    "report.html", "work-order.html", "zero_offsets.csv", "corrected_dh.csv", "corrected_origins.csv",
    "ur_kinematics.yaml",
)  # fmt: skip


@app.command()
def diagnose(
    recordings: Annotated[
        Path,
        typer.Argument(help="recordings.csv: commanded angles and measured positions; motions.csv; a folder with one"),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for report, verdict, model and figures")],
    robot: ArmOrFolders = None,
    run: Annotated[list[str] | None, typer.Option(help="only these runs (may be given several times)")] = None,
    first_id: Annotated[int | None, typer.Option(help="leave out rows with a smaller id")] = None,
    seed: Annotated[int, typer.Option(min=0, help="seed of the random folds and resampling")] = 0,
    resamples: Annotated[
        int, typer.Option(min=0, help="how often rows are resampled to see which causes stay; 0 saves time")
    ] = 10,
    cross_validation: Annotated[
        bool, typer.Option(help="repeat the whole diagnosis without a part of the rows, to test it on these (slower)")
    ] = True,
    tool_per_run: Annotated[
        bool, typer.Option(help="fit the tool anew in every run: it was taken off in between")
    ] = False,
    estimate_gravity: Annotated[
        bool, typer.Option(help="estimate gravity's direction: the arm is on a wedge whose lean nobody measured")
    ] = False,
    orientation: Annotated[bool, typer.Option(help="use measured orientations (qw, qx, qy, qz), too")] = True,
    floor_mm: Annotated[
        float | None,
        typer.Option(help="floor in the base frame, for the poses to measure next; the recordings' lowest if left out"),
    ] = None,
    report: Annotated[bool, typer.Option(help="write report.html, work-order.html and their figures")] = True,
    anyway: Annotated[bool, typer.Option("--anyway", help="go on though the check says the table is unusable")] = False,
    exit_code: Annotated[
        bool,
        typer.Option(
            "--exit-code", help="make the exit code the answer. 0: nothing missing, 10: a mismatch, 2: cannot tell"
        ),
    ] = False,
    cutoff: Annotated[
        float | None, typer.Option(min=0.01, help="motions: cut-off of the low-pass filter in Hz; chosen if left out")
    ] = None,
    held_out: Annotated[
        list[str] | None,
        typer.Option(help="motions: keep this run out of the fit, to test on it (may be given several times)"),
    ] = None,
    priors: Annotated[
        Path | None, typer.Option(help="priors.yaml of a fleet: expect errors as large as its arms had")
    ] = None,
    arm_type: Annotated[str | None, typer.Option(help="which type in --priors, where it has several")] = None,
    json: Annotated[bool, typer.Option("--json", help="print verdict.json in place of words")] = False,
    threads: Threads = 1,
) -> None:
    """Find where simulation and recordings differ, and which physics was left out.

    A table of torques or currents over time (motions.csv) is recognised by its columns. Ends with 0 when the diagnosis
    was made, whatever it found (see --exit-code), and with 2 when the recordings can't be used: then nothing is
    written, unless --anyway.
    """
    from armscope.cli.cost import DIAGNOSE, announce
    from armscope.cli.motion import MotionOptions, diagnose_motions
    from armscope.cli.robots import arm_and_tables, print_json
    from armscope.core.files import writable
    from armscope.recordings.first_lines import is_motion_table
    from armscope.recordings.folders import robot_for, table_in
    from armscope.verdict.filenames import FILES

    robot, recordings = robot_for(robot, recordings), table_in(recordings)
    moving = is_motion_table(recordings)
    of_points: dict[str, Any] = {"--priors": priors, "--first-id": first_id, "--tool-per-run": tool_per_run or None}
    of_points |= {"--estimate-gravity": estimate_gravity or None, "--floor-mm": floor_mm}
    _refuse_of_the_other(
        of_points if moving else {"--cutoff": cutoff, "--held-out": held_out or None}, recordings, moving
    )
    if moving:
        with _progress("diagnosing") as tell:
            asked = MotionOptions(cutoff, held_out or [], run or [], json, report, anyway)
            answer = diagnose_motions(recordings, robot, output, asked, tell)
        if exit_code:
            raise typer.Exit(exit_code_of(answer))
        return
    announce(recordings, DIAGNOSE, threads)
    writable(output, *FILES, *(PAGES if report else ()))
    arm, (table,) = arm_and_tables(robot, [recordings], priors, arm_type)

    from armscope.check.preconditions import refuse_unusable

    if run or first_id is not None:
        table = table.of_runs(run or (), first_id)
    if not orientation:  # what nobody uses is not judged either
        table = replace(table, orientation=None)
    if not anyway:
        refuse_unusable(arm, table)

    from armscope.compensation.physical import FILE as DOMAIN
    from armscope.compensation.physical import identified_on, save_identified
    from armscope.diagnosis import Settings, write_verdict
    from armscope.diagnosis import diagnose as diagnose_arm
    from armscope.verdict.diagnosis import promised, rows_it_rests_on

    writable(output, DOMAIN)
    settings = Settings(seed, tool_per_run, resamples, cross_validation, estimate_gravity, orientation, floor_mm)
    with _progress("diagnosing") as tell:
        verdict = diagnose_arm(arm, table, settings, tell)
        write_verdict(verdict, output)
        used = identified_on(verdict.model.arm, rows_it_rests_on(verdict), *promised(verdict).foretold)
        save_identified(output / DOMAIN, used)
        if report:
            from armscope.report.pages.diagnosis import write_report

            tell("drawing the report", 0.95)
            write_report(verdict, output)
    for note in _notes(verdict, arm, table):
        print(f"note: {note}", file=sys.stderr)
    if json:
        print_json(verdict.to_json())
    else:
        print(verdict.headline)
        print(f"{output}/{'report.html' if report else 'verdict.json'}")
    if exit_code:
        raise typer.Exit(exit_code_of(verdict.answer))


def _notes(verdict: Verdict, arm: Arm, table: Recordings) -> Iterator[str]:
    """What stands beside the answer: the check's doubts, what makes it impossible, rows that look like bad shots."""
    from armscope.check.enough_rows import rows_needed
    from armscope.check.suspicion import BESIDE
    from armscope.core.words import rounded
    from armscope.verdict.payload_place import of_payloads
    from armscope.verdict.schema import MISLABELLED, TOOL_AS_STATED, TOOL_EXCHANGED

    obstacle = verdict.notices[-1:] if verdict.mismatch is None else of_payloads(verdict)
    told = ("check", TOOL_AS_STATED, TOOL_EXCHANGED, *BESIDE)
    yield from (each.text for each in verdict.notices if each.kind in told)
    yield from (each.text for each in obstacle)
    if any(each.kind == "fewer rows than parameters" for each in obstacle):
        yield f"of these runs and targets a diagnosis needs {rows_needed(arm, table)} rows at least."
    yield from (each.text for each in verdict.notices if each.kind == MISLABELLED)
    if suspects := [each for each in verdict.suspects if not each.reads_as]:
        rows = [f"{f'{row.run}: ' if row.run else ''}{row.id} ({rounded(row.residual_mm)} mm off)" for row in suspects]
        more = f", ... ({len(rows)} in all: suspects.csv)" if len(rows) > MOST_NAMED else ""
        yield f"rows that look like bad shots, and count for little: {', '.join(rows[:MOST_NAMED])}{more}"


def _refuse_of_the_other(options: dict[str, Any], table: Path, moving: bool) -> None:
    """Options that a table of this kind would silently do without."""
    from armscope.core.inputs import InputError

    for name, value in options.items():
        if value is not None:
            kind, other = ("motions", "measured points") if moving else ("measured points", "motions")
            rule = f"{table} is a table of {kind}, and this option is for tables of {other}"
            raise InputError(name, "", value, rule, "Leave it out.")


@contextlib.contextmanager
def _progress(title: str) -> Iterator[Callable[[str, float], None]]:
    """A bar on a terminal's standard error; nothing where there is none."""
    if not sys.stderr.isatty():
        yield unheard
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=1.0)
        yield lambda text, share: bar.update(task, description=text, completed=share)


@app.command()
def predict(
    model: Annotated[
        Path,
        typer.Argument(help="model.yaml of `armscope diagnose`, errormodel.json, or a robot.yaml (the nominal arm)"),
    ],
    poses: Annotated[Path, typer.Argument(help="a table of motor angles and whatever context the model follows")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="table to write: id, run, x_mm, y_mm, z_mm; for a motion tau1_nm ...")
    ],
    pose: Annotated[bool, typer.Option(help="write orientations (qw, qx, qy, qz), too")] = False,
    threads: Threads = 1,
) -> None:
    """Predict where the tool point will be, in the measurement frame (by a robot.yaml: in the base frame).

    By the model of a motion: the torques of every sample of a table of motions.
    """
    from armscope.cli.cost import PREDICT, announce
    from armscope.cli.motion import predicted_motions
    from armscope.compensation.predicting import predict_file
    from armscope.core.files import write_table

    announce(poses, PREDICT, threads)
    of_motion = predicted_motions(model, poses)
    table, notes = of_motion if of_motion is not None else predict_file(model, poses, pose)
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    write_table(output, table)
