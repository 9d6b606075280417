"""Raw files to a recordings table, as a mapping says: piece by piece, every dropped row reported, nothing guessed."""

from __future__ import annotations

import contextlib
import gzip
import io
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

import pandas as pd

from armscope.core.files import replacing
from armscope.core.inputs import InputError, nearest
from armscope.recordings.columns import AXES_MM, QUATERNION
from armscope.recordings.importing.constants import DIGITS, LIMITS
from armscope.recordings.importing.conversion import Converter
from armscope.recordings.importing.mapping import Mapping, Run
from armscope.recordings.importing.motions import MotionConverter, MotionMapping, MotionRun, load_any_mapping
from armscope.recordings.importing.pieces import BesideFiles, Filter, LeftOut, Piece
from armscope.recordings.importing.rawfiles import read_pieces

AnyMapping = Mapping | MotionMapping
AnyRun = Run | MotionRun


@dataclass
class RunReport:
    """One imported run: rows read and written, and what each filter left out."""

    run: str
    file: str
    rows_read: int = 0
    rows_written: int = 0
    left_out: list[LeftOut] = field(default_factory=list)
    notes: Counter[str] = field(default_factory=Counter)
    within: set[str] = field(default_factory=set)
    """The runs that its rows name themselves; its own name where they name none."""


@dataclass
class ImportReport:
    """What an import did, for the user."""

    output: Path
    columns: tuple[str, ...]
    runs: list[RunReport]

    def text(self) -> str:
        """The report in words."""
        named = set().union(*(run.within for run in self.runs))
        lines = [f"{self.output}: {sum(run.rows_written for run in self.runs)} rows, {len(named)} run(s)"]
        lines += ["columns: " + ", ".join(self.columns)]
        for run in self.runs:
            several = run.rows_written > run.rows_read
            rows = f"{run.rows_written} {'rows, of' if several else 'of'} {run.rows_read} rows"
            lines.append(f"run {run.run} from {run.file}: {rows}")
            lines += [f"  left out, {out.rule}: {_shortened(out.rows)}" for out in run.left_out]
            lines += [f"  {text}: {count}" for text, count in run.notes.items()]
        return "\n".join(lines)


def _shortened(rows: list[int]) -> str:
    if not rows:
        return "no row"
    some = ", ".join(map(str, rows[: LIMITS.rows_named])) + (", ..." if len(rows) > LIMITS.rows_named else "")
    return f"1 row (source row {some})" if len(rows) == 1 else f"{len(rows)} rows (source rows {some})"


def import_recordings(raw_files: list[Path], mapping_file: Path | str, output: Path | str) -> ImportReport:
    """Convert raw files to a table of recordings or of motions (``.gz`` compresses), whole or not at all.

    Args:
        raw_files: the files; the mapping names them without their folders.
        mapping_file: mapping.yaml.
        output: the table to write.

    Returns:
        What was read, written and passed over, by run.

    Raises:
        InputError: anything that can't be converted, with file, line, column, value, rule and cure.
    """
    _check_output(Path(output), [*raw_files, Path(mapping_file)])
    mapping = load_any_mapping(mapping_file)
    runs = _runs_for(mapping, [Path(path) for path in raw_files], mapping_file)
    columns = _columns_of(mapping, [run for run, _ in runs])
    report = ImportReport(Path(output), tuple(columns), [])
    with replacing(output) as beside, _writing(beside, Path(output).suffix == ".gz") as stream:
        stream.write(",".join(columns) + "\n")
        for run, paths in runs:
            report.runs.append(RunReport(run.run, run.file))
            for piece in _convert_run(mapping, run, paths, report.runs[-1]):
                if "time_s" in piece:  # seconds since 1970 need more digits than anything measured
                    piece["time_s"] = piece["time_s"].map(f"{{:.{DIGITS.time}g}}".format, na_action="ignore")
                piece.reindex(columns=columns).to_csv(
                    stream, index=False, header=False, float_format=f"%.{DIGITS.values}g", lineterminator="\n"
                )
    return report


def _runs_for(mapping: AnyMapping, raw_files: list[Path], source: Path | str) -> list[tuple[AnyRun, dict[str, Path]]]:
    """Each run with the paths of its files, by the names that the mapping uses; none left over."""
    by_name = {path.name: path for path in raw_files}
    if len(by_name) < len(raw_files):
        names = [path.name for path in raw_files]
        twice = next(name for name in names if names.count(name) > 1)
        raise InputError(
            source, "raw files", twice, "two raw files have this name, so the mapping can't tell them apart"
        )
    if not mapping.runs:
        stems = [Path(path.name.removesuffix(".gz")).stem for path in raw_files]
        shared = next((stem for stem in stems if stems.count(stem) > 1), None)
        if shared is not None:
            rule = "runs are named by their files' stems, and two files have this one"
            raise InputError(source, "raw files", shared, rule, "Name the runs in the mapping: `runs`.")
        kind = Run if isinstance(mapping, Mapping) else MotionRun
        return [
            (kind(run=stem, file=path.name), {path.name: path}) for stem, path in zip(stems, raw_files, strict=True)
        ]
    wanted = [(run, [run.file, *(beside.file for beside in run.beside)]) for run in mapping.runs]
    for run, names in wanted:
        for name in names:
            if name not in by_name:
                cure = nearest(name, by_name) if by_name else "No raw file was given."
                raise InputError(source, f"run {run.run}", f"no file {name}", "each run needs its raw files", cure)
    all_wanted = {name for _, names in wanted for name in names}
    for name in by_name:
        if name not in all_wanted:
            raise InputError(
                source, "runs", name, "no run of the mapping uses this raw file", nearest(name, all_wanted)
            )
    return [(run, {name: by_name[name] for name in names}) for run, names in wanted]


def _check_output(output: Path, inputs: list[Path]) -> None:
    """An import never writes over what it reads."""
    if output.is_dir():
        rule = "the table is written to a file"
        raise InputError(output, "", "a folder", rule, f"Say where in it: {output / 'recordings.csv'}.")
    for path in inputs:
        if output.exists() and path.exists() and output.samefile(path):
            raise InputError(output, "", "a file that is read", "the table is written to a file of its own")


@contextlib.contextmanager
def _writing(path: Path, compressed: bool) -> Iterator[IO[str]]:
    if not compressed:
        with path.open("w", encoding="utf-8", newline="") as stream:
            yield stream
        return
    # no name and no time in the header: the same input gives the same bytes
    with path.open("wb") as raw, gzip.GzipFile(filename="", mode="wb", fileobj=raw, mtime=0) as packed:
        text = io.TextIOWrapper(packed, encoding="utf-8", newline="")
        yield text
        text.flush()


def _columns_of(mapping: AnyMapping, runs: Sequence[AnyRun]) -> list[str]:
    return _table_columns(mapping, runs) if isinstance(mapping, Mapping) else mapping.table_columns()


def _table_columns(mapping: Mapping, runs: Sequence[AnyRun]) -> list[str]:
    """The columns of the table, in the contract's order: those that any run has."""
    stated = [mapping.columns.with_own(run.columns) for run in runs if isinstance(run, Run)]
    motors = range(1, max(len(columns.angles.columns) for columns in stated if columns.angles is not None) + 1)

    def any_has(*groups: str) -> bool:
        return any(getattr(columns, group) is not None for columns in stated for group in groups)

    names = ["id", "run"] + ["target"] * any_has("target", "reflectors") + [f"q{j}_rad" for j in motors] + AXES_MM
    names += QUATERNION * any_has("orientation", "pose")
    names += [f"tau{j}_nm" for j in motors] * any_has("torque") + [f"dq{j}_rad_s" for j in motors] * any_has("speed")
    names += [f"approach{j}" for j in motors] * any_has("approach")
    names += ["payload_kg"] * any_has("payload") + ["time_s"] * any_has("time")
    names += ["temperature_c"] * any_has("temperature")
    return names + [f"sigma_{axis}_mm" for axis in "xyz"] * any_has("sigma")


def _convert_run(mapping: AnyMapping, run: AnyRun, paths: dict[str, Path], report: RunReport) -> Iterator[pd.DataFrame]:
    """The rows of one run as pieces of a recordings table, in the order of the file; ``report`` counts along."""
    beside = BesideFiles(run.format or mapping.format, run, paths, report.notes)
    filters = [Filter(rule) for rule in (mapping.rows if run.rows is None else run.rows)]
    report.left_out = [each.left_out for each in filters]
    converter = _converter(mapping, run)
    for rows in read_pieces(paths[run.file], run.format or mapping.format, report.notes):
        beside.forget_before(report.rows_read + 1)
        report.rows_read += len(rows)
        piece = Piece(rows, beside)
        for each in filters:
            piece = each.apply(piece)
        if len(piece):
            table = converter.table(piece)
            report.rows_written += len(table)
            report.within |= set(table["run"]) if "run" in table else {run.run}
            yield table
    beside.check_all_used(report.rows_read)
    if report.rows_written == 0:
        raise InputError(
            paths[run.file],
            f"run {run.run}",
            "no row left",
            "at least one row is needed",
            " ".join(f"Left out, {out.rule}: {len(out.rows)}." for out in report.left_out),
        )


def _converter(mapping: AnyMapping, run: AnyRun) -> Converter | MotionConverter:
    if isinstance(mapping, Mapping) and isinstance(run, Run):
        return Converter(mapping.columns.with_own(run.columns), run.run)
    assert isinstance(mapping, MotionMapping)
    assert isinstance(run, MotionRun)
    return MotionConverter(mapping.columns.with_own(run.columns), run.run)
