"""What a notebook shows of a result: sentences and a table, in place of its arrays."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from html import escape


class InWords(ABC):
    """A result that a notebook shows as one paragraph. A dataclass must ask for it: `dataclass(repr=False)`."""

    @abstractmethod
    def sentences(self) -> tuple[str, ...]:
        """What it is; its main numbers with their units; what to call next."""

    def __repr__(self) -> str:
        return " ".join(self.sentences())

    def _repr_html_(self) -> str:
        return paragraphs(*self.sentences())


def paragraphs(headline: str, *further: str) -> str:
    """Sentences below each other, the first one bold."""
    return f"<p><b>{escape(headline)}</b></p>" + "".join(f"<p>{escape(text)}</p>" for text in further)


def table(head: Sequence[str], cells: Sequence[Sequence[str]]) -> str:
    """A table of texts; nothing where it has no row."""
    if not cells:
        return ""
    rows = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in cells)
    return f"<table><tr>{''.join(f'<th>{escape(name)}</th>' for name in head)}</tr>{rows}</table>"
