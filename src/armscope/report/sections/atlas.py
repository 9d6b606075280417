"""The atlas: what each place could explain."""

from __future__ import annotations

from armscope.report.figures.atlas import atlas_figure, attribution
from armscope.report.subject import Section

ATLAS = Section("atlas", "Atlas", figures=(atlas_figure,), applies=attribution)
