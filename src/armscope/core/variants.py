"""The table of a sweep: which variants of swarm and model to run."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Literal

import pydantic
from pydantic import Field

from armscope.core.inputs import InputError, Strict, nearest, note_read

VARIED = {
    "particles": "particles", "iterations": "iterations", "update": "update", "harmonics": "order", "basis": "basis",
    "layout": "layout",
}  # fmt: skip
"""What is on the horizontal axis of a sweep, by the first word of its name; all others vary the model's order."""

OPTIONAL = ("basis", "layout")  # Columns that may be left out or empty


class Variant(Strict):
    """One row of a sweep's table; basis and layout may be left out or empty: then they are the study's."""

    id: str = Field(pattern=r"^\w+$")
    sweep: str = Field(pattern=r"\S")
    family: Literal["polynomial", "fourier"]
    order: int = Field(ge=1)
    space: Literal["cartesian", "angular"]
    particles: int = Field(ge=2)
    iterations: int = Field(ge=1)
    update: Literal["constriction", "inertia", "original"]
    neighbourhood: Literal["gbest", "ring"]
    basis: Literal["raw", "standardised", "qr"] | None = None
    layout: Literal["per axis", "joint"] | None = None
    seeds: int = Field(ge=1)

    @property
    def varied(self) -> str | int:
        """Where the variant stands on the sweep's horizontal axis."""
        value: str | int = getattr(self, VARIED.get(self.sweep.split()[0], "order"))
        return value


def read_variants(path: Path | str) -> list[Variant]:
    """The variants of a sweep's table (CSV). Raises InputError: a column, value or id that can't be; it names row,
    column, rule."""
    header, *rows = _lines(Path(path))
    for column in header:
        if column not in Variant.model_fields:
            raise InputError(path, "line 1", column, "no such column", nearest(column, Variant.model_fields))
    variants = []
    for number, row in enumerate(rows, start=2):
        if len(row) != len(header):
            found = f"{len(row)} values" if row else "nothing"
            raise InputError(path, f"line {number}", found, f"every row has the {len(header)} values that line 1 names")
        variants.append(_variant(path, number, dict(zip(header, row, strict=True))))
    seen: dict[str, int] = {}
    for number, variant in enumerate(variants, start=2):
        if variant.id in seen:
            raise InputError(
                path, f"line {number}, column id", variant.id, f"ids differ, line {seen[variant.id]} has it"
            )
        seen[variant.id] = number
    return variants


def _lines(path: Path) -> list[list[str]]:
    """The rows of a CSV file, its header first."""
    note_read(path)
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            rows = list(csv.reader(stream, strict=True))
    except OSError as error:
        raise InputError(
            path, "", "no readable file", "a sweep's table is needed here", error.strerror or ""
        ) from error
    except UnicodeDecodeError as error:
        raise InputError(path, "", "no UTF-8 text", "tables are UTF-8", "Save it as UTF-8.") from error
    except csv.Error as error:
        raise InputError(path, "", str(error), "this must be a comma-separated table") from error
    if not rows or not rows[0]:
        raise InputError(path, "line 1", "nothing", "the first line names the columns")
    return rows


def _variant(path: Path | str, number: int, row: dict[str, str]) -> Variant:
    try:
        return Variant.model_validate(
            {column: value for column, value in row.items() if value or column not in OPTIONAL}
        )
    except pydantic.ValidationError as error:
        problem = error.errors()[0]
        place = f"line {number}" + (f", column {problem['loc'][0]}" if problem["loc"] else "")
        raise InputError(path, place, problem["input"], problem["msg"].lower()) from error
