"""Which of the package's sources a module depends on, so that a changed source reruns what used it and nothing else."""

from __future__ import annotations

import ast
import functools
import hashlib
from pathlib import Path

PACKAGE = Path(__file__).parents[1]


def digest(*targets: str) -> str:
    """A short hash of the sources and data files that modules or functions depend on.

    Args:
        targets: "armscope.paper.anchoring", or "armscope.cli.paper:fit" for one function, what it imports itself and
            the functions of its module that it calls.
    """
    sha = hashlib.sha256()
    files: set[Path] = set()
    for target in targets:
        module, _, function = target.partition(":")
        if not function:
            files |= sources(module)
            continue
        for node in _with_callees(_file(module), function):
            sha.update(ast.unparse(node).encode())
            files = files.union(*(sources(name) for name in _imports(node)))
    for file in sorted(files):
        sha.update(file.relative_to(PACKAGE).as_posix().encode())
        sha.update(file.read_bytes())
    return sha.hexdigest()[:12]


@functools.cache
def sources(module: str) -> frozenset[Path]:
    """The files of the package that importing ``module`` runs or reads, found by following its imports.

    A package's data files count with each of its modules.

    Raises:
        ModuleNotFoundError: there is no such module in the package.
    """
    found: set[Path] = set()
    waiting = [module]
    while waiting:
        file = _file(waiting.pop())
        if file not in found:
            found.add(file)
            found.update(path for path in (file.parent / "data").glob("*") if path.is_file())
            waiting.extend(_imports(ast.parse(file.read_bytes())))
    return frozenset(found)


def _file(module: str) -> Path:
    path = PACKAGE.joinpath(*module.split(".")[1:])
    for candidate in (path.with_suffix(".py"), path / "__init__.py"):
        if candidate.is_file():
            return candidate
    raise ModuleNotFoundError(f"{module} is not a module of armscope")


def _with_callees(file: Path, function: str) -> list[ast.stmt]:
    """The definitions of a function and of what it uses from its own module, in the module's order."""
    definitions = {
        node.name: node
        for node in ast.parse(file.read_bytes()).body
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
    }
    if function not in definitions:
        raise AttributeError(f"{file.name} defines no {function}")
    used, waiting = set(), [function]
    while waiting:
        name = waiting.pop()
        if name in definitions and name not in used:
            used.add(name)
            waiting += [node.id for node in ast.walk(definitions[name]) if isinstance(node, ast.Name)]
    return [node for name, node in definitions.items() if name in used]


def _imports(tree: ast.AST) -> list[str]:
    """The package's modules that a piece of source imports, at any depth."""
    names: list[str] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names += [
                f"{node.module}.{alias.name}" if _is_module(f"{node.module}.{alias.name}") else node.module
                for alias in node.names
            ]
    return [name for name in names if name.split(".")[0] == "armscope"]


def _is_module(name: str) -> bool:
    path = PACKAGE.joinpath(*name.split(".")[1:])
    return name.startswith("armscope.") and (path.with_suffix(".py").is_file() or (path / "__init__.py").is_file())
