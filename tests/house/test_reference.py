"""The pages about files are what the typed models say, and every key of a file a user writes has a meaning."""

import pytest
from tools import reference


@pytest.mark.parametrize("name", reference.MAKERS)
def test_pages_are_what_the_code_is(name: str) -> None:
    assert (reference.PAGES / name).read_text(encoding="utf-8") == reference.MAKERS[name]()


@pytest.mark.parametrize("name", ["robot-yaml.md", "verdict-json.md", "model-yaml.md"])
def test_every_key_has_a_meaning(name: str) -> None:
    rows = [line.split(" | ") for line in reference.MAKERS[name]().splitlines() if line.startswith("| `")]
    assert len(rows) > 15
    assert [row[0] for row in rows if len(row[-1].strip(" |")) < 2] == []


def test_signs_and_axes_are_said() -> None:
    assert "axes of frame j" in reference.robot()
    assert "positive along gravity's pull" in reference.recordings()
