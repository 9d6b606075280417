"""A calibration in words: how well it does, what was fitted and how surely, what was held and why."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from armscope.calibration.by_run import ALL

if TYPE_CHECKING:
    from armscope.calibration.calibrate import Calibration

SHOWN = {"m": (1e3, "mm"), "rad": (1e3, "mrad"), "rad/(N m)": (1e6, "µrad/(N m)")}
"""Factor and unit for reading."""
MOST_SUSPECTS = 12


def in_words(calibration: Calibration) -> str:
    """Lengths in mm, angles in mrad, compliances in µrad/(N m); what D-H constants become as in robot.yaml."""
    arm = calibration.set_up.arm
    rows, parameters = len(calibration.set_up), int(calibration.free.sum())
    lines = [f"{arm.name}: {calibration.level} calibration on {rows} rows, {parameters} parameters"]
    lines += _misses(calibration)
    if arm.description.urdf is not None and arm.description.actuation is None:
        motors = ", ".join(f"q{motor} {name}" for motor, name in enumerate(arm.joint_names, start=1))
        lines.append(f"motors: {motors}")
    lines += calibration.notes
    lines += [f"doubtful: {doubt}" for doubt in calibration.doubts]
    if len(suspects := calibration.ids[calibration.suspects]):
        more = ", ..." if len(suspects) > MOST_SUSPECTS else ""
        lines.append(f"{len(suspects)} rows look like bad shots: {', '.join(suspects[:MOST_SUSPECTS])}{more}")
    lines.append("fitted, with standard errors (of base frames: along and about the base's own axes):")
    lines += [_parameter(*row) for row in calibration.table.itertuples(index=False)]
    if calibration.held:
        lines.append("held at nominal: from these poses not told apart from what moves the tool alike:")
        lines += [f"  {each.text()}" for each in calibration.held]
    return "\n".join(lines)


def _parameter(name: str, unit: str, value: float, stderr: float, nominal: float) -> str:
    factor, shown = SHOWN[unit]
    beside = ""
    if not np.isnan(nominal):
        beside = f"  (nominal {nominal * factor:.6g} {shown})"
        if name.startswith("joint "):  # the value is a change
            after = nominal + value
            becomes = f"{np.degrees(after):.5g} deg" if unit == "rad" else f"{1e3 * after:.6g} mm"
            beside = f"  (becomes {becomes})"
    return f"  {name:<28} {value * factor:12.5g} +- {stderr * factor:.2g} {shown}{beside}"


def _misses(calibration: Calibration) -> list[str]:
    stopped = f"after {calibration.steps} steps; {calibration.reason}"
    if calibration.misses is None:
        return [f"RMS of the 3D distance {calibration.rms_distance * 1e3:.4g} mm {stopped}"]
    lines = []
    for run, _, inside, held, spread, alone in calibration.misses.itertuples(index=False):
        where = "RMS of the 3D distance" if run == ALL else f"  run {run}:"
        outside = f"held out {held:.4g} +- {spread:.2g} mm (base and tool alone {alone:.4g} mm)"
        lines.append(f"{where} {inside:.4g} mm on the rows fitted, {outside if np.isfinite(held) else 'none held out'}")
    return [*lines, stopped]
