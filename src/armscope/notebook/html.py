"""What a notebook shows of a result: sentences and a table."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape


def paragraphs(headline: str, *further: str) -> str:
    """Sentences below each other, the first one bold."""
    return f"<p><b>{escape(headline)}</b></p>" + "".join(f"<p>{escape(text)}</p>" for text in further)


def table(head: Sequence[str], cells: Sequence[Sequence[str]]) -> str:
    """A table of texts; nothing where it has no row."""
    if not cells:
        return ""
    rows = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in cells)
    return f"<table><tr>{''.join(f'<th>{escape(name)}</th>' for name in head)}</tr>{rows}</table>"
