"""What shows the tool's orientation errs smoothly with its attitude: allowed for, never named.

Spheres, a marker or a probe are seen from one side. Which of their features show, and how the image lies, goes with
the side that they turn to the instrument, and neighbouring poses err alike. The error follows the lowest waves on all
rotations (Wigner functions of degrees one and two), about the tool's own axes. Points do not move by it.
"""

from __future__ import annotations

import itertools

from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import AXES, Cure, Direction, Driver, Effect, Placed, term
from armscope.physics.form_constants import FORM
from armscope.physics.placing import nowhere
from armscope.recordings import Recordings

ORIENTATION_ERROR = Effect(
    "orientation_error",
    "instrument",
    nowhere,
    "What shows the tool's orientation errs a little, smoothly with the side that it turns to the instrument.",
    "Measure one attitude from two sides of the instrument.",
    Cure("Nothing to cure: it is no error of the arm."),
)


def orientation_errors(recordings: Recordings) -> list[Placed]:
    """An error about the tool's three axes by each wave of its attitude, where enough orientations were recorded.

    Args:
        recordings: the table.

    Returns:
        One effect per wave, rad; all together are as large as is plausible.
    """
    found: list[Placed] = []
    for degree, kind in ((1, "attitude"), (2, "attitude twice")):
        entries = 2 * degree + 1
        if FORM.numbers_per_orientation_value * (len(found) + entries**2) > recordings.oriented.sum():
            break
        # over all rotations an entry's mean square is one over their number in a row
        size = PLAUSIBLE.orientation_rad / degree / entries**0.5
        found += [_by(Driver(kind, each), size) for each in itertools.product(range(1, entries + 1), repeat=2)]
    return found


def _by(follows: Driver, size: float) -> Placed:
    terms = tuple(term(axis, "rad", (Direction("instrument", axis), follows)) for axis in AXES[3:])
    variant = " ".join(map(str, (follows.kind, *follows.arguments)))
    return Placed(ORIENTATION_ERROR, "instrument", terms, (size,) * 3, "attitude", variant=variant)
