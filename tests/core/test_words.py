"""Words in a row read as a sentence does."""

from armscope.core.words import enumerated, uncapitalised


def test_words_in_a_row() -> None:
    assert enumerated(["one", "two", "three"]) == "one, two and three"
    assert enumerated(["one", "two"], "or") == "one or two"
    assert enumerated(["one"]) == "one"
    assert enumerated([]) == ""


def test_a_name_keeps_its_capital() -> None:
    assert uncapitalised("The arm") == "the arm"
    assert uncapitalised("D-H rows") == "D-H rows"
    assert uncapitalised("") == ""
