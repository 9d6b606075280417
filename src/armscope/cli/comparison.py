"""The command that says what changed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import ArmOrFolders, Commands
from armscope.core.streams import is_stream

app = Commands()


@app.command()
def compare(
    recordings: Annotated[
        list[Path], typer.Argument(help="two or more tables, or folders with recordings.csv, in the order of time")
    ],
    robot: ArmOrFolders = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="folder for changes.html, comparison.json and history.csv")
    ] = None,
    arms: Annotated[
        bool, typer.Option("--arms", help="the tables are of several arms of one type: say which is unlike the others")
    ] = False,
    anyway: Annotated[bool, typer.Option("--anyway", help="go on though the check says a table is unusable")] = False,
    json: Annotated[bool, typer.Option("--json", help="print comparison.json in place of words")] = False,
) -> None:
    """Say what changed between two or more recordings of one arm: after a crash, a repair, a year.

    Causes that came, went, grew or shrank, each with a 95 % interval of the difference, and one joint test that nothing
    changed. Base and tool may differ. Ends with 2 when a table can't be used: then nothing is written, unless --anyway.
    """
    from armscope.cli.robots import arm_and_tables, print_json
    from armscope.recordings.folders import others_than, robot_for, table_in

    used = robot_for(robot, recordings[0])
    for other in others_than(used, recordings):
        print(f"note: {other} differs from {used}, which is taken for all recordings", file=sys.stderr)
    arm, read = arm_and_tables(used, [table_in(each) for each in recordings])
    tables = dict(zip(_names(recordings), read, strict=True))

    from armscope.check.preconditions import refuse_unusable

    for table in [] if anyway else read:
        refuse_unusable(arm, table, anyway="compares")

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


def _names(paths: list[Path]) -> list[str]:
    """What the recordings are called: folders or files by their own name, numbered where that is not enough."""
    named = [path if is_stream(path) else path.resolve() for path in paths]  # what a pipe leads to has no name
    own = [path.name.removesuffix(".gz").removesuffix(".csv") for path in named]
    folders = [path.parent.name if path.is_file() else name for path, name in zip(named, own, strict=True)]
    both = [name if name == folder else f"{folder}/{name}" for name, folder in zip(own, folders, strict=True)]
    names = max((own, folders, both), key=lambda each: len(set(each)))  # the shortest that tell most apart
    return names if len(set(names)) == len(names) else [f"{n}: {name}" for n, name in enumerate(names, 1)]
