"""The page about the numbers that decide, made from where they are defined.

python -m tools.constants           # writes docs/constants.md
python -m tools.constants --check   # fails where the page is not what the code is
"""

from __future__ import annotations

import importlib
import pkgutil
import sys
from collections import Counter
from pathlib import Path

import armscope
from armscope.core.constants import BASES, Constants, entries

PAGE = Path(__file__).parents[1] / "docs" / "constants.md"
ROOMS = (
    "check",
    "measurement",
    "inference",
    "fitting",
    "diagnosis",
    "motion",
    "robot",
    "recordings",
    "compensation",
    "calibration",
    "comparison",
    "fleet",
    "poses",
    "real",
)
"""Rooms whose every number is on the page."""
SHOWN = ("physics", *ROOMS)
"""Of physics, how large each error is on real arms; other numbers there are what an effect is made of."""
HEAD = """# Numbers that decide

Made from the code by `python -m tools.constants`. A number is *measured* (an experiment is named), *derived* (a
formula gives it), a *convention* (what everybody does), or a *judgement* (somebody's view, nothing more).
"""


def groups() -> list[type[Constants]]:
    """All groups of the rooms that decide, by module and place in it."""
    for room in SHOWN:
        package = importlib.import_module(f"armscope.{room}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    order = [f"{armscope.__name__}.{room}" for room in SHOWN]
    found = [each for each in Constants.__subclasses__() if each.__module__.startswith(tuple(order))]
    return sorted(found, key=lambda each: (order.index(".".join(each.__module__.split(".")[:2])), each.__module__))


def page() -> str:
    """The page's text."""
    kinds = Counter(number.basis.partition(":")[0] for group in groups() for number in entries(group))
    count = ", ".join(f"{kinds[basis]} {basis}" for basis in BASES)
    parts = [HEAD, f"{sum(kinds.values())} numbers: {count}.\n"]
    for group in groups():
        home = group.__module__.removeprefix("armscope.").replace(".", "/") + ".py"
        told = str(group.__doc__).splitlines()[0]
        parts.append(f"## `{group.__name__}`: {told[0].lower()}{told[1:].rstrip('.')} (`{home}`)\n")
        parts.append("| name | value | unit | meaning | basis |\n|---|---|---|---|---|")
        parts += [
            f"| `{each.name}` | {shown(each.value)} | {each.unit} | {each.meaning} | {each.basis} |"
            for each in entries(group)
        ]
        parts.append("")
    return "\n".join(parts)


def shown(value: object) -> str:
    """A value as text; shares of pi and the like to six digits."""
    if isinstance(value, tuple):
        return ", ".join(map(shown, value))
    return f"{value:.8g}" if isinstance(value, float) else str(value)


def main() -> None:
    """Write the page, or check the one that is there."""
    if "--check" in sys.argv[1:]:
        if not PAGE.exists() or PAGE.read_text(encoding="utf-8") != page():
            sys.exit("docs/constants.md is not what the code is: python -m tools.constants")
        return
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
