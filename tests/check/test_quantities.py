"""What stands beside the points in another unit, or with another sign, is named; what is usual is not."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.quantities import of_quantities
from armscope.check.report import check
from armscope.robot import chain, load_arm
from armscope.robot.gravity import gravity_torques
from tests.check.test_check import ROOT
from tests.recordings.test_reading import as_recordings

ROWS = 60


@pytest.fixture(scope="module")
def arm():
    return load_arm(ROOT / "config" / "robots" / "parallelogram-120kg.yaml")


@pytest.fixture
def table(arm):
    """Poses with everything recorded beside, as it should be; torques a little more than the mass table says."""
    import pandas as pd

    rng = np.random.default_rng(0)
    angles = rng.uniform(-0.7, 0.7, (ROWS, arm.n_motors))
    columns = {f"q{j + 1}_rad": angles[:, j] for j in range(arm.n_motors)}
    columns |= {f"{axis}_mm": rng.uniform(-1000, 1000, ROWS) for axis in "xyz"}
    columns |= {"time_s": np.arange(ROWS), "temperature_c": np.linspace(18, 60, ROWS), "payload_kg": np.arange(ROWS)}
    columns |= {"sigma_mm": 0.02}
    recordings = as_recordings(pd.DataFrame(columns))
    pull = gravity_torques(arm, chain(arm, angles), recordings.payload)
    return replace(recordings, torque=1.4 * pull + rng.normal(scale=20, size=pull.shape))


def test_nothing_is_said_of_a_sound_table(arm, table):
    assert of_quantities(table, arm) == []
    assert of_quantities(table, None) == []
    for seconds in (45292 + table.time, 45292 + 1e-3 * table.time, 20 * table.time / 86400):
        assert of_quantities(replace(table, time=seconds), arm) == []
    none = dict.fromkeys(("torque", "time", "temperature", "payload", "sigma"))
    assert of_quantities(replace(table, **none), arm) == []


def test_days_as_spreadsheets_count_them_are_no_seconds(arm, table):
    (found,) = of_quantities(replace(table, time=45292 + 20 * table.time / 86400), arm)
    assert found.weight == "hint"
    assert "time_s reads 45292 ... 45292.01, a row usually 0.00023 after another. A spreadsheet" in found.text()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda t: {"temperature": t.temperature + 273.15}, "291.1 ... 333.1 degrees Celsius. Is it in kelvin"),
        (lambda t: {"temperature": np.where(np.arange(ROWS) == 7, -273, t.temperature)}, "-273 ... 60"),
        (lambda t: {"payload": t.payload * 1e3, "torque": None}, "5.9e+04 kg, more than"),
        (lambda t: {"sigma": t.sigma / 1e3}, "usually 2e-05 mm. Is its unit right"),
        (lambda t: {"sigma": t.sigma * 1e3}, "usually 20 mm"),
        (lambda t: {"torque": -t.torque}, "the other sign than gravity's pull"),
        (lambda t: {"torque": t.torque * 1e3}, "times what gravity asks for"),
        (lambda t: {"torque": -t.torque / 1e3}, "0.00140 times what gravity asks for"),
    ],
)
def test_another_unit_or_sign_is_a_problem_that_is_named(arm, table, wrong, words):
    found = of_quantities(replace(table, **wrong(table)), arm)
    assert [each.weight for each in found] == ["problem"]
    assert words in found[0].text().replace("0.0014 ", "0.00140 ")


@pytest.mark.parametrize(
    ("unusual", "words"),
    [
        (lambda t: {"temperature": 1.8 * t.temperature.clip(18, 24) + 32}, "is it in Fahrenheit"),
        (lambda t: {"time": t.time * 1e3 * 37}, "are these milliseconds?"),
        (lambda t: {"time": 1.7e12 + t.time * 1e3 * 37}, "are these milliseconds?"),
    ],
)
def test_what_may_be_in_another_unit_is_hinted_at(arm, table, unusual, words):
    (found,) = of_quantities(replace(table, **unusual(table)), arm)
    assert found.weight == "hint"
    assert words in found.text()


def test_torques_that_have_nothing_to_do_with_gravity_are_left_in_peace(arm, table):
    noise = np.random.default_rng(1).normal(size=table.torque.shape)
    assert of_quantities(replace(table, torque=noise), arm) == []
    assert of_quantities(replace(table, torque=np.full_like(noise, np.nan)), arm) == []
    assert of_quantities(replace(table, torque=-table.torque), None) == []


def test_zero_uncertainty_and_time_that_goes_back_are_hints(arm, table):
    sigma = table.sigma.copy()
    sigma[3:5, 0] = 0
    found = of_quantities(replace(table, sigma=sigma, time=np.roll(table.time, 3)), arm)
    assert {each.weight for each in found} == {"hint"}
    assert "zero in 2 rows" in found[0].text()
    assert "time goes back between two rows once" in found[1].text()
    # time that starts anew in another run does not go back
    runs = np.repeat(["a", "b"], ROWS // 2)
    assert of_quantities(replace(table, run=runs, time=np.r_[0 : ROWS // 2, 0 : ROWS // 2].astype(float)), arm) == []


def test_the_check_says_what_stands_beside_the_points(table):
    report = check(replace(table, temperature=table.temperature + 273.15))
    assert report.has_problems
    assert "kelvin" in report.text()
    still = check(replace(table, temperature=np.full(ROWS, 20.0), payload=np.zeros(ROWS)))
    assert "temperature, payload never change, so nothing shows what changes with them" in still.text()


def test_coarse_angles_are_worth_a_look_where_an_instrument_sees_them(arm, table):
    coarse, fine = (
        replace(table, motor_angles=np.radians(np.round(np.degrees(table.motor_angles), decimals)))
        for decimals in (1, 4)
    )
    (found,) = of_quantities(replace(coarse, torque=None), arm)
    assert found.weight == "hint"
    most = np.radians(0.1) / 2 * arm.reach * 1e3
    assert "steps of 0.1 degrees" in found.text()
    assert f"up to {most:.2g} mm" in found.text()
    assert of_quantities(replace(fine, torque=None), arm) == []
