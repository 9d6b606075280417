"""The atlas: what each place could explain."""

from __future__ import annotations

from typing import Any

from armscope.report.figures.atlas import atlas_map, attribution
from armscope.report.sectioning import Section, Subject


def _context(subject: Subject) -> dict[str, Any]:
    atlas = subject.verdict.atlas
    return {} if atlas is None else {"map": atlas_map(atlas, subject.verdict.effects)}


ATLAS = Section("atlas", "Atlas", "The atlas: what each place could explain", _context, (), attribution, folded=True)
