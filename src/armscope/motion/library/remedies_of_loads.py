"""How a load that is not as stated is put into robot.yaml: as its `tool_load`, to be typed in as printed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.clauses import amount
from armscope.motion.library.for_a_while import INERTIA, OF_A_LOAD
from armscope.motion.library.remedies import Fitted, as_stated_and
from armscope.robot.model import TIP
from armscope.verdict.effects import INTERVAL
from armscope.verdict.wording import decimals_for

OWN_INERTIA = tuple(name for name, _ in INERTIA)


class Load(NamedTuple):
    """Of a load: kg; (3,) its centre, m, and (3, 3) its inertia about that, kg m^2, in the last frame."""

    mass: float
    centre: Array
    inertia: Array


def as_tool_load(fitted: Fitted) -> str:
    """A load's mass and centre in the last frame, what is stated of it among them; the sum must be a body."""
    numbers = fitted.numbers
    if "mass" not in numbers or not set(numbers) <= {*OF_A_LOAD, *OWN_INERTIA}:
        return as_stated_and(fitted)
    whole, errors = _with_stated(fitted)
    if whole.mass <= 0:
        cure = as_stated_and(fitted).removesuffix(".")
        return f"{cure}: less than no load, so that the last link's mass is wrong; corrected.urdf has both together."
    half = INTERVAL * numbers["mass"].stderr
    known = np.isfinite(half) and half > 0 and not np.isinf(errors).any()
    decimals = decimals_for(half) if known else 3
    centre = ", ".join(f"{1e3 * each:.1f}" for each in whole.centre)
    inertia = _inertia(fitted, whole)
    content = f"{{mass_kg: {whole.mass:.{decimals}f}, com_mm: [{centre}]{inertia}}}"
    assumed = len(numbers) == 1
    within = ", ".join("–" if np.isnan(each) else f"{1e3 * INTERVAL * each:.1f}" for each in errors)
    of_place = "" if assumed else f"; ± {within} mm"
    sure = f" (± {half:.{decimals}f} kg{of_place})" if known else ""
    told = f"{fitted.in_general}: set `tool_load` of robot.yaml to {content}{sure}{_of_run(fitted)}"
    untold = [axis for axis in "xyz" if f"m{axis}" not in numbers]
    if 0 < len(untold) < len("xyz"):
        return f"{told}. Where it sits along {' and '.join(untold)} of the last joint, this motion does not tell."
    return f"{told}{_at_assumed_place(fitted) if assumed else ''}."


def _at_assumed_place(fitted: Fitted) -> str:
    """Of a mass alone: where it was taken to be, and what is measured of it."""
    stated = "tool_mm" in fitted.arm.description.model_fields_set
    where = "at `tool_mm`" if stated else "at the last frame's origin, `tool_mm` not being stated"
    return (
        f": {amount(fitted.numbers['mass'], sign=True)} {where}. That place was not fitted: measured is mass × "
        "distance, so where the load sits elsewhere, its mass is another one"
    )


def _of_run(fitted: Fitted) -> str:
    return f", for run {fitted.run} alone" if fitted.run else ""


def _with_stated(fitted: Fitted) -> tuple[Load, Array]:
    """The whole load in the last frame, and (3,) standard errors of its centre, m, mass and moments apart.

    A coordinate that the motion does not tell is that of the last frame's origin, and has no error (NaN); a mass alone
    is at the tool point, all of whose place is taken as stated.
    """
    arm, numbers = fitted.arm, fitted.numbers
    placement = arm.model.frames[arm.model.getFrameId(TIP)].placement
    at = np.array(arm.description.tool_mm) * 1e-3 if len(numbers) == 1 else np.zeros(3)
    mass = numbers["mass"].value
    moments = mass * placement.act(at)
    errors = np.zeros(3)
    for axis, name in enumerate(OF_A_LOAD[1:]):
        if name in numbers:
            moments[axis], errors[axis] = numbers[name].value, numbers[name].stderr
    first = placement.rotation.T @ (moments - mass * placement.translation)
    stated = _stated(fitted)
    total = stated.mass + mass
    centre = (stated.mass * stated.centre + first) / total if total > 0 else np.zeros(3)
    by_mass = -(centre + placement.rotation.T @ placement.translation) if len(numbers) > 1 else at - centre
    spread = (placement.rotation.T**2) @ errors**2 + (by_mass * numbers["mass"].stderr) ** 2
    turned = stated.inertia + _about(stated.mass, stated.centre - centre)
    turned = turned + (_about(mass, first / mass - centre) if mass else 0.0)
    turned = turned + placement.rotation.T @ _own_inertia(fitted) @ placement.rotation
    untold = [axis for axis, name in enumerate(OF_A_LOAD[1:]) if name not in numbers]
    along = np.sum(placement.rotation[untold] ** 2, axis=0)  # of each of its own axes, what lies along untold ones
    own = np.where(along > 0.5, np.nan, np.sqrt(spread) / max(abs(total), 1e-300))
    return Load(total, centre, turned), own


def _own_inertia(fitted: Fitted) -> Array:
    """(3, 3) of what is carried about its own centre, along the last joint's axes, kg m^2; 0 where it is a point."""
    xx, xy, yy, xz, yz, zz = (fitted.numbers[n].value if n in fitted.numbers else 0.0 for n in OWN_INERTIA)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _stated(fitted: Fitted) -> Load:
    """The load that robot.yaml states."""
    load = fitted.arm.description.tool_load
    if load is None:
        return Load(0.0, np.zeros(3), np.zeros((3, 3)))
    xx, yy, zz, xy, xz, yz = load.inertia_kg_m2 or (0.0,) * 6
    about = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return Load(load.mass_kg, np.array(load.com_mm) * 1e-3, about)


def _about(mass: float, lever: Array) -> Array:
    """(3, 3) kg m^2 of a point mass at a lever."""
    return np.asarray(mass * (lever @ lever * np.eye(3) - np.outer(lever, lever)))


def _inertia(fitted: Fitted, whole: Load) -> str:
    """The key of its inertia: of a load that has its own, or beside a stated one, about both bodies' centre.

    What was told is left out where it is no body's: its numbers are known too little.
    """
    stated = fitted.arm.description.tool_load
    if (stated is None or stated.mass_kg == 0) and not fitted.numbers.keys() & set(OWN_INERTIA):
        return ""
    about = whole.inertia
    least, middle, most = np.linalg.eigvalsh(about)
    if least < 0 or least + middle < most:  # what was taken off was no body by itself
        values = None if stated is None else stated.inertia_kg_m2
        return "" if values is None else f", inertia_kg_m2: [{', '.join(f'{each:g}' for each in values)}]"
    six = about[*np.array([[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]]).T]
    return f", inertia_kg_m2: [{', '.join(f'{each:.3g}' for each in six)}]"
