"""The 2006 paper, step by step: each command reads tables, calls `armscope.paper`, and writes tables or figures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from armscope.cli.commands import Commands
from armscope.cli.studies import (
    Errors,
    Fits,
    ManyErrors,
    ManyFits,
    Output,
    Poses,
    Residuals,
    Settings,
    parsed,
    read_fits,
    read_measurements,
    read_tables,
    write_fits,
)
from armscope.core.inputs import InputError

if TYPE_CHECKING:
    import pandas as pd

app = Commands("paper", no_args_is_help=True)


@app.command()
def measure(
    robot: Annotated[Path, typer.Argument(help="robot.yaml")],
    settings: Settings,
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for poses, errors, robots and observability")],
) -> None:
    """Anchor virtual robots to the printed equations and measure them on identification poses and test paths."""
    import pandas as pd

    from armscope.cli.paper_settings import MeasureSettings, tracker_of
    from armscope.core.files import write_table
    from armscope.paper.virtual import identification_poses, measure_virtual, paper_paths_mm, trajectory_poses
    from armscope.robot import load_arm
    from armscope.world.tolerances import geometric_errors

    chosen = parsed(MeasureSettings, settings)
    arm = load_arm(robot)
    sizes, paths, poses = chosen.tolerances, chosen.trajectories, chosen.identification
    errors = geometric_errors(
        arm,
        sizes.link_mm.value * 1e-3,
        sizes.link_mrad.value * 1e-3,
        sizes.base_mm.value * 1e-3,
        sizes.base_mrad.value * 1e-3,
    )
    trajectories = trajectory_poses(
        arm,
        paper_paths_mm(
            paths.corners_mm.value,
            paths.points_per_side.value,
            paths.spiral_starts_mm.value,
            paths.spiral_enlargement.value,
            paths.spiral_turns_pi.value,
            paths.spiral_points.value,
            paths.third_coordinate_rise_mm.value,
        ),
    )
    identification, choice = identification_poses(
        errors,
        trajectories,
        poses.poses.value,
        poses.candidates.value,
        poses.margin_rad.value,
        poses.motor_6_rad.value,
        chosen.seed,
    )
    study = measure_virtual(
        errors,
        pd.concat([identification, trajectories], ignore_index=True),
        tracker_of(chosen.tracker),
        chosen.ensemble_robots,
        chosen.seed,
    )
    pose_rows, error_rows = study.measurements.to_tables()
    is_anchored = error_rows["robot"] == study.robots.names[0]
    write_table(output / "poses.csv", pose_rows)
    write_table(output / "errors.csv", error_rows[is_anchored])
    write_table(output / "ensemble_errors.csv.gz", error_rows[~is_anchored])
    write_table(output / "robots.csv", study.robots.to_table())
    write_table(output / "observability.csv", _observability(choice))


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
    from armscope.paper.real import real_measurements, select_rows
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm

    chosen = parsed(RealSettings, settings)
    arm = load_arm(robot)
    rows = select_rows(read_recordings(recordings, arm.n_motors), chosen.run, chosen.first_id)
    study = real_measurements(arm, rows, chosen.seed, chosen.poses)
    pose_rows, error_rows = study.measurements.to_tables()
    write_table(output / "poses.csv", pose_rows)
    write_table(output / "errors.csv", error_rows)
    write_table(output / "observability.csv", _observability(study.choice))


def _residuals(paths: list[Path]) -> pd.DataFrame:
    from armscope.paper.residuals import COLUMNS

    return read_tables(paths, COLUMNS, "the table residuals.csv of a study")


@app.command()
def fit(poses: Poses, errors: Errors, settings: Settings, output: Output) -> None:
    """Fit the error models to every robot of a table by particle swarm, with many seeds."""
    from armscope.cli.paper_settings import SwarmStudySettings, specs_of, swarm_settings_of
    from armscope.errormodels import fit_swarms

    chosen = parsed(SwarmStudySettings, settings)
    measurements, swarm = read_measurements(poses, errors), chosen.swarm
    problems = measurements.fit_problems(specs_of(chosen.models), list(measurements.robots))
    write_fits(output, fit_swarms(problems, chosen.seeds, swarm_settings_of(swarm), swarm.basis, swarm.engine))


@app.command()
def residuals(poses: Poses, errors: Errors, fits: Fits, output: Output) -> None:
    """What every fit leaves of the errors, for every robot of a table."""
    from armscope.core.files import write_table
    from armscope.paper.residuals import residual_table

    write_table(output, residual_table(read_measurements(poses, errors), read_fits(fits)))


@app.command("table2")
def table2_(
    residuals: Residuals,
    output: Output,
    beside_printed: Annotated[bool, typer.Option(help="beside what the paper prints of its own arm")] = True,
) -> None:
    """Table 2: the first robot's errors that are left over, beside the printed ones and those of its ensemble."""
    from armscope.core.files import write_table
    from armscope.paper.table2 import table2

    table = table2(_residuals(residuals))
    write_table(
        output, table if beside_printed else table.drop(columns=["printed", "rss_ratio", "rms_ratio"]), digits=6
    )


@app.command()
def coefficients(fits: Fits, output: Output) -> None:
    """The fitted coefficients of one robot, beside Eqs. (9)-(20)."""
    from armscope.core.files import write_table
    from armscope.paper.coefficients import coefficient_table

    write_table(output, coefficient_table(read_fits(fits)), digits=6)


@app.command("cross-check")
def cross_check_(residuals: Residuals, fits: ManyFits, output: Output) -> None:
    """Hold the robots against printed numbers that anchoring did not use."""
    from armscope.core.files import write_table
    from armscope.paper.cross_check import cross_check

    write_table(output, cross_check(_residuals(residuals), read_fits(*fits)), digits=5)


@app.command("sub-volumes")
def sub_volumes_(poses: Poses, errors: ManyErrors, output: Output) -> None:
    """What one model for each of several regions of the workspace leaves of the errors."""
    from armscope.core.files import write_table
    from armscope.paper.sub_volumes import sub_volumes

    write_table(output, sub_volumes(read_measurements(poses, *errors)), digits=6)


@app.command("outlook")
def outlook_(
    poses: Poses,
    errors: ManyErrors,
    output: Output,
    seed: Annotated[int, typer.Option(help="of the folds")] = 0,
) -> None:
    """What blended sub-volumes and products between inputs leave of the errors, chosen by cross-validation."""
    from armscope.core.files import write_table
    from armscope.paper.outlook import outlook

    write_table(output, outlook(read_measurements(poses, *errors), seed=seed), digits=6)


@app.command("claims")
def claims_(
    residuals: Residuals,
    fits: ManyFits,
    as_printed: Annotated[Path, typer.Option(help="fits of swarms that move as the paper prints it")],
    sub_volumes: Annotated[Path, typer.Option(help="sub_volumes.csv")],
    outlook: Annotated[Path, typer.Option(help="outlook.csv")],
    output: Output,
) -> None:
    """Whether each claim of the paper holds: for the anchored robot and for which share of the ensemble."""
    from armscope.core.files import read_table, write_table
    from armscope.paper.claims import claims

    regions, products = read_table(sub_volumes), read_table(outlook)
    judged = claims(_residuals(residuals), read_fits(*fits), regions, products, read_fits(as_printed))
    write_table(output, judged, digits=4)


@app.command("audit")
def audit_(
    output: Annotated[Path, typer.Option("--output", "-o", help="audit.csv")],
    settings: Settings,
) -> None:
    """Whether the printed table, equations and trajectories can all be true."""
    from armscope.cli.paper_settings import AuditSettings, audit_scope_of
    from armscope.core.files import write_table
    from armscope.paper.audit import audit

    write_table(output, audit(audit_scope_of(parsed(AuditSettings, settings))), digits=4)


@app.command("reading")
def reading_(poses: Poses, output: Output) -> None:
    """Read the printed Eqs. (15)-(17) as a rigid motion, a scale and a rest."""
    from armscope.core.files import read_table, write_table
    from armscope.paper.reading import reading

    table = read_table(poses, ["trajectory", "x_mm", "y_mm", "z_mm"], "the table poses.csv of a study")
    identification = table[table["trajectory"] == "identification"]
    write_table(output, reading(identification[["x_mm", "y_mm", "z_mm"]].to_numpy()), digits=5)


@app.command()
def convergence(poses: Poses, errors: Errors, settings: Settings, output: Output) -> None:
    """Compare the velocity updates: which reaches the least-squares optimum, and when."""
    from armscope.cli.paper_settings import SwarmStudySettings, specs_of, swarm_settings_of
    from armscope.core.files import write_table
    from armscope.paper.convergence import convergence as histories

    chosen = parsed(SwarmStudySettings, settings)
    measurements = read_measurements(poses, errors)
    problems, swarm = measurements.fit_problems(specs_of(chosen.models), list(measurements.robots)), chosen.swarm
    history = histories(problems, chosen.seeds, swarm_settings_of(swarm), swarm.basis, swarm.engine)
    write_table(output, history, digits=5)


@app.command()
def figure(
    name: Annotated[str, typer.Argument(help="fig03 ... fig11")],
    poses: Poses,
    errors: Errors,
    fits: Fits,
    output: Annotated[Path, typer.Option("--output", "-o", help="a path; PNG, SVG and PDF are written there")],
) -> None:
    """Draw one figure of the paper from what was measured and fitted."""
    from armscope.core.inputs import nearest
    from armscope.report.figures.paper import FIGURES, draw
    from armscope.report.style import save_figure

    if name not in FIGURES:
        raise InputError("the figure's name", "", name, "the paper's plots are Figs. 3-11", nearest(name, FIGURES))
    save_figure(draw(name, read_measurements(poses, errors), read_fits(fits)), output)


@app.command("convergence-figure")
def convergence_figure(
    history: Annotated[Path, typer.Argument(help="convergence.csv")],
    output: Annotated[Path, typer.Option("--output", "-o", help="a path; PNG, SVG and PDF are written there")],
) -> None:
    """Draw how the swarms converge."""
    from armscope.core.files import read_table
    from armscope.report.figures.paper import convergence
    from armscope.report.style import save_figure

    save_figure(convergence(read_table(history, ["model", "rule"], "the table convergence.csv of a study")), output)


@app.command()
def report(
    results: Annotated[Path, typer.Argument(help="folder with the study's tables and figures")],
    proof: Annotated[Path, typer.Argument(help="folder of the small proof of the diagnosis")],
    robot: Annotated[Path, typer.Option(help="robot.yaml")],
    compensation: Annotated[Path, typer.Option(help="folder with the closed loop's tables and figures")],
    settings: Settings,
    output: Annotated[Path, typer.Option("--output", "-o", help="report.html; table2.html is written beside it")],
) -> None:
    """One page that shows what the paper claimed, what holds, and what is assumed."""
    from armscope.cli.paper_settings import ReportSettings
    from armscope.core.files import read_table
    from armscope.report.pages.paper import Outlook, RealArm, error_field, write_paper_page, write_table2
    from armscope.robot import load_arm

    chosen = parsed(ReportSettings, settings)
    arms = [RealArm(arm.title, Path(arm.folder) if arm.folder else None, arm.reason) for arm in chosen.real]
    write_table2(output.with_name("table2.html"), read_table(results / "table2.csv"))
    left_over = read_table(compensation / "closed_loop_points.csv")
    field = error_field(load_arm(robot), read_table(results / "poses.csv"), left_over)
    write_paper_page(output, chosen.paper, chosen.seed, results, proof, arms, field, Outlook(compensation))


@app.command("readme")
def readme_(
    readme: Annotated[Path, typer.Argument(help="README.md; its numbers are replaced")],
    results: Annotated[Path, typer.Argument(help="folder with the study's tables")],
    proof: Annotated[Path, typer.Argument(help="folder with the tables of the full proof")],
) -> None:
    """Fill the README's numbers from results."""
    from armscope.report.pages.readme import fill_readme

    fill_readme(readme, results, proof)


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
