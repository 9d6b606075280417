"""A plain table's shape is told without the csv module as the csv module tells it."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from armscope.recordings import textfile

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


@pytest.mark.parametrize("text", TABLES.values(), ids=TABLES)
@pytest.mark.parametrize("block", [1, 3, 1000])
def test_it_is_as_csv_says(monkeypatch: pytest.MonkeyPatch, text: str, block: int) -> None:
    monkeypatch.setattr(textfile, "BLOCK", block)
    rows = csv.reader(io.StringIO(text))
    assert textfile.plain_shape(io.StringIO(text)) == (next(rows), [len(row) for row in rows])


@pytest.mark.parametrize("block", [1, 2, 7])
def test_any_text_is_as_csv_says_or_left_to_it(monkeypatch: pytest.MonkeyPatch, block: int) -> None:
    monkeypatch.setattr(textfile, "BLOCK", block)
    rng, told = np.random.default_rng(1), 0
    for _ in range(300):
        text = "".join(rng.choice(list('ab,\n"\r'), rng.integers(1, 15), p=[0.3, 0.2, 0.2, 0.2, 0.05, 0.05]))
        if (plain := textfile.plain_shape(io.StringIO(text, newline=""))) is None:
            continue
        rows, told = csv.reader(io.StringIO(text, newline="")), told + 1
        assert plain == (next(rows), [len(row) for row in rows]), text
    assert told > 50


@pytest.mark.parametrize("text", ["", 'a,b\n"1",2\n', "a,b\r\n1,2\r\n", "a\n" + 200_000 * "1" + "\n"])
def test_the_rest_is_left_to_csv(text: str) -> None:
    assert textfile.plain_shape(io.StringIO(text, newline="")) is None
