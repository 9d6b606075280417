"""A public function or class has a name of its own, unless two of them are obviously parallel."""

import ast
from collections import defaultdict
from itertools import combinations
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "src" / "armscope"
PARALLEL = [{"proof", "real"}, {"report", "proof"}, {"report", "real"}, {"report", "paper"}]
"""Rooms that do the same to different things, or draw what the other computes."""
SAME_OF_MANY = {"schema", "draw_all"}
"""Of each file format its schema, of each set of figures all of it."""
OF_THEIR_OWN = {"cli", "notebook", "world"}
"""Commands, also as functions, are named as what they call; worlds share the field's words, and no code."""


def homes() -> dict[str, list[Path]]:
    """Modules by the public names that they define."""
    found = defaultdict(list)
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                found[node.name].append(path.relative_to(PACKAGE))
    return found


def parallel(one: Path, other: Path) -> bool:
    """Whether two modules may use the same word."""
    rooms = {one.parts[0], other.parts[0]}
    alike = one.name == other.name and one.parts[:-2] == other.parts[:-2] == ("report",)
    if ("motion" in one.parts) != ("motion" in other.parts):
        return True  # what is done for an arm that stands, done for one that moves
    return bool(rooms & OF_THEIR_OWN) or any(rooms == pair for pair in PARALLEL) or len(one.parts) == 1 or alike


def test_names_are_unique_or_parallel() -> None:
    twice = {
        name: [str(path) for path in paths]
        for name, paths in homes().items()
        if name not in SAME_OF_MANY and any(not parallel(one, other) for one, other in combinations(paths, 2))
    }
    assert not twice
