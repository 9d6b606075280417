"""An exciting motion: angles, and how much of the limits on speed, acceleration and torque it uses."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from armscope.poses.exciting.search import Excitation
from armscope.report.style import GREY, legend_above, styled

LINES = ("-", "--", "-.", ":")


def motion_figure(found: Excitation, table: pd.DataFrame) -> Figure:
    """Four panels over time, one line per joint: angle, degrees; speed, acceleration and torque as shares of limits."""
    limits = found.limits
    parts = (
        ("q{}_rad", np.full(len(limits.torque), np.pi / 180), "angle (deg)"),
        ("dq{}_rad_s", limits.path.speed, "speed / limit"),
        ("ddq{}_rad_s2", limits.path.acceleration, "acceleration / limit"),
        ("tau{}_nm", limits.torque, "torque / limit"),
    )
    with styled():
        figure, panels = plt.subplots(2, 2, figsize=(8.4, 4.6), sharex=True)
        for panel, (pattern, unit, label) in zip(panels.flat, parts, strict=True):
            known = np.isfinite(unit)
            for motor in range(len(unit)):
                values = table[pattern.format(motor + 1)].to_numpy()
                share = values / unit[motor] if known[motor] else values / max(float(np.abs(values).max()), 1e-12)
                style = {"linestyle": LINES[motor % len(LINES)], "label": f"joint {motor + 1}"}
                panel.plot(table["time_s"], share, linewidth=1.1, **style)
            panel.set_ylabel(label if known.all() else f"{label[: label.index('/')]}/ largest\n(no limit stated)")
            if "limit" in label:
                panel.set_ylim(-1.08, 1.08)
                for edge in (-1, 1):
                    panel.axhline(edge, color=GREY, linewidth=0.8, linestyle=":")
        for panel in panels[1]:
            panel.set_xlabel("time (s)")
        panels[0, 0].set_title(_title(found), loc="left", fontsize="small")
        legend_above(figure, columns=7)
    return figure


def _title(found: Excitation) -> str:
    if found.pairs:
        told = f"least separation {found.before.value:.2f} (random) to {found.after.value:.2f}"
    else:
        told = f"log determinant {found.before.value:.1f} (random) to {found.after.value:.1f}"
        told += f", condition number {found.before.condition:.0f} to {found.after.condition:.0f}"
    return f"{found.arm.name}: {told}"
