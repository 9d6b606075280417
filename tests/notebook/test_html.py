"""What a notebook shows is text, whatever stands in it."""

from armscope.notebook.html import paragraphs, table


def test_texts_are_escaped_and_a_table_without_rows_is_none() -> None:
    assert paragraphs("a < b", "c & d") == "<p><b>a &lt; b</b></p><p>c &amp; d</p>"
    assert table(("cause",), []) == ""
    assert table(("cause", "cure"), [("<script>", "x")]) == (
        "<table><tr><th>cause</th><th>cure</th></tr><tr><td>&lt;script&gt;</td><td>x</td></tr></table>"
    )
