"""What no command takes out: an arm whose axes are all parallel cannot lift its tool, whatever its motors are told."""

from __future__ import annotations

import numpy as np

from armscope.core.averages import rms
from armscope.physics.effect import motor
from armscope.verdict.constants import ORDER
from armscope.verdict.contributions import Contributions
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.wording import millimetres


def out_of_reach(verdict: Diagnosis, worth: Contributions) -> str:
    """That numbers in the controller leave more than is expected; "" where its motors move the tool every way it errs.

    A bearing that tilts, or a twist, may lift the tool of such an arm. The steps that put right the parts themselves
    take that out; a corrected row, or a command, knows of it and can do nothing.

    Args:
        verdict: the diagnosis.
        worth: what its causes move.

    Returns:
        A sentence with what stays.
    """
    model = verdict.model
    posture = model.posture(model.scene(verdict.recordings.rows(worth.rows)))
    turned = (posture.displacement(motor(j)) for j in range(1, model.arm.n_motors + 1))
    ways, size, _ = np.linalg.svd(np.stack([each for each in turned if each is not None], axis=2), full_matrices=False)
    ways = ways[:, :, np.median(size / size[:, :1], axis=0) > ORDER.moves_that_way]
    wrong = worth.before - worth.left
    stays = rms(worth.before - np.einsum("nik,njk,nj->ni", ways, ways, wrong))
    if rms(worth.left) > (1 - ORDER.worth_together) * stays:
        return ""
    return (
        f"The motors of this arm do not move its tool every way it errs: numbers in the controller and commands "
        f"(armscope compensate) leave {millimetres(stays)} RMS per axis, and what is expected below that takes repairs "
        "of the parts themselves."
    )
