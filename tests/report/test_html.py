"""What a terminal shows in backticks is code on a page; scripts, styles and tags are what they are."""

from __future__ import annotations

from armscope.report.html import _as_code


def test_names_in_backticks_are_code_on_a_page() -> None:
    body = "<script>`a`</script><style>/* `b` */</style><p title='`c`'>see `armscope check`, a ` alone</p>"
    said = _as_code(body)
    assert "<script>`a`</script><style>/* `b` */</style><p title='`c`'>" in said
    assert "see <code>armscope check</code>, a ` alone" in said
