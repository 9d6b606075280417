"""All torque that lasts and has no law here, of each joint what most of it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary.by_run import friction_by_run
from armscope.motion.summary.differing_runs import differing_runs
from armscope.motion.summary.lasting import LastingTorque, lasting_torques, left_by_friction
from armscope.motion.summary.wandering import wandering_torques


def left_over(selected: SelectedCauses) -> tuple[LastingTorque, ...]:
    """What repeats on other motion, differs from run to run, or lasts; first where most of a joint's torque is such.

    Args:
        selected: the selection.

    Returns:
        At most one of each joint.
    """
    of_joint: dict[int, LastingTorque] = {}
    for each in (*lasting_torques(selected), *friction_by_run(selected), *differing_runs(selected)):
        if each.joint not in of_joint or each.rms > of_joint[each.joint].rms:
            of_joint[each.joint] = each
    for each in wandering_torques(selected):  # what repeats, or differs by runs, says more
        of_joint.setdefault(each.joint, each)
    return tuple(sorted(of_joint.values(), key=lambda each: -each.of_torque))


def shares_left_over(selected: SelectedCauses, lasting: Sequence[LastingTorque]) -> dict[int, float]:
    """What lasts, as shares of what friction and rotors leave of all joints: as shares of causes are.

    Args:
        selected: the selection.
        lasting: see `left_over`.

    Returns:
        By joint, from 0.
    """
    weights = selected.weights
    unit = 1 / (weights.sigma**2 * weights.correlated)
    rows = weights.row.sum(axis=0)
    whole = float(np.sum(weights.row * left_by_friction(selected) ** 2 * unit))
    return {each.joint: float(rows[each.joint] * each.rms**2 * unit[each.joint]) / whole for each in lasting}
