"""The sections of the page of a diagnosis, in their order: a new one is a file here, a template, and a line."""

from __future__ import annotations

from armscope.report.sectioning import Section
from armscope.report.sections.along import ALONG
from armscope.report.sections.assumed import ASSUMED
from armscope.report.sections.atlas import ATLAS
from armscope.report.sections.better import BETTER
from armscope.report.sections.cures import CURES
from armscope.report.sections.effects import EFFECTS
from armscope.report.sections.left import LEFT
from armscope.report.sections.next_poses import NEXT
from armscope.report.sections.rows import ROWS
from armscope.report.sections.terms import TERMS
from armscope.report.sections.where import WHERE
from armscope.report.sections.work import WORK
from armscope.report.subject import Subject

SECTIONS: tuple[Section[Subject], ...] = (
    WORK, WHERE, CURES, EFFECTS, NEXT, LEFT, BETTER, ATLAS, ALONG, ROWS, ASSUMED, TERMS,
)  # fmt: skip
"""What a person acts on comes first; what it rests on is folded below."""
