"""The pages about the house say what the code is."""

import re

import pytest
from tools import architecture


def test_the_picture_is_drawn_from_the_code_as_it_is() -> None:
    assert architecture.PICTURE.read_text(encoding="utf-8") == architecture.svg()


@pytest.mark.parametrize("page", ["ARCHITECTURE.md", "CONTRIBUTING.md"])
def test_files_that_a_page_names_exist(page: str) -> None:
    text = (architecture.ROOT / page).read_text(encoding="utf-8")
    named = re.findall(r"`(\w+(?:/\w+)*/(?:\w+\.py)?)`", text)
    assert named
    for name in named:
        assert (architecture.PACKAGE / name).exists() or (architecture.ROOT / name).exists(), name


def test_every_room_stands_on_a_floor() -> None:
    on_floors = {room for rooms in architecture.floors() for room in rooms}
    assert on_floors == {path.parent.name for path in architecture.PACKAGE.glob("*/__init__.py")}


def test_lines_left_out_are_reached_another_way() -> None:
    assert architecture.reduced({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == {"a": {"b"}, "b": {"c"}, "c": set()}
