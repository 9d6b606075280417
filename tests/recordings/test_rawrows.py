from collections import Counter

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.recordings.importing.formats import TextFormat
from armscope.recordings.importing.rawfiles import read_pieces
from armscope.recordings.importing.rawrows import TextRows, joined


def pieces(tmp_path, text: str, name: str) -> list[TextRows]:
    (tmp_path / name).write_text(text)
    return list(read_pieces(tmp_path / name, TextFormat(), Counter()))


def test_pieces_of_a_file_become_one_with_their_lines(tmp_path):
    (whole,) = pieces(tmp_path, "a,b\n1,2\n3,4\n5,6\n", "whole.csv")
    first, second = whole.take(np.array([0, 1])), whole.take(np.array([2]))
    again = joined([first, second])
    assert again.numbers("b").tolist() == [2.0, 4.0, 6.0]
    assert again.lines.tolist() == whole.lines.tolist() == [2, 3, 4]
    assert again.numbers_of_rows.tolist() == [1, 2, 3]


def test_a_column_that_stands_twice_must_be_told_by_its_number(tmp_path):
    (rows,) = pieces(tmp_path, "a,a\n1,2\n", "twice.csv")
    with pytest.raises(InputError, match="2 times"):
        rows.numbers("a")
    assert rows.numbers(2).tolist() == [2.0]
