"""The sections of the page of a diagnosis, in their order: a new one is a file here, a template, and a line."""

from __future__ import annotations

from armscope.report.sections.assumed import ASSUMED
from armscope.report.sections.atlas import ATLAS
from armscope.report.sections.better import BETTER
from armscope.report.sections.effects import EFFECTS
from armscope.report.sections.left import LEFT
from armscope.report.sections.next_poses import NEXT
from armscope.report.sections.rows import ROWS
from armscope.report.sections.terms import TERMS
from armscope.report.sections.where import WHERE
from armscope.report.sections.workspace import WORKSPACE
from armscope.report.subject import Section

SECTIONS: tuple[Section, ...] = (WHERE, ATLAS, BETTER, WORKSPACE, EFFECTS, LEFT, ROWS, NEXT, ASSUMED, TERMS)
