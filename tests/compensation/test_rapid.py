"""Job files hold the commands and give them back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.compensation.rapid import read_rapid, write_rapid
from armscope.core.inputs import InputError


@settings(max_examples=25)
@given(st.integers(1, 7), st.integers(1, 30), st.integers(0, 10_000))
def test_a_job_file_gives_the_commands_back(tmp_path_factory, motors, count, seed):
    angles = np.random.default_rng(seed).uniform(-6, 6, (count, motors))
    path = tmp_path_factory.mktemp("job") / "job.mod"
    write_rapid(path, angles)
    np.testing.assert_allclose(read_rapid(path, motors), angles, atol=1e-9)


def test_a_joint_target_is_written_as_rapid_wants_it(tmp_path):
    write_rapid(tmp_path / "a.mod", np.radians([[10.0, -20.5, 30, 0, 90, -180]]), "weld_1", 200)
    lines = (tmp_path / "a.mod").read_text().splitlines()
    assert lines[0] == "MODULE weld_1"
    assert lines[1] == (
        "  CONST jointtarget p00001 := [[10.0000000, -20.5000000, 30.0000000, 0.0000000, 90.0000000, -180.0000000], "
        "[9E9, 9E9, 9E9, 9E9, 9E9, 9E9]];"
    )
    assert "    MoveAbsJ p00001\\NoEOffs, v200, fine, tool0;" in lines
    assert lines[-1] == "ENDMODULE"


def test_moves_count_not_the_order_of_definitions(tmp_path):
    write_rapid(tmp_path / "a.mod", np.array([[0.1] * 6, [0.2] * 6]))
    text = (tmp_path / "a.mod").read_text()
    text = text.replace("MoveAbsJ p00001", "MoveAbsJ swap").replace("MoveAbsJ p00002", "MoveAbsJ p00001")
    (tmp_path / "a.mod").write_text(text.replace("MoveAbsJ swap", "MoveAbsJ p00002"))
    np.testing.assert_allclose(read_rapid(tmp_path / "a.mod", 6)[:, 0], [0.2, 0.1], atol=1e-9)


@pytest.mark.parametrize(
    ("change", "found"),
    [
        (lambda text: text.replace("MoveAbsJ p00001", "MoveAbsJ p00009"), "p00009"),
        (lambda text: text.replace("MoveAbsJ", "MoveL"), "no MoveAbsJ"),
        (lambda text: text.replace("9E9, 9E9]", "9E9, 12.5]"), "6 motors"),
    ],
)
def test_a_job_that_does_not_fit_is_an_error(tmp_path, change, found):
    path = tmp_path / "a.mod"
    write_rapid(path, np.zeros((2, 6)))
    path.write_text(change(path.read_text()))
    with pytest.raises(InputError, match=found):
        read_rapid(path, 6)


@pytest.mark.parametrize(
    ("angles", "name", "speed", "found"),
    [
        (np.zeros((1, 8)), "a", 100, "at most 7"),
        (np.zeros((1, 6)), "2nd", 100, "letter"),
        (np.zeros((1, 6)), "a", 123, "speeds"),
        (np.full((1, 6), np.nan), "a", 100, "every row"),
        (np.vstack([np.zeros((2, 6)), np.full((1, 6), np.nan)]), "a", 100, "row 3: found no command"),
    ],
)
def test_what_rapid_cannot_hold_is_an_error(tmp_path, angles, name, speed, found):
    with pytest.raises(InputError, match=found):
        write_rapid(tmp_path / "a.mod", angles, name, speed)
    assert not (tmp_path / "a.mod").exists()
