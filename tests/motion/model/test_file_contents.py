"""A motion's model file holds numbers that an arm can have, and motors that are counted from one."""

import pytest
from pydantic import ValidationError

from armscope.motion.model.constants import MODEL_FILE
from armscope.motion.model.file_contents import LawFile, ParameterFile

LAW = {"kind": "viscous", "joints": (1,), "numbers": (0.5,)}


@pytest.mark.parametrize("wrong", [{"joints": (0,)}, {"joints": (1.5,)}, {"numbers": (2 * MODEL_FILE.largest,)}])
def test_a_law_of_no_motor_or_of_no_size_is_refused(wrong: dict[str, object]) -> None:
    assert LawFile(**LAW).joints == (1,)
    with pytest.raises(ValidationError, match=next(iter(wrong))):
        LawFile(**{**LAW, **wrong})


def test_what_the_motion_does_not_tell_has_no_standard_error() -> None:
    assert ParameterFile(name="mass", unit="kg", value=1.0, stderr=None).stderr is None
    with pytest.raises(ValidationError, match="stderr"):
        ParameterFile(name="mass", unit="kg", value=1.0, stderr=float("nan"))
