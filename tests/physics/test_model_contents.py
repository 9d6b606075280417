"""A model's file holds rotations that are rotations, and numbers that an arm can have."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.spatial.transform import Rotation as Turn

from armscope.physics.model_contents import LARGEST_VALUE, BaseFile, TermFile

TERM = {"name": "a", "unit": "mm", "si": 1e-3, "products": ()}


def base(rotation: np.ndarray) -> BaseFile:
    return BaseFile(rotation=rotation.tolist(), translation_m=(0.0, 0.0, 0.0))


@given(st.tuples(*[st.floats(-3, 3)] * 3))
def test_every_turn_is_taken_and_its_mirror_image_is_not(vector: tuple[float, float, float]) -> None:
    turn = Turn.from_rotvec(vector).as_matrix()
    np.testing.assert_array_equal(base(turn).rotation, turn)
    for no_turn in (-turn, 1.001 * turn):
        with pytest.raises(ValidationError, match="three orthogonal rows"):
            base(no_turn)


@pytest.mark.parametrize("value", [np.nan, np.inf, 2 * LARGEST_VALUE, -2 * LARGEST_VALUE])
def test_values_that_no_arm_has_are_refused(value: float) -> None:
    with pytest.raises(ValidationError, match="value"):
        TermFile(value=value, **TERM)
    assert TermFile(value=0.5 * LARGEST_VALUE, **TERM).value == 0.5 * LARGEST_VALUE
