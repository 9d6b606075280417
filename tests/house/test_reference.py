"""The pages about files are what the typed models say, and every key of a file a user writes has a meaning."""

import pytest
from tools import reference


@pytest.mark.parametrize("name", reference.MAKERS)
def test_pages_are_what_the_code_is(name: str) -> None:
    assert (reference.PAGES / name).read_text(encoding="utf-8") == reference.MAKERS[name]()


@pytest.mark.parametrize("name", ["robot-yaml.md", "verdict-json.md", "motion-verdict-json.md", "model-yaml.md"])
def test_every_key_has_a_meaning(name: str) -> None:
    rows = [line.split(" | ") for line in reference.MAKERS[name]().splitlines() if line.startswith("| `")]
    assert len(rows) > 15
    assert [row[0] for row in rows if len(row[-1].strip(" |")) < 2] == []


@pytest.mark.parametrize("name", ["verdict-json.md", "motion-verdict-json.md", "model-yaml.md"])
def test_what_is_not_known_is_null_in_every_cell(name: str) -> None:
    rows = [line.split(" | ") for line in reference.MAKERS[name]().splitlines() if line.startswith("| `")]
    assert not [row for row in rows if {"None", "NaN"} & set(row[-1].replace(";", " ").split())]
    said = [row for row in rows if "null" in row[-1] and "null for" not in row[-1]]
    assert said
    assert [row[0] for row in said if "null" not in row[1]] == []


def test_a_key_that_may_be_left_out_is_not_called_null() -> None:
    assert "or null" not in reference.robot()
    assert "| `noise_mm` | number or null |" in reference.verdict()


def test_signs_and_axes_are_said() -> None:
    assert "axes of frame j" in reference.robot()
    assert "positive along gravity's pull" in reference.recordings()
