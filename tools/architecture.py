"""The picture of the house, drawn from the code: rooms on their floors, and who imports whom.

    python -m tools.architecture           # writes docs/figures/architecture.svg
    python -m tools.architecture --check   # fails where the picture is not what the code is

Floors are those of the import-linter contract in pyproject.toml, imports are read from the sources, a room's words are
the first line of its `__init__.py`, and the numbers are the steps of a diagnosis in ARCHITECTURE.md. Where a room
imports another that it reaches by way of a third anyhow, no line is drawn.
"""

from __future__ import annotations

import ast
import re
import sys
import textwrap
import tomllib
from collections import defaultdict
from html import escape
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "armscope"
PICTURE = ROOT / "docs" / "figures" / "architecture.svg"
WIDTH, BOX, HIGH, GAP, STORY = 1120, 204, 80, 16, 106
"""Of the page, a box, between boxes, from floor to floor; px."""

COLUMN = {
    **dict.fromkeys(("check", "calibration", "inference"), 0),
    **dict.fromkeys(("diagnosis", "fitting", "measurement", "physics", "robot"), 1),
    **dict.fromkeys(("cli", "report", "real", "proof", "poses", "verdict", "recordings", "core"), 2),
    **dict.fromkeys(("compensation", "errormodels", "swarm"), 3),
    **dict.fromkeys(("paper", "world", "design"), 4),
}
"""Where a room stands on its floor; a room that is not here stands in the first free place."""

STYLE = """
text { font-family: "DejaVu Sans", "Helvetica Neue", Arial, sans-serif; }
.room { fill: #ffffff; stroke: #5b6770; } .path { fill: #e8f1fa; stroke: #0072b2; stroke-width: 1.6; }
.name { font-size: 15px; font-weight: bold; fill: #1c2429; } .words { font-size: 10.5px; fill: #48535b; }
.floor { fill: #f4f6f7; } .line { fill: none; stroke: #9aa5ad; stroke-width: 1.1; }
.badge { fill: #0072b2; } .step { font-size: 10.5px; fill: #ffffff; text-anchor: middle; }
"""


def floors() -> list[list[str]]:
    """Rooms by floor, highest first, as the contract names them."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    layers = next(each["layers"] for each in contracts if each["id"] == "floors")
    return [re.split(r"\s*[|:]\s*", layer) for layer in layers]


def imports() -> dict[str, set[str]]:
    """Which rooms each room imports."""
    found = defaultdict(set)
    for path in sorted(PACKAGE.rglob("*.py")):
        room = path.relative_to(PACKAGE).parts[0]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("armscope."):
                found[room].add(str(node.module).split(".")[1])
    return {room: others - {room} for room, others in found.items()}


def descending(storeys: list[list[str]]) -> dict[str, set[str]]:
    """The imports that go down from floor to floor, as all do but the contract's exceptions."""
    level = {room: n for n, rooms in enumerate(storeys) for room in rooms}
    found = {room: others & level.keys() for room, others in imports().items() if room in level}
    return {room: {other for other in others if level[other] > level[room]} for room, others in found.items()}


def reduced(edges: dict[str, set[str]]) -> dict[str, set[str]]:
    """The imports without those that another one implies."""

    def reached(room: str) -> set[str]:
        return {each for other in edges.get(room, ()) for each in {other, *reached(other)}}

    return {
        room: {other for other in others if not any(other in reached(third) for third in others - {other})}
        for room, others in edges.items()
    }


def steps() -> dict[str, list[int]]:
    """In which steps of a diagnosis, as ARCHITECTURE.md numbers them, a room takes part."""
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    found = defaultdict(list)
    for number, room in re.findall(r"^(\d+)\. .*?\(`(\w+)/", text, re.MULTILINE):
        found[room].append(int(number))
    return found


def words(room: str) -> str:
    """The first line of a room's own description."""
    text = ast.get_docstring(ast.parse((PACKAGE / room / "__init__.py").read_text(encoding="utf-8"))) or ""
    return text.splitlines()[0]


def svg() -> str:
    """The picture."""
    storeys = floors()
    corner = {
        room: (GAP + column * (BOX + GAP), level * STORY + (STORY - HIGH) / 2)
        for level, rooms in enumerate(storeys)
        for room, column in _columns(rooms).items()
    }
    height = len(storeys) * STORY
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img">',
        "<title>Rooms of armscope on their floors; lines are imports, downwards</title>",
        f"<style>{STYLE}</style>",
    ]
    parts += [
        f'<rect class="floor" x="0" y="{level * STORY + 5}" width="{WIDTH}" height="{STORY - 10}"/>'
        for level in range(len(storeys))
    ]
    edges = reduced(descending(storeys))
    parts += [_line(corner[room], corner[other]) for room in corner for other in sorted(edges.get(room, ()))]
    taken = steps()
    parts += [_box(room, *corner[room], taken.get(room, [])) for room in corner]
    return "\n".join([*parts, "</svg>", ""])


def _columns(rooms: list[str]) -> dict[str, int]:
    taken = {COLUMN[room] for room in rooms if room in COLUMN}
    free = iter(sorted(set(range(5)) - taken))
    return {room: COLUMN[room] if room in COLUMN else next(free) for room in rooms}


def _line(upper: tuple[float, float], lower: tuple[float, float]) -> str:
    (x, y), (u, v) = (upper[0] + BOX / 2, upper[1] + HIGH), (lower[0] + BOX / 2, lower[1])
    bend = max((v - y) / 2, 14.0)
    return f'<path class="line" d="M{x:g},{y:g} C{x:g},{y + bend:g} {u:g},{v - bend:g} {u:g},{v:g}"/>'


def _box(room: str, x: float, y: float, taken: list[int]) -> str:
    kind = "path" if taken else "room"
    parts = [
        f'<rect class="{kind}" x="{x:g}" y="{y:g}" width="{BOX}" height="{HIGH}" rx="5"/>',
        f'<text class="name" x="{x + 9:g}" y="{y + 19:g}">{escape(room)}</text>',
    ]
    lines = textwrap.wrap(words(room).rstrip("."), 34)[:4]
    parts += [
        f'<text class="words" x="{x + 9:g}" y="{y + 33 + 12.5 * n:g}">{escape(line)}</text>'
        for n, line in enumerate(lines)
    ]
    for n, step in enumerate(reversed(taken)):
        middle = x + BOX - 13 - 19 * n
        parts.append(f'<circle class="badge" cx="{middle:g}" cy="{y + 14:g}" r="8.5"/>')
        parts.append(f'<text class="step" x="{middle:g}" y="{y + 17.8:g}">{step}</text>')
    return "\n".join(parts)


def main() -> None:
    """Write the picture, or check the one that is there."""
    if "--check" in sys.argv[1:]:
        if not PICTURE.exists() or PICTURE.read_text(encoding="utf-8") != svg():
            sys.exit("docs/figures/architecture.svg is not what the code is: python -m tools.architecture")
        return
    PICTURE.write_text(svg(), encoding="utf-8")


if __name__ == "__main__":
    main()
