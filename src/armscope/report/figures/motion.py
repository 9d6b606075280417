"""Torques of an arm in motion: over time, friction over speed, and what is left over angle, speed and time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.motion.library.laws import Law
from armscope.motion.library.remedies_of_curves import WAY
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.model.shapes import free_curve, friction_over_speed, limits_of, since_reversal
from armscope.motion.verdict import FoundCause
from armscope.report.colours import AFTER, BEFORE, MEASURED, OUTLINE, QUIET, Key
from armscope.report.figures.along_joints import running_mean
from armscope.report.figures.effect_curve import DrawnCurve, draw_curves
from armscope.report.motion_subject import MotionSubject, liveliest_piece
from armscope.report.sectioning import Drawn
from armscope.report.svg import Drawing, Panel
from armscope.verdict.effects import INTERVAL

WIDE, HIGH = 500.0, 200.0  # Of one joint's picture, px
SMALL, LOW = 330.0, 165.0
"""Of a picture of which three stand beside each other, px; what is left is as high as the wide ones."""
FEW = 2  # Joints up to which a picture has the width of half a page
MOST_ROWS, MOST_DOTS = 450, 500
BEYOND = 1.6  # A simulated torque is drawn up to so many times the measured ones' range
DASH = "5 4"
KNOT, OVER_WAY = "knot ", "over way "  # How numbers are called that are points of a curve, or slip after a way
TRACE = (Key(MEASURED, "measured", "wide"), Key(BEFORE, "as stated", "dashed"), Key(AFTER, "corrected"))
LEFT = (Key(BEFORE, "friction only"), Key(AFTER, "with causes"))
FRICTION = (Key(QUIET, "rows", "dots"), Key(AFTER, "model"))  # What the colours of each kind of picture stand for


def trace_figures(subject: MotionSubject) -> Iterator[Drawn]:
    """Torques of every joint over a piece of motion that took no part: measured, as stated, corrected."""
    part, piece = liveliest_piece(subject.found.held, MOST_ROWS)
    time = part.rows.time[part.which][piece]
    wide = _wide(subject)
    for joint in range(subject.arm.n_motors):
        lines = [(each[piece, joint], colour, width) for each, colour, width in (
            (part.measured, MEASURED, 5.5), (part.stated, BEFORE, 1.4), (part.model, AFTER, 1.6),
        )]  # fmt: skip
        yield Drawn(f"trace_{joint + 1}", draw_trace(f"joint {joint + 1}", subject.unit(joint), time, lines, wide))


def _wide(subject: MotionSubject) -> float:
    """Width of a picture, px: two of them stand beside each other, or three."""
    return WIDE if subject.arm.n_motors <= FEW else SMALL


def _high(wide: float) -> float:
    return HIGH if wide >= WIDE else LOW


def draw_trace(
    title: str, unit: str, time: Array, lines: Sequence[tuple[Array, str, float]], wide: float = WIDE
) -> Drawing:
    """Measured, simulated and corrected torque over time.

    Args:
        title: the joint.
        unit: of torque.
        time: (K,) s.
        lines: torque (K,), colour and width of each: measured first, then as stated, then corrected.
        wide: px; a narrow one has no room for what the colours stand for, which its page says.

    Returns:
        The figure.
    """
    measured = lines[0][0]
    middle, half = (measured.max() + measured.min()) / 2, max(float(np.ptp(measured)) / 2, 1e-9)
    shown = np.clip(np.concatenate([each for each, _, _ in lines]), middle - BEYOND * half, middle + BEYOND * half)
    drawing = Drawing(
        wide, _high(wide), f"Torque of {title} over time on held-out motion: measured, as stated, corrected"
    )
    panel = _panel(drawing, wide, (float(time[0]), float(time[-1])), _range(shown))
    panel.frame("", "time (s)", f"torque ({unit})")
    for (values, colour, width), key in zip(lines, TRACE, strict=True):
        drawing.line(panel.at(time, values), colour, width, dash=DASH if key.look == "dashed" else "")
    _head(drawing, title, TRACE if wide >= WIDE else ())
    return drawing


def friction_figures(subject: MotionSubject) -> Iterator[Drawn]:
    """Friction of every joint that moves, over its speed: what the rows say, and the model's curve."""
    rows, model = subject.found.selected.rows, subject.found.model
    left = subject.found.selected.residuals
    few = spread_evenly(len(rows), MOST_DOTS)
    for joint in subject.moving:
        speed = rows.dq[:, joint]
        cloud = left[few, joint] + friction_over_speed(model, joint, speed[few])
        # steps fine enough for the change of sides at rest, which is the steepest there is
        low, high = float(speed.min()), float(speed.max())
        grid = np.unique(np.concatenate([np.linspace(low, high, 160), np.linspace(-0.02, 0.02, 41) * (high - low)]))
        grid = grid[(grid >= low) & (grid <= high)]
        factor, unit = subject.shown(joint)
        curve = friction_over_speed(model, joint, grid)
        drawn = draw_friction(
            f"joint {joint + 1}",
            (factor * speed[few], cloud),
            (factor * grid, curve),
            (f"speed ({unit}/s)", f"friction ({subject.unit(joint)})"),
            _wide(subject),
        )
        yield Drawn(f"friction_{joint + 1}", drawn)


def draw_friction(
    title: str, cloud: tuple[Array, Array], curve: tuple[Array, Array], labels: tuple[str, str], wide: float = WIDE
) -> Drawing:
    """A cloud of friction over speed, and the model's curve.

    Args:
        title: the joint.
        cloud: (K,) speeds and friction of rows.
        curve: (N,) speeds and friction by the model.
        labels: of both axes.
        wide: px.

    Returns:
        The figure.
    """
    drawing = Drawing(wide, _high(wide), f"Friction of {title} over its speed: rows and the model's curve")
    values = np.concatenate([np.percentile(cloud[1], [0.5, 99.5]), curve[1]])
    panel = _panel(drawing, wide, (float(curve[0][0]), float(curve[0][-1])), _range(values))
    panel.frame("", *labels)
    for ends in ((np.array(panel.x), np.zeros(2)), (np.zeros(2), np.array(panel.y))):
        drawing.line(panel.at(*ends), OUTLINE, 0.8, -1)
    drawing.dots(panel.at(*cloud), QUIET, 2.4, 0.45)
    drawing.line(panel.at(*curve), AFTER, 2.4, 1)
    _head(drawing, title, FRICTION)
    return drawing


def left_figures(subject: MotionSubject) -> Iterator[Drawn]:
    """What is left of every joint's torque on held-out motion over its angle, its speed and time."""
    held = subject.held
    few = spread_evenly(len(held.time), MOST_DOTS)
    for joint in subject.moving:
        factor, unit = subject.shown(joint)
        before, after = ((held.measured - each)[:, joint] for each in (held.background, held.model))
        limit = 1.2 * float(np.percentile(np.abs(before), 99)) + 1e-12
        along = (
            ("position" if subject.arm.sliding[joint] else "angle", factor * held.q[:, joint], unit),
            ("speed", factor * held.dq[:, joint], f"{unit}/s"),
            ("time", held.time, "s"),
        )
        for name, at, of in along:
            drawing = Drawing(SMALL, HIGH, f"What is left of joint {joint + 1}'s torque over its {name}")
            panel = _panel(drawing, SMALL, (float(at.min()), float(at.max()) + 1e-9), (-limit, limit))
            panel.frame("", f"{name} ({of})", f"left ({subject.unit(joint)})")
            for values, key in zip((before, after), LEFT, strict=True):
                drawing.dots(panel.at(at[few], values[few]), key.colour, 2.2, 0.45)
                drawing.line(panel.at(*running_mean(at, values)), key.colour, 2.2, 1)
            _head(drawing, f"joint {joint + 1}", LEFT)
            yield Drawn(f"left_{joint + 1}_{name if name != 'position' else 'angle'}", drawing)


def curve_figures(subject: MotionSubject) -> Iterator[Drawn]:
    """Free curves among the causes, and what clings over ways, by the number of the cause."""
    fitted = {(str(each.placed.cause.name), each.placed.location, each.placed.driver): each
              for each in subject.found.model.causes}  # fmt: skip
    for number, cause in enumerate(subject.verdict.effects, start=1):
        curve = fitted.get((cause.effect, cause.location, cause.driver))
        if curve is not None and is_drawn(cause):
            yield Drawn(f"curve_{number}", draw_curves([_drawn_curve(subject, cause, curve)]))


def is_drawn(cause: FoundCause) -> bool:
    """Whether a cause has a curve that says more than its numbers."""
    return any(each.name.startswith((KNOT, OVER_WAY)) for each in cause.parameters)


def _drawn_curve(subject: MotionSubject, cause: FoundCause, curve: FittedCause) -> DrawnCurve:
    law = curve.placed.columns
    assert isinstance(law, Law)
    if cause.driver == WAY:
        longest = 2 * max(law.numbers[-curve.placed.width :])
        at = longest * np.linspace(0, 1, 241) ** 2  # the short ways lie close together
        value, stderr = since_reversal(curve, at)
    else:
        at = np.linspace(*_seen(subject, cause.driver, law.joints[0], limits_of(curve)), 120)
        value, stderr = free_curve(curve, at)
    factor, unit = _driver_unit(subject, cause.driver, law.joints[0])
    band = INTERVAL * stderr
    return DrawnCurve(
        f"what {cause.location} does over the {cause.driver}",
        factor * at, value, value - band, value + band,
        f"{cause.driver} ({unit})", f"torque ({cause.unit})",
    )  # fmt: skip


def _seen(subject: MotionSubject, driver: str, joint: int, limits: tuple[float, float]) -> tuple[float, float]:
    """Where the rows were: beyond that a curve is anything."""
    rows = subject.found.selected.rows
    there = {"joint angle": rows.q, "speed": rows.dq, "load": rows.nominal}.get(driver)
    if there is None:
        return limits
    low, high = np.percentile(there[:, joint], [1, 99])
    return max(limits[0], float(low)), min(limits[1], float(high))


def _driver_unit(subject: MotionSubject, driver: str, joint: int) -> tuple[float, str]:
    factor, unit = subject.shown(joint)
    units = {
        "joint angle": (factor, unit),
        WAY: (factor, unit),
        "speed": (factor, f"{unit}/s"),
        "load": (1.0, subject.unit(joint)),
    }
    return units.get(driver, (1.0, {"time": "s", "temperature": "°C"}.get(driver, "")))


def _panel(drawing: Drawing, wide: float, x: tuple[float, float], y: tuple[float, float]) -> Panel:
    return Panel(drawing, 62, 26, wide - 74, drawing.height - 68, x, y)


def _range(values: Array) -> tuple[float, float]:
    low, high = float(np.min(values)), float(np.max(values))
    edge = 0.06 * max(high - low, 1e-9)
    return low - edge, high + edge


def _head(drawing: Drawing, title: str, keys: Sequence[Key]) -> None:
    """The joint's name on the left, what the colours stand for on the right."""
    drawing.text((62, 12), title, size=13, weight="bold")
    right = drawing.width - 12
    for colour, words, look in reversed(keys):
        drawing.text((right, 12), words, size=12, anchor="end")
        right -= 7.4 * len(words) + 6
        width, dash = (5.5, "") if look == "wide" else (2.8, DASH if look == "dashed" else "")
        drawing.line(np.array([[right - 16, 12], [right, 12]]), colour, width, dash=dash)
        right -= 30
