"""What gains and delays are of: all torque of a joint, its own causes' too."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, moved, robot

JOINT, STIFFNESS, GAIN = 1, 30.0, 0.3


def sprung_and_misread(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A spring at joint 2, and all torque of that joint read a third too large."""
    j = JOINT
    own = rigid[:, j] + COULOMB[j] * np.sign(dq[:, j]) + VISCOUS[j] * dq[:, j] + ROTOR[j] * ddq[:, j]
    extra = np.zeros_like(q)
    extra[:, j] = (1 + GAIN) * (own + STIFFNESS * (q[:, j] - 0.1)) - own
    return extra


def test_a_spring_behind_a_wrong_gain_has_its_own_stiffness() -> None:
    stated = [{"rotor_inertia_kg_m2": r, "coulomb_nm": c, "viscous_nm_s_rad": v}
              for r, c, v in zip(ROTOR, COULOMB, VISCOUS, strict=True)]  # fmt: skip
    arm = robot(drives=stated)
    found = diagnose_motion(arm, moved(arm, 3, sprung_and_misread), MotionSettings(cutoff=10.0)).verdict
    causes = {(each.effect, each.location): each.parameters[0] for each in found.effects}
    assert set(causes) == {("gravity_balance", "joint 2"), ("motor_constant", "joint 2")}
    assert causes["motor_constant", "joint 2"].value == pytest.approx(GAIN, abs=0.01)
    assert causes["gravity_balance", "joint 2"].value == pytest.approx(STIFFNESS, rel=0.03)
