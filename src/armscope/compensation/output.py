"""Commands as files: CSV and JSON hold every row, refused ones with their reason; a job file needs all rows."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from armscope.compensation.rapid import write_rapid
from armscope.core.files import write_json, write_pieces
from armscope.core.inputs import InputError
from armscope.core.streams import is_stream

if TYPE_CHECKING:
    from armscope.compensation.result import Compensated

FORMATS = (".csv", ".csv.gz", ".json", ".mod")


def write_commands(path: Path | str, result: Compensated) -> None:
    """Write commands in the format that the file's name asks for: .csv (.gz), .json, or .mod (ABB RAPID).

    A pipe, a device and standard output get CSV.

    Raises:
        InputError: another ending; for a job file: rows without a command.
    """
    name = str(path)
    if name.endswith((".csv", ".csv.gz")) or is_stream(path):
        write_pieces(path, len(result.reasons), result.to_table)
    elif name.endswith(".json"):
        write_json(path, to_dict(result))
    elif name.endswith(".mod"):
        write_rapid(path, result.require_all(path))
    else:
        raise InputError("--output", "", name, f"the file's ending says the format: {', '.join(FORMATS)}")


def to_dict(result: Compensated) -> dict[str, Any]:
    """Plain values: what holds for all rows, and one object per row with units in its keys (null where refused)."""
    table = result.to_table()
    rows = [
        {key: None if isinstance(value, float) and not np.isfinite(value) else value for key, value in row.items()}
        for row in table.to_dict(orient="records")
    ]
    return {
        "format": "armscope commands 1",
        "robot": result.arm.name,
        "frame": result.frame,
        "command_frame": "base",
        "pose": result.pose,
        "rows": len(table),
        "refused": int((~result.reached).sum()),
        "notes": list(result.notes),
        "commands": rows,
    }
