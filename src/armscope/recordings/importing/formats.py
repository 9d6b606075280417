"""How raw files are written, which rows stay, and when they were recorded: what mappings of all tables share."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Annotated, Literal, Self

import pydantic
from pydantic import Field

from armscope.core.inputs import Strict


def _column(value: object) -> object:
    if isinstance(value, bool) or not isinstance(value, int | str) or value == "":
        raise ValueError("a column is a name from the header or a number counted from 1")
    if isinstance(value, int) and value < 1:
        raise ValueError("columns are counted from 1: the first column is 1")
    return value


Column = Annotated[int | str, pydantic.BeforeValidator(_column)]


class CellsFormat(Strict):
    """Cells in lines; ``decimal`` is the sign that every number uses, ``missing`` are words for no value.

    ``below_header`` lines below the names hold units, say, and are passed over; lines after ``last_line`` are not read.
    ``thousands`` is the sign between groups of three digits; a blank stands for those that do not break a line, too.
    """

    decimal: Literal[".", ","] = "."
    thousands: Literal[",", ".", " ", "'"] | None = None
    header: bool = True
    skip_lines: int = Field(default=0, ge=0)
    below_header: int = Field(default=0, ge=0)
    last_line: int | None = Field(default=None, ge=1)
    comment: str | None = Field(default=None, min_length=1)
    missing: tuple[str, ...] = ("", "NaN", "nan", "NA")

    @pydantic.model_validator(mode="after")
    def _of_one_meaning(self) -> Self:
        if self.thousands == self.decimal:
            raise ValueError("`thousands` and `decimal` can't be the same sign")
        if self.below_header and not self.header:
            raise ValueError("without a header there is nothing below it: say `skip_lines` in place of `below_header`")
        return self


class TextFormat(CellsFormat):
    """Delimited text; quotation marks may stand around a cell that holds the delimiter.

    ``values_per_row`` cuts a flat list of values, one a line, into rows.
    """

    kind: Literal["text"] = "text"
    delimiter: Literal[",", ";", "tab", "|", "whitespace"] = ","
    values_per_row: int | None = Field(default=None, ge=2)
    encoding: str = "utf-8-sig"

    @pydantic.model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.delimiter == "whitespace" and self.thousands == " ":
            raise ValueError("blanks between thousands can't be told from those between columns")
        if self.values_per_row is not None and self.header:
            raise ValueError("a flat list (`values_per_row`) has no header: say `header: false`")
        return self


class MatlabFormat(Strict):
    """A real matrix in a MATLAB file (up to v7.2); ``variable`` may be left out where the file holds one only."""

    kind: Literal["matlab"]
    variable: str | None = None


def _text_unless_said(value: object) -> object:
    return {"kind": "text", **value} if isinstance(value, dict) and "kind" not in value else value


class WorkbookFormat(CellsFormat):
    """A sheet of an Excel workbook (.xlsx, .xlsm); without ``sheet`` the first one. A formula counts as its value."""

    kind: Literal["workbook"]
    sheet: str | None = None


Format = Annotated[
    TextFormat | WorkbookFormat | MatlabFormat, Field(discriminator="kind"), pydantic.BeforeValidator(_text_unless_said)
]


class Range(Strict):
    """Numbers of a column from ``low`` to ``high``, both included; one of them may be left open."""

    column: Column
    low: float | None = None
    high: float | None = None

    @pydantic.model_validator(mode="after")
    def _bounded(self) -> Self:
        if self.low is None and self.high is None:
            raise ValueError("`between` needs `low`, `high` or both")
        if self.low is not None and self.high is not None and self.low > self.high:
            raise ValueError("`low` is above `high`, so that no row would be left")
        return self


class Equal(Strict):
    """Rows where a column says ``value``."""

    column: Column
    value: float | str


class RowFilter(Strict):
    """Which rows stay; exactly one rule. Every filter reports the source rows that it left out."""

    drop_missing: tuple[Column, ...] | None = Field(default=None, min_length=1)
    first_of: tuple[Column, ...] | None = Field(default=None, min_length=1)
    between: Range | None = None
    equal: Equal | None = None

    @pydantic.model_validator(mode="after")
    def _one_rule(self) -> Self:
        if len(self.model_fields_set) != 1 or all(rule is None for _, rule in self):  # one that is empty is none
            raise ValueError("a row filter has one rule: `drop_missing`, `first_of`, `between` or `equal`")
        return self


class Time(Strict):
    """When a row was recorded: numbers with a ``unit``, or time stamps with a strftime ``format``.

    Time stamps become seconds since the first row of the run.
    """

    column: Column
    unit: Literal["s", "ms", "min", "h"] | None = None
    format: str | None = None

    @pydantic.model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.unit is None) == (self.format is None):
            raise ValueError("a time has a `unit` (numbers) or a `format` (time stamps), one of the two")
        if self.format is not None:
            self._check_directives(self.format)
        return self

    @staticmethod
    def _check_directives(style: str) -> None:
        try:
            datetime.strptime("", style)
        except re.error as error:
            raise ValueError(f"`format` has each directive of strftime once: {error.msg}") from error
        except ValueError as error:
            if "bad directive" in str(error) or "stray %" in str(error):
                raise ValueError(f"`format` is written with the directives of strftime: {error}") from error
