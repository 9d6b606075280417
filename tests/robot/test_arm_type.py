"""A type of arm in a fleet's priors.yaml: what can't be one is one clear error."""

from __future__ import annotations

from pathlib import Path

import pytest

from armscope.core.inputs import InputError
from armscope.robot.arm_type import read_arm_type

PRIORS = Path(__file__).parents[1] / "fuzz" / "corpus" / "priors" / "two-types.yaml"


def test_sizes_are_read_for_the_type_that_is_named() -> None:
    found = read_arm_type(PRIORS, "six-axis")
    assert found.title == "20 arms of type six-axis"
    assert found.sizes["joint_compliance at joint 2"]["compliance"].rms == 1.5e-7


@pytest.mark.parametrize(("name", "said"), [(None, "--arm-type says which"), ("six-axes", "Did you mean 'six-axis'")])
def test_a_type_is_named_and_there(name: str | None, said: str) -> None:
    with pytest.raises(InputError, match=said):
        read_arm_type(PRIORS, name)


@pytest.mark.parametrize(
    ("change", "place"),
    [
        (("priors 2", "priors 1"), "format"),
        (("rms: 1.5e-07", "rms: -1"), "rms"),
        (("rms: 1.5e-07", "rms: .nan"), "rms"),
        (("arms: 14", "arms: 0"), "arms"),
        (("unit:", "units:"), "units"),
    ],
)
def test_a_changed_file_is_one_error_that_names_the_place(tmp_path: Path, change: tuple[str, str], place: str) -> None:
    (bad := tmp_path / "priors.yaml").write_text(PRIORS.read_text().replace(*change))
    with pytest.raises(InputError, match=place):
        read_arm_type(bad, "six-axis")
