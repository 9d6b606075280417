"""The table of a sweep: which variants of swarm and model to run."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Literal

import pydantic
from pydantic import Field

from armscope.core.inputs import InputError, Strict, nearest

VARIED = {
    "particles": "particles", "iterations": "iterations", "update": "update", "harmonics": "order", "basis": "basis",
    "layout": "layout",
}  # fmt: skip
"""What is on the horizontal axis of a sweep, by the first word of its name; all others vary the model's order."""

OPTIONAL = ("basis", "layout")
"""Columns that may be left out or empty."""


class Variant(Strict):
    """One row of a sweep's table; basis and layout may be left out or empty: then they are the study's."""

    id: str = Field(pattern=r"^\w+$")
    sweep: str
    family: Literal["polynomial", "fourier"]
    order: int = Field(ge=1)
    space: Literal["cartesian", "angular"]
    particles: int = Field(ge=2)
    iterations: int = Field(ge=0)
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
    """The variants of a sweep's table (CSV).

    Raises:
        InputError: a column, value or id that can't be; it names row, column, rule.
    """
    with Path(path).open(encoding="utf-8-sig", newline="") as stream:
        table = csv.DictReader(stream)
        for column in table.fieldnames or ():
            if column not in Variant.model_fields:
                raise InputError(path, "line 1", column, "no such column", nearest(column, Variant.model_fields))
        variants = [_variant(path, number, row) for number, row in enumerate(table, start=2)]
    seen: dict[str, int] = {}
    for number, variant in enumerate(variants, start=2):
        if variant.id in seen:
            raise InputError(path, f"row {number}, column id", variant.id, f"ids differ, row {seen[variant.id]} has it")
        seen[variant.id] = number
    return variants


def _variant(path: Path | str, number: int, row: dict[str, str]) -> Variant:
    try:
        return Variant.model_validate(
            {column: value for column, value in row.items() if value or column not in OPTIONAL}
        )
    except pydantic.ValidationError as error:
        problem = error.errors()[0]
        place = f"row {number}, column {problem['loc'][0]}"
        raise InputError(path, place, problem["input"], problem["msg"].lower()) from error
