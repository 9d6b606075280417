"""Self-contained HTML pages: everything embedded, nothing fetched."""

from __future__ import annotations

import base64
import contextlib
import importlib.resources
import importlib.util
import os
import re
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from pickle import UnpicklingError
from typing import TYPE_CHECKING, Any

import jinja2
import pandas as pd
from jinja2 import BytecodeCache
from markupsafe import Markup, escape

from armscope.core.files import write_text
from armscope.core.inputs import spelt_out
from armscope.core.outputs import readable
from armscope.core.words import rounded
from armscope.verdict.wording import capitalised, plain

if TYPE_CHECKING:
    from jinja2.bccache import Bucket


class BesideTemplates(BytecodeCache):
    """In ``__pycache__`` beside the templates, or where PYTHONPYCACHEPREFIX says; nowhere where that can't be written.

    Jinja compares a digest of the template, and its own and Python's version, before it takes what is kept.

    Args:
        folder: of the templates.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def _file(self, bucket: Bucket) -> Path:
        return Path(importlib.util.cache_from_source(str(self.folder / f"{bucket.key}.jinja.py")))

    def load_bytecode(self, bucket: Bucket) -> None:
        """Take what is kept; whatever can't be read is compiled anew."""
        with (
            contextlib.suppress(OSError, ValueError, EOFError, TypeError, UnpicklingError),
            self._file(bucket).open("rb") as kept,
        ):
            bucket.load_bytecode(kept)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep what was compiled, whole or not at all."""
        if sys.dont_write_bytecode:
            return
        path = self._file(bucket)
        with contextlib.suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(dir=path.parent)
            try:
                with os.fdopen(handle, "wb") as made:
                    bucket.write_bytecode(made)
                Path(name).replace(path)
            except BaseException:
                Path(name).unlink(missing_ok=True)
                raise


_TEMPLATES = jinja2.Environment(
    loader=jinja2.PackageLoader("armscope.report", "templates"),
    autoescape=True,
    trim_blocks=True,
    lstrip_blocks=True,
    undefined=jinja2.StrictUndefined,
    auto_reload=False,
    bytecode_cache=BesideTemplates(Path(__file__).parent / "templates"),
)


def unbroken(text: str) -> str:
    """Numbers keep their units beside them: no line break between "55" and "%", within "N m", nor before a dash."""
    return re.sub(r"(?<=\d) (?=[%°µa-zA-Z])| (?=–)|(?<=\bN) (?=m\b)", "\u00a0", text)


def by_cause(headline: str) -> list[Markup]:
    """A headline cause by cause, a line each, what is beside each in brackets quiet; one line if it is one sentence."""
    clauses = headline.split("; ")
    several = len(clauses) > 1 and all(" – " in clause for clause in clauses)
    lines = [capitalised(clause.rstrip(".")) for clause in clauses] if several else [headline]
    return [Markup(re.sub(r"\([^()]*\)", r"<i>\g<0></i>", str(escape(unbroken(line))))) for line in lines]


_TEMPLATES.filters["unbroken"] = unbroken
_TEMPLATES.filters["by_cause"] = by_cause
_TEMPLATES.filters["plain"] = plain
_TEMPLATES.filters["rounded"] = rounded


def render_page(template: str, **content: Any) -> str:
    """The HTML of ``templates/<template>`` filled with ``content``."""
    html = _TEMPLATES.get_template(template).render(embed=embed, beside=beside, table=html_table, **content)
    return spelt_out(_as_code(html))


def _as_code(html: str) -> str:
    """Names in backticks, as a terminal shows them, as a page does; scripts, styles and tags stay what they are."""
    tags = r"(<(script|style)\b.*?</\2>|<[^>]*>)|`([^`<>]+)`"
    return re.sub(tags, lambda found: found[1] or f"<code>{found[3]}</code>", html, flags=re.DOTALL)


def write_page(path: Path | str, template: str, **content: Any) -> None:
    """Render a page and write it, whole or not at all.

    Args:
        path: of the page.
        template: its name.
        content: what the template shows.
    """
    write_text(path, render_page(template, **content))


def beside(name: str) -> Markup:
    """A script or style sheet that lies beside the templates, as it is."""
    return Markup(importlib.resources.files("armscope.report").joinpath("templates", name).read_text())


def embed(figure: Path | str, alt: str = "") -> Markup:
    """An <img> that carries the picture in itself."""
    path = Path(figure)
    kind = {".svg": "image/svg+xml", ".png": "image/png"}[path.suffix]
    data = base64.b64encode(readable(path).read_bytes()).decode()
    return Markup('<img src="data:{};base64,{}" alt="{}">').format(kind, data, alt)


def html_table(rows: pd.DataFrame, digits: int = 3) -> Markup:
    """A table as HTML: numbers right, with ``digits`` significant digits, text left, a dash for nothing.

    Names and words come from users' files: whatever they hold is shown, never obeyed.
    """
    looks = ["" if pd.api.types.is_numeric_dtype(rows[name]) else ' class="words"' for name in rows.columns]

    def shown(value: Any) -> str:
        if pd.isna(value):
            return "–"
        return significant(value, digits) if isinstance(value, float) else str(value)

    def line(tag: str, values: Iterable[Any]) -> Markup:
        cells = zip(looks, values, strict=True)
        return Markup("\n").join(Markup(f"<{tag}{look}>{{}}</{tag}>").format(shown(value)) for look, value in cells)

    body = Markup("").join(Markup("<tr>{}</tr>").format(line("td", row)) for row in rows.itertuples(index=False))
    head = Markup("<tr>{}</tr>").format(line("th", rows.columns))
    return Markup('<div class="scroll"><table><thead>{}</thead><tbody>{}</tbody></table></div>').format(head, body)


def share_text(share: float, right: float, cases: float) -> str:
    """A share of cases as "97 % (29/30)".

    Args:
        share: 0 ... 1.
        right: how many were.
        cases: of how many.

    Returns:
        The text; a dash where there were none.
    """
    return f"{100 * share:.0f} % ({right:.0f}/{cases:.0f})" if cases else "–"


def definitions(text: str) -> list[tuple[str, Markup]]:
    """(bold head, rest as HTML) of a docstring's paragraphs after the first."""
    found = []
    for paragraph in text.strip().split("\n\n")[1:]:
        head, _, rest = " ".join(paragraph.split()).removeprefix("**").partition("**")
        found.append((head, Markup(re.sub(r"`(.+?)`", r"<code>\1</code>", str(escape(rest))))))
    return found


def significant(value: float, digits: int = 3) -> str:
    """A number with that many significant digits, without exponent where it is of readable size."""
    if value == 0:
        return "0"
    if 1e-4 <= abs(value) < 1e5:
        decimals = max(0, digits - 1 - int(f"{value:.{digits - 1}e}".split("e")[1]))
        return f"{value:.{decimals}f}"
    return f"{value:.{digits - 1}e}"
