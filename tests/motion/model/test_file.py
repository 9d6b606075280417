"""model.yaml of a motion, read."""

from __future__ import annotations

from pathlib import Path

import pytest

from armscope.core.inputs import InputError
from armscope.motion.model.file import is_motion_model, load_motion_model


def test_a_model_of_another_version_is_one_error_that_says_what_writes_this_one(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text("format: armscope motion model 1\n")
    assert is_motion_model({"format": "armscope motion model 1"})
    with pytest.raises(InputError, match=r"found 'armscope motion model 1'.*motion model 2.*diagnose motions.csv"):
        load_motion_model(path)


@pytest.mark.parametrize("content", [None, [], {}, {"format": 2}, {"format": "armscope model 1"}])
def test_no_other_file_is_a_model_of_a_motion(content: object) -> None:
    assert not is_motion_model(content)
