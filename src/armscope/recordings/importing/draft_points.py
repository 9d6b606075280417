"""Which columns of a foreign table are measured points: one, or those of several reflectors."""

from __future__ import annotations

import re
from collections.abc import Sequence

from armscope.recordings.importing.first_table import ForeignTable

COMMANDED = ("target", "cmd", "command", "commanded", "set", "desired", "nominal", "ref", "soll", "指令", "理论")
MEASURED = ("measured", "meas", "actual", "act", "ist", "tracker", "laser", "leica", "faro", "mcs", "测量", "实测")

AXIS = re.compile(r"(?<![a-z])(?:pos|coord|p)?([xyz])(?![a-z])")


def points_of(table: ForeignTable, taken: Sequence[int]) -> list[list[int]]:
    """The three columns of each measured point, those of one name with numbers 1, 2, ... in their order. Returns
    Columns along x, y, z by reflector; nothing where no columns look like a point."""
    if not table.header:
        return [list(range(len(taken), len(taken) + 3))] if taken else []
    found: dict[str, dict[str, int]] = {}
    for column, name in enumerate(table.names):
        if column in taken:
            continue
        apart = re.sub(r"(?<=[a-z])(?=[XYZ](?![A-Za-z]))", " ", name)  # PosX
        for match in AXIS.finditer(apart.lower().replace("_", " ")):
            rest = (apart[: match.start(1)] + "?" + apart[match.end(1) :]).lower()
            found.setdefault(rest, {})[match[1]] = column
    whole = {rest: [axes[a] for a in "xyz"] for rest, axes in found.items() if set(axes) == set("xyz")}
    whole = {rest: columns for rest, columns in whole.items() if not _NO_POINT.search(rest)}
    if not whole:
        return []
    best = max(whole, key=lambda rest: (_measured(rest), -whole[rest][0]))
    alike = {_number(rest): columns for rest, columns in whole.items() if _bare(rest) == _bare(best)}
    numbered = [alike.get(number) for number in range(1, len(alike) + 1)]
    several = [columns for columns in numbered if columns is not None]
    return several if len(several) == len(alike) > 1 else [whole[best]]


_NO_POINT = re.compile(r"r\?|rot|orient|q\?|quat|force|f\?|sigma")
"""What stands beside an axis' letter where a column is no length."""


def _measured(rest: str) -> int:
    """Whether a name says that it is measured (1) or commanded (-1)."""
    return any(word in rest for word in MEASURED) - any(word in rest for word in COMMANDED)


def _bare(rest: str) -> str:
    return re.sub(r"\d+", "#", rest)


def _number(rest: str) -> int:
    numbers = re.findall(r"\d+", rest)
    return int(numbers[0]) if len(numbers) == 1 else -1
