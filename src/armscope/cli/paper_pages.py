"""Figures and pages of the paper's reproduction."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import Commands
from armscope.cli.studies import Errors, Fits, Poses, Settings, parsed, read_fits, read_measurements, tell
from armscope.core.inputs import InputError

app = Commands("paper")


@app.command()
def figure(
    name: Annotated[str, typer.Argument(help="fig03 ... fig11")],
    studies: Annotated[list[Path], typer.Argument(help="folders with poses.csv, errors.csv and fits.json.gz")],
    output: Annotated[list[Path], typer.Option("--output", "-o", help="a path for each study, for PNG and SVG")],
) -> None:
    """Draw one figure of the paper from what was measured and fitted, of any arms."""
    import pandas as pd

    from armscope.core.inputs import nearest
    from armscope.report.figures.paper import ARM_FIGURES, FIGURES, PaperResults, draw
    from armscope.report.style import save_figure

    known = [each for each in FIGURES if each not in ARM_FIGURES]
    if name not in known:
        raise InputError("the figure's name", "", name, "the paper's plots are Figs. 3-11", nearest(name, known))
    if len(output) != len(studies):
        raise InputError("-o", "", f"{len(output)} paths", f"each of the {len(studies)} studies needs one")
    for study, path in zip(studies, output, strict=True):
        measurements = read_measurements(study / "poses.csv", study / "errors.csv")
        shown = PaperResults(measurements, read_fits(study / "fits.json.gz"), pd.DataFrame())
        save_figure(draw(name, shown), path, formats=("png", "svg"))


@app.command()
def figures(
    poses: Poses,
    errors: Errors,
    fits: Fits,
    settings: Settings,
    robot: Annotated[Path, typer.Option(help="robot.yaml, for Figs. 1 and 2")],
    bands: Annotated[Path, typer.Option(help="where the drawn robots' errors lie")],
    output: Annotated[Path, typer.Option("--output", "-o", help="folder; PNG, SVG and PDF are written there")],
) -> None:
    """Draw the paper's figures of the virtual arm, with the drawn robots behind the anchored one."""
    import numpy as np

    from armscope.cli.paper_settings import FigureSettings
    from armscope.core.files import read_table
    from armscope.report.figures.paper import PaperResults, draw
    from armscope.report.style import save_figure
    from armscope.robot import load_arm

    chosen = parsed(FigureSettings, settings)
    tracker = np.array(chosen.tracker.position_mm.value)
    measurements, fitted = read_measurements(poses, errors), read_fits(fits)
    shown = PaperResults(measurements, fitted, read_table(bands), load_arm(robot), tracker)
    for name in chosen.figures:
        tell(name)
        save_figure(draw(name, shown), output / f"{name}.png")


@app.command("convergence-figure")
def convergence_figure(
    history: Annotated[Path, typer.Argument(help="convergence.csv")],
    output: Annotated[Path, typer.Option("--output", "-o", help="a path; PNG, SVG and PDF are written there")],
) -> None:
    """Draw how the swarms converge."""
    from armscope.core.files import read_table
    from armscope.report.figures.convergence import convergence
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
    from armscope.report.pages.paper import Outlook, PaperPage, ReproducedArm, write_table2
    from armscope.report.pages.paper_field import error_field
    from armscope.robot import load_arm

    chosen = parsed(ReportSettings, settings)
    arms = [ReproducedArm(arm.title, Path(arm.folder) if arm.folder else None, arm.reason) for arm in chosen.real]
    table, audit = read_table(results / "table2.csv"), read_table(results / "audit.csv")
    write_table2(output.with_name("table2.html"), table, audit)
    left_over = read_table(compensation / "closed_loop_points.csv")
    field = error_field(load_arm(robot), read_table(results / "poses.csv"), left_over)
    PaperPage(chosen.paper, chosen.seed, results, proof, arms, field, Outlook(compensation)).write(output)


@app.command("readme")
def readme_(
    readme: Annotated[Path, typer.Argument(help="README.md; its numbers are replaced")],
    results: Annotated[Path, typer.Argument(help="folder with the study's tables")],
    proof: Annotated[Path, typer.Argument(help="folder with the tables of the full proof")],
) -> None:
    """Fill the README's numbers from results."""
    from armscope.report.pages.readme import fill_readme

    fill_readme(readme, results, proof)
