"""A cell of a pasted D-H table as papers print it: a number, a multiple of pi, a joint's angle and what is added."""

from __future__ import annotations

import math
import re
import unicodedata
from dataclasses import dataclass

_NUMBER = r"(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:e[+-]?\d+)?"
_PART = r"(?:\d+(?:[.,]\d*)?|[.,]\d+)"
_TOKEN = re.compile(
    rf"\s*(?:(?P<pi>(?:(?P<times>{_PART})(?:/(?P<part>{_PART}))?\s*\*?\s*)?pi(?:\s*\*\s*(?P<more>{_PART}))?"
    rf"(?:\s*/\s*(?P<below>{_PART}))?)\s*(?:rad)?"
    rf"|(?P<number>{_NUMBER})\s*(?P<unit>°|deg|rad)?"
    r"|(?P<joint>(?:theta|th|phi|joint|[θϑφqtj])\s*(?P<of>\d{1,2}|[ijn])?(?:\s*\(t\))?\s*\*?)"
    r"|(?P<any>\*)|(?P<sign>[+-])|(?P<open>\()|(?P<close>\)))\s*"
)
_DASHES = re.compile("[\u2010-\u2015\u2212\ufe58\ufe63\uff0d]")
_FRACTION = re.compile(r"\\[dt]?frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}")
_NUMBERED = re.compile(r"(?<=[a-zθϑφ])[\[(](\d{1,2}|[ijn])[\])]")
_LATEX = re.compile(r"[\\$_{}^]|\\(?:left|right|mathrm|circ)")


@dataclass(frozen=True)
class DHCell:
    """A cell's number: the sum of its parts, each in the unit that it is written in.

    Args:
        plain: what has no unit.
        degrees: what is followed by ° or deg.
        radians: multiples of pi, and what is followed by rad.
        turns: 0 where no joint stands in it, else 1, or -1 where it is taken away.
        joint: the number of that joint; None where it has none.
    """

    plain: float = 0.0
    degrees: float = 0.0
    radians: float = 0.0
    turns: int = 0
    joint: int | None = None

    def angle(self, unit: str) -> float:
        """Degrees, where a part without a unit is in `unit`."""
        return (
            self.degrees
            + math.degrees(self.radians + (self.plain if unit == "rad" else 0.0))
            + (0.0 if unit == "rad" else self.plain)
        )


def written_plainly(text: str) -> str:
    """A cell in small letters of ASCII and Greek: no subscripts, no LaTeX, one sign for minus and one for degrees."""
    text = _FRACTION.sub(r"\1/\2", text.replace("º", "°").replace("˚", "°"))
    text = text.replace("^\\circ", "°").replace("^{\\circ}", "°").replace("\\circ", "°")
    text = _DASHES.sub("-", unicodedata.normalize("NFKC", text)).lower()
    text = re.sub(r"[·×⋅]", "*", _LATEX.sub("", text))
    return text.replace("π", "pi").replace("⁄", "/").replace("degrees", "deg").replace("degree", "deg").strip()


def read_dh_cell(text: str) -> DHCell | None:
    """What a cell says; None where it can't be read, nothing is left over.

    A sum of numbers ("-90", "1,5", "90°"), multiples of pi ("3pi/4") and at most one joint's angle ("q2", "θ₂",
    "theta_2", "-q3", "*"), in brackets or not.
    """
    text = _NUMBERED.sub(r"\1", written_plainly(text))
    signs, sign, awaits = [1], 1, True
    sums = {"plain": 0.0, "degrees": 0.0, "radians": 0.0}
    turns, joint, parts, at = 0, None, 0, 0
    while at < len(text):
        found = _TOKEN.match(text, at)
        if found is None or (not awaits and not (found["sign"] or found["close"] or found["any"])):
            return None
        at = found.end()
        if found["sign"]:
            sign, awaits = (sign if awaits else 1) * (-1 if found["sign"] == "-" else 1), True
        elif found["open"]:
            signs.append(signs[-1] * sign)
            sign = 1
        elif found["close"]:
            if awaits or len(signs) == 1:
                return None
            signs.pop()
        elif found["joint"] or found["any"]:
            if turns:
                return None
            turns = signs[-1] * sign if awaits else 1  # "90*": the star marks what turns
            joint = int(found["of"]) if found["of"] and found["of"].isdigit() else None
            awaits = False
        else:
            number = _size(found)
            if number is None:
                return None
            sums[_unit(found)] += signs[-1] * sign * number
            awaits, parts = False, parts + 1
    is_range = parts > 1 and not turns  # "0.1-0.2" is no difference
    return None if awaits or len(signs) > 1 or is_range else DHCell(**sums, turns=turns, joint=joint)


def _unit(found: re.Match[str]) -> str:
    if found["pi"] or found["unit"] == "rad":
        return "radians"
    return "degrees" if found["unit"] else "plain"


def _size(found: re.Match[str]) -> float | None:
    """A number or a multiple of pi; None where it is none that a computer holds."""
    if not found["pi"]:
        value = float(found["number"].replace(",", "."))
        return value if math.isfinite(value) else None
    times, part, more, below = (
        float((found[key] or "1").replace(",", ".")) for key in ("times", "part", "more", "below")
    )
    return times / part * more * math.pi / below if part and below else None


@dataclass(frozen=True)
class DHLine:
    """A row of the table as its cells say it.

    Args:
        number: of the line that it stands in.
        cells: what each column says, by its name in robot.yaml; a column that is empty there is left out.
        theta: its angle as it is written.
    """

    number: int
    cells: dict[str, DHCell]
    theta: str
