"""What a notebook shows is text, whatever stands in it."""

from armscope.core.told import InWords, paragraphs, table


class _Answer(InWords):
    def sentences(self) -> tuple[str, ...]:
        return "It is 3 < 4 mm.", "Next: text()."


def test_a_result_is_told_in_sentences_of_which_the_first_is_bold() -> None:
    assert repr(_Answer()) == "It is 3 < 4 mm. Next: text()."
    assert _Answer()._repr_html_() == "<p><b>It is 3 &lt; 4 mm.</b></p><p>Next: text().</p>"


def test_texts_are_escaped_and_a_table_without_rows_is_none() -> None:
    assert paragraphs("a < b", "c & d") == "<p><b>a &lt; b</b></p><p>c &amp; d</p>"
    assert table(("cause",), []) == ""
    assert table(("cause", "cure"), [("<script>", "x")]) == (
        "<table><tr><th>cause</th><th>cure</th></tr><tr><td>&lt;script&gt;</td><td>x</td></tr></table>"
    )
