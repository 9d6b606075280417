"""docs/motion-causes.md, docs/motion-measured.md: tables filled from the library and from results, never by hand."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from armscope.core.files import read_table, write_text
from armscope.core.words import table_lines
from armscope.motion.library.catalogue import CAUSES
from armscope.motion.library.twist_catalogue import TWISTS
from armscope.motion.summary.held_out_errors import ON_HELD_OUT
from armscope.motion.verdict import read_motion_verdict
from armscope.report.html import significant
from armscope.report.pages.readme import filled

MEDIAN = "median"  # In the name of the one aim that is no rate


def fill_motion_pages(docs: Path, proof: Path | None, real: Path | None, of: str) -> None:
    """Replace what stands between the pages' marks.

    Args:
        docs: folder of the pages; they keep everything outside the marks.
        proof: folder with a motion proof's summary.csv and proof.csv; None keeps the rates that stand there.
        real: folder with a folder per real set, each with verdict.json; None keeps what stands there.
        of: what the results are of: a commit, and which proof.

    Raises:
        InputError: marks are missing, or a file of the results.
    """
    causes, measured = docs / "motion-causes.md", docs / "motion-measured.md"
    listed, text = (page.read_text(encoding="utf-8") for page in (causes, measured))
    listed = filled(listed, "causes", cause_lines(), causes)
    if proof is not None:
        summary, worlds = read_table(proof / "summary.csv"), read_table(proof / "proof.csv")
        text = filled(text, "rates", _rate_lines(summary, len(worlds), of), measured)
    if real is not None:
        text = filled(text, "real", real_lines(real, of), measured)
    write_text(causes, listed)
    write_text(measured, text)


def cause_lines() -> list[str]:
    """Every cause of the library: its name in verdict.json, its family, what it is."""
    rows = ((f"`{cause.name}`", cause.family, cause.physics) for cause in (*CAUSES, *TWISTS))
    return table_lines(("name", "family", "what it is"), rows)


def _rate_lines(summary: pd.DataFrame, worlds: int, of: str) -> list[str]:
    """The proof's aims over all of its worlds, with exact intervals, in Markdown."""
    rows = []
    for row in summary[(summary["seeds"] == "all") & (summary["cases"] > 0)].to_dict("records"):
        if MEDIAN in row["aim"]:
            found = f"{significant(row['estimate'], 3)} ({significant(row['low'], 3)}–{significant(row['high'], 3)})"
        else:
            found = f"{row['estimate']:.0%} ({row['low']:.0%}–{row['high']:.0%})".replace("%", " %")
        rows.append((row["aim"], row["cases"], found, row["verdict"]))
    head = f"Measured at {of}, {worlds} worlds, with 95 % intervals:"
    return [head, "", *table_lines(("", "cases", "found", "aim"), rows)]


def real_lines(folder: Path, of: str) -> list[str]:
    """Held-out errors on real arms, and what was said of them."""
    rows = []
    for path in sorted(folder.glob("*/verdict.json")):
        verdict = read_motion_verdict(path)
        held = verdict.held_out
        errors = (f"{significant(100 * error, 2)} %" for error in (held.stated, held.background, held.model))
        said = verdict.headline.partition(f" {ON_HELD_OUT}")[0]
        rows.append((path.parent.name, held.what, *errors, said))
    head = ("set", "held out", "as stated", "friction and rotors", "with masses and causes", "said")
    return [f"Measured at {of}:", "", *table_lines(head, rows)]
