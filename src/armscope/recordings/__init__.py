"""What was measured: the recordings table, its contract, and its reader.

The reader is imported when it is first asked for: what other files say needs no table.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.recordings.table import Recordings, as_recordings, read_recordings

__all__ = ["Recordings", "as_recordings", "read_recordings"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from armscope.recordings import table

    return getattr(table, name)
