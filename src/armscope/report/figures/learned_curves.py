"""Curves that two runs tell of one joint, one upon the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from armscope.real.curves import Shared
from armscope.report.style import BLUE, VERMILION, legend_above, styled


def draw_shared_curves(curves: Sequence[Shared]) -> Figure:
    """One panel per joint: what it turns over its angle, as learned on either run, without the slow part."""
    with styled():
        figure, panels = plt.subplots(len(curves), 1, figsize=(7.2, 0.9 + 1.5 * len(curves)), squeeze=False)
        for axes, curve in zip(panels[:, 0], curves, strict=True):
            degrees = np.degrees(curve.at)
            for values, colour, run, width in (
                (curve.one, BLUE, curve.runs[0], 2.2),
                (curve.other, VERMILION, curve.runs[1], 1.1),
            ):
                axes.plot(degrees, 1e3 * values, color=colour, lw=width, label=f"learned on {run}")
            axes.set_ylabel(f"{curve.joint}\nturns by (mrad)")
            axes.set_title(f"correlation {curve.correlation:.2f}", loc="right", fontsize="small")
        panels[-1, 0].set_xlabel("angle of the joint (deg), where both runs know the curve")
        legend_above(figure, columns=2)
    return figure
