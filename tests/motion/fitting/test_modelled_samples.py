"""Fits and fitted models say the same of the same samples."""

import numpy as np
import pinocchio as pin
import pytest

from armscope.motion.fitting.model_estimate import Estimate
from armscope.motion.fitting.modelled_samples import modelled_samples, stated_samples
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.dry_friction import ChangeOfSides
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import OWN
from armscope.motion.model.fitted import MotionModel
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.samples.preparation import Signals, preparation
from armscope.robot.dynamics import leaning_gravity
from tests.motion.moving import path, robot

ARM, HOW = robot(), preparation(200.0, 10.0, "test")
LEAN, KG, UNSTATED = np.array([0.03, -0.02]), 10.0, 4.0


def samples(payload: np.ndarray | None) -> Signals:
    """Of a random path, recorded in run a."""
    time, q, dq, ddq = path(np.random.default_rng(1), 3, 2.0, 200.0)
    return Signals("a", 0, time, q, dq, ddq, np.zeros((0, 3)), payload, None, np.arange(len(time)))


def leaning_torque(signals: Signals, load: float, lean: np.ndarray) -> np.ndarray:
    """By inverse dynamics of an arm that carries it on a base that leans."""
    model = ARM.with_masses(ARM.inertial + load * ARM.point_load())
    down = np.array(ARM.model.gravity.linear)
    model.gravity.linear = down + lean @ leaning_gravity(down)
    data = model.createData()
    motion = zip(signals.q, signals.dq, signals.ddq, strict=True)
    return np.array([pin.rnea(model, data, *row).copy() for row in motion])


@pytest.mark.parametrize("stated", [0.0, KG])
def test_a_leaning_base_pulls_at_what_the_arm_carries_too(stated: float) -> None:
    """Whether the table states it or a run's load was found: 10 kg of it were left out of fit and model."""
    signals = samples(np.full(400, stated))
    numbers = tuple(map(float, leaning_gravity(np.array(ARM.model.gravity.linear)).ravel()))
    law = Law("leaning gravity", (0, 1, 2), numbers)
    leaning = PlacedCause(catalogue.GRAVITY, "base", "load", (("x", "rad"), ("y", "rad")), (0, 1, 2), law)
    load = PlacedCause(
        catalogue.PAYLOAD, "payload", "load", (("mass", "kg"),), (0, 1, 2),
        inertial=ARM.point_load()[:, None], runs=("a",),
    )  # fmt: skip
    causes = (FittedCause(leaning, LEAN, np.eye(2)), FittedCause(load, np.array([UNSTATED]), np.eye(1)))
    model = MotionModel(ARM, HOW, "torque", np.zeros((3, OWN)), ARM.inertial, np.zeros(3), causes)
    straight, leant = (leaning_torque(signals, stated + UNSTATED, lean) for lean in (0 * LEAN, LEAN))
    np.testing.assert_allclose(model.torque(signals), leant, atol=1e-8)
    estimate = Estimate(ARM.inertial, np.zeros((3, 4)), np.zeros(3), {"a": UNSTATED * ARM.point_load()})
    stated_part, _ = stated_samples(ARM, signals)
    moment = modelled_samples(ARM, stated_part, estimate, ChangeOfSides.of(ARM), HOW).moment
    np.testing.assert_allclose(leaning.columns_in(moment) @ LEAN, leant - straight, atol=1e-8)
