"""What was measured: the recordings table, its contract, and its reader."""

from armscope.recordings.table import Recordings, as_recordings, read_recordings

__all__ = ["Recordings", "as_recordings", "read_recordings"]
