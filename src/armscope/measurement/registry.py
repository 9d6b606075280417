"""The kinds of reading that armscope knows; a new one is one file beside this one, and one word here."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.measurement.channel import ORIENTATIONS, POSITIONS, Channel
from armscope.recordings import Recordings

CHANNELS: tuple[Channel, ...] = (POSITIONS, ORIENTATIONS)  # The first is the reference: it is always measured


def supported(recordings: Recordings, channels: Sequence[Channel] = CHANNELS) -> tuple[Channel, ...]:
    """Those of some channels that a table holds readings of."""
    return tuple(c for n, c in enumerate(channels) if n == 0 or c.measured(recordings).any())
