"""Commands about recordings: fetch, import."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import EXPERIMENTS, Commands

app = Commands()


@app.command("import")
def import_(
    files: Annotated[list[Path], typer.Argument(help="raw files, as the instrument or the controller wrote them")],
    mapping: Annotated[Path, typer.Option("--mapping", "-m", help="mapping.yaml: which column means what")],
    output: Annotated[Path, typer.Option("--output", "-o", help="the recordings table to write (.gz compresses)")],
) -> None:
    """Convert raw files to a recordings table by a declarative mapping."""
    from armscope.core.inputs import read_keys, validate
    from armscope.recordings.importing.mapping import Mapping

    content = read_keys(mapping)
    if "table" not in content:  # of points: what is wrong with it is told before all that reads tables is imported
        validate(Mapping, content, mapping)

    from armscope.recordings.importing.tables import import_recordings

    print(import_recordings(files, mapping, output).text())


@app.command(rich_help_panel=EXPERIMENTS)
def fetch(
    source: Annotated[Path, typer.Argument(help="source.yaml of a public data set")],
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for the raw files")],
    recordings_dir: Annotated[
        Path | None, typer.Option(help="take the files from this local folder, not from the network")
    ] = None,
) -> None:
    """Fetch the raw files of a public data set and check their checksums."""
    from armscope.recordings.importing.fetching import fetch_recordings

    print(fetch_recordings(source, output, recordings_dir).text())
