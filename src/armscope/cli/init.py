"""The command that writes the first files: robot.yaml of an arm, mapping.yaml of a foreign table."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, TextIO

import typer

from armscope.cli.commands import Commands
from armscope.core.inputs import InputError
from armscope.core.outputs import current
from armscope.core.streams import is_stream
from armscope.recordings.opening import UTF_16

app = Commands()

WHAT = "a URDF, `-` for a D-H table on standard input, the name of an arm (--list shows them), or a foreign table"


@app.command()
def init(
    what: Annotated[str, typer.Argument(help=WHAT, metavar="WHAT")] = "",
    output: Annotated[Path, typer.Option("--output", "-o", help="robot.yaml or mapping.yaml to write")] = Path("-"),
    tip: Annotated[str | None, typer.Option(help="URDF: the frame that carries the tool; guessed if left out")] = None,
    name: Annotated[str, typer.Option(help="D-H table: what to call the arm")] = "my arm",
    modified: Annotated[
        bool, typer.Option("--modified", help="D-H table: it is in Craig's convention (modified)")
    ] = False,
    list_: Annotated[bool, typer.Option("--list", help="show the nominal arms of the library")] = False,
) -> None:
    """Write robot.yaml from a URDF, a D-H table or an arm's name; or a draft mapping.yaml from a foreign table.

    Every guess is labelled in what is written: read it before you use it.
    """
    from armscope.robot.library import nominal_names

    if list_ or not what:
        _show_library(sys.stdout if not list_ or (delivery := current()) is None else delivery.stdout)
        if not list_:
            raise InputError("WHAT", "", "nothing", WHAT, "Arms: " + ", ".join(nominal_names()) + ".")
        return
    text, guesses, is_robot = _first_file(what, output, tip, name, modified)
    if is_robot:
        _refuse_unusable(text, output)
    for guess in guesses:
        print(f"guess: {guess}", file=sys.stderr)
    from armscope.core.files import write_text

    write_text(output, text)


def _refuse_unusable(text: str, output: Path) -> None:
    """A robot.yaml that no command could read is not written: it is read as they do. Raises InputError: what they
    would say."""
    from armscope.core.plainyaml import plain_yaml
    from armscope.robot.arm import build_arm
    from armscope.robot.description_file import described
    from armscope.robot.model import pinocchio_model
    from armscope.robot.urdf import SLIDING

    found = described(plain_yaml(text), output)
    try:
        build_arm(found)
    except InputError as error:
        if error.found != SLIDING:
            raise
        pinocchio_model(found, sliding=True)  # tables of motions are taken of it


def _first_file(what: str, output: Path, tip: str | None, name: str, modified: bool) -> tuple[str, list[str], bool]:
    """The file's text, what was guessed for it, and whether it is of an arm."""
    from armscope.robot.description_file import as_yaml, describe_urdf, guesses
    from armscope.robot.library import is_nominal, nominal_file
    from armscope.robot.urdf_file import is_xml

    if what == "-":
        from armscope.robot.dh_table import parse_dh_table

        described = parse_dh_table(_pasted(), name, "modified" if modified else "standard")
    elif is_xml(what):
        if is_stream(what):
            rule = "robot.yaml names its URDF, which must stay a file"
            raise InputError(what, "", "a URDF on a pipe", rule, "Save it to a file first.")
        described = describe_urdf(what, tip)
    elif Path(what).exists() or not is_nominal(what):
        if not Path(what).exists() and not Path(what).suffix:
            nominal_file(what)
        from armscope.recordings.importing.draft_motions import draft_any_mapping

        text = draft_any_mapping(what)
        return (
            text,
            [line.strip() for line in text.splitlines() if "# guessed" in line or "# to fill in" in line],
            False,
        )
    else:
        file = nominal_file(what)
        text = file.read_text(encoding="utf-8")
        return text, [line.strip() for line in text.splitlines() if "unsure" in line or "from memory" in line], True
    return as_yaml(described, output.parent), guesses(described), True


def _pasted() -> str:
    """Standard input as text, whatever its bytes are. Raises InputError: it is no text."""
    content = sys.stdin.buffer.read()
    try:
        return content.decode("utf-16" if content.startswith(UTF_16) else "utf-8-sig")
    except UnicodeDecodeError as error:
        found = f"byte 0x{content[error.start]:02x}" if error.start < len(content) else "half a character"
        raise InputError("D-H table", "standard input", found, "text in UTF-8 is needed here") from error


def _show_library(to: TextIO) -> None:
    """The arms, one a line: asked for, they are the command's output, else they stand beside an error."""
    from armscope.robot.library import nominal_description, nominal_names

    for each in nominal_names():
        described = nominal_description(each)
        basis = described.source["dh"]
        print(f"{each:10s} {described.name}: {basis}", file=to)
