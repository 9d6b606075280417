"""The command that says what changed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import Commands

app = Commands()

RECORDINGS, ROBOT = "recordings.csv", "robot.yaml"


@app.command()
def compare(
    recordings: Annotated[
        list[Path], typer.Argument(help=f"two or more tables, or folders with {RECORDINGS}, in the order of time")
    ],
    robot: Annotated[
        Path | None, typer.Option("--robot", "-r", help=f"the nominal arm; {ROBOT} in the first folder if left out")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="folder for changes.html, comparison.json and history.csv")
    ] = None,
    arms: Annotated[
        bool, typer.Option("--arms", help="the tables are of several arms of one type: say which is unlike the others")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="print comparison.json in place of words")] = False,
) -> None:
    """Say what changed between two or more recordings of one arm: after a crash, a repair, a year.

    Causes that came, went, grew or shrank, each with a 95 % interval of the difference, and one joint test that nothing
    changed. Base and tool may differ.
    """
    from armscope.cli.robots import arm_and_tables, print_json
    from armscope.core.inputs import InputError

    if robot is None and recordings[0].is_file():
        rule = f"the nominal arm must be known: {ROBOT} stands beside no table, only in a folder"
        raise InputError("--robot", "", "nothing", rule, "Add --robot robot.yaml, or name folders.")
    files = [_inside(each, RECORDINGS) for each in recordings]
    arm, read = arm_and_tables(robot or _inside(recordings[0], ROBOT), files)
    tables = dict(zip(_names(recordings), read, strict=True))

    from armscope.comparison import compare as compare_recordings

    found = compare_recordings(arm, tables, arms)
    page = None
    if output is not None:
        from armscope.report.pages.changes import write_changes

        page = write_changes(found, output)
    if json:
        print_json(found.to_json())
    else:
        print(found.text())
        if page is not None:
            print(page)


def _inside(path: Path, name: str) -> Path:
    return path / name if path.is_dir() else path


def _names(paths: list[Path]) -> list[str]:
    """What the recordings are called: folders or files by their own name, numbered where that is not enough."""
    names = [path.resolve().name.removesuffix(".gz").removesuffix(".csv") for path in paths]
    if len(set(names)) < len(names):
        names = [
            path.resolve().parent.name if path.is_file() else name for path, name in zip(paths, names, strict=True)
        ]
    return names if len(set(names)) == len(names) else [f"{n}: {name}" for n, name in enumerate(names, 1)]
