"""What gains and delays are of: all torque of a joint, its own causes' too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.laws import Law
from armscope.motion.layout import TorqueLayout
from armscope.motion.library import place_causes
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.preparation import preparation
from armscope.motion.rows import SoFar, build_rows, stated_model
from armscope.motion.timing import stretches
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, moved, robot
from tests.motion.test_parts import seen

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


def test_while_causes_compete_a_gain_is_not_of_laws_that_may_still_go() -> None:
    arm = robot()
    laid, how = list(stretches(moved(arm, 3))), preparation(200.0, 10.0, "test")
    causes = [each for each in place_causes(seen(moved(arm, 3))) if each.location == "joint 2"]
    kinds = {each.columns.kind: each for each in causes if isinstance(each.columns, Law)}
    layout = TorqueLayout(arm, (kinds["torque"], kinds["spring"]), False)

    def gain(model: SoFar) -> Array:
        rows = build_rows(layout, laid, how, model)
        column = np.searchsorted(rows.at[JOINT], layout.columns[0])
        return np.asarray(rows.columns[JOINT][:, column[0]], dtype=np.float64)

    plain = stated_model(arm)
    spring = ((kinds["spring"], np.array([STIFFNESS, 0.0])),)
    compete, stay = (gain(replace(plain, laws=spring, laws_stay=stays)) for stays in (False, True))
    np.testing.assert_allclose(compete, gain(plain), atol=1e-4)
    assert np.std(stay - compete) > 1.0
