"""The sections of the page of a diagnosis, in their order: a new one is a file here, a template, and a line."""

from __future__ import annotations

from armscope.report.sectioning import Section, Subject
from armscope.report.sections.along_joints import ALONG_JOINTS
from armscope.report.sections.assumptions import ASSUMPTIONS
from armscope.report.sections.atlas import ATLAS
from armscope.report.sections.cures import CURES
from armscope.report.sections.effects import EFFECTS
from armscope.report.sections.glossary import GLOSSARY
from armscope.report.sections.locations import LOCATIONS
from armscope.report.sections.next_poses import NEXT_POSES
from armscope.report.sections.suspect_rows import SUSPECT_ROWS
from armscope.report.sections.unexplained import UNEXPLAINED
from armscope.report.sections.validation import VALIDATION
from armscope.report.sections.work_order import WORK_ORDER

SECTIONS: tuple[Section[Subject], ...] = (
    WORK_ORDER, LOCATIONS, CURES, EFFECTS, NEXT_POSES, UNEXPLAINED, VALIDATION, ATLAS, ALONG_JOINTS, SUSPECT_ROWS,
    ASSUMPTIONS, GLOSSARY,
)  # fmt: skip
"""What a person acts on comes first; what it rests on is folded below."""
