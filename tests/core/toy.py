"""Two commands that write what they are told, and what is seen of their outputs."""

import subprocess
import sys
from pathlib import Path
from typing import Annotated

import typer
from typer.testing import CliRunner

from armscope.cli.commands import Commands
from armscope.core.files import writable, write_text
from armscope.core.inputs import InputError

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "five-effects"

toy = Commands()


@toy.command()
def folder(
    output: Annotated[Path, typer.Option("-o")],
    names: Annotated[list[str], typer.Argument()],
    source: Annotated[Path | None, typer.Option()] = None,
    end: str = "",
):
    """Write files of some names into a folder."""
    writable(output, *names)
    for name in names:
        write_text(output / name, f"{name} {source.read_text() if source else ''}")
        if end == "error":
            raise RuntimeError
    if end == "found":
        raise typer.Exit(1)


@toy.command()
def file(
    output: Annotated[Path, typer.Option("-o")],
    source: Annotated[Path | None, typer.Option()] = None,
    text: str = "made",
    beside: bool = False,
):
    """Write a file, and another beside it."""
    write_text(output, text)
    if beside:
        write_text(output.with_suffix(".json"), text)
    print("words")


def run(*words, app=toy):
    return CliRunner().invoke(app, [str(word) for word in words])


def refused(*words, app=toy):
    error = run(*words, app=app).exception
    assert isinstance(error, InputError), repr(error)
    return str(error)


def tree(folder):
    """What a user sees: names and contents without the hidden folder."""
    seen = (path for path in sorted(folder.rglob("*")) if ".armscope" not in path.parts and path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_text() for path in seen}


def leftovers(folder):
    """What should be gone when a command has ended: drafts, plans, locks."""
    return [path for path in folder.rglob("*") if path.suffix in (".part", ".new", ".plan", ".lock")]


def command(*words, **options):
    code = "from armscope.cli import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, words)],
        capture_output=True, text=True, check=False, timeout=100, **options,
    )  # fmt: skip


PREDICT = ("predict", EXAMPLE / "robot.yaml", EXAMPLE / "recordings.csv", "-o")
