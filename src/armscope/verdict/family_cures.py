"""What mends a family of causes: several of its effects, or its small errors in the whole arm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.words import size_of
from armscope.physics.backgrounds import GEOMETRIC, THERMAL
from armscope.physics.effect import Part
from armscope.physics.thermal import BY_MODEL, KEPT_WARM, THERMAL_EXPANSION
from armscope.physics.unexplained_turn import ELSEWHERE
from armscope.physics.zero_shift import ZERO_SHIFT
from armscope.verdict.calibrated import mended_by_calibration
from armscope.verdict.effects import FoundEffect

PAYLOAD = "payload"

_CURES = {
    "geometric": "Calibrate the geometry: measure once more, and put the zeros and D-H rows that `armscope calibrate` "
    "finds into the controller; or let the fitted model's inverse kinematics compute "
    "the commands (`armscope compensate`).",
    "elastic": "Give the controller the fitted compliances of what is named and the true loads, or compensate for the "
    "deflection in the commands (`armscope compensate`).",
    "transmission": "Store the fitted waves, ratios and play of the joints named as corrections, or compensate for "
    "them in the commands (`armscope compensate`); replace the worst gear.",
    "thermal": "Compensate for each of what is named by its own formula, with the temperature at work and counted from "
    f"20 C; or {BY_MODEL}. {KEPT_WARM}",
    "drift": "Fasten the instrument, the base and the tool, let them settle, and measure again: what is fitted here "
    "describes this recording, not the arm.",
    "unknown": "Measure each joint named here by itself, in fine steps; until the cause is found, store the fitted "
    "curves (curves.csv) as correction tables, commanded = wanted - curve, or compensate for them in the commands "
    "(`armscope compensate`). The tables hold what is constant in them, the joints' own zeros too, where no other step "
    "sets it.",
}
"""What mends a family where it has several members or small errors everywhere."""

_NO_TABLE = "No table of these is printed: they are small, and many (model.yaml has them under `background`). "
_ALL_AT_ONCE = ", in place of all other steps, which it takes out, too"
_WITHOUT_A_NAME = {
    "elastic": f"{_NO_TABLE}Compensate for the deflection in the commands (`armscope compensate`){_ALL_AT_ONCE}.",
    "transmission": f"{_NO_TABLE}Replace the worst gear, or compensate for them in the commands (`armscope compensate`)"
    f"{_ALL_AT_ONCE}.",
}
"""Where a family has small errors everywhere and no member: nobody can store hundreds of waves that no page prints."""

WARMING = (
    "Record `temperature_c` (best the link's own) beside the poses and diagnose again: then its growth is told in "
    "millionths per kelvin, and can be compensated for. Without a thermometer: let the arm warm up, calibrate it warm, "
    "and work with it as warm; one without the other makes it worse. If the link is as cold as it was, see whether "
    "something works loose on it."
)
"""What is done about a link whose length changes slowly, where no temperature says why."""
SCALE_ALL = (
    "Scale all links in the controller's model with the arm's temperature at work (a and d of every D-H row, or the "
    "origins of a URDF):"
)
ALSO_NAMED = "What is named besides comes on top, each by its own formula."
CONFIRM_FIRST = "Confirm it first: these rows do not determine its size (each interval holds zero)."
OVER_TIME = "What follows the time moved meanwhile: fasten it and measure again; its curve corrects nothing later."


def warms(family: str, worst: str) -> bool:
    """Whether most of what drifts is a link that grows and shrinks, not base or instrument."""
    return family == "drift" and worst.startswith("link")


def mended_together(effect: FoundEffect) -> str:
    """What is mended in one go: a family; but a payload is weighed, whatever gives way under it.

    So is what geometry has beside zeros and rows: no calibration mends an axis that wobbles, or a linkage's bars. A
    zero that jumped is set, not fastened as base and instrument are.
    """
    apart = effect.family == GEOMETRIC and not mended_by_calibration(effect)
    if apart or effect.effect == ZERO_SHIFT.name:
        return effect.effect
    return effect.location if effect.location == PAYLOAD else effect.family


def cure_of_family(
    family: str, members: Sequence[FoundEffect], everywhere: bool, worst: str = "", growth: str = ""
) -> str:
    """What to do about a cause: its only effect's cure, or what mends the whole family.

    Args:
        family: of the cause.
        members: its effects.
        everywhere: whether small errors of the family in the whole arm belong to it.
        worst: where these do most; "" where nowhere stands out.
        growth: by how much all links grow with temperature, as a formula (`armscope.verdict.family_cures`); "" for not.

    Returns:
        A sentence or two.
    """
    if len(members) == 1 and not everywhere:
        return f"{CONFIRM_FIRST} {members[0].cure}" if members[0].size_open else members[0].cure
    if warms(family, worst) and not members:
        return WARMING
    if not members and family in _WITHOUT_A_NAME:
        return _WITHOUT_A_NAME[family]
    if growth and everywhere and family == THERMAL:
        each_other = f" {ALSO_NAMED}" if members else ""
        return f"{SCALE_ALL} {growth} Or {BY_MODEL}.{each_other} {KEPT_WARM}"
    if members and all(each.nameless and each.driver.startswith(ELSEWHERE) for each in members):
        return members[0].cure  # nothing of these is in a table over the joint's own angle
    together = mended_together(members[0]) if members else family
    mend = _CURES.get(together, " ".join(dict.fromkeys(each.cure for each in members)))
    return f"{mend} {OVER_TIME}" if any(each.nameless and each.driver == "time" for each in members) else mend


WHOLE_ARM = "arm"


def growth_in_words(background: Sequence[Part]) -> str:
    """The formula by which all links of an arm are scaled: one number for all, weighed by their lengths. Returns a
    sentence or two; "" where the links do not grow."""
    grown = _by_link(background)
    if not grown:
        return ""
    coefficients, lengths = np.array(list(grown.values())).T
    mean = float(np.average(coefficients, weights=lengths))
    told = f"length = stated length x (1 + coefficient x (temperature - 20 C)). Here coefficient = {_told(mean)}"
    lowest, highest = float(coefficients.min()), float(coefficients.max())
    apart = _told(lowest) != _told(highest)
    return f"{told}, the mean by length (link by link {_told(lowest)} to {_told(highest)})." if apart else f"{told}."


def _by_link(background: Sequence[Part]) -> dict[str, tuple[float, float]]:
    """By link what it grows by, 1/K, as one of all and by itself, and its length, m."""
    growing = [part for part in background if part.placed.effect is THERMAL_EXPANSION]
    if not any(part.values.any() for part in growing):
        return {}
    alike = sum(float(part.values[0]) for part in growing if part.placed.location == WHOLE_ARM)
    return {
        part.placed.location: (
            alike + float(part.values[0]),
            sum(abs(product.factor) for product in part.placed.terms[0].products),
        )
        for part in growing
        if part.placed.location != WHOLE_ARM
    }


def _told(coefficient: float) -> str:
    return size_of(coefficient, "1/K", sign=coefficient < 0)
