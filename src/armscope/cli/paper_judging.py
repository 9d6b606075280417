"""The paper's claims, judged: by both methods, under other assumptions, and why they depend; and the audit."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import WRITTEN, Commands, Output
from armscope.cli.studies import (
    ManyErrors,
    ManyFits,
    Poses,
    Settings,
    parsed,
    read_fits,
    read_measurements,
    read_tables,
    tell,
)

app = Commands("paper")

Robot = Annotated[Path, typer.Argument(help="robot.yaml")]


@app.command()
def reach(robot: Robot, settings: Settings, output: Output) -> None:
    """Follow the test paths under all assumptions that will be tried, before anything else is done with them."""
    from armscope.cli.paper_plans import follow_all
    from armscope.core.files import write_table

    write_table(output, follow_all(robot, settings))


@app.command()
def scenario(
    robot: Robot,
    settings: Settings,
    output: Output,
    part: Annotated[int, typer.Option(min=1, help="which part of the scenarios")] = 1,
    parts: Annotated[int, typer.Option(min=1, help="of how many")] = 1,
) -> None:
    """Judge every claim under other assumptions, one scenario after the other."""
    import pandas as pd

    from armscope.cli.paper_plans import fitting_of, scenarios_of
    from armscope.cli.paper_settings import ScenarioSettings
    from armscope.core.files import write_table
    from armscope.paper.sensitivity import COLUMNS, judge_scenario
    from armscope.robot import load_arm

    chosen = parsed(ScenarioSettings, settings)
    mine = scenarios_of(chosen, load_arm(robot))[part - 1 :: parts]
    tables = [pd.DataFrame(columns=COLUMNS)]
    for number, each in enumerate(mine, start=1):
        tell(f"{number} of {len(mine)}: {each.factor}, {each.level}")
        tables.append(judge_scenario(each, fitting_of(chosen)))
    write_table(output, pd.concat(tables[1:] or tables, ignore_index=True), digits=5)


@app.command("join")
def join_(tables: Annotated[list[Path], typer.Argument(help="tables of the same columns")], output: Output) -> None:
    """Put tables one after the other, scenarios in their order."""
    from armscope.core.files import write_table

    joined = read_tables(tables)
    write_table(output, joined.sort_values("scenario", kind="stable") if "scenario" in joined else joined)


@app.command("method")
def method_(
    poses: Poses,
    errors: ManyErrors,
    settings: Settings,
    output: Annotated[Path, typer.Option("--output", "-o", help="method.csv")],
    claims: Annotated[Path, typer.Option(help="table of what becomes of the claims about the swarm"), WRITTEN],
) -> None:
    """Excess over least squares for every basis, layout and update rule."""
    from armscope.cli.paper_settings import MethodSettings, specs_of, swarm_settings_of
    from armscope.core.files import write_table
    from armscope.paper.method import method_table

    chosen = parsed(MethodSettings, settings)
    measurements = read_measurements(poses, *errors)
    robots = measurements.robots[1 : 1 + chosen.method.robots] or measurements.robots
    seeds = range(chosen.seed, chosen.seed + chosen.method.seeds)
    found = method_table(measurements, specs_of(chosen.models), robots, seeds, swarm_settings_of(chosen.swarm), tell)
    for path, table in zip((output, claims), found, strict=True):
        write_table(path, table, digits=5)


@app.command("judge")
def judge_(
    poses: Poses,
    errors: ManyErrors,
    fits: ManyFits,
    as_printed: Annotated[list[Path], typer.Option(help="fits by the method as printed, of the same robots")],
    sub_volumes: Annotated[Path, typer.Option(help="sub_volumes.csv")],
    outlook: Annotated[Path, typer.Option(help="outlook.csv")],
    enough_poses: Annotated[Path, typer.Option(help="enough_poses.csv")],
    output: Annotated[Path, typer.Option("--output", "-o", help="judged.csv")],
    per_robot: Annotated[Path, typer.Option(help="table of the outcome for every robot"), WRITTEN],
) -> None:
    """Whether each claim of the paper holds, for which share of the robots, by the method as printed and improved."""
    from armscope.core.files import read_table, write_table
    from armscope.paper.claims import judge_claims
    from armscope.paper.evidence import gather

    measurements = read_measurements(poses, *errors)
    tables = {"sub_volumes": read_table(sub_volumes), "outlook": read_table(outlook), "poses": read_table(enough_poses)}
    judged, robots = judge_claims(gather(measurements, read_fits(*fits), read_fits(*as_printed), tables, tell))
    write_table(output, judged, digits=5)
    write_table(per_robot, robots, digits=5)


@app.command("claims")
def claims_(
    judged: Annotated[Path, typer.Argument(help="judged.csv")],
    sensitivity: Annotated[Path, typer.Option(help="sensitivity.csv")],
    output: Annotated[Path, typer.Option("--output", "-o", help="claims.csv")],
) -> None:
    """Each claim with the paper's wording, its verdicts, and what remains of them under other assumptions."""
    from armscope.core.files import read_table, write_table
    from armscope.paper.claims import summarise
    from armscope.paper.sensitivity import COLUMNS

    found = read_table(judged, ("key", "method"), "what `armscope paper judge` writes")
    varied = read_table(sensitivity, COLUMNS, "what `armscope paper scenario` writes, joined")
    write_table(output, summarise(found, varied), digits=5)


@app.command("why")
def why_(
    per_robot: Annotated[Path, typer.Argument(help="judged_per_robot.csv")],
    robots: Annotated[Path, typer.Option(help="robots_in_tolerances.csv")],
    output: Annotated[Path, typer.Option("--output", "-o", help="why.csv; the figure is drawn beside it")],
    figure: Annotated[Path, typer.Option(help="picture")],
) -> None:
    """Which geometric errors of a robot decide the claims that depend on it."""
    from armscope.core.files import read_table, write_table
    from armscope.paper.decisive_errors import reasons
    from armscope.report.figures.why import why_figure
    from armscope.report.style import save_figure

    outcomes, geometric = read_table(per_robot), read_table(robots)
    found = reasons(outcomes, geometric.iloc[1:])
    write_table(output, found, digits=4)
    save_figure(why_figure(found, outcomes, geometric.iloc[1:]), figure)


@app.command("audit")
def audit_(output: Annotated[Path, typer.Option("--output", "-o", help="audit.csv")], settings: Settings) -> None:
    """Whether the printed table, equations and trajectories can all be true."""
    from armscope.cli.paper_plans import audit_scope_of
    from armscope.cli.paper_settings import AuditSettings
    from armscope.core.files import write_table
    from armscope.paper.audit import audit

    write_table(output, audit(audit_scope_of(parsed(AuditSettings, settings))), digits=4)
