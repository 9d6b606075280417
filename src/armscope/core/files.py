"""Writing files so that nobody ever sees half of one: write beside, then rename."""

from __future__ import annotations

import contextlib
import gzip
import json
import os
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from armscope.core.inputs import InputError, nearest


def writable(folder: Path | str) -> Path:
    """A folder for output, made if need be; long work asks first, so that it does not end in vain.

    Raises:
        InputError: nothing can be written there.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        rule = f"output goes into this folder ({error.strerror})"
        raise InputError(folder, "", "no folder that can be written to", rule) from error


def read_table(path: Path | str, columns: Iterable[str] = (), what: str = "a table (CSV)") -> pd.DataFrame:
    """A CSV table that armscope wrote, gzipped or not.

    Args:
        path: the file.
        columns: what it must have.
        what: what it is, for the error.

    Returns:
        The table, every column as pandas reads it.

    Raises:
        InputError: no such file, no table, a column is missing.
    """
    try:
        table = pd.read_csv(path)
    except OSError as error:
        raise _unreadable(path, what, error) from error
    except (pd.errors.EmptyDataError, pd.errors.ParserError, UnicodeDecodeError, EOFError) as error:
        raise InputError(path, "", "no table", f"{what} is needed here", f"{error}") from error
    for column in columns:
        if column not in table:
            raise InputError(
                path,
                "line 1",
                f"no column {column}",
                f"{what} is needed here",
                nearest(column, map(str, table.columns)),
            )
    return table


def read_json(path: Path | str, what: str) -> Any:
    """The content of a JSON file, gzipped or not; ``what`` it is, for the error.

    Raises:
        InputError: no such file, no JSON.
    """
    path = Path(path)
    try:
        content = path.read_bytes()
        return json.loads(gzip.decompress(content) if path.suffix == ".gz" else content)
    except OSError as error:
        raise _unreadable(path, what, error) from error
    except (ValueError, EOFError) as error:
        raise InputError(path, "", "no readable JSON", f"{what} is needed here", str(error)) from error


def _unreadable(path: Path | str, what: str, error: OSError) -> InputError:
    return InputError(path, "", "no readable file", f"{what} is needed here", error.strerror or str(error))


@contextlib.contextmanager
def replacing(path: Path | str) -> Iterator[Path]:
    """A temporary path beside ``path`` that takes its name when the block ends well, and vanishes when it doesn't.

    Where the process is killed, a hidden ``.part`` stays behind, which nobody takes for a finished file.
    """
    path = Path(path)
    writable(path.parent)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}-", suffix=".part", dir=path.parent)
    os.close(handle)
    beside = Path(name)
    try:
        yield beside
        umask = os.umask(0)
        os.umask(umask)
        beside.chmod(0o666 & ~umask)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def write_text(path: Path | str, text: str) -> None:
    """Write text, whole or not at all."""
    with replacing(path) as beside:
        beside.write_text(text, encoding="utf-8")


def write_table(path: Path | str, table: pd.DataFrame, digits: int = 10) -> None:
    """Write a table as CSV without its index, numbers with ``digits`` significant digits (``.gz`` compresses).

    Args:
        path: where to; ``.gz`` compresses.
        table: what to write.
        digits: significant digits of its numbers.
    """
    text = table.to_csv(index=False, float_format=f"%.{digits}g", lineterminator="\n")
    with replacing(path) as beside:
        # no name and no time in the header, so that the same table has the same bytes
        beside.write_bytes(gzip.compress(text.encode(), mtime=0) if str(path).endswith(".gz") else text.encode())


def write_json(path: Path | str, content: Any) -> None:
    """Write JSON, indented, with numpy scalars and arrays as plain numbers; NaN becomes null."""
    write_text(path, json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def write_yaml(path: Path | str, content: Any) -> None:
    """Write YAML in the order of ``content``."""
    write_text(path, yaml.safe_dump(_plain(content), sort_keys=False, allow_unicode=True, width=120))


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
