"""Which of the package's sources a module depends on, so that a changed source reruns what used it and nothing else."""

from __future__ import annotations

import ast
import functools
import hashlib
from pathlib import Path

PACKAGE = Path(__file__).parent


def digest(*modules: str) -> str:
    """A short hash of the sources and data files that ``modules`` ("armscope.paper.anchor") depend on."""
    files = sorted(set().union(*(sources(module) for module in modules)))
    sha = hashlib.sha256()
    for file in files:
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
            waiting.extend(_imports(file))
    return frozenset(found)


def _file(module: str) -> Path:
    path = PACKAGE.joinpath(*module.split(".")[1:])
    for candidate in (path.with_suffix(".py"), path / "__init__.py"):
        if candidate.is_file():
            return candidate
    raise ModuleNotFoundError(f"{module} is not a module of armscope")


def _imports(file: Path) -> list[str]:
    """The package's modules that a source file imports, at any depth."""
    names: list[str] = []
    for node in ast.walk(ast.parse(file.read_bytes())):
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
