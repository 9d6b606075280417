"""A table's length is guessed from its first lines, near enough to say what it will cost."""

import gzip

import pytest

from armscope.recordings.first_lines import estimated_rows


@pytest.mark.parametrize("packed", [False, True])
def test_the_guess_is_near(tmp_path, packed):
    text = "q1_rad,q2_rad\n" + "".join(f"{k / 7:.6f},{k / 3:.3f}\n" for k in range(20_000))
    path = tmp_path / "table.csv"
    path.write_bytes(gzip.compress(text.encode()) if packed else text.encode())
    assert estimated_rows(path) == pytest.approx(20_000, rel=0.2)


@pytest.mark.parametrize("content", [b"", b"\x1f\x8b", b"no line", b"\xff\xfe\n"])
def test_what_is_no_table_has_no_length(tmp_path, content):
    path = tmp_path / "table.csv"
    path.write_bytes(content)
    assert estimated_rows(path) <= 1


def test_a_file_that_is_not_there_has_no_length(tmp_path):
    assert estimated_rows(tmp_path / "nothing.csv") == 0
