"""One clear error: file, place, value, rule, cure."""

from typing import Annotated, Literal

import pydantic
import pytest
import yaml

from armscope.core.inputs import InputError, Strict, format_of, load, nearest, read_yaml


class Inner(Strict):
    a_mm: float


class Outer(Strict):
    name: str
    rows: tuple[Inner, ...]
    count: int = pydantic.Field(1, ge=1)


def written(tmp_path, text):
    path = tmp_path / "thing.yaml"
    path.write_text(text)
    return path


def test_an_unknown_key_is_named_with_the_nearest_known_one(tmp_path):
    path = written(tmp_path, "name: arm\nrows:\n  - {a_mm: 1}\n  - {a_mmm: 2, a_mm: 3}\n")
    with pytest.raises(InputError) as caught:
        load(Outer, path)
    assert caught.value.place == "rows[1].a_mmm"
    assert "Did you mean 'a_mm'?" in str(caught.value)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    ("text", "place", "found"),
    [
        ("name: arm\nrows: [{a_mm: one}]\n", "rows[0].a_mm", "one"),
        ("name: arm\nrows: [{a_mm: .nan}]\n", "rows[0].a_mm", "nan"),
        ("name: arm\nrows: [{}]\n", "rows[0].a_mm", "nothing"),
        ("name: arm\nrows: []\ncount: 0\n", "count", "0"),
    ],
)
def test_a_wrong_value_is_quoted_at_its_place(tmp_path, text, place, found):
    with pytest.raises(InputError) as caught:
        load(Outer, written(tmp_path, text))
    assert caught.value.place == place
    assert f"found {found}" in str(caught.value).replace("'", "")


def test_broken_yaml_is_an_error_with_line_and_column(tmp_path):
    with pytest.raises(InputError, match="line 3, column 2"):
        read_yaml(written(tmp_path, "a: 1\nb: [1, 2\nc: 3\n"))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a: 1\n---\nb: 2\n", "found 'a second document'; a configuration is one document.*Leave out the line `---`"),
        ("a: !size 3\n", "line 1, column 4: found 'the tag !size'.*Leave out the word that begins with `!`"),
        ("a_mm: 19:10\n", "line 1, column 7: found '19:10, neither a number nor a word'.*19.10.*in quotes"),
        ("a_mm: 1:30.5\n", "found '1:30.5, neither"),
    ],
)
def test_what_is_yaml_but_no_configuration_is_told_with_its_own_cure(tmp_path, text, told):
    """Indentation and colons were not the cause; 19:10 was 1150 without a word."""
    with pytest.raises(InputError, match=told) as caught:
        read_yaml(written(tmp_path, text))
    assert "indentation" not in str(caught.value)


def test_times_of_day_in_quotes_are_words(tmp_path):
    assert read_yaml(written(tmp_path, "a: '19:10'\nb: at 19:10\nc: 2024-01-01 19:10:11\n"))["a"] == "19:10"


def test_a_key_that_stands_twice_is_not_silently_dropped(tmp_path):
    assert yaml.safe_load("a: 1\na: 2\n") == {"a": 2}  # what plain YAML does
    with pytest.raises(InputError, match="'a' twice"):
        read_yaml(written(tmp_path, "a: 1\na: 2\n"))


def test_a_key_that_can_not_be_one_is_an_error_with_its_place(tmp_path):
    with pytest.raises(InputError, match=r"line 1, column 3.*\['a', 'b'\]"):
        read_yaml(written(tmp_path, "? [a, b]\n: 1\n"))


def test_a_misspelt_key_is_named_before_what_is_then_missing(tmp_path):
    with pytest.raises(InputError, match=r"rows\[0\].a_m: .*Did you mean 'a_mm'"):
        load(Outer, written(tmp_path, "name: arm\nrows: [{a_m: 1}]\n"))


class Round(Strict):
    kind: Literal["round"]
    radius: float


class Square(Strict):
    kind: Literal["square"]
    side: float


class Shapes(Strict):
    shapes: tuple[Annotated[Round | Square, pydantic.Field(discriminator="kind")], ...]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("shapes: [{kind: round, radius: a}]", r"shapes\[0\].radius: found 'a'"),
        ("shapes: [{kind: round, radios: 1}]", r"shapes\[0\].radios: .*Did you mean 'radius'"),
        ("shapes: [{kind: round}]", r"shapes\[0\].radius: found nothing"),
        ("shapes: 1", "shapes: found 1; input should be a list"),
    ],
)
def test_a_place_is_as_the_user_wrote_it_whatever_alternatives_were_tried(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        load(Shapes, written(tmp_path, text))


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match="no_such"):
        read_yaml(tmp_path / "no_such.yaml")


def test_the_nearest_name_differs_in_capitals_first():
    assert nearest("q2_rad", ["q1_rad", "Q2_Rad", "q3_rad"]) == "Did you mean 'Q2_Rad'?"


def test_nearest_lists_what_is_known_when_nothing_is_close():
    assert nearest("zzzz", ["beta", "alpha"]) == "Known: alpha, beta."


def test_a_format_is_told_whatever_the_content_is() -> None:
    assert format_of({"format": "armscope model 1"}) == "armscope model 1"
    assert format_of({}) == "no key format"
    assert format_of([1]) == "no mapping"


def test_a_mapping_of_more_keys_than_anything_has_is_refused_where_they_become_too_many(tmp_path):
    path = tmp_path / "many.yaml"
    path.write_text("".join(f"k{number}: 1\n" for number in range(30_000)), encoding="utf-8")
    with pytest.raises(InputError, match=r"line 20001.*20000 keys of one mapping"):
        read_yaml(path)
