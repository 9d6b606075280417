"""A running number is nobody's reflector."""

import numpy as np
import pytest

from armscope.recordings.importing.draft import draft_mapping
from armscope.recordings.numbered_points import number_the_rows, told_of_names

ROWS = 110


@pytest.mark.parametrize(
    ("names", "number"),
    [
        ([str(row) for row in range(ROWS)], True),
        ([f"P{row // 2:03}" for row in range(ROWS)], True),  # every pose twice
        (["p1", "p2", "p3"] * 40, False),
        (["p1", "p2", "p3"], False),  # one pose
        ([""] * ROWS, False),
    ],
)
def test_names_that_nearly_all_differ_number_the_rows(names, number):
    assert number_the_rows(names) is number
    assert told_of_names(["a", "b", "a"]) == "2 different names in 3 rows"


@pytest.mark.parametrize("name", ["Point", "Point No", "target_id"])
def test_a_column_of_point_numbers_is_drafted_as_no_target(name, tmp_path):
    file, reflectors = tmp_path / "log.csv", tmp_path / "reflectors.csv"
    rng = np.random.default_rng(1)
    values = [",".join(f"{value:.3f}" for value in row) for row in rng.uniform(100, 170, (30, 9))]
    head = f"{name},{','.join(f'A{n} [deg]' for n in range(1, 7))},X [mm],Y [mm],Z [mm]"
    file.write_text("\n".join([head, *(f"{n},{row}" for n, row in enumerate(values, 1))]))
    reflectors.write_text("\n".join([head, *(f"{n % 3},{row}" for n, row in enumerate(values, 1))]))
    assert f"  # no target: '{name}', which differs from row to row\n" in draft_mapping(file)
    assert "target: {" not in draft_mapping(file)
    assert f"  target: {{column: '{name}'}}   # guessed by name\n" in draft_mapping(reflectors)
