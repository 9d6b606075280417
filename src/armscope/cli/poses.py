"""The command that chooses identification poses."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armscope.cli.commands import Commands, NominalArm
from armscope.core.inputs import InputError

if TYPE_CHECKING:
    from armscope.poses.choose import Choice

app = Commands()


@app.command()
def poses(
    robot: NominalArm,
    count: Annotated[int, typer.Option("--poses", "-n", min=1, help="how many to measure")] = 85,
    output: Annotated[Path, typer.Option("--output", "-o", help="poses to measure; .json and .png beside it")] = Path(
        "poses.csv"
    ),
    effects: Annotated[
        str, typer.Option(help="what they must show: geometry, or causes such as joint_compliance,backlash")
    ] = "geometry",
    criterion: Annotated[str, typer.Option(help="how poses are judged: O1 (D-optimal), O2, O3, O4 or O5")] = "O1",
    tracker: Annotated[str | None, typer.Option(help="x,y,z in mm, base frame: the tracker must see the tool")] = None,
    floor_mm: Annotated[float | None, typer.Option(help="height of the floor in the base frame")] = None,
    radius_mm: Annotated[
        float | None,
        typer.Option(min=0, help="radius of the links; if left out, the URDF's shapes, or 4 % of the reach"),
    ] = None,
    payload_kg: Annotated[
        float, typer.Option(min=0, help="payload of half of the candidates: most of the chosen may carry it")
    ] = 0.0,
    candidates: Annotated[int, typer.Option(min=1, help="possible poses to choose from")] = 5000,
    starts: Annotated[int, typer.Option(min=1, help="how many starts the search makes")] = 3,
    noise_mm: Annotated[
        float | None, typer.Option(min=0, help="noise, 1-sigma per axis; robot.yaml's if left out")
    ] = None,
    seeds: Annotated[
        int, typer.Option(min=0, help="simulated arms in the comparison with random poses and a grid")
    ] = 40,
    all_criteria: Annotated[
        bool, typer.Option(help="compare with the choices by the other four criteria, too")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="seed of candidates, starts and comparison")] = 0,
) -> None:
    """Choose the poses that show a set of effects best, and say what they are worth beside random ones and a grid."""
    from armscope.cli.robots import robot_of
    from armscope.core.streams import is_stream

    if output.suffix != ".csv" and not is_stream(output):
        raise InputError("--output", "", str(output), "a table that ends in .csv")
    arm = robot_of(robot)

    from armscope.core.files import write_table
    from armscope.poses.compare import RivalOptions
    from armscope.poses.options import PoseOptions
    from armscope.poses.output import write_choice
    from armscope.report.figures.pose_choice import choice_figure
    from armscope.report.style import save_figure

    asked = PoseOptions(effects, criterion, tracker, floor_mm, radius_mm, payload_kg, candidates, starts, seed)
    choice = asked.choose(arm, count)
    rivals = RivalOptions(seeds, noise_mm, all_criteria)
    noise, source = rivals.noise(arm.sigma)
    compared = rivals.compare(choice, asked)
    write_choice(output, choice, compared, noise, source)
    if compared is not None and not is_stream(output):
        write_table(output.with_name(f"{output.stem}_compared.csv"), compared)
        title = f"{arm.name}: {count} poses for {', '.join(asked.names)} by {criterion}"
        save_figure(choice_figure(compared, title), output.with_suffix(".png"), formats=("png", "svg"))
    _tell(choice, source, noise)
    print(output)


def _tell(choice: Choice, source: str, noise: float) -> None:
    from armscope.poses.obstacles import surroundings_notes

    pool = choice.candidates
    refused = ", ".join(f"{reason} {count}" for reason, count in pool.refused.items() if count)
    drawn = f"; of {pool.drawn} drawn were refused: {refused}" if refused else ""
    print(f"chosen from {len(pool)} possible poses{drawn}")
    print(", ".join(f"{name} {value:.4g}" for name, value in choice.indices.items()))
    if choice.targets.hidden:
        print(f"not told apart from the others: {', '.join(choice.targets.hidden)}")
    notes = surroundings_notes(choice.targets.arm, choice.around)
    notes += [f"noise {noise * 1e3:g} mm per axis, assumed"] if source == "assumed" else []
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
