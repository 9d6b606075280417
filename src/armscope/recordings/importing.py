"""Raw files to a recordings table, as a mapping says: piece by piece, every dropped row reported, nothing guessed."""

from __future__ import annotations

import contextlib
import gzip
import io
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

import pandas as pd

from armscope.files import replacing
from armscope.inputs import InputError
from armscope.recordings.conversion import Converter
from armscope.recordings.mapping import Mapping, Run, load_mapping, runs_for
from armscope.recordings.pieces import BesideFiles, Filter, LeftOut, Piece
from armscope.recordings.rawfiles import read_pieces

DIGITS = 10
NAMED_ROWS = 8


@dataclass
class RunReport:
    """One imported run: rows read and written, and what each filter left out."""

    run: str
    file: str
    rows_read: int = 0
    rows_written: int = 0
    left_out: list[LeftOut] = field(default_factory=list)
    notes: Counter[str] = field(default_factory=Counter)


@dataclass
class ImportReport:
    """What an import did, for the user."""

    output: Path
    columns: tuple[str, ...]
    runs: list[RunReport]

    def text(self) -> str:
        """The report in words."""
        lines = [f"{self.output}: {sum(run.rows_written for run in self.runs)} rows, {len(self.runs)} run(s)"]
        lines += ["columns: " + ", ".join(self.columns)]
        for run in self.runs:
            lines.append(f"run {run.run} from {run.file}: {run.rows_written} of {run.rows_read} rows")
            lines += [f"  left out, {out.rule}: {len(out.rows)} rows ({_shortened(out.rows)})" for out in run.left_out]
            lines += [f"  {text}: {count}" for text, count in run.notes.items()]
        return "\n".join(lines)


def _shortened(rows: list[int]) -> str:
    if not rows:
        return "none"
    return "source rows " + ", ".join(map(str, rows[:NAMED_ROWS])) + (", ..." if len(rows) > NAMED_ROWS else "")


def import_recordings(raw_files: list[Path], mapping_file: Path | str, output: Path | str) -> ImportReport:
    """Convert raw files to a recordings table (``.gz`` compresses), whole or not at all.

    Args:
        raw_files: the files; the mapping names them without their folders.
        mapping_file: mapping.yaml.
        output: the table to write.

    Raises:
        InputError: anything that can't be converted, with file, line, column, value, rule and cure.
    """
    mapping = load_mapping(mapping_file)
    runs = runs_for(mapping, [Path(path) for path in raw_files], mapping_file)
    columns = _table_columns(mapping, [run for run, _ in runs])
    report = ImportReport(Path(output), tuple(columns), [])
    with replacing(output) as beside, _writing(beside) as stream:
        stream.write(",".join(columns) + "\n")
        for run, paths in runs:
            report.runs.append(RunReport(run.run, run.file))
            for piece in convert_run(mapping, run, paths, report.runs[-1]):
                piece.reindex(columns=columns).to_csv(
                    stream, index=False, header=False, float_format=f"%.{DIGITS}g", lineterminator="\n"
                )
    return report


@contextlib.contextmanager
def _writing(path: Path) -> Iterator[IO[str]]:
    if path.suffix != ".gz":
        with path.open("w", encoding="utf-8", newline="") as stream:
            yield stream
        return
    # no name and no time in the header: the same input gives the same bytes
    with path.open("wb") as raw, gzip.GzipFile(filename="", mode="wb", fileobj=raw, mtime=0) as packed:
        text = io.TextIOWrapper(packed, encoding="utf-8", newline="")
        yield text
        text.flush()


def _table_columns(mapping: Mapping, runs: list[Run]) -> list[str]:
    """The columns of the table, in the contract's order: those that any run has."""
    stated = [mapping.columns.with_own(run.columns) for run in runs]
    counts = {len(columns.angles.columns) for columns in stated if columns.angles is not None}
    motors = range(1, max(counts) + 1)
    if len(counts) > 1:
        raise InputError("mapping", "angles", f"{sorted(counts)} motors", "every run has the same motors")

    def any_has(*groups: str) -> bool:
        return any(getattr(columns, group) is not None for columns in stated for group in groups)

    names = ["id", "run"] + ["target"] * any_has("target") + [f"q{j}_rad" for j in motors] + ["x_mm", "y_mm", "z_mm"]
    names += ["qw", "qx", "qy", "qz"] * any_has("orientation", "pose")
    names += [f"tau{j}_nm" for j in motors] * any_has("torque") + [f"dq{j}_rad_s" for j in motors] * any_has("speed")
    names += [f"approach{j}" for j in motors] * any_has("approach")
    names += ["payload_kg"] * any_has("payload") + ["time_s"] * any_has("time")
    names += ["temperature_c"] * any_has("temperature")
    return names + [f"sigma_{axis}_mm" for axis in "xyz"] * any_has("sigma")


def convert_run(mapping: Mapping, run: Run, paths: dict[str, Path], report: RunReport) -> Iterator[pd.DataFrame]:
    """The rows of one run as pieces of a recordings table; ``report`` counts along.

    Args:
        mapping: the mapping as a whole.
        run: the run, one of `runs_for`.
        paths: its files by name.
        report: takes the counts.
    """
    beside = BesideFiles(mapping, run, paths, report.notes)
    filters = [Filter(rule) for rule in (mapping.rows if run.rows is None else run.rows)]
    report.left_out = [each.left_out for each in filters]
    converter = Converter(mapping.columns.with_own(run.columns), run.run)
    for rows in read_pieces(paths[run.file], run.format or mapping.format, report.notes):
        report.rows_read += len(rows)
        piece = Piece(rows, beside)
        for each in filters:
            piece = each.apply(piece)
        if len(piece):
            report.rows_written += len(piece)
            yield converter.table(piece)
    beside.check_all_used(report.rows_read)
    if report.rows_written == 0:
        raise InputError(
            paths[run.file], f"run {run.run}", "no row left", "at least one row is needed", _what_left_nothing(report)
        )


def _what_left_nothing(report: RunReport) -> str:
    """Which row filter left nothing."""
    return " ".join(f"Left out, {out.rule}: {len(out.rows)}." for out in report.left_out)
