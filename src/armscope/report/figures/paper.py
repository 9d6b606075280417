"""Figures 3-11 of the paper in its arrangement, and how the swarm converges."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.errormodels import FittedModel
from armscope.paper.measurements import Measurements
from armscope.report.style import (
    AXIS_NAMES,
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    SKY,
    VERMILION,
    legend_above,
    styled,
)

TEST_FIGURES = {"fig05": "test 1", "fig08": "test 2", "fig09": "test 3"}
ESTIMATION_FIGURES = {
    "fig06": ("test 1", ("FDP(CI)", "SDP(CI)")),
    "fig07": ("test 1", ("FDP(AI)", "SDP(AI)")),
    "fig10": ("test 2", ("FDP(CI)", "SDP(CI)")),
    "fig11": ("test 2", ("FDP(AI)", "SDP(AI)")),
}
MODELLING = ("FDP(CI)", "SDP(CI)", "FDP(AI)", "SDP(AI)")
FIGURES = ("fig03", "fig04", "fig05", "fig06", "fig07", "fig08", "fig09", "fig10", "fig11")


def draw(name: str, measurements: Measurements, fits: Sequence[FittedModel]) -> Figure:
    """One of `FIGURES`, for the study's first robot.

    Args:
        name: "fig03" ... "fig11".
        measurements: of the study.
        fits: of its first robot, one per model.
    """
    by_model = {fit.name: fit for fit in fits if fit.label == measurements.robots[0]}
    if name == "fig03":
        return errors_of_positions(measurements.identification.errors_mm[0])
    if name == "fig04":
        rows = measurements.identification
        return modelling_performance(rows.errors_mm[0], _predictions(by_model, MODELLING, rows.inputs, np.median))
    if name in TEST_FIGURES:
        path = measurements[TEST_FIGURES[name]]
        return trajectory(path.nominal_mm, path.motor_angles)
    set_name, models = ESTIMATION_FIGURES[name]
    path = measurements[set_name]
    medians, lows, highs = (_predictions(by_model, models, path.inputs, f) for f in (np.median, np.min, np.max))
    return estimation_performance(path.errors_mm[0], medians, {m: np.stack([lows[m], highs[m]]) for m in models})


def _predictions(
    fits: Mapping[str, FittedModel],
    models: Sequence[str],
    inputs: Callable[..., Array],
    over_seeds: Callable[..., Array],
) -> dict[str, Array]:
    """By model, the seeds' predictions (N, 3) mm reduced to one."""
    return {
        model: over_seeds(fits[model].predict_all(inputs(fits[model].features.spec)), axis=0)
        for model in models
        if model in fits
    }


def errors_of_positions(errors: Array) -> Figure:
    """Fig. 3: errors of the identification positions.

    Args:
        errors: (N, 3) measured minus nominal, mm.
    """
    with styled():
        figure, panels = plt.subplots(3, 1, figsize=(7, 5), sharex=True)
        for axis, panel in enumerate(panels):
            panel.axhline(0, color=GREY, linewidth=0.6)
            panel.plot(np.arange(1, len(errors) + 1), errors[:, axis], ".-", color=BLUE, markersize=3, linewidth=0.7)
            panel.set_ylabel(f"$\\delta_{AXIS_NAMES[axis]}$ (mm)")
        panels[-1].set_xlabel("identification position")
    return figure


def modelling_performance(errors: Array, predictions: Mapping[str, Array], axis: int = 1) -> Figure:
    """Fig. 4: what each model makes of the identification errors along one axis.

    Args:
        errors: (N, 3) mm.
        predictions: by model, (N, 3) mm.
        axis: 0, 1, 2 for x, y, z; the paper shows y.
    """
    with styled():
        figure, panels = plt.subplots(2, 2, figsize=(9, 5), sharex=True, sharey=True)
        points = np.arange(1, len(errors) + 1)
        for panel, (model, predicted) in zip(panels.T.flat, predictions.items(), strict=True):
            panel.plot(points, errors[:, axis], color=BLACK, linewidth=0.8, label="measured")
            panel.plot(points, predicted[:, axis], color=VERMILION, linestyle="--", linewidth=1.0, label="predicted")
            rest = np.sqrt(np.mean((errors[:, axis] - predicted[:, axis]) ** 2))
            panel.set_title(f"{model}: {rest:.2f} mm RMS left")
        for panel in panels[:, 0]:
            panel.set_ylabel(f"$\\delta_{AXIS_NAMES[axis]}$ (mm)")
        for panel in panels[-1]:
            panel.set_xlabel("identification position")
        legend_above(figure)
    return figure


def trajectory(positions: Array, motor_angles: Array) -> Figure:
    """Figs. 5, 8, 9: a path in space (left) and the motor angles that follow it (right).

    Args:
        positions: (N, 3) nominal tool points in the base frame, mm.
        motor_angles: (N, m) rad.
    """
    with styled():
        figure = plt.figure(figsize=(10, 4.4))
        grid = figure.add_gridspec(1, 2, width_ratios=(1.1, 1))
        space = figure.add_subplot(grid[0], projection="3d")
        space.plot(*positions.T, color=BLUE)
        space.scatter(*positions[0], color=VERMILION, s=25, label="start", depthshade=False)
        space.set_xlabel("x (mm)", labelpad=6)
        space.set_ylabel("y (mm)", labelpad=6)
        space.set_zlabel("z (mm)", labelpad=2)
        space.set_box_aspect((4, 4, 3), zoom=0.95)
        space.locator_params(nbins=5)
        space.legend(loc="upper left")
        joints = figure.add_subplot(grid[1])
        styles = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)))
        for motor in range(motor_angles.shape[1]):
            joints.plot(
                np.arange(1, len(motor_angles) + 1), motor_angles[:, motor],
                linestyle=styles[motor % len(styles)], label=f"$\\theta_{motor + 1}$",
            )  # fmt: skip
        joints.set(xlabel="target point", ylabel="motor angle (rad)")
        joints.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def estimation_performance(errors: Array, predictions: Mapping[str, Array], bands: Mapping[str, Array]) -> Figure:
    """Figs. 6, 7, 10, 11: true and estimated errors along a trajectory; first degree left, second right.

    Args:
        errors: (N, 3) mm.
        predictions: by model (two of them), (N, 3) median over the seeds, mm.
        bands: by model, (2, N, 3) smallest and largest over the seeds, mm.
    """
    with styled():
        figure, panels = plt.subplots(3, len(predictions), figsize=(9, 6.5), sharex=True, sharey="row", squeeze=False)
        points = np.arange(1, len(errors) + 1)
        for column, (model, predicted) in enumerate(predictions.items()):
            for axis in range(3):
                panel: Axes = panels[axis, column]
                panel.plot(points, errors[:, axis], color=BLACK, label="true error")
                low, high = bands[model][:, :, axis]
                panel.fill_between(
                    points, low, high, color=VERMILION, alpha=0.25, linewidth=0, label="range over seeds"
                )
                panel.plot(points, predicted[:, axis], color=VERMILION, linestyle="--", label="estimated error")
                panel.axhline(0, color=GREY, linewidth=0.6)
                if column == 0:
                    panel.set_ylabel(f"$\\delta_{AXIS_NAMES[axis]}$ (mm)")
            panels[0, column].set_title(model)
            panels[-1, column].set_xlabel("target point")
        legend_above(figure)
    return figure


def convergence(history: pd.DataFrame) -> Figure:
    """Which velocity update reaches the least-squares optimum, and when.

    Args:
        history: columns rule, model, iteration, and the excess of the best fitness over the least-squares optimum in
            percent: median, low, high (over seeds and axes).
    """
    colours = {"constriction": BLUE, "inertia": GREEN, "constriction, ring": SKY, "original": VERMILION,
               "original, clamped": ORANGE, "random search": BLACK}  # fmt: skip
    dashes = {"random search": ":", "original, clamped": "--"}
    models = list(dict.fromkeys(history["model"]))
    with styled():
        columns = min(3, len(models))
        rows = -(-len(models) // columns)
        figure, panels = plt.subplots(
            rows, columns, figsize=(3.2 * columns, 2.7 * rows + 0.5), sharex=True, sharey=True, squeeze=False
        )
        for panel in panels.flat[len(models) :]:
            panel.set_visible(False)
        for panel, model in zip(panels.flat, models, strict=False):
            for rule, rows_of_rule in history[history["model"] == model].groupby("rule", sort=False):
                colour = colours[str(rule)]
                iteration = rows_of_rule["iteration"]
                panel.fill_between(
                    iteration, rows_of_rule["low"], rows_of_rule["high"], color=colour, alpha=0.15, linewidth=0
                )
                panel.plot(iteration, rows_of_rule["median"], dashes.get(str(rule), "-"), color=colour, label=str(rule))
            panel.set(title=model, yscale="log")
            panel.axhline(1, color=BLACK, linewidth=0.6, linestyle=":")
        figure.supxlabel("iteration")
        figure.supylabel("excess over least squares (%)")
        legend_above(figure)
    return figure
