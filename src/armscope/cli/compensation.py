"""Commands of the compensation: compensate, fit-error-model."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from armscope.cli.commands import Commands, NominalArm, Threads
from armscope.cli.studies import model_named
from armscope.core.inputs import InputError
from armscope.core.words import or_less

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from armscope.compensation.black_box import ErrorModel
    from armscope.compensation.physical import Identified
    from armscope.compensation.result import Compensated
    from armscope.physics.model import FittedModel
    from armscope.robot import Arm

app = Commands()

MOST_CAUSES = 10
SEEN_MM = 1e-3  # What instruments tell apart at best: what two fits leave may differ by rounding
REFUSED = 3  # Exit code where some rows of a path have no command


@app.command()
def compensate(
    model: Annotated[Path, typer.Argument(help="model.yaml of a diagnosis, or errormodel.json of fit-error-model")],
    path: Annotated[Path, typer.Argument(help="wanted points (x_mm, y_mm, z_mm) or joint path (q1_rad, ...)")],
    output: Annotated[Path, typer.Option("--output", "-o", help="commands: .csv, .json, or .mod (ABB RAPID)")],
    robot: Annotated[
        Path | None, typer.Option("--robot", "-r", help="robot.yaml: stop if the model is of another arm")
    ] = None,
    recordings: Annotated[
        Path | None, typer.Option(help="the table that model.yaml was diagnosed on; domain.json beside it if left out")
    ] = None,
    frame: Annotated[Literal["base", "measurement"], typer.Option(help="the frame of the wanted points")] = "base",
    pose: Annotated[bool, typer.Option(help="correct the orientation, too")] = False,
    start_rad: Annotated[
        str | None, typer.Option(help="q1,q2,... in rad: the posture from which the arm starts")
    ] = None,
    allowed_outside: Annotated[
        float | None,
        typer.Option(
            min=0,
            help="how far a command may lie outside the identified range, in standard deviations; as far as poses do "
            "that were recorded alike if left out",
        ),
    ] = None,
    separate_points: Annotated[
        bool, typer.Option(help="single points, no path: the arm may turn far between them")
    ] = False,
    threads: Threads = 1,
) -> None:
    """Commands that make the real arm reach the wanted points; exit code 3 where some rows have none."""
    from armscope.cli.cost import COMPENSATE, announce
    from armscope.compensation.output import FORMATS, write_commands
    from armscope.core.streams import is_stream

    if not str(output).endswith(FORMATS) and not is_stream(output):
        raise InputError("--output", "", str(output), f"the file's ending says the format: {', '.join(FORMATS)}")
    fitted = _load(model)
    _check_robot(robot, fitted.arm)
    announce(path, COMPENSATE, threads)

    from armscope.compensation.path import read_path

    wanted = read_path(path, fitted.arm)

    from armscope.compensation.black_box import ErrorModel
    from armscope.compensation.compensate import compensate_black_box, compensate_physical
    from armscope.compensation.task import Options
    from armscope.robot.inverse import BEYOND_REACH

    options = Options(frame, pose, _start(start_rad, fitted.arm), allowed_outside, separate_points)
    if isinstance(fitted, ErrorModel):
        result = compensate_black_box(fitted, wanted, options)
    else:
        result = compensate_physical(fitted, _identified(model, fitted, recordings), wanted, options)
    for note in result.notes:
        print(f"note: {note}", file=sys.stderr)
    _tell(result)
    if frame == "base" and all(BEYOND_REACH in reason for reason in result.reasons):
        print("no point is within reach of the arm's base: if they are where the instrument stood, --frame measurement")
    write_commands(output, result)
    print(output)
    if not result.reached.all():
        raise typer.Exit(REFUSED)


@app.command("fit-error-model")
def fit_error_model(
    recordings: Annotated[Path, typer.Argument(help="recordings.csv: commanded angles and measured positions")],
    robot: NominalArm,
    output: Annotated[Path, typer.Option("--output", "-o", help="errormodel.json")],
    model: Annotated[str, typer.Option("--model", "-m", help="FDP(CI), SDP(AI), 'Fourier 2 (AI)', ...")] = "SDP(CI)",
    method: Annotated[str, typer.Option(help="least-squares or swarm")] = "least-squares",
    seed: Annotated[int, typer.Option(min=0, help="seed of the swarm")] = 0,
    run: Annotated[str | None, typer.Option(help="only this run")] = None,
    target: Annotated[str | None, typer.Option(help="only this target")] = None,
    register: Annotated[bool, typer.Option(help="fit measurement frame and tool offset with the nominal arm")] = False,
    products: Annotated[bool, typer.Option(help="choose among products of the inputs' terms, too")] = False,
    regions: Annotated[str, typer.Option(help="1, 2, 4, ... blended models, or auto: by cross-validation")] = "1",
    orientation: Annotated[bool, typer.Option(help="fit measured orientations (qw, qx, qy, qz), too")] = True,
) -> None:
    """Fit one of the paper's error models to recordings, ready for `armscope compensate`: three axes, or all six."""
    from armscope.cli.robots import arm_and_tables
    from armscope.core.inputs import nearest

    methods = {"least-squares": "least squares", "swarm": "swarm"}
    if method not in methods:
        raise InputError("--method", "", method, "least-squares or swarm")
    if regions != "auto" and (not regions.isdecimal() or (method != "least-squares" and regions != "1")):
        raise InputError("--regions", "", regions, "auto or 1, 2, 4, ...; more than one by least squares only")
    if products and (method != "least-squares" or regions != "1"):
        raise InputError("--products", "", f"--method {method} --regions {regions}", "least squares, one region")
    arm, (table,) = arm_and_tables(robot, [recordings])

    from armscope.compensation.black_box import save_error_model
    from armscope.compensation.fitting import fit_error_model as fit
    from armscope.compensation.fitting import left_by_frames_alone

    for column, wanted in (("run", run), ("target", target)):
        if wanted is not None:
            values = getattr(table, column)
            if wanted not in values:
                cure = nearest(wanted, set(values.tolist()))
                raise InputError(f"--{column}", "", wanted, f"{recordings} has no such {column}", cure)
            table = table.rows(values == wanted)
    count = None if regions == "auto" else int(regions)
    fitted = fit(arm, table, model_named(model), methods[method], seed, register, count, products, orientation)
    save_error_model(output, fitted)
    left = ", ".join(f"{value:.4g}" for value in fitted.rms_mm)
    print(f"{fitted.name} by {fitted.method} on {len(table)} rows leaves ({left}) mm RMS along x, y, z")
    alone = left_by_frames_alone(arm, table)
    if fitted.left_mm > alone + SEEN_MM:
        left = f"{fitted.left_mm:.3g} mm RMS of the distance, where base and tool alone leave {alone:.3g} mm"
        cure = " Give --register." if not register else " Another --model, or `armscope diagnose`, may do better."
        print(f"warning: this model leaves {left}: it makes the arm worse.{cure}", file=sys.stderr)
    if fitted.turning is not None:
        turned = ", ".join(f"{value:.4g}" for value in fitted.turning.rms_mrad)
        print(f"and ({turned}) mrad RMS about x, y, z of the base frame")
    if len(fitted.coefficients) > 1:
        print(f"{len(fitted.coefficients)} regions")
    print(output)


def _load(model: Path) -> ErrorModel | FittedModel:
    if model.suffix == ".json":
        from armscope.compensation.black_box import load_error_model

        return load_error_model(model)
    from armscope.physics.model_file import load_model

    return load_model(model)


def _identified(model: Path, fitted: FittedModel, recordings: Path | None) -> Identified:
    from armscope.check.preconditions import check_table
    from armscope.compensation.physical import FILE, identified_beside, identified_on
    from armscope.recordings import read_recordings

    if recordings is not None:
        table = read_recordings(recordings, fitted.arm.n_motors)
        return identified_on(fitted.arm, check_table(fitted.arm, table).recordings)
    identified = identified_beside(model)
    if identified is None:
        raise InputError(
            model, "", f"no {FILE} beside it", "commands outside the identified range are refused: it must be known",
            "Give the recordings of the diagnosis with --recordings.",
        )  # fmt: skip
    motors = sum(name.startswith("q") for name in identified.domain.inputs)
    if motors != fitted.arm.n_motors:
        rule = f"the model's arm has {fitted.arm.n_motors}"
        raise InputError(model.parent / FILE, "domain.inputs", f"{motors} motors", rule, "Is it of another diagnosis?")
    return identified


def _check_robot(robot: Path | None, arm: Arm) -> None:
    """The robot.yaml must describe the model's arm; the tool may differ, since models may hold a fitted one."""
    if robot is None:
        return
    from armscope.robot import load_arm

    ours, theirs = arm.description, load_arm(robot).description
    for name in ("dh", "urdf", "actuation", "tip"):
        if getattr(ours, name) != getattr(theirs, name):
            rule = f"the model is of {ours.name!r}, whose {name} differs"
            raise InputError(robot, name, theirs.name, rule, "Is this the model of another arm?")


def _start(text: str | None, arm: Arm) -> NDArray[np.float64] | None:
    import numpy as np

    if text is None:
        return None
    try:
        values = np.array([float(part) for part in text.split(",")])
    except ValueError as error:
        raise InputError("--start-rad", "", text, "numbers separated by commas") from error
    if len(values) != arm.n_motors or np.abs(values).max() > 4 * np.pi:
        raise InputError("--start-rad", "", text, f"{arm.n_motors} angles in rad, within two turns")
    return values


def _tell(result: Compensated) -> None:
    import numpy as np

    reached, count = result.reached, len(result.reasons)
    if reached.any():
        missed, left = (np.sqrt(np.mean(miss[reached] ** 2)) * 1e3 for miss in (result.uncorrected, result.residual))
        outside = result.outside[reached].max()
        print(
            f"{reached.sum()} of {count} rows: predicted miss {or_less(missed, 3)} mm RMS of the distance; corrected, "
            f"the model expects {or_less(left)} mm"
        )
        if result.pose:
            beside = " beside one constant turn on the flange, which it does not know" if result.turn_open else ""
            turns = (result.uncorrected_turn, result.residual_turn)
            turned, left = (np.sqrt(np.mean(turn[reached] ** 2)) * 1e3 for turn in turns)
            print(
                f"orientation: predicted error {or_less(turned, 4)} mrad RMS; corrected, the model expects "
                f"{or_less(left)} mrad{beside}"
            )
        if outside < 0.005:
            print("all inside the identified range")
        else:
            print(f"up to {outside:.2g} standard deviations outside the identified range")
    told = result.refused
    for rows, reason in told[:MOST_CAUSES]:
        which = f"line {rows[0] + 2}" if len(rows) == 1 else f"{len(rows)} rows, lines {_ranges(rows + 2)}"
        print(f"refused: {which} of the file: {reason}")
    if len(told) > MOST_CAUSES:
        print(f"refused for {len(told) - MOST_CAUSES} more reasons: the table says which")


def _ranges(rows: NDArray[np.intp]) -> str:
    """Lines of a file, whose heading is the first, as "2-6, 9, ..."."""
    import numpy as np

    pieces = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
    text = [str(piece[0]) if len(piece) == 1 else f"{piece[0]}-{piece[-1]}" for piece in pieces]
    return ", ".join(text[:5]) + (", ..." if len(text) > 5 else "")
