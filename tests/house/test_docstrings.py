"""Public functions say what they take, give back and refuse.

Asked of every public function or method of more than two parameters: each parameter under `Args:`, `Returns:` or
`Yields:` unless nothing comes back, InputError under `Raises:` where it raises one itself.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "armscope"


def functions(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    """Public functions of a module and public methods of its public classes."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from functions(node)
        elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node


def asked(function: ast.FunctionDef) -> list[str]:
    """Its parameters, without self and cls."""
    given = function.args
    names = [
        each.arg for each in (*given.posonlyargs, *given.args, given.vararg, *given.kwonlyargs, given.kwarg) if each
    ]
    return [name for name in names if name not in ("self", "cls")]


def missing(function: ast.FunctionDef) -> list[str]:
    """What its docstring doesn't say."""
    text = ast.get_docstring(function) or ""
    sections = dict(re.findall(r"^(Args|Returns|Yields|Raises):\n((?:(?: {4}.*)?(?:\n|\Z))+)", text, re.MULTILINE))
    entries = re.findall(r"^ {4}([\w, *]+):", sections.get("Args", ""), re.MULTILINE)
    told = {name for entry in entries for name in re.split(r"[, *]+", entry)}
    wrong = [f"argument {name}" for name in asked(function) if name not in told]
    gives_back = function.returns is not None and ast.unparse(function.returns) != "None"
    if gives_back and not {"Returns", "Yields"} & sections.keys():
        wrong.append("what is returned")
    if raises_input_error(function) and "InputError" not in sections.get("Raises", ""):
        wrong.append("InputError")
    return wrong


def raises_input_error(function: ast.FunctionDef) -> bool:
    """Whether it says so itself, not by what it calls."""
    raised = [node.exc for node in ast.walk(function) if isinstance(node, ast.Raise)]
    return any(isinstance(error, ast.Call) and ast.unparse(error.func) == "InputError" for error in raised)


def is_asked(function: ast.FunctionDef) -> bool:
    """Whether the rule holds for it: a command's options tell about themselves, an overload is told of elsewhere."""
    marks = " ".join(ast.unparse(each) for each in function.decorator_list)
    return len(asked(function)) > 2 and "command" not in marks and "overload" not in marks


@pytest.mark.parametrize("room", sorted({path.relative_to(PACKAGE).parts[0] for path in PACKAGE.rglob("*.py")}))
def test_public_functions_say_what_they_take_and_give(room: str) -> None:
    files = [PACKAGE / room] if room.endswith(".py") else sorted((PACKAGE / room).rglob("*.py"))
    silent = {
        f"{path.relative_to(PACKAGE)}:{function.lineno} {function.name}": wrong
        for path in files
        for function in functions(ast.parse(path.read_text(encoding="utf-8")))
        if is_asked(function) and (wrong := missing(function))
    }
    assert not silent


def test_a_silent_function_is_noticed() -> None:
    source = '''
def f(one, two, three) -> int:
    """Say something.

    Args:
        one: a.
        two: b.
    """
    raise InputError("file", "", "", "")
'''
    assert missing(next(functions(ast.parse(source)))) == ["argument three", "what is returned", "InputError"]
