"""A plain table's shape is told without the csv module as the csv module tells it."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.core.parallel import processes
from armscope.recordings import textfile
from armscope.recordings.constants import PIECES

TABLES = {
    "plain": "a,b,c\n1,2,3\n4,5,6\n",
    "no last newline": "a,b\n1,2\n3,4",
    "ragged": "a,b\n1\n3,4,5\n",
    "blank lines": "a,b\n\n1,2\n\n",
    "blank first line": "\na,b\n1,2\n",
    "header alone": "a,b",
    "empty values": "a,b\n,\n,,\n",
    "spaces": "a , b\n 1, 2\n",
}


def shapes(path: Path, text: str) -> tuple[object, object] | None:
    """Header and lengths of rows, by pieces and by the csv module; None where pieces leave them to that."""
    path.write_text(text, encoding="utf-8", newline="")
    header, counts, pieces = textfile._shape(path)
    rows = csv.reader(io.StringIO(text, newline=""))
    return ((header, counts), (next(rows), [len(row) for row in rows])) if pieces else None


@pytest.mark.parametrize("text", TABLES.values(), ids=TABLES)
@pytest.mark.parametrize("size", [1, 3, 1000])
def test_it_is_as_csv_says(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, text: str, size: int) -> None:
    monkeypatch.setattr(textfile, "PIECES", replace(PIECES, size=size))
    found = shapes(tmp_path / "table.csv", text)
    assert found is not None
    assert found[0] == found[1]


@pytest.mark.parametrize("size", [1, 2, 7])
def test_any_text_is_as_csv_says_or_left_to_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, size: int) -> None:
    monkeypatch.setattr(textfile, "PIECES", replace(PIECES, size=size))
    rng, told = np.random.default_rng(1), 0
    for _ in range(300):
        text = "".join(rng.choice(list('ab,\n"\r'), rng.integers(1, 15), p=[0.3, 0.2, 0.2, 0.2, 0.05, 0.05]))
        if found := shapes(tmp_path / "table.csv", text):
            told += 1
            assert found[0] == found[1], text
    assert told > 50


@pytest.mark.parametrize("text", ["", 'a,b\n"1",2\n', "a,b\r\n1,2\r\n"])
def test_the_rest_is_left_to_csv(tmp_path: Path, text: str) -> None:
    (tmp_path / "table.csv").write_text(text, encoding="utf-8", newline="")
    *_, pieces = textfile._shape(tmp_path / "table.csv")
    assert pieces == []


def test_a_line_that_csv_refuses_is_refused(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("a\n" + 200_000 * "1" + "\n", encoding="utf-8")
    with pytest.raises(InputError, match="field larger than field limit"):
        textfile.read_text_table(tmp_path / "table.csv")


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("mark", ["", "\ufeff"], ids=["plain", "byte-order mark"])
def test_a_table_is_the_same_read_in_pieces_by_any_number_of_processes(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, count: int, mark: str
) -> None:
    lines = [f"r\u00fcn,{number},{number / 7},{'' if number % 3 else number}" for number in range(60)]
    text = "\n".join([f"{mark}run,id,x_mm,", *lines])
    (tmp_path / "table.csv").write_text(text, encoding="utf-8")
    whole = textfile.read_text_table(tmp_path / "table.csv")
    assert len(whole) == len(lines)
    monkeypatch.setattr(textfile, "PIECES", replace(PIECES, size=100))
    with processes(count):
        pd.testing.assert_frame_equal(textfile.read_text_table(tmp_path / "table.csv"), whole)


def test_memory_that_ends_is_no_fault_of_the_table(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Pandas says it in the same words as a cell too many: a good table was called a bad one."""
    (tmp_path / "table.csv").write_text("a,b\n1,2\n")

    def full(*arguments: object, **how: object) -> None:
        raise pd.errors.ParserError("Error tokenizing data. C error: out of memory")

    monkeypatch.setattr(pd, "read_csv", full)
    with pytest.raises(MemoryError):
        textfile.read_text_table(tmp_path / "table.csv")
