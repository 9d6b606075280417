"""Commands of a fleet: diagnose, page, simulate."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import Commands
from armscope.cli.studies import every_nth

app = Commands("fleet", no_args_is_help=True)

Fleet = Annotated[Path, typer.Argument(help="fleet.csv: arm, type, robot, recordings; date, run")]
Output = Annotated[Path, typer.Option("--output", "-o", help="folder to write")]


@app.command()
def diagnose(
    fleet: Fleet,
    output: Output,
    part: Annotated[str, typer.Option(help="part of the arms to diagnose: 0/4 is the first of four parts")] = "0/1",
) -> None:
    """Diagnose every arm of a fleet, or every n-th of them."""
    from armscope.diagnosis import Settings
    from armscope.fleet.members import diagnose_members, read_fleet

    members = read_fleet(fleet)[every_nth(part)]
    diagnose_members(members, output, Settings(resamples=0, cross_validation=False))


@app.command()
def page(
    fleet: Fleet,
    verdicts: Annotated[list[Path], typer.Option(help="folder of verdicts; may be given several times")],
    output: Output,
) -> None:
    """One page over all arms: causes by arm and date, who is the outlier, what repeats in arms of a type."""
    from armscope.fleet.members import read_fleet
    from armscope.report.pages.fleet import write_fleet_page

    write_fleet_page(read_fleet(fleet), verdicts, output)


@app.command()
def simulate(
    robots: Annotated[Path, typer.Argument(help="folder of the arms' descriptions")],
    output: Output,
    arms: Annotated[int, typer.Option(min=1, help="how many")] = 200,
    seed: Annotated[int, typer.Option(min=0, help="seed of everything random")] = 2006,
) -> None:
    """Make recordings of simulated arms of three types, with weaknesses that repeat, and their fleet.csv."""
    from armscope.fleet.simulation import simulate as simulated

    simulated(arms, seed, robots, output)
