"""Commands of the sweeps: run one variant, draw all."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import Commands, Output
from armscope.cli.studies import Errors, Poses, Settings, parsed, read_measurements, read_tables

app = Commands("sweep", no_args_is_help=True)


@app.command()
def run(poses: Poses, errors: Errors, settings: Settings, output: Output) -> None:
    """Fit and judge one variant of a sweep with all its seeds."""
    from armscope.cli.paper_settings import SweepSettings
    from armscope.core.files import write_table
    from armscope.paper.sweep import run_variant

    chosen = parsed(SweepSettings, settings)
    measurements = read_measurements(poses, errors)
    table = run_variant(measurements, chosen.variant, chosen.seed, chosen.basis, chosen.layout, chosen.engine)
    write_table(output, table, digits=6)


@app.command()
def draw(
    tables: Annotated[list[Path], typer.Argument(help="tables of the variants")],
    output: Annotated[Path, typer.Option("--output", "-o", help="sweep.csv; figures are written beside it")],
) -> None:
    """Join the variants' tables and draw them as curves with spread."""
    from armscope.core.files import write_table
    from armscope.report.figures.sweep import sweeps
    from armscope.report.style import save_figure

    table = read_tables(tables, ["sweep", "model"], "the table of a sweep's variant")
    write_table(output, table, digits=6)
    save_figure(sweeps(table), output.with_suffix(".png"))
