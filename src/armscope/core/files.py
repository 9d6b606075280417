"""Writing files so that nobody ever sees half of one: write beside, then rename."""

from __future__ import annotations

import contextlib
import glob
import gzip
import io
import json
import os
import shutil
import socket
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml

from armscope.core import outputs
from armscope.core.inputs import InputError, nearest, note_read, why_unreadable
from armscope.core.locks import alive
from armscope.core.parallel import piece_by_piece
from armscope.core.streams import copy_into, is_stream

if TYPE_CHECKING:
    import pandas as pd  # slow to import, and the workflow starts often

LARGEST_UNPACKED_SHARE = 200
"""Bytes for each packed one: recordings unpack to ten times their size, a bomb to a thousand times."""
ROWS_AT_A_TIME = 10_000  # Numbers as text take several times their memory: of thirty columns some forty megabytes
LONGEST_WHOLE = 18  # Digits of a whole number


def writable(folder: Path | str, *names: str) -> Path:
    """A folder for output; long work asks first, so that it does not end in vain.

    Args:
        folder: made if need be; what a command writes is made ready elsewhere, so there it may stay away till the end.

    Raises:
        InputError: nothing can be written there, or not under one of the names.
    """
    folder = Path(folder)
    if (delivery := outputs.current()) is not None and delivery.expect(folder, names):
        return folder
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        raise outputs.unwritable(folder, error) from error


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
    import pandas as pd

    note_read(path)
    try:
        table = pd.read_csv(path)
    except OSError as error:
        raise _unreadable(path, what, error) from error
    except (ValueError, EOFError, zlib.error, OverflowError) as error:
        raise InputError(path, "", "no table", f"{what} is needed here", why_unreadable(error)) from error
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
    """The content of a JSON file, gzipped or not; ``what`` it is, for the error. Raises InputError: no such file, no
    JSON."""
    path = Path(path)
    note_read(path)
    try:
        content = path.read_bytes()
        text = _unpacked(path, content, what) if content.startswith(b"\x1f\x8b") else content
        return json.loads(text, parse_constant=_no_number, parse_float=_finite, parse_int=_whole)
    except OSError as error:
        raise _unreadable(path, what, error) from error
    except RecursionError as error:
        raise InputError(path, "", "no readable JSON", f"{what} is needed here", "It is nested too deeply.") from error
    except (ValueError, EOFError, zlib.error) as error:
        raise InputError(path, "", "no readable JSON", f"{what} is needed here", why_unreadable(error)) from error


def _unpacked(path: Path, content: bytes, what: str) -> bytes:
    """What a gzipped file holds; not what swells a few bytes into all memory."""
    most = LARGEST_UNPACKED_SHARE * len(content) + LARGEST_UNPACKED_SHARE
    with gzip.open(io.BytesIO(content)) as packed:
        text = packed.read(most + 1)
    if len(text) > most:
        found = f"more than {LARGEST_UNPACKED_SHARE} bytes for each packed one"
        raise InputError(path, "", found, f"{what} is needed here", "No table or model packs so well.")
    return text


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no number of JSON")


def _finite(text: str) -> float:
    number = float(text)
    if not np.isfinite(number):
        raise ValueError(f"{text[:40]} is too large a number")
    return number


def _whole(text: str) -> int:
    if len(text) > LONGEST_WHOLE:
        raise ValueError(f"a whole number of {len(text)} digits")
    return int(text)


def _unreadable(path: Path | str, what: str, error: OSError) -> InputError:
    return InputError(path, "", "no readable file", f"{what} is needed here", why_unreadable(error))


@contextlib.contextmanager
def replacing(path: Path | str, at_once: bool = False) -> Iterator[Path]:
    """A temporary path whose content takes the place of ``path`` when the block ends well, and else vanishes.

    Within a command the content waits until the command has ended well, see `armscope.core.outputs`. A device or a
    pipe is written through, "-" is standard output, a link stays one: its target is written. Where the process is
    killed, a hidden ``.part`` stays behind, which nobody takes for a finished file and the next writer removes.

    Raises:
        InputError: the command may not write there.
    """
    delivery = outputs.current()
    if is_stream(path):
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder) / "content"
            yield made
            copy_into(made, path, sys.stdout if delivery is None else delivery.stdout)
        return
    if delivery is not None and not at_once and (staged := delivery.stage(path)) is not None:
        yield staged
        delivery.keep(path)
        return
    path = Path(os.path.realpath(path))
    writable(path.parent)
    path.parent.mkdir(parents=True, exist_ok=True)  # within a command the folder is not made before it is written to
    with _beside(path) as beside:
        yield beside
        umask = os.umask(0)
        os.umask(umask)
        beside.chmod(0o666 & ~umask)
        beside.replace(path)


@contextlib.contextmanager
def _beside(path: Path) -> Iterator[Path]:
    """A new file beside a path, named after its process; those of dead processes are removed."""
    start = f".{path.name}-{socket.gethostname()}-"
    for left in path.parent.glob(f"{glob.escape(start)}*.part"):
        pid = left.name.removeprefix(start).partition("-")[0]
        if pid.isdecimal() and not alive(int(pid)):
            left.unlink(missing_ok=True)
    handle, name = tempfile.mkstemp(prefix=f"{start}{os.getpid()}-", suffix=".part", dir=path.parent)
    os.close(handle)
    try:
        yield Path(name)
    finally:
        Path(name).unlink(missing_ok=True)


def new_folder(folder: Path | str) -> None:
    """Make sure that a folder to be written holds nothing yet, unless a command looks after what is in it. Raises
    InputError: there is something in it."""
    if outputs.current() is None and Path(folder).is_dir() and any(Path(folder).iterdir()):
        raise InputError(folder, "", "a folder with files in it", "a new or empty folder is needed")


def copy_file(source: Path | str, path: Path | str) -> None:
    """Copy a file, whole or not at all."""
    note_read(source)
    with replacing(path) as beside:
        shutil.copyfile(outputs.readable(source), beside)


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
    write_pieces(path, len(table), lambda rows: table.iloc[rows], digits)


def write_pieces(path: Path | str, count: int, piece: Callable[[slice], pd.DataFrame], digits: int = 10) -> None:
    """As `write_table` a table that is never held as a whole.

    Args:
        path: where to; ``.gz`` compresses.
        count: of its rows.
        piece: some of its rows, always with the same columns; made and spelt by several processes where they are
            allowed (`armscope.core.parallel`), to the same bytes.
        digits: significant digits of its numbers.
    """
    # one piece without rows where there are none
    pieces = [slice(start, start + ROWS_AT_A_TIME) for start in range(0, max(count, 1), ROWS_AT_A_TIME)]
    # no name and no time in gzip's header, so that the same table has the same bytes
    packer = zlib.compressobj(9, zlib.DEFLATED, 31) if str(path).endswith(".gz") else None
    with replacing(path) as beside, beside.open("wb") as stream:
        for text in piece_by_piece(pieces, lambda rows: _as_text(piece(rows), digits, rows.start == 0)):
            stream.write(text if packer is None else packer.compress(text))
        if packer is not None:
            stream.write(packer.flush())


def _as_text(table: pd.DataFrame, digits: int, header: bool) -> bytes:
    """Rows as in the file; numbers become text a column at once, in half the time that they take one by one."""
    spelt = table.copy()
    for number in range(table.shape[1]):
        values = table.iloc[:, number].to_numpy()
        if values.dtype.kind == "f":
            text = (f"%.{digits}g\n" * len(values) % tuple(values.tolist())).split("\n")[:-1]
            spelt.isetitem(number, ["" if word == "nan" else word for word in text])
    lines = spelt.to_csv(index=False, header=header, float_format=f"%.{digits}g", lineterminator="\n")
    return str(lines).encode()


def write_json(path: Path | str, content: Any) -> None:
    """Write JSON, indented, with numpy scalars and arrays as plain numbers; NaN becomes null."""
    write_text(path, as_json(content) + "\n")


def as_json(content: Any) -> str:
    """JSON as `write_json` writes it."""
    return json.dumps(plain_values(content), indent=2, ensure_ascii=False, allow_nan=False)


def yaml_text(content: Any) -> str:
    """YAML in the order of ``content``."""
    return str(yaml.dump(plain_values(content), Dumper=_DUMPER, sort_keys=False, allow_unicode=True, width=120))


def write_yaml(path: Path | str, content: Any) -> None:
    """Write YAML in the order of ``content``."""
    write_text(path, yaml_text(content))


_DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
"""The one in C where there is one: a model of many waves has thousands of lines."""


def plain_values(value: Any) -> Any:
    """As JSON has it: plain numbers, lists and texts as keys; null for what is no number."""
    if isinstance(value, dict):
        return {str(key): plain_values(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(map(plain_values, value)) if type(value) in (list, tuple) else [*map(plain_values, value)]
    if isinstance(value, np.ndarray | np.generic):
        return plain_values(value.tolist())
    return None if isinstance(value, float) and not np.isfinite(value) else value
