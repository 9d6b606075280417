"""Links beside parallel axes: rows tell how far all of them are off along these axes, and not which of them is.

Hayati and Mirmirani (1985) leave the length d of such a row out. Here each may be named for what else is wrong with
it. Where several are, one of them holds the length of all, for shares of it, each with an error of millimetres, help
nobody.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from armscope.core.location import Location
from armscope.physics.effect import ONE, Placed, Term
from armscope.physics.form_constants import FORM
from armscope.robot import Arm


def lengths_told_once(arm: Arm, named: Sequence[Placed]) -> list[Placed]:
    """Named effects in their order; of shifts along axes that are parallel the last joint's alone is kept."""
    stretch = _parallel_stretches(arm)
    shifts = {term: joint for placed in named for term in placed.terms if (joint := _shifted_along_its_axis(term))}
    last = {stretch[joint - 1]: joint for joint in sorted(shifts.values())}
    said = {term for term, joint in shifts.items() if last[stretch[joint - 1]] != joint}
    return [placed.without(said) or placed for placed in named]


def _parallel_stretches(arm: Arm) -> list[int]:
    """(n_joints,) number of the stretch of parallel axes that each joint is in."""
    found = [0]
    for before in arm.before[1:]:
        found.append(found[-1] + (abs(before[2, 2]) < math.cos(FORM.parallel_rad)))
    return found


def _shifted_along_its_axis(term: Term) -> int:
    """The joint (1-based) that a term shifts along its own axis alone; 0 for other terms."""
    if len(term.products) != 1:
        return 0
    (product,) = term.products
    place = Location.of(product.direction.location)
    own = product.direction.axis == "tz" and product.driver == ONE and place.kind == "joint"
    return place.number if own else 0
