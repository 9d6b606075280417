"""A stand that was seen to ring is placed at the base, with its numbers in its law."""

from __future__ import annotations

from dataclasses import replace

from armscope.motion.library.causes import Stand
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.library.stands import place_stand
from armscope.motion.samples.timing import stretches
from tests.motion.moving import moved, robot


def test_a_stand_competes_only_where_one_was_seen_to_ring() -> None:
    seen = seen_in(robot(), list(stretches(moved(robot(), 1))), 0.02)
    assert not list(place_stand(seen))
    (placed,) = place_stand(replace(seen, stand=Stand(7.0, 0.05, (1.0, 2.0), 30)))
    assert (placed.location, placed.joints, placed.multiplicity) == ("base", (0, 1, 2), 30)
    assert placed.columns.numbers == (1.0, 2.0, 0.05, 7.0)  # type: ignore[union-attr]
