"""Masses that no body has: links and loads that weigh less than nothing, or sit nowhere on the arm."""

from __future__ import annotations

import numpy as np

from armscope.motion.fitting.constants import CONSISTENCY
from armscope.motion.fitting.refining import carried_in, sits_nowhere
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.changes_catalogue import LOAD_CHANGE
from armscope.motion.library.laws import Law
from armscope.motion.summary.constants import NAMING
from armscope.robot.bodies import last_axis
from armscope.verdict.effects import INTERVAL


def no_place(selected: SelectedCauses, number: int) -> bool:
    """Whether a load that may sit anywhere has no mass, or sits nowhere.

    Where none is stated and its mass is not determined, what sits elsewhere is nothing.
    """
    layout, placed = selected.rows.layout, selected.rows.layout.placed[number]
    if placed.parameters[0][0] != "mass":
        return True
    columns, (_, stated) = layout.columns[number], carried_in(selected, placed)
    mass = float(selected.coefficients[columns[0]])
    error = float(np.sqrt(selected.best.variances(columns[:1])[0])) / selected.problem.scale[columns[0]]
    return (not stated and NAMING.determined * abs(mass) < INTERVAL * error) or sits_nowhere(selected, number)


def no_link(selected: SelectedCauses, number: int) -> bool:
    """Whether a link, or the last one with its load, would weigh less than nothing, or be centred off the arm."""
    layout, placed = selected.rows.layout, selected.rows.layout.placed[number]
    if placed.cause not in (catalogue.LINK_MASS, catalogue.LINK_CENTRE, catalogue.PAYLOAD):
        return False
    link = layout.arm.n_links if placed.cause is catalogue.PAYLOAD else int(placed.location.split()[1])
    mass, *moments = layout.arm.inertial[10 * link - 10 : 10 * link - 6]
    found, columns = selected.coefficients[layout.columns[number]], layout.columns[number][:1]
    error = float(np.sqrt(selected.best.variances(columns)[0])) / selected.problem.scale[columns[0]]
    if placed.cause is catalogue.LINK_CENTRE:
        axes = ["xyz".index(name[1]) for name, _ in placed.parameters]
        centre = np.array(moments)
        centre[axes] += found
        return bool(np.linalg.norm(centre) > layout.reach * mass)
    if placed.parameters[0][0] != "mass":
        return False
    there = mass + (carried_in(selected, placed)[1] if placed.cause is catalogue.PAYLOAD else 0.0)
    return bool(found[0] < -there - CONSISTENCY.below * error)


def not_at_the_flange(selected: SelectedCauses, number: int) -> bool:
    """Whether a load with a place of its own turns about the last joint where the flange does not: inside the arm.

    What one joint's torque reads too large in one run looks like that, where no other joint feels it.
    """
    layout, placed = selected.rows.layout, selected.rows.layout.placed[number]
    names, axis = [name for name, _ in placed.parameters], last_axis(layout.arm)
    if placed.cause is not catalogue.PAYLOAD or names[:4] != ["mass", "mx", "my", "mz"] or not axis.any():
        return False
    columns = layout.columns[number][:4]
    error = np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
    mass, *moments = selected.coefficients[columns]
    least = NAMING.at_the_flange * np.linalg.norm(np.cross(axis, layout.arm.point_load()[-9:-6])) * abs(mass)
    unsure = INTERVAL * np.linalg.norm(np.cross(axis, error[1:]))
    return bool(np.linalg.norm(np.cross(axis, moments)) + unsure < least)


def no_load(selected: SelectedCauses, number: int) -> bool:
    """Whether what is picked up or put down is none: heavier than an arm, beyond its reach, or not determined.

    What is put down was there: stated, or as a part of the last link.
    """
    layout, placed = selected.rows.layout, selected.rows.layout.placed[number]
    if placed.cause is not LOAD_CHANGE:
        return False
    columns, links = layout.columns[number], layout.arm.inertial[::10]
    (mass, *moments), kind = selected.coefficients[columns], getattr(placed.columns, "kind", "")
    stated = placed.columns.numbers[0] if isinstance(placed.columns, Law) and kind == "load for a while" else 0.0
    error = float(np.sqrt(selected.best.variances(columns[:1])[0])) / selected.problem.scale[columns[0]]
    if abs(mass) > CHANGE.heaviest_load * links.sum() or NAMING.determined * abs(mass) < INTERVAL * error:
        return True
    gone = mass < -(stated + links[-1]) - CONSISTENCY.below * error
    return bool(gone or np.linalg.norm(moments) > layout.reach * abs(mass))
