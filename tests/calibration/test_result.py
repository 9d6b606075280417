"""A calibration's words say the numbers of its table, in the units that they name."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from armscope.calibration.calibrate import calibrate
from armscope.calibration.result import SHOWN
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like


@pytest.fixture(scope="module")
def calibration():
    rng = np.random.default_rng(4)
    recordings = measured(planted(ur_like(), rng), poses(rng, 80, 6), far_away(rng), {"": [0.05, 0.1, 0.2]}, run="")
    return calibrate(ur_like(), recordings)


def test_every_parameter_is_told_with_its_standard_error(calibration):
    lines = {line.split("  ")[1]: line for line in calibration.text().splitlines() if " +- " in line}
    for parameter, unit, value, stderr, _ in calibration.table.itertuples(index=False):
        factor, shown = SHOWN[unit]
        told, error, said = re.search(r"(\S+) \+- (\S+) (\S+)", lines[parameter]).groups()
        assert said == shown
        assert float(told) == pytest.approx(factor * value, rel=1e-4, abs=1e-9)
        assert float(error) == pytest.approx(factor * stderr, rel=0.06, abs=1e-9)


def test_what_a_constant_becomes_is_what_the_corrected_arm_has(calibration):
    told = dict(re.findall(r"(joint \d [ad]) .*\(becomes (\S+) mm\)", calibration.text()))
    rows = calibration.arm.description.dh
    corrected = {f"joint {n} {key}": getattr(row, f"{key}_mm") for n, row in enumerate(rows.joints, 1) for key in "ad"}
    assert len(told) > 5
    assert {name: float(value) for name, value in told.items()} == pytest.approx(
        {name: corrected[name] for name in told}, abs=2e-3
    )


def test_what_is_held_limits_the_standard_errors_and_it_says_so(calibration):
    assert calibration.held
    assert "are right if it is exactly nominal" in calibration.text()


def test_a_constant_that_the_rows_hardly_tell_is_undetermined(calibration):
    """Its error exceeds what is plausible of any arm: 0.7 mrad with an error of 17 is no correction."""
    vague = replace(calibration, covariance=0.017**2 * np.eye(len(calibration.covariance)))
    (line,) = (each for each in vague.text().splitlines() if each.startswith("  joint 3 theta "))
    assert line.endswith("(undetermined: see its error)")
    assert "undetermined" not in calibration.text()


def test_without_a_held_out_gain_the_nominal_arm_serves(calibration):
    assert not calibration.nominal_serves
    misses = pd.DataFrame({"held_out_mm": [0.07], "frames_only_mm": [0.06]})
    assert replace(calibration, misses=misses).nominal_serves
    assert not replace(calibration, misses=misses, level="nominal").nominal_serves


def test_constants_that_hold_only_with_compliances_say_so_with_what_they_leave_alone(calibration):
    rng = np.random.default_rng(8)
    arm, angles, torque = ur_like(), poses(rng, 80, 6), rng.normal(scale=40, size=(80, 6))
    compliance = np.array([1, 5, 3, 0, 0, 0]) * 1e-5
    shown = measured(arm, angles + torque * compliance, far_away(rng), {"": [0.05, 0.1, 0.2]})
    elastic = calibrate(arm, replace(shown, motor_angles=angles, torque=torque), "compliance")
    by_hand = replace(elastic.state, compliances=np.zeros(6))
    rms = np.sqrt(np.mean(np.sum(elastic.set_up.residuals(by_hand) ** 2, axis=1)))
    assert elastic.rms_without_compliances == pytest.approx(rms)
    assert rms > 100 * elastic.rms_distance
    assert (
        f"in frames.yaml (robot.yaml and URDF have no place for them): without them {rms * 1e3:.4g} mm"
        in elastic.text()
    )
    assert calibration.rms_without_compliances is None
    assert "frames.yaml" not in calibration.text()
