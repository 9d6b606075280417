"""What is said of a cause has the sign, the unit and the number under which the motion was simulated."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.constants import LIBRARY
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.clauses import amount, rms_of, run_in_words
from armscope.motion.library.laws import Law
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.library.remedies import Fitted, by_factor, gravity_vector
from armscope.motion.samples.timing import stretches
from armscope.motion.summary.words import clause, cure
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import Parameter
from tests.motion.moving import moved, robot


def cause(
    effect: str, *parameters: Parameter, location: str = "joint 4", title: str = "", driver: str = ""
) -> FoundCause:
    return FoundCause(
        effect, location, "x", driver, title or effect, False, parameters, 0.5, "N m", "joint 4", 0.3, 9.0
    )


@pytest.mark.parametrize(("size", "told"), [(243.4, "243 N m"), (24.34, "24 N m"), (0.0243, "0.024 N m")])
def test_a_size_is_written_as_people_read_it(size: float, told: str) -> None:
    assert rms_of(replace(cause("load_friction"), rms=size)) == f"{told} RMS"


def test_a_number_stands_with_half_its_interval_in_a_readable_unit() -> None:
    assert amount(Parameter("delay", "s", -0.00079, 0.00005)) == "0.790 ± 0.098 ms"
    assert amount(Parameter("delay", "s", -0.00079, 0.00005), sign=True) == "−0.790 ± 0.098 ms"
    assert amount(Parameter("square", "N s^2/m^2", -4254.9, 693.8)) == "4255 ± 1360 N s²/m²"
    assert amount(Parameter("per_turn", "", 9.0, float("nan"))) == "9.000"


@pytest.mark.parametrize(("name", "told"), [("b", "run b"), ("run 3", "run 3"), ("Run 3", "run 3")])
def test_a_run_is_told_once_whatever_it_is_called(name: str, told: str) -> None:
    assert run_in_words(name) == told
    heavier = cause("payload_error", HEAVIER, title=f"payload error in {run_in_words(name)}")
    assert clause(heavier).startswith(f"in {told} ")


TIMES, HAND = Parameter("times", "", -1.0, 0.1), "the model's hand is not on the arm"
MASS, MOMENT = Parameter("mass", "kg", -0.3, 0.5), Parameter("mx", "kg m", 0.4, 0.1)
WIDER = Parameter("wider", "N m", 1.0, 0.1)
TURNED = Parameter("gain", "", -1.9998, 1e-3)
HEAVIER, IN_RUN = Parameter("mass", "kg", 2.0, 0.1), "payload error in run b"


@pytest.mark.parametrize(
    ("told", "words"),
    [
        (cause("torque_delay", Parameter("delay", "s", -0.002, 1e-4)), "2.00 ± 0.20 ms too early"),
        (cause("torque_delay", Parameter("delay", "s", 0.002, 1e-4)), "2.00 ± 0.20 ms too late"),
        (cause("torque_delay", Parameter("delay", "s", 0.002, 3e-3)), "where joint 4 reverses, its friction does not"),
        (cause("torque_delay", Parameter("delay", "s", 0.002, 3e-3)), "up to 7.9 ms early or late: this motion does"),
        (cause("joint_compliance", Parameter("compliance", "rad/(N m)", 2e-6, 3e-6)), "whose size is not determined"),
        (cause("link_mass", Parameter("mass", "kg", -4.31, 2.04)), "link_mass, whose size is not determined"),
        (cause("link_mass", Parameter("mass", "kg", -4.31, 1.0)), "4.3 ± 2.0 kg lighter than stated"),
        (cause("motor_constant", Parameter("gain", "", 0.085, 0.01)), "joint 4 is 8.5 ± 2.0 % too large"),
        (cause("motor_constant", TURNED), "the sign of the recorded torque of joint 4 is turned"),
        (cause("motor_constant", replace(TURNED, value=-3.0)), "is turned, and its size 100.00 ± 0.20 % too large"),
        (cause("motor_constant", replace(TURNED, value=-1.0)), "joint 4 is 100.00 ± 0.20 % too small"),
        (cause("torque_offset", Parameter("offset", "N m", -0.2, 0.01)), "reads 0.200 ± 0.020 N m too low"),
        (cause("asymmetric_friction", Parameter("viscous_difference", "N m s/rad", -3, 0.1)), "lower forward"),
        (cause("stribeck_friction", Parameter("stribeck", "N m", 0.5, 0.1), WIDER), "0.50 ± 0.20 N m higher near rest"),
        (cause("stribeck_friction", Parameter("stribeck", "N m", -0.1, 0.1), WIDER), "not what it is farther from it"),
        (cause("attached_body", TIMES, location="hand"), HAND),
        (cause("attached_body", replace(TIMES, value=-1.5), location="hand"), "1.50 ± 0.20 times what it weighs"),
        (cause("payload_error", HEAVIER, title=IN_RUN), "in run b the arm carries 2.00 ± 0.20 kg more"),
        (cause("payload_error", HEAVIER), "more than stated, taken to sit at the tool point"),
        (cause("payload_error", MASS, MOMENT), "the load sits elsewhere than stated (its mass as stated ± 0.98 kg)"),
        (cause("unknown", driver="load"), "follows the load by no known law"),
    ],
)  # fmt: skip
def test_a_clause_says_which_way(told: FoundCause, words: str) -> None:
    assert words in clause(told)


def test_every_cause_of_the_library_has_a_clause() -> None:
    assert not [each.name for each in catalogue.CAUSES if each.clause is None]


def test_every_cause_that_is_placed_has_a_clause_and_a_cure() -> None:
    arm = robot()
    seen = seen_in(arm, list(stretches(moved(arm, 3, runs=2))), LIBRARY.still_rad)
    placed = place_causes(seen)
    assert len({each.cause.name for each in placed}) > 12
    for each in placed:
        numbers = tuple(Parameter(name, unit, 0.1, 0.01) for name, unit in each.parameters)
        numbers += tuple(Parameter(name, unit, value, float("nan")) for name, unit, value in each.scanned)
        told = clause(cause(each.cause.name, *numbers, location=each.location, driver=each.driver))
        assert told
        assert "nan" not in told + cure(each, numbers, arm)


def placed_at(kind: catalogue.Cause, *parameters: Parameter, law: Law | None = None) -> PlacedCause:
    return PlacedCause(kind, "joint 1", "", tuple((p.name, p.unit) for p in parameters), (0,), law)


def test_a_gain_is_cured_by_the_factor_that_is_told() -> None:
    gain = Parameter("gain", "", 0.25, 0.01)
    (factor,) = re.findall(r"by (\d\.\d+)", cure(placed_at(catalogue.GAIN, gain), (gain,), robot()))
    true = np.array([3.0, -7.0])
    assert true * (1 + gain.value) * float(factor) == pytest.approx(true)


def test_a_delay_and_an_offset_are_cured_against_their_signs() -> None:
    late, low = Parameter("delay", "s", 0.01, 1e-3), Parameter("offset", "N m", -0.2, 0.01)
    assert "earlier" in cure(placed_at(catalogue.DELAY, late), (late,), robot())
    assert "offset, −0.200 ± 0.020 N m, from" in cure(placed_at(catalogue.OFFSET, low), (low,), robot())


def test_a_number_that_is_not_determined_stands_in_no_cure() -> None:
    unsure = Parameter("delay", "s", 0.001, 0.001)
    assert cure(placed_at(catalogue.DELAY, unsure), (unsure,), robot()).startswith("Change nothing for it yet.")
    for error, told in ((0.01, True), (0.11, False)):
        gain = Parameter("gain", "", 0.25, error)
        assert bool(re.search(r"\d", cure(placed_at(catalogue.GAIN, gain), (gain,), robot()))) is told


def test_the_gravity_that_is_told_is_that_of_the_leaning_base() -> None:
    arm, true = robot(), robot(gravity_m_s2=[0.12, -0.2, -9.806])
    seen = seen_in(arm, list(stretches(moved(arm, 3, runs=2))), LIBRARY.still_rad)
    tilt = next(each for each in place_causes(seen) if each.cause is catalogue.GRAVITY)
    assert isinstance(tilt.columns, Law)
    q = np.random.default_rng(0).uniform(-2, 2, (40, 3))
    leans = np.array(tilt.columns.numbers).reshape(-1, 3)
    columns = np.stack([arm.gravity_torques(q, lean).ravel() for lean in leans], axis=1)
    extra = true.gravity_torques(q, true.model.gravity.linear) - arm.gravity_torques(q, arm.model.gravity.linear)
    found = np.linalg.lstsq(columns, extra.ravel())[0]
    numbers = tuple(Parameter(name, "rad", float(value), 1e-4) for name, value in zip("xy", found, strict=True))
    told = [float(each) for each in re.findall(r"-?\d+\.\d+", cure(tilt, numbers, arm))]
    assert told == pytest.approx([0.12, -0.2, -9.81], abs=2e-3)


def test_a_torque_of_the_other_sign_has_no_factor_and_a_tilt_found_by_a_curve_no_vector() -> None:
    reversed_ = Parameter("gain", "", -1.2, 0.01)
    for remedy, kind in ((by_factor, catalogue.GAIN), (gravity_vector, catalogue.GRAVITY)):
        assert kind.remedy is remedy
        assert remedy(Fitted(kind.cure, (reversed_,), robot())) == kind.cure


def test_a_turned_sign_is_turned_back_in_its_own_column_and_by_its_size_where_that_is_off_too() -> None:
    told = lambda value, **how: by_factor(Fitted("", (replace(TURNED, value=value),), robot(), place="joint 3", **how))
    assert told(-1.9998) == "Turn the sign of tau3_nm."
    assert told(-3.0) == "Turn the sign of tau3_nm, and multiply it by 0.500."
    own = "Turn the sign of current3_a, or of the joint's gain_nm_per_a in robot.yaml"
    assert told(-1.9998, currents=True) == f"{own}."
    assert told(-0.5) == "Multiply the joint's torque constant, and so the recorded torque, by 2.000."
