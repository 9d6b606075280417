"""A unit that a table states is never guessed over: it is read, or left open for whoever knows it."""

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.recordings.importing.draft import draft_mapping
from armscope.recordings.importing.draft_columns import FILL_IN, filled_in
from armscope.recordings.importing.draft_motions import draft_any_mapping
from armscope.recordings.importing.tables import import_recordings

RNG = np.random.default_rng(3)
ANGLES, POINTS = RNG.uniform(-2, 2, (20, 6)), RNG.uniform(-900, 900, (20, 3)) + np.array([1500, 0, 500])


def foreign(folder, angle="J{} [rad]", length="{} [mm]", factors=(1.0, 1.0), below=""):
    columns = {angle.format(j + 1): ANGLES[:, j] * factors[0] for j in range(6)}
    columns |= {length.format(axis): POINTS[:, k] * factors[1] for k, axis in enumerate("XYZ")}
    head, _, rest = pd.DataFrame(columns).to_csv(index=False).partition("\n")
    file = folder / "foreign.csv"
    file.write_text("\n".join(filter(None, [head, below, rest])))
    return file


def imported(folder, file, text):
    (folder / "mapping.yaml").write_text(text)
    import_recordings([file], folder / "mapping.yaml", folder / "rec.csv")
    return pd.read_csv(folder / "rec.csv")


@pytest.mark.parametrize(
    ("angle", "length", "factors"),
    [
        ("J{} [rad]", "{} [um]", (1, 1e3)),
        ("J{} [rad]", "{} [µm]", (1, 1e3)),
        ("J{}", "{} [ft]", (1, 1 / 304.8)),
        ("J{} [gon]", "{} mm", (200 / np.pi, 1)),
        ("J{} [mrad]", "{} / cm", (1e3, 0.1)),
        ("J{} (degrees)", "{} (inches)", (180 / np.pi, 1 / 25.4)),
    ],
)
def test_what_the_header_states_is_what_is_imported(angle, length, factors, tmp_path):
    file = foreign(tmp_path, angle, length, factors)
    table = imported(tmp_path, file, draft_mapping(file))
    np.testing.assert_allclose(table[["x_mm", "y_mm", "z_mm"]], POINTS, atol=1e-5)
    np.testing.assert_allclose(table[[f"q{j}_rad" for j in range(1, 7)]], ANGLES, atol=1e-8)


@pytest.mark.parametrize(
    ("angle", "length", "below", "word", "place"),
    [
        ("J{}", "{} [furlong]", "", "furlong", "position"),
        ("J{} [turn]", "{} [mm]", "", "turn", "angles"),
        ("J{}", "{}", "turn,turn,turn,turn,turn,turn,mm,mm,mm", "turn", "angles"),
    ],
)
def test_one_that_is_not_known_is_left_open_and_import_asks_for_it(angle, length, below, word, place, tmp_path):
    file = foreign(tmp_path, angle, length, below=below)
    text = draft_mapping(file)
    line = next(line for line in text.splitlines() if line.strip().startswith(place))
    assert f"unit: {FILL_IN}" in line
    assert f"to fill in: the table says '{word}'" in line
    with pytest.raises(InputError, match=rf"{place}\.unit: found 'FILL_IN'"):
        imported(tmp_path, file, text)
    assert len(imported(tmp_path, file, filled_in(text))) == len(ANGLES)


def test_columns_of_one_quantity_in_two_units_are_refused(tmp_path):
    file = foreign(tmp_path)
    file.write_text(file.read_text().replace("J5 [rad]", "J5 [deg]"))
    with pytest.raises(InputError, match=r"line 1.*have one unit, these have rad and deg"):
        draft_mapping(file)


def test_speeds_and_torques_are_in_their_stated_units_or_not_taken(tmp_path):
    table = pd.read_csv(foreign(tmp_path))
    for j in range(1, 7):
        table[f"dq{j} [deg/s]"] = 1.0
        table[f"tau{j} [Nmm]"] = 5.0
    table.to_csv(tmp_path / "more.csv", index=False)
    text = draft_mapping(tmp_path / "more.csv")
    assert "unit: deg/s}" in text
    assert "  # torque:" in text


def test_a_motions_currents_in_another_unit_have_its_factor_or_an_open_one(tmp_path):
    for unit, scale in (("A", ""), ("mA", "scale: 0.001"), ("counts", f"scale: {FILL_IN}")):
        table = pd.DataFrame({"time [s]": np.arange(20) / 100})
        for j in range(1, 4):
            table[f"q{j} [deg]"], table[f"dq{j} [rad/s]"], table[f"current{j} [{unit}]"] = 30.0, 0.1, 2.0
        table.to_csv(tmp_path / "motion.csv", index=False)
        text = draft_any_mapping(tmp_path / "motion.csv")
        line = next(line for line in text.splitlines() if line.startswith("  current"))
        assert scale in line
        assert ("scale" in line.partition("#")[0]) == bool(scale)
        assert "unit: rad/s}" in text
