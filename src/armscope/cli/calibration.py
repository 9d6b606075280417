"""Commands before and beside a diagnosis: check a table, calibrate the plain geometry."""

from __future__ import annotations

import functools
import sys
from pathlib import Path
from typing import Annotated, Literal

import typer

from armscope.cli.commands import ArmOrFolders, Commands
from armscope.core.inputs import InputError

app = Commands()

FILES = ("robot.yaml", "robot.urdf", "robot_urdf.yaml", "ur_kinematics.yaml", "frames.yaml")
TABLES = ("calibration.csv", "held.csv", "covariance.csv", "misses.csv")


@app.command()
def check(
    recordings: Annotated[Path, typer.Argument(help="recordings.csv or motions.csv, or a folder with one")],
    robot: Annotated[
        Path | None,
        typer.Option("--robot", "-r", help="robot.yaml: also compare with the arm; that of a folder if left out"),
    ] = None,
    figure: Annotated[Path | None, typer.Option(help="draw poses and joint coverage (PNG, SVG and PDF)")] = None,
    json: Annotated[bool, typer.Option("--json", help="print what looks wrong as JSON in place of words")] = False,
) -> None:
    """Say what a recordings table holds and what looks wrong in it; exit code 1 if something does."""
    from armscope.cli.motion import check_motions_table
    from armscope.cli.robots import print_json, robot_of, table_of
    from armscope.recordings.first_lines import is_motion_table
    from armscope.recordings.folders import robot_in, table_in

    robot, recordings = robot or robot_in(recordings), table_in(recordings)
    if is_motion_table(recordings):
        if figure is not None:
            raise InputError("--figure", "", str(figure), "of a table of motions there is none")
        if check_motions_table(recordings, robot, json):
            raise typer.Exit(1)
        return
    from armscope.recordings import read_recordings

    table = table_of(recordings) if json else read_recordings(recordings)  # the text has the reader's notes
    arm = None if robot is None else robot_of(robot)

    from armscope.check.report import check as check_table

    found = check_table(table, arm)
    if json:
        print_json(found.to_json())
    else:
        print(found.text())
    if figure is not None:
        from armscope.report.figures.check import draw_check
        from armscope.report.style import save_figure

        named = figure if figure.suffix in (".png", ".svg", ".pdf") else figure.with_name(f"{figure.name}.png")
        print("\n".join(str(path) for path in save_figure(draw_check(table, arm), named)))
    if found.has_problems:
        raise typer.Exit(1)


@app.command()
def calibrate(
    recordings: Annotated[Path, typer.Argument(help="recordings.csv, or a folder with it")],
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for robot.yaml, URDF and frames")],
    robot: ArmOrFolders = None,
    level: Annotated[
        Literal["nominal", "offsets", "geometric", "compliance"],
        typer.Option(help="what is fitted beside base and tool"),
    ] = "geometric",
    robust: Annotated[bool, typer.Option(help="give bad shots less weight")] = False,
    one_base: Annotated[bool, typer.Option(help="all runs share one base frame")] = False,
    tool_per_run: Annotated[
        bool | None,
        typer.Option(help="fit the tool anew in every run, or one for all; the recordings decide if left out"),
    ] = None,
    orientation: Annotated[
        bool | None,
        typer.Option(
            help="use measured orientations, or not; if left out, they are used unless held-out positions get worse"
        ),
    ] = None,
    splits: Annotated[
        int,
        typer.Option(
            min=0, help="how many random splits measure the held-out error (70 % to learn from, the rest to test)"
        ),
    ] = 5,
    target: Annotated[
        str | None, typer.Option(help="the target whose tool goes into robot.yaml; the first one if left out")
    ] = None,
    anyway: Annotated[bool, typer.Option(help="write the result even where it should not be used")] = False,
) -> None:
    """Calibrate the arm's geometry and export it as robot.yaml and URDF."""
    from dataclasses import replace

    from armscope.cli.robots import arm_and_tables
    from armscope.core.files import writable, write_table
    from armscope.recordings.folders import robot_for, table_in

    writable(output, *FILES, *TABLES)
    arm, (table,) = arm_and_tables(robot_for(robot, recordings), [table_in(recordings)])

    from armscope.calibration.calibrate import calibrate as calibrated
    from armscope.calibration.export import export
    from armscope.check.report import check as check_table

    looked_through = check_table(table, arm)
    consistency = looked_through.consistency
    assert consistency is not None
    for found in looked_through.suspicions:
        if found.weight == "problem" and found in consistency.suspicions and not anyway:
            cure = f"{found.cure} --anyway calibrates all the same.".strip()
            raise InputError(recordings, "", "no match with the arm", found.statement, cure)
        if found.weight == "problem" or found in consistency.suspicions:
            print(f"{found.weight}: {found.text()}", file=sys.stderr)
    if not consistency.orientations and not orientation:  # and it was said
        table = replace(table, orientation=None)
    fit = functools.partial(
        calibrated, arm, table, robust=robust, one_base=one_base, tool_per_run=tool_per_run, orientation=orientation
    )
    calibration = fit(level, splits=splits)
    if calibration.doubts and not anyway:
        answer = f"a {level} calibration that should not be used"
        cure = "`armscope check` and `armscope diagnose` may say why; --anyway writes it all the same."
        raise InputError(recordings, "", answer, "; ".join(calibration.doubts), cure)
    no_constants = calibration.nominal_serves and not anyway
    paths = export(fit("nominal") if no_constants else calibration, output, target)
    write_table(output / "calibration.csv", calibration.table)
    write_table(output / "held.csv", calibration.held_table)
    write_table(output / "covariance.csv", calibration.covariance_table)
    if calibration.misses is not None:
        write_table(output / "misses.csv", calibration.misses, digits=6)
    print(calibration.text())
    if no_constants:
        print("these constants are not written, since they help no other pose: robot.yaml, robot.urdf and frames.yaml")
        print("have base and tool fitted to the nominal arm; --anyway writes the constants")
    print("\n".join(str(path) for path in paths))
