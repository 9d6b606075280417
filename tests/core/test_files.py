"""Files are written whole or not at all."""

import gzip
import json
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest

from armscope.core import files
from armscope.core.files import read_json, replacing, write_json, write_table
from armscope.core.inputs import InputError
from armscope.core.parallel import processes


def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path):
    target = tmp_path / "table.csv"
    target.write_text("old")
    with pytest.raises(RuntimeError):
        _fail_halfway(target)
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def _fail_halfway(target):
    with replacing(target) as beside:
        beside.write_text("half of the new")
        raise RuntimeError


def test_the_same_table_has_the_same_bytes_even_compressed(tmp_path):
    table = pd.DataFrame({"x_mm": [1 / 3, np.nan], "run": ["a", "b"]})
    for name in ("one.csv.gz", "two.csv.gz"):
        write_table(tmp_path / name, table)
    assert (tmp_path / "one.csv.gz").read_bytes() == (tmp_path / "two.csv.gz").read_bytes()
    assert pd.read_csv(tmp_path / "one.csv.gz")["x_mm"][0] == pytest.approx(1 / 3, rel=1e-9)


def test_json_has_plain_numbers_and_null_for_what_is_not_one(tmp_path):
    write_json(tmp_path / "a.json", {"a": np.float64(1.5), "b": np.array([1, 2]), "c": float("nan")})
    assert json.loads((tmp_path / "a.json").read_text()) == {"a": 1.5, "b": [1, 2], "c": None}


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (b'{"a": NaN}', "NaN is no number of JSON"),
        (b'{"a": 1e999}', "1e999 is too large a number"),
        (b'{"a": 12345678901234567890}', "a whole number of 20 digits"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"a": 1', "Expecting"),
        (gzip.compress(b"[" + b" " * 10_000_000 + b"]"), "No table or model packs so well"),
    ],
)
def test_json_that_no_program_here_wrote_is_refused_with_the_reason(tmp_path, text, why):
    (tmp_path / "a.json").write_bytes(text)
    with pytest.raises(InputError, match=why):
        read_json(tmp_path / "a.json", "a model")


def test_json_is_read_packed_or_not(tmp_path):
    for name, pack in (("a.json", bytes), ("a.json.gz", gzip.compress)):
        (tmp_path / name).write_bytes(pack(b'{"a": [1, 2.5, 123456789012345678]}'))
        assert read_json(tmp_path / name, "a model") == {"a": [1, 2.5, 123456789012345678]}


def test_what_a_killed_process_leaves_is_no_table_to_anybody(tmp_path):
    code = (
        "import os, signal, sys\nfrom armscope.core.files import replacing\n"
        "with replacing(sys.argv[1]) as beside:\n"
        "    beside.write_text('half')\n    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    subprocess.run([sys.executable, "-c", code, tmp_path / "table.csv"], check=False)
    left = list(tmp_path.iterdir())
    assert [path.suffix for path in left] == [".part"]
    assert list(tmp_path.glob("*.csv")) == []


def test_a_table_has_the_bytes_that_pandas_writes_number_by_number(tmp_path):
    numbers = [1.5, float("nan"), float("inf"), -0.0, 1e-300, 123456789.123456]
    words = ['x,"y"', "", None, "z", "w\n", "nan"]
    table = pd.DataFrame({"a": numbers, "b": words, "c": range(6), "d": np.float32(numbers), "e": [True, False] * 3})
    for some in (table, table[["a"]], table.head(0)):
        write_table(tmp_path / "a.csv", some, digits=7)
        expected = some.to_csv(index=False, float_format="%.7g", lineterminator="\n")
        assert (tmp_path / "a.csv").read_bytes().decode() == expected


@pytest.mark.parametrize("name", ["table.csv", "table.csv.gz"])
def test_several_processes_write_the_same_bytes(tmp_path, monkeypatch, name):
    monkeypatch.setattr(files, "ROWS_AT_A_TIME", 7)
    table = pd.DataFrame({"a": np.linspace(0, 1, 50), "b": np.arange(50), "c": [f"n{k}" for k in range(50)]})
    written = []
    for count in (1, 2):
        with processes(count):
            files.write_table(tmp_path / name, table)
        written.append((tmp_path / name).read_bytes())
    assert written[0] == written[1]
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / name), table)
