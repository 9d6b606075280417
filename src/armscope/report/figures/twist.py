"""Links beside their motors: what was recorded and what the causes say, over the torque between them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.motion.links.judgement import JudgedTwist
from armscope.report.colours import AFTER, QUIET, Key
from armscope.report.motion_subject import MotionSubject
from armscope.report.sectioning import Drawn
from armscope.report.svg import Drawing, Panel

WIDE, HIGH = 500.0, 230.0  # Of a picture, px
MOST_DOTS = 600
TWIST = (Key(QUIET, "as recorded"), Key(AFTER, "by the causes"))  # What the colours of the dots stand for


def twist_figures(subject: MotionSubject) -> Iterator[Drawn]:
    """One picture for every joint whose link was recorded."""
    for twist in subject.found.twists:
        yield Drawn(
            f"twist_{twist.selected.rows.joint + 1}", draw_twist(twist, subject.unit(twist.selected.rows.joint))
        )


def draw_twist(twist: JudgedTwist, torque_unit: str) -> Drawing:
    """Link less motor, less their zeros' difference, over torque. ``torque_unit``: N m, or N of a sliding joint."""
    rows, zero = twist.selected.rows, twist.side.offset.value
    few = spread_evenly(len(rows), MOST_DOTS)
    factor, unit = (1e3, "mrad") if twist.side.unit == "rad" else (1e6, "µm")
    measured = factor * (rows.measured[few] - zero)
    modelled = factor * ((rows.columns @ twist.selected.coefficients)[few] - zero)
    drawing = Drawing(WIDE, HIGH, f"Link less motor of {twist.side.joint} over the torque between them")
    both = np.concatenate([measured, modelled])
    edge = 0.08 * max(float(np.ptp(both)), 1e-9)
    across = (float(rows.torque.min()) - 1e-9, float(rows.torque.max()) + 1e-9)
    panel = Panel(drawing, 62, 26, WIDE - 74, HIGH - 68, across, (float(both.min()) - edge, float(both.max()) + edge))
    panel.frame("", f"torque that the links ask of the joint ({torque_unit})", f"link less motor ({unit})")
    drawing.dots(panel.at(rows.torque[few], measured), QUIET, 2.4, 0.45)
    drawing.dots(panel.at(rows.torque[few], modelled), AFTER, 2.0, 0.8)
    drawing.text((62, 12), twist.side.joint, size=13, weight="bold")
    return drawing
