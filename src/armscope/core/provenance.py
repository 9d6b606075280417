"""Which of the package's sources a module depends on, so that a changed source reruns what used it and nothing else."""

from __future__ import annotations

import ast
import functools
import hashlib
import re
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
_IMPORT = re.compile(
    r"\n[ \t]*(?:from|import)\s+(?P<module>armscope(?:\.\w+)*)"
    r"(?:\s+import\s+(?:\((?P<several>[^)]*)\)|(?P<few>[^\n;]*)))?"
)


@functools.cache
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
        for definition in _with_callees(_file(module), function):
            sha.update(definition.encode())
            files = files.union(*(sources(name) for name in _imports(definition)))
    for file in sorted(files, key=_place):
        sha.update(_identity(file))
    return sha.hexdigest()[:12]


@functools.cache
def sources(module: str) -> frozenset[Path]:
    """The files of the package that importing ``module`` runs or reads, found by following its imports.

    A package's data files count with each of its modules.

    Raises:
        ModuleNotFoundError: there is no such module in the package.
    """
    found: set[Path] = set()
    waiting = {_file(module)}
    while waiting:
        found |= waiting
        waiting = {file for each in waiting for file in _followed_by(each)} - found
    return frozenset(found)


def _file(module: str) -> Path:
    file = _modules().get(module)
    if file is None:
        raise ModuleNotFoundError(f"{module} is not a module of armscope")
    return file


@functools.cache
def _modules() -> dict[str, Path]:
    """The package's modules by their names, from one look at its folders; of a folder and a file the file counts."""
    files = sorted(PACKAGE.rglob("*.py"), key=lambda file: file.name != "__init__.py")
    places = [file.relative_to(PACKAGE.parent).with_suffix("").parts for file in files]
    return {
        ".".join(["armscope", *place[1:]]).removesuffix(".__init__"): file
        for place, file in zip(places, files, strict=True)
    }


@functools.cache
def _place(file: Path) -> tuple[str, ...]:
    """Folders and name in the package: several hundred files are sorted by it for each of forty rules."""
    return file.relative_to(PACKAGE).parts


@functools.cache
def _content(file: Path) -> bytes:
    return file.read_bytes()


@functools.cache
def _identity(file: Path) -> bytes:
    """A hash of a file's place and content: what forty rules share is hashed once."""
    return hashlib.sha256("/".join(_place(file)).encode() + b"\0" + _content(file)).digest()


@functools.cache
def _followed_by(file: Path) -> frozenset[Path]:
    """The files that a module imports itself, and the data beside it; data bring nothing more."""
    if file.suffix != ".py":
        return frozenset()
    return _data_beside(file.parent).union(_file(name) for name in _imports(_content(file).decode()))


@functools.cache
def _data_beside(folder: Path) -> frozenset[Path]:
    return frozenset(path for path in (folder / "data").glob("*") if path.is_file())


def _with_callees(file: Path, function: str) -> list[str]:
    """The definitions of a function and of what it uses from its own module, in the module's order."""
    definitions = _definitions(file)
    if function not in definitions:
        raise AttributeError(f"{file.name} defines no {function}")
    used, waiting = set(), [function]
    while waiting:
        name = waiting.pop()
        if name in definitions and name not in used:
            used.add(name)
            waiting += definitions[name][1]
    return [text for name, (text, _) in definitions.items() if name in used]


@functools.cache
def _definitions(file: Path) -> dict[str, tuple[str, frozenset[str]]]:
    """The functions and classes of a module: each as it stands in its file, and the names that it uses."""
    content = _content(file)
    lines = content.splitlines()
    found = {}
    for node in ast.parse(content).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            first = min(part.lineno for part in (node, *node.decorator_list))
            names = frozenset(each.id for each in ast.walk(node) if isinstance(each, ast.Name))
            found[node.name] = (b"\n".join(lines[first - 1 : node.end_lineno]).decode(), names)
    return found


def _imports(source: str) -> list[str]:
    """The package's modules that a piece of source imports, at any depth.

    Its import statements are found by their look, which takes a tenth of the time of parsing: one in a string counts,
    too, so that at worst a rule is run again without need.
    """
    names = []
    for statement in _IMPORT.finditer("\n" + source):
        module, imported = statement["module"], statement["several"] or statement["few"] or ""
        words = [part.split()[0] for part in re.sub("#.*", "", imported).split(",") if part.strip()]
        submodules = [f"{module}.{word}" for word in words]
        names += [name if name in _modules() else module for name in submodules] or [module]
    return names
