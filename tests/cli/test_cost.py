"""A long table's cost is said before the work, a short one's is not."""

from pathlib import Path

import pytest

from armscope.cli import cost
from armscope.cli.cost import Cost, announce


@pytest.fixture
def table(tmp_path) -> Path:
    path = tmp_path / "table.csv"
    path.write_text("q1_rad\n" + "0.1234\n" * 1000)
    return path


def test_a_short_table_costs_nothing_to_speak_of(table, capsys):
    announce(table, cost.DIAGNOSE, 1)
    assert capsys.readouterr().err == ""


def test_time_memory_and_processes_are_told(table, capsys, monkeypatch):
    monkeypatch.setattr(cost, "LONG_ROWS", 500)
    announce(table, Cost(start_s=10.0, row_us=1e6, start_mb=100.0, row_kb=100.0), 2)
    told = capsys.readouterr().err
    assert "17 minutes of CPU time, shared by 2 processes, and 0.2 GB of memory" in told
    assert "free here" not in told


def test_too_little_memory_is_told_with_a_cure(table, capsys, monkeypatch):
    monkeypatch.setattr(cost, "LONG_ROWS", 500)
    monkeypatch.setattr(cost, "_free_mb", lambda: 50.0)
    announce(table, Cost(1.0, 1.0, 100.0, 1.0), 1)
    assert "0.1 GB are free here: keep one row in 3, or take a larger machine" in capsys.readouterr().err


def test_what_is_said_of_the_longest_tables_is_not_below_what_was_measured():
    """Commands of `benchmarks.scale`, measured at two lengths on a busy machine, continued to ten million rows."""
    for said, (short, long), (rows, more) in (
        (cost.DIAGNOSE, ((19.6, 670), (143.5, 1427)), (100_000, 1_000_000)),
        (cost.PREDICT, ((3.8, 264), (8.3, 333)), (100_000, 300_000)),
        (cost.COMPENSATE, ((14.7, 509), (128.2, 1085)), (100_000, 1_000_000)),
    ):
        seconds, megabytes = (
            at + (far - at) * (10_000_000 - rows) / (more - rows) for at, far in zip(short, long, strict=True)
        )
        assert said.seconds(10_000_000) >= seconds
        assert said.megabytes(10_000_000) >= megabytes
