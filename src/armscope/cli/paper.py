"""The 2006 paper, step by step: each command reads tables, calls `armscope.paper`, and writes tables or figures."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from armscope.cli import paper_judging, paper_pages
from armscope.cli.commands import WRITTEN, Commands, Output
from armscope.cli.studies import (
    Errors,
    Fits,
    ManyErrors,
    ManyFits,
    Poses,
    Residuals,
    Settings,
    parsed,
    read_fits,
    read_measurements,
    read_residuals,
    tell,
    write_fits,
)

app = Commands("paper", no_args_is_help=True)
app.add_typer(paper_judging.app)
app.add_typer(paper_pages.app)


@app.command()
def measure(
    robot: Annotated[Path, typer.Argument(help="robot.yaml")],
    settings: Settings,
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for poses, errors, robots and observability")],
) -> None:
    """Anchor virtual robots to the printed equations and measure them on identification poses and test paths."""
    from armscope.cli.paper_plans import plan_of
    from armscope.cli.paper_settings import MeasureSettings
    from armscope.core.files import write_table
    from armscope.paper.enough_poses import enough_poses
    from armscope.paper.virtual import measured
    from armscope.robot import load_arm

    plan = plan_of(parsed(MeasureSettings, settings), load_arm(robot))
    tell(f"{plan.arm.name}: anchoring and measuring {1 + plan.ensemble} robots")
    study, choice = measured(plan)
    pose_rows, error_rows = study.measurements.to_tables()
    is_anchored = error_rows["robot"] == study.robots.names[0]
    write_table(output / "poses.csv", pose_rows)
    write_table(output / "errors.csv", error_rows[is_anchored])
    write_table(output / "ensemble_errors.csv.gz", error_rows[~is_anchored])
    write_table(output / "robots.csv", study.robots.to_table())
    write_table(output / "robots_in_tolerances.csv", study.robots.in_tolerances(), digits=6)
    write_table(output / "observability.csv", _observability(choice))
    tell("how many poses are enough")
    write_table(output / "enough_poses.csv", enough_poses(plan, study), digits=6)


@app.command("measure-real")
def measure_real(
    recordings: Annotated[Path, typer.Argument(help="recordings of a real arm")],
    robot: Annotated[Path, typer.Argument(help="its robot.yaml")],
    settings: Settings,
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for poses, errors and observability")],
) -> None:
    """Take identification and held-out rows from real recordings, in the form of the paper's measurements."""
    from armscope.cli.paper_settings import RealSettings
    from armscope.core.files import write_table
    from armscope.paper.real import real_measurements
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm

    chosen = parsed(RealSettings, settings)
    arm = load_arm(robot)
    rows = read_recordings(recordings, arm.n_motors).of_runs([chosen.run] if chosen.run else (), chosen.first_id)
    study = real_measurements(arm, rows, chosen.seed, chosen.poses)
    pose_rows, error_rows = study.measurements.to_tables()
    write_table(output / "poses.csv", pose_rows)
    write_table(output / "errors.csv", error_rows)
    write_table(output / "observability.csv", _observability(study.choice))


@app.command()
def fit(
    poses: Poses,
    errors: Errors,
    settings: Settings,
    output: Output,
    as_printed: Annotated[bool, typer.Option(help="with the paper's own basis, layout and update rule")] = False,
) -> None:
    """Fit the error models to every robot of a table by particle swarm, with many seeds."""
    from armscope.cli.paper_settings import SwarmStudySettings, specs_of, swarm_settings_of
    from armscope.errormodels.swarm_fit import fit_swarms

    chosen = parsed(SwarmStudySettings, settings)
    measurements, swarm = read_measurements(poses, errors), chosen.swarm
    how = swarm_settings_of(swarm)
    basis: str = swarm.basis
    layout: str = swarm.layout
    if as_printed:
        from armscope.paper import method  # imports the claims, which takes as long as half a fit

        how, basis, layout = method.as_printed(how), method.PRINTED_BASIS, method.PRINTED_LAYOUT
    fits = []
    for model in specs_of(chosen.models):
        tell(f"{model.name}: {len(measurements.robots)} robots, {len(chosen.seeds)} swarms each")
        problems = measurements.fit_problems((model,), list(measurements.robots))
        fits += fit_swarms(problems, chosen.seeds, how, basis, swarm.engine, layout)
    write_fits(output, fits)


@app.command()
def residuals(
    poses: Poses,
    errors: Errors,
    fits: Fits,
    output: Output,
    bands: Annotated[
        Path | None, typer.Option(help="table of where the robots' errors lie at every point"), WRITTEN
    ] = None,
) -> None:
    """What every fit leaves of the errors, for every robot of a table."""
    from armscope.core.files import write_table
    from armscope.paper.bands import ensemble_bands
    from armscope.paper.residuals import residual_table

    measurements, fitted = read_measurements(poses, errors), read_fits(fits)
    write_table(output, residual_table(measurements, fitted))
    if bands is not None:
        write_table(bands, ensemble_bands(measurements, fitted), digits=5)


@app.command("table2")
def table2_(
    residuals: Residuals,
    output: Output,
    beside_printed: Annotated[bool, typer.Option(help="beside what the paper prints of its own arm")] = True,
) -> None:
    """Table 2: the first robot's errors that are left over, beside the printed ones and those of its ensemble."""
    from armscope.core.files import write_table
    from armscope.paper.beside_printed import table2

    table = table2(read_residuals(residuals))
    of_printed = [name for name in table.columns if name == "printed" or name.endswith("_ratio")]
    write_table(output, table if beside_printed else table.drop(columns=of_printed), digits=6)


@app.command()
def coefficients(fits: Fits, output: Output) -> None:
    """The fitted coefficients of one robot, beside Eqs. (9)-(20)."""
    from armscope.core.files import write_table
    from armscope.paper.beside_printed import coefficient_table

    write_table(output, coefficient_table(read_fits(fits)), digits=6)


@app.command("cross-check")
def cross_check_(residuals: Residuals, fits: ManyFits, output: Output) -> None:
    """Hold the robots against printed numbers that anchoring did not use."""
    from armscope.core.files import write_table
    from armscope.paper.beside_printed import cross_check

    write_table(output, cross_check(read_residuals(residuals), read_fits(*fits)), digits=5)


@app.command("sub-volumes")
def sub_volumes_(poses: Poses, errors: ManyErrors, output: Output) -> None:
    """What one model for each of several regions of the workspace leaves of the errors."""
    from armscope.core.files import write_table
    from armscope.paper.outlook import sub_volumes

    write_table(output, sub_volumes(read_measurements(poses, *errors)), digits=6)


@app.command("outlook")
def outlook_(
    poses: Poses, errors: ManyErrors, output: Output, seed: Annotated[int, typer.Option(min=0, help="of the folds")] = 0
) -> None:
    """What blended sub-volumes and products between inputs leave of the errors, chosen by cross-validation."""
    from armscope.core.files import write_table
    from armscope.paper.outlook import outlook

    write_table(output, outlook(read_measurements(poses, *errors), seed=seed), digits=6)


@app.command("reading")
def reading_(poses: Poses, output: Output) -> None:
    """Read the printed Eqs. (15)-(17) as a rigid motion, a scale and a rest."""
    from armscope.core.files import read_table, write_table
    from armscope.paper.printed import reading

    table = read_table(poses, ["trajectory", "x_mm", "y_mm", "z_mm"], "the table poses.csv of a study")
    identification = table[table["trajectory"] == "identification"]
    write_table(output, reading(identification[["x_mm", "y_mm", "z_mm"]].to_numpy()), digits=5)


@app.command()
def convergence(poses: Poses, errors: Errors, settings: Settings, output: Output) -> None:
    """Compare the velocity updates: which reaches the least-squares optimum, and when."""
    from armscope.cli.paper_settings import SwarmStudySettings, specs_of, swarm_settings_of
    from armscope.core.files import write_table
    from armscope.paper.method import convergence as histories

    chosen = parsed(SwarmStudySettings, settings)
    measurements = read_measurements(poses, errors)
    problems, swarm = measurements.fit_problems(specs_of(chosen.models), list(measurements.robots)), chosen.swarm
    history = histories(problems, chosen.seeds, swarm_settings_of(swarm), swarm.basis, swarm.engine)
    write_table(output, history, digits=5)


def _observability(choice: Any) -> Any:
    import pandas as pd

    return pd.DataFrame(
        {
            "choice": ["chosen", "random (median)"],
            "poses": len(choice.rows),
            "parameters": choice.n_parameters,
            "observability_index_O1": [choice.index, choice.random_index],
        }
    )
