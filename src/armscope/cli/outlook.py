"""Experiments on the paper's outlook: closed-loop, full-pose, cross-table, regions, products."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armscope.cli.commands import EXPERIMENTS, Commands
from armscope.cli.studies import model_named
from armscope.core.inputs import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from armscope.errormodels.fitted import ModelSet
    from armscope.paper.measurements import Measurements
    from armscope.robot import Arm

app = Commands()

Robot = Annotated[Path, typer.Argument(help="robot.yaml")]
Poses = Annotated[Path, typer.Option(help="poses.csv of `armscope paper measure`")]
Errors = Annotated[Path, typer.Option(help="errors.csv")]
Robots = Annotated[Path, typer.Option(help="robots.csv: the anchored robot's geometric errors")]
Models = Annotated[list[str] | None, typer.Option(help="models; may be given several times")]
Products = Annotated[list[str] | None, typer.Option(help="models to fit with products, too")]
Regions = Annotated[list[str] | None, typer.Option(help="models to divide: 'FDP(CI)=4', four regions")]
Picture = Annotated[Path | None, typer.Option(help="picture of the table")]


@app.command("closed-loop", rich_help_panel=EXPERIMENTS)
def closed_loop(
    robot: Robot,
    poses: Poses,
    errors: Errors,
    robots: Robots,
    fits: Annotated[Path, typer.Option(help="fits.json.gz: the models, fitted")],
    output: Annotated[Path, typer.Option("--output", "-o", help="table: model, trajectory, stage, axis, rms_mm")],
    points: Annotated[Path | None, typer.Option(help="table of the error left at every point")] = None,
    figure: Picture = None,
    products: Products = None,
    regions: Regions = None,
    diagnosed: Annotated[bool, typer.Option(help="diagnose the identification rows, too")] = True,
) -> None:
    """Compensate the paper's test paths with every model and let the virtual arm follow the commands."""
    from armscope.cli.studies import read_fits, read_measurements
    from armscope.compensation.closed_loop import cross_table
    from armscope.core.files import write_table
    from armscope.paper.closed_loop import paper_closed_loop
    from armscope.report.figures.compensation import cross_table_figure
    from armscope.report.style import save_figure
    from armscope.robot import load_arm

    measurements = read_measurements(poses, errors)
    arm, truth, models = load_arm(robot), _true_errors(robots), _model_set((), products, regions)
    _check_nominal(robot, arm, poses, measurements)
    left = paper_closed_loop(arm, measurements, read_fits(fits), truth, models, diagnosed)
    table = cross_table(left)
    write_table(output, table)
    if points is not None:
        write_table(points, left, digits=6)
    if figure is not None:
        save_figure(cross_table_figure(table), figure)


@app.command("full-pose", rich_help_panel=EXPERIMENTS)
def full_pose(
    robot: Robot,
    poses: Poses,
    errors: Errors,
    robots: Robots,
    output: Annotated[Path, typer.Option("--output", "-o", help="table: model, trajectory, stage, rms_mm, rms_mrad")],
    model: Models = None,
    products: Products = None,
    regions: Regions = None,
    seed: Annotated[int, typer.Option(min=0, help="of the identification poses and the noise")] = 0,
) -> None:
    """Position and orientation by every model, predicted and in closed loop, with the virtual arm's wrist bent."""
    from armscope.cli.studies import read_measurements
    from armscope.core.files import write_table
    from armscope.paper.full_pose import paper_full_pose
    from armscope.robot import load_arm

    measurements, arm = read_measurements(poses, errors), load_arm(robot)
    _check_nominal(robot, arm, poses, measurements)
    models = _model_set(model or ("FDP(CI)", "SDP(CI)", "FDP(AI)", "SDP(AI)"), products, regions)
    write_table(output, paper_full_pose(arm, measurements, _true_errors(robots), models, seed), digits=6)


@app.command("cross-table", rich_help_panel=EXPERIMENTS)
def cross_table_(
    virtual: Annotated[Path, typer.Argument(help="closed_loop.csv of `armscope closed-loop`")],
    output: Annotated[Path, typer.Option("--output", "-o", help="table: arm, model, trajectory, stage, axis, rms_mm")],
    real: Annotated[list[Path] | None, typer.Option(help="folders with poses.csv, errors.csv, fits.json.gz")] = None,
    products: Products = None,
    regions: Regions = None,
) -> None:
    """Model by trajectory by stage for the virtual arm and for real ones, whose held-out rows stand in for paths."""
    import pandas as pd

    from armscope.cli.studies import read_fits, read_measurements
    from armscope.compensation.closed_loop import cross_table
    from armscope.core.files import read_table, write_table
    from armscope.paper.closed_loop import real_left_over

    models = _model_set((), products, regions)
    tables = [read_table(virtual).assign(arm="virtual")]
    for folder in real or ():
        measurements = read_measurements(folder / "poses.csv", folder / "errors.csv")
        left = real_left_over(measurements, read_fits(folder / "fits.json.gz"), models)
        tables.append(cross_table(left).assign(arm=measurements.robots[0]))
    table = pd.concat(tables, ignore_index=True)
    write_table(output, table[["arm", *table.columns.drop("arm")]])


def _model_set(plain: Sequence[str], products: Sequence[str] | None, regions: Sequence[str] | None) -> ModelSet:
    """Models by their names; regions as in "FDP(CI)=4"."""
    from armscope.errormodels.fitted import ModelSet

    divided = []
    for text in regions or ():
        name, _, count = text.partition("=")
        if not count.isdecimal() or int(count) < 1 or int(count) & (int(count) - 1):
            raise InputError("--regions", "", text, "a model and 2, 4, 8, ... regions, like FDP(CI)=4")
        divided.append((model_named(name), int(count)))
    multiplied = tuple(model_named(name) for name in products or ())
    return ModelSet(tuple(model_named(name) for name in plain), multiplied, tuple(divided))


@app.command("regions", rich_help_panel=EXPERIMENTS)
def regions_(
    poses: Poses,
    errors: Errors,
    output: Annotated[Path, typer.Option("--output", "-o", help="table: model, regions, held_out_rms_mm, ...")],
    model: Models = None,
    figure: Picture = None,
    seed: Annotated[int, typer.Option(min=0, help="of the folds")] = 0,
) -> None:
    """Error against the number of blended sub-volumes, chosen by cross-validation on the identification rows."""
    from armscope.cli.studies import read_measurements
    from armscope.core.files import write_table
    from armscope.paper.outlook import paper_regions
    from armscope.report.figures.compensation import regions_figure
    from armscope.report.style import save_figure

    specs = [model_named(name) for name in model or ("FDP(CI)", "SDP(CI)", "FDP(AI)", "SDP(AI)")]
    table = paper_regions(read_measurements(poses, errors), specs, seed)
    write_table(output, table)
    if figure is not None:
        save_figure(regions_figure(table), figure)


@app.command("products", rich_help_panel=EXPERIMENTS)
def products_(
    poses: Poses,
    errors: Errors,
    output: Annotated[Path, typer.Option("--output", "-o", help="table: model, kind, terms, held_out_rms_mm, ...")],
    model: Models = None,
    seed: Annotated[int, typer.Option(min=0, help="of the folds")] = 0,
) -> None:
    """Sums of one-input terms against a sparse choice of their products, on held-out rows and the test paths."""
    from armscope.cli.studies import read_measurements
    from armscope.core.files import write_table
    from armscope.paper.outlook import paper_products

    names = model or ("SDP(CI)", "SDP(AI)", "4th-degree polynomial (AI)", "Fourier 2 (AI)", "Fourier 3 (AI)")
    specs = [model_named(name) for name in names]
    write_table(output, paper_products(read_measurements(poses, errors), specs, seed))


def _check_nominal(robot: Path, arm: Arm, poses: Path, measurements: Measurements) -> None:
    """The study's nominal points must be the arm's own."""
    import numpy as np

    from armscope.robot import forward_kinematics

    rows = measurements.identification
    if rows.motor_angles.shape[1] != arm.n_motors:
        raise InputError(robot, "", f"{arm.n_motors} motors", f"{poses} has {rows.motor_angles.shape[1]}")
    apart = np.abs(forward_kinematics(arm, rows.motor_angles) * 1e3 - rows.nominal_mm).max()
    if apart > 0.1:
        rule = f"its tool points lie up to {apart:.0f} mm from the nominal ones of {poses}"
        raise InputError(robot, "", arm.name, rule, "Is it the robot of this study?")


def _true_errors(robots: Path) -> NDArray[np.float64]:
    """Geometric errors of the anchored robot, m and rad."""
    import numpy as np

    from armscope.core.files import read_table

    table = read_table(robots, ["anchored"], "the table robots.csv of `armscope paper measure`")
    return np.asarray(table["anchored"], dtype=float) * 1e-3  # mm and mrad
