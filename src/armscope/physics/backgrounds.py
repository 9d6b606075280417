"""What every real arm has a little of: small errors everywhere, family by family, allowed for but not named.

The ``prior_scale`` of what stands here is in SI units: how large each value is on a real arm, of which the diagnosis
finds the share that this arm has.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from armscope.physics import elastic, geometric, tilting, transmission
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Placed
from armscope.physics.form_constants import FORM
from armscope.physics.orientation_error import orientation_errors
from armscope.physics.placing import moving_joints
from armscope.physics.set_ups import SetUps
from armscope.physics.soft_start import soft_starts
from armscope.physics.thermal import all_links_growing
from armscope.physics.uneven_bearing import uneven_bearings
from armscope.physics.wander import link_wander, wander
from armscope.recordings import Recordings
from armscope.robot import Arm

GEOMETRIC, ELASTIC, TRANSMISSION, DRIFT = "geometric", "elastic", "transmission", "drift"
SOFT = "soft start"
"""How much softer drives are under small loads: no soft arm need have it, so its size is learned by itself."""
STRUCTURE = "structure"
"""How much links and the base bend: what gives way besides joints, by itself, since it may be far stiffer than they."""
UNEVEN = "uneven bearings"
"""How much softer bearings are about one axis than about the other."""
THERMAL = "thermal"
"""How much all links grow with the recorded temperature."""
ORIENTATION = "orientation"
"""How smoothly the orientations' instrument errs: nothing of the arm, and no point moves by it."""
FAMILIES = (GEOMETRIC, ELASTIC, TRANSMISSION, DRIFT, SOFT, ORIENTATION, THERMAL, STRUCTURE, UNEVEN)
MENDED = {
    GEOMETRIC: (GEOMETRIC,), ELASTIC: (ELASTIC, SOFT, STRUCTURE, UNEVEN), TRANSMISSION: (TRANSMISSION,),
    DRIFT: (DRIFT,), THERMAL: (THERMAL,),
}  # fmt: skip
"""As what families are told: who mends one of the same, mends the others."""
MASSES = "mass"
"""The family that comes with all that gives way: how wrong stated masses are, in shares."""


def backgrounds(arm: Arm, recordings: Recordings, set_ups: SetUps = ()) -> dict[str, list[Placed]]:
    """By family: D-H constants, what gives way, gears' waves, wander, what grows with the temperature and so on.

    Args:
        arm: the nominal arm.
        recordings: the table.
        set_ups: runs that share a base, which stands a little elsewhere in each of them.

    Returns:
        What every real arm and set-up has a little of, in the order of `FAMILIES`.
    """
    bases = tilting.BASE_COMPLIANCE.place(arm, recordings)
    pedestal = [placed for placed in bases if placed.variant in (tilting.TWO_AXES, tilting.THREE_AXES)]
    return {
        GEOMETRIC: constants(arm),
        ELASTIC: springs(arm, recordings),
        TRANSMISSION: gear_waves(recordings, PLAUSIBLE.waves),
        DRIFT: [*wander(recordings, set_ups), *link_wander(arm, recordings)],
        SOFT: [_sized(placed) for placed in soft_starts(arm, recordings)],
        ORIENTATION: orientation_errors(recordings),
        THERMAL: all_links_growing(arm, recordings),
        STRUCTURE: _loaded([*pedestal, *elastic.LINK_BENDING.place(arm, recordings)]),
        UNEVEN: _loaded(uneven_bearings(arm, recordings)),
    }


def constants(arm: Arm) -> list[Placed]:
    """D-H constants, each within a maker's tolerance."""
    return [replace(placed, prior_scale=(FORM.tolerance,) * len(placed.terms)) for placed in geometric.background(arm)]


def springs(arm: Arm, recordings: Recordings) -> list[Placed]:
    """What gives way at the joints: drives and bearings."""
    giving_way = (*elastic.JOINT_COMPLIANCE.place(arm, recordings), *tilting.BEARING_COMPLIANCE.place(arm, recordings))
    return _loaded(placed for placed in giving_way if placed.variant == "")


def _loaded(giving_way: Iterable[Placed]) -> list[Placed]:
    """What bears a load; the rest has no size, and shows nothing."""
    return [_sized(placed) for placed in giving_way if all(np.isfinite(term.plausible) for term in placed.terms)]


def _sized(placed: Placed) -> Placed:
    """An effect whose values are as large as is plausible."""
    return replace(placed, prior_scale=tuple(term.plausible for term in placed.terms))


def gear_waves(recordings: Recordings, count: int) -> list[Placed]:
    """The first waves per turn of every gear, whose size falls with their number."""
    sizes = [(per_turn, PLAUSIBLE.eccentricity_rad / per_turn) for per_turn in range(1, count + 1)]
    return [
        replace(transmission.cyclic(j, per_turn), prior_scale=(size, size))
        for j in moving_joints(recordings)
        for per_turn, size in sizes
    ]
