"""A stand that rings, among the causes that are placed on an arm."""

from __future__ import annotations

from collections.abc import Iterator

from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause, Seen
from armscope.motion.library.laws import Law
from armscope.motion.library.rocking import ABOUT


def place_stand(seen: Seen) -> Iterator[PlacedCause]:
    """The base on the stand that was seen to ring, if any was."""
    if (stand := seen.stand) is None:
        return
    every = tuple(range(seen.arm.n_motors))
    names = tuple((name, "rad/(N m)") for name in ABOUT)
    law = Law("rocking base", every, (*stand.held, stand.damping, stand.hz))
    scanned = (("damping", "", stand.damping), ("frequency", "Hz", stand.hz))
    yield PlacedCause(
        catalogue.ROCKING_BASE, "base", "load", names, every, law, multiplicity=stand.tried, scanned=scanned
    )
