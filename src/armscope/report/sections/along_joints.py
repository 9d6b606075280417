"""The error along each joint's motion, before and after."""

from __future__ import annotations

from armscope.report.figures.along_joints import along_joints_figure
from armscope.report.sectioning import Section

TITLE = "The error along each joint's motion"
ALONG_JOINTS = Section("along_joints", "Joint by joint", TITLE, figures=(along_joints_figure,), folded=True)
