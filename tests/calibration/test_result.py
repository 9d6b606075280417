"""A calibration's words say the numbers of its table, in the units that they name."""

import re

import numpy as np
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
