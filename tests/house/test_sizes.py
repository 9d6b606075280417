"""Nothing grows too large to read: parameters of a function, lines of a function and of a file."""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "armscope"
FOLDERS = ("src", "tests", "tools", "workflow", "benchmarks")
MOST_PARAMETERS, MOST_LINES, MOST_LINES_OF_A_FILE = 6, 60, 300
STILL_LONG_FUNCTIONS = {"calibrate"}
"""Most of it is its docstring."""


def modules() -> Iterator[tuple[str, list[str]]]:
    for path in sorted(PACKAGE.rglob("*.py")):
        yield str(path.relative_to(PACKAGE)), path.read_text(encoding="utf-8").splitlines()


def functions(lines: list[str]) -> list[ast.FunctionDef]:
    return _functions("\n".join(lines))


@functools.cache  # two tests look at all modules
def _functions(text: str) -> list[ast.FunctionDef]:
    return [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]


def first_line(function: ast.FunctionDef) -> int:
    return min([function.lineno, *(each.lineno for each in function.decorator_list)])


def test_many_parameters_have_a_reason() -> None:
    """Commands are asked for options by name, as many as there are."""
    wrong = [
        f"{name}: {function.name}"
        for name, lines in modules()
        if not name.startswith("cli/")
        for function in functions(lines)
        if len({a.arg for a in (*function.args.args, *function.args.kwonlyargs)} - {"self", "cls"}) > MOST_PARAMETERS
        and not lines[first_line(function) - 2].lstrip().startswith("#")
    ]
    assert not wrong


def test_functions_are_short() -> None:
    wrong = [
        f"{name}: {function.name}"
        for name, lines in modules()
        if not name.startswith("cli/")
        for function in functions(lines)
        if (function.end_lineno or 0) - function.lineno > MOST_LINES and function.name not in STILL_LONG_FUNCTIONS
    ]
    assert not wrong


def test_files_are_short() -> None:
    files = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))]
    assert len(files) > 500
    assert not [str(path) for path in files if len(path.read_text("utf-8").splitlines()) > MOST_LINES_OF_A_FILE]
