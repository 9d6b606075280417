"""What all commands share: they tell their inputs from their outputs, and write all or nothing."""

from __future__ import annotations

import contextlib
import difflib
import functools
import inspect
import math
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Annotated, Any, cast, get_type_hints

import typer
from typer.core import TyperCommand

from armscope.cli.endings import plain_words, told_to_end
from armscope.core.inputs import InputError
from armscope.core.outputs import Delivery
from armscope.core.parallel import processes
from armscope.core.streams import is_stream, pipes_kept

EXPERIMENTS = "Experiments (the workflow calls these)"


OUTPUTS = ("output", "figure", "points", "visible", "sealed")
"""Parameters of this name are files or folders to write, and those marked `WRITTEN`; all other paths are read."""
WRITTEN = object()
ALIKE, SOMEHOW_ALIKE = 0.7, 0.5
"""Likeness (0 to 1) from which a name is taken for a misspelt one: any, and one with the same ending."""
NOMINAL = ("robot", "nominal")  # Parameters of this name are an arm: a file, or a name in the library
WORKBOOKS = (".xlsx", ".xls", ".xlsm", ".ods")

Output = Annotated[Path, typer.Option("--output", "-o", help="file or folder to write")]
NominalArm = Annotated[
    Path, typer.Option("--robot", "-r", help="the nominal arm: robot.yaml, a URDF, or a name (armscope init --list)")
]
ArmOrFolders = Annotated[
    Path | None,
    typer.Option(
        "--robot",
        "-r",
        help="the nominal arm: robot.yaml, a URDF, or a name (armscope init --list); that of a folder if left out",
    ),
]
"""As a parameter ``robot`` beside a table: `armscope.recordings.folders` says which file is meant."""
Force = Annotated[bool, typer.Option("--force", help="overwrite files that armscope did not write (never an input)")]
Threads = Annotated[
    int, typer.Option(min=1, help="processes that share the rows of a long table; the result is the same")
]
"""As a parameter ``threads`` of a command: its work is shared by so many processes."""


Quiet = Annotated[bool, typer.Option("--quiet", help="say nothing but errors")]


class PlainHelp(TyperCommand):
    """Help as plain lines, which are not cut however narrow the terminal is."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options | {"rich_markup_mode": None})


class Commands(typer.Typer):
    """Commands whose outputs are put in place together, when the command has ended well; see `armscope.core.outputs`.

    Args:
        name: the words before the commands' own names.
        options: as of `typer.Typer`.
    """

    def __init__(self, name: str = "", **options: Any) -> None:
        super().__init__(**options)
        self._words = f"{name} " if name else ""

    def command(self, name: str | None = None, **options: Any) -> Callable[[Any], Any]:
        """As of `typer.Typer`; a command gets ``--quiet``, and one with outputs ``--force``."""
        register = super().command(name, **{"cls": PlainHelp} | options)

        def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
            own = name or function.__name__.rstrip("_").replace("_", "-")
            register(_delivering(function, self._words + own))
            return function

        return decorate


def _delivering(function: Callable[..., Any], command: str) -> Callable[..., Any]:
    """A command with its outputs looked after."""
    hints = get_type_hints(function, include_extras=True)
    signature = inspect.signature(function)
    parameters = [each.replace(annotation=hints[each.name]) for each in signature.parameters.values()]
    outputs = {name for name, hint in hints.items() if name in OUTPUTS or WRITTEN in getattr(hint, "__metadata__", ())}
    added = [inspect.Parameter("quiet", inspect.Parameter.KEYWORD_ONLY, default=False, annotation=Quiet)]
    if outputs:
        added.append(inspect.Parameter("force", inspect.Parameter.KEYWORD_ONLY, default=False, annotation=Force))

    @functools.wraps(function)
    def run(*, force: bool = False, quiet: bool = False, **values: Any) -> None:
        _refuse_endless(values)
        data = bool(values.get("json")) or any(map(is_stream, _paths(values[name] for name in outputs)))
        with _silence(data) if quiet else plain_words(), pipes_kept():
            if outputs:
                deliver(force, values)
            else:
                function(**values)

    def deliver(force: bool, values: dict[str, Any]) -> None:
        reads = _paths(value for name, value in values.items() if name not in outputs)
        for name, value in values.items():
            absent = [
                path
                for path in _paths([value] if name not in outputs else [])
                if not (path.exists() or is_stream(path))
            ]
            arms = name in NOMINAL
            _refuse_absent([path for path in absent if not (arms and _in_library(path))], _help(hints[name]), arms)
        writes = _paths(value for name, value in values.items() if name in outputs)
        for name in outputs:
            _refuse_file(_paths([values[name]]), _help(hints[name]))
        _refuse_workbooks(writes)
        delivery = Delivery(command, reads, writes, force)
        with processes(values.get("threads", 1)), told_to_end(), _stdout_kept_for_data(writes), delivery.running():
            try:
                function(**values)
            except typer.Exit:  # an answer, not a failure
                delivery.put()
                raise
            delivery.put()

    cast(Any, run).__signature__ = signature.replace(parameters=[*parameters, *added])
    run.__annotations__ = {each.name: each.annotation for each in [*parameters, *added]} | {"return": None}
    return run


def _refuse_endless(values: dict[str, Any]) -> None:
    """Numbers of options are finite: click lets "nan" pass where there is no bound, and "inf" below a lower one.
    Raises InputError: one is not."""
    for name, value in values.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(f"--{name.replace('_', '-')}", "", value, "a finite number is needed here")


@contextlib.contextmanager
def _silence(data: bool) -> Iterator[None]:
    """Words go nowhere; errors are told where commands end, and data that was asked for goes to standard output."""
    with contextlib.ExitStack() as silent:
        nowhere = silent.enter_context(open(os.devnull, "w"))
        silent.enter_context(contextlib.redirect_stderr(nowhere))
        if not data:
            silent.enter_context(contextlib.redirect_stdout(nowhere))
        yield


def _paths(values: Iterable[Any]) -> list[Path]:
    several = (value if isinstance(value, list | tuple) else [value] for value in values)
    return [each for value in several for each in value if isinstance(each, Path)]


def _help(hint: Any) -> str:
    """What a parameter is, in the words of the command's help; "" where it has none."""
    return str(next((each.help for each in getattr(hint, "__metadata__", ()) if getattr(each, "help", None)), ""))


def _refuse_absent(paths: list[Path], needed: str, arms: bool) -> None:
    """What is to be read must be there: said before a command imports what it works with. Raises InputError: there
    is one."""
    for path in paths:
        alike = _named_like(path, arms)
        cure = f"Did you mean {alike!r}?" if alike else "No such file or directory."
        if path.is_symlink():
            cure = f"It is a link to {os.readlink(path)}, where no file is."
        elif not arms and _in_library(path):
            cure = f"{path} is an arm of the library, and no file"
            cure += f": `armscope init {path} -o robot.yaml` writes one." if "robot.yaml" in needed else "."
        raise InputError(path, "", "no readable file", f"needed here: {needed or 'a file'}", cure)


def _refuse_file(paths: list[Path], needed: str) -> None:
    """What several files go into is no file, and --force makes it none; nor is it standard output. Raises
    InputError: a folder is needed, and a file or a stream is there."""
    for path in paths if needed.startswith("folder") else ():
        if is_stream(path):
            rule = f"needed here: {needed}"
            raise InputError(path, "", "no folder, but a stream", rule, "Several files are written: name a folder.")
        if path.exists() and not path.is_dir():
            raise InputError(path, "", "a file", f"needed here: {needed}", "Choose another name.")


def _named_like(path: Path, arms: bool) -> str:
    """What a file that is not there may be a misspelling of: packed, a file beside it, an arm of the library; or ""."""
    hidden = path.name.startswith(".")  # nobody means a hidden file by another name
    there = path.parent.glob("*") if path.parent.is_dir() else ()
    beside = [each.name for each in there if hidden or not each.name.startswith(".")]
    if f"{path.name}.gz" in beside:
        return f"{path}.gz"
    own = [name for name in beside if Path(name).suffix == path.suffix]
    known_arms = _arms_of_library() if arms and not path.suffix and len(path.parts) == 1 else []
    for known, likeness in ((known_arms, ALIKE), (own, SOMEHOW_ALIKE), (beside, ALIKE)):
        if found := difflib.get_close_matches(path.name, known, 1, likeness):
            return found[0]
    return ""


def _arms_of_library() -> list[str]:
    from armscope.robot.library import nominal_names

    return list(nominal_names())


def _refuse_workbooks(paths: list[Path]) -> None:
    """A name that says workbook, with CSV inside, is a file that spreadsheets call damaged. Raises InputError: a
    file has such a name."""
    for path in paths:
        if path.suffix.lower() in WORKBOOKS:
            cure = f"Call it {path.stem}.csv: spreadsheets open it."
            raise InputError(path, "", f"a workbook's ending {path.suffix}", "no command writes workbooks", cure)


def _in_library(robot: Path) -> bool:
    """Whether an arm is asked for by its name."""
    from armscope.robot.library import is_nominal

    return is_nominal(str(robot))


@contextlib.contextmanager
def _stdout_kept_for_data(writes: list[Path]) -> Iterator[None]:
    """Where a table goes to standard output, words go to standard error."""
    if any(is_stream(path) for path in writes):
        with contextlib.redirect_stdout(sys.stderr):
            yield
    else:
        yield
