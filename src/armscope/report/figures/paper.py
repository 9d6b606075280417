"""Figures 1-11 of the paper in its arrangement, for whichever models are configured."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.bands import TRUE, band_of
from armscope.paper.measurements import Measurements
from armscope.paper.printed import PRINTED_MODELS
from armscope.report.figures.paper_arm import arm_with_frames, measuring_setup
from armscope.report.style import AXIS_NAMES, BLACK, BLUE, GREY, VERMILION, legend_above, panel_grid, styled
from armscope.robot import Arm


def _errors_of_positions(errors: Array, low: Array | None = None, high: Array | None = None) -> Figure:
    """Fig. 3: errors (N, 3) of the identification positions, mm, and the range of the drawn robots."""
    with styled():
        figure, panels = plt.subplots(3, 1, figsize=(7, 5), sharex=True)
        points = np.arange(1, len(errors) + 1)
        for axis, panel in enumerate(panels):
            panel.axhline(0, color=GREY, linewidth=0.6)
            if low is not None and high is not None:
                panel.vlines(
                    points, low[:, axis], high[:, axis], color=GREY, alpha=0.45, linewidth=2.5,
                    label="5–95 % of the drawn robots",
                )  # fmt: skip
            panel.plot(points, errors[:, axis], ".", color=BLUE, markersize=4, label="anchored robot")
            panel.set_ylabel(f"$\\delta_{AXIS_NAMES[axis]}$ (mm)")
        panels[-1].set_xlabel("identification position")
        if low is not None:
            legend_above(figure)
    return figure


def _modelling_performance(errors: Array, predictions: Mapping[str, Array]) -> Figure:
    """Fig. 4: what each model makes of the identification errors (N, 3) along y, mm, as the paper shows it."""
    with styled():
        figure, panels = panel_grid(len(predictions), 2, (4.5, 2.2), sharex=True, sharey=True)
        points = np.arange(1, len(errors) + 1)
        for panel, (model, predicted) in zip(panels, predictions.items(), strict=True):
            panel.plot(points, errors[:, 1], color=BLACK, linewidth=0.8, label="measured")
            panel.plot(points, predicted[:, 1], color=VERMILION, linestyle="--", linewidth=1.0, label="predicted")
            rest = np.sqrt(np.mean((errors[:, 1] - predicted[:, 1]) ** 2))
            panel.set_title(f"{model}: {rest:.2f} mm RMS left")
            panel.set(xlabel="identification position", ylabel=f"$\\delta_{AXIS_NAMES[1]}$ (mm)")
            panel.label_outer()
        legend_above(figure)
    return figure


def trajectory(positions: Array, motor_angles: Array) -> Figure:
    """Figs. 5, 8, 9: a path in space (left) and the motor angles that follow it (right). ``positions``: (N, 3)
    nominal tool points in the base frame, mm; ``motor_angles``: (N, m) rad."""
    with styled():
        figure = plt.figure(figsize=(10, 4.4))
        grid = figure.add_gridspec(1, 2, width_ratios=(1.1, 1))
        space = figure.add_subplot(grid[0], projection="3d")
        space.plot(*positions.T, color=BLUE)
        space.scatter(*positions[0], color=VERMILION, s=25, label="start", depthshade=False)
        space.set_xlabel("x (mm)", labelpad=6)
        space.set_ylabel("y (mm)", labelpad=6)
        space.set_zlabel("z (mm)", labelpad=8)
        space.set_box_aspect((4, 4, 3), zoom=0.85)
        space.locator_params(nbins=5)
        space.legend(loc="upper left")
        joints = figure.add_subplot(grid[1])
        styles = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)))
        points = np.arange(1, len(motor_angles) + 1)
        for style, (label, angles) in zip(cycle(styles), _joined(motor_angles)):
            joints.plot(points, angles, linestyle=style, label=label)
        joints.set(xlabel="target point", ylabel="motor angle (rad)")
        joints.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _joined(motor_angles: Array) -> list[tuple[str, Array]]:
    """Label and (N,) angles of each motor; motors with the same angles throughout, such as theta4 = theta5, as one."""
    lines: list[tuple[str, Array]] = []
    for motor, angles in enumerate(motor_angles.T, start=1):
        name = f"$\\theta_{motor}$"
        same = next((k for k, (_, others) in enumerate(lines) if np.array_equal(others, angles)), None)
        if same is None:
            lines.append((name, angles))
        else:
            lines[same] = (f"{lines[same][0]} = {name}", angles)
    return lines


Band = tuple[Array, Array]  # (low, high), each (N, 3), mm


def _estimation_performance(
    errors: Array,
    predictions: Mapping[str, Array],
    true_band: Band | None = None,
    bands: Mapping[str, Band] | None = None,
) -> Figure:
    """True and estimated errors (N, 3), mm, along a trajectory: one row per axis, one column per model."""
    with styled():
        figure, panels = plt.subplots(
            3, len(predictions), figsize=(4.5 * len(predictions), 6.5), sharex=True, sharey="row", squeeze=False
        )
        points = np.arange(1.0, len(errors) + 1)
        for column, (model, predicted) in enumerate(predictions.items()):
            for axis in range(3):
                panel: Axes = panels[axis, column]
                if true_band is not None:
                    _shade(panel, points, true_band, axis, GREY, "true, 5–95 % of the drawn robots")
                if bands and model in bands:
                    _shade(panel, points, bands[model], axis, VERMILION, "estimated, 5–95 % of them")
                panel.plot(points, errors[:, axis], color=BLACK, label="true error")
                panel.plot(points, predicted[:, axis], color=VERMILION, linestyle="--", label="estimated error")
                panel.axhline(0, color=GREY, linewidth=0.6)
                if column == 0:
                    panel.set_ylabel(f"$\\delta_{AXIS_NAMES[axis]}$ (mm)")
            panels[0, column].set_title(model)
            panels[-1, column].set_xlabel("target point")
        labelled = [panel.get_legend_handles_labels() for panel in panels.flat]
        entries = {label: handle for handles, labels in labelled for handle, label in zip(handles, labels, strict=True)}
        legend_above(figure, entries.values())
    return figure


def _shade(panel: Axes, points: Array, band: Band, axis: int, colour: str, label: str) -> None:
    """A band, unless it is too thin to be seen: then it has no entry in the legend either."""
    low, high = band[0][:, axis], band[1][:, axis]
    name = label if np.max(high - low) > THINNEST_MM else None
    panel.fill_between(points, low, high, color=colour, alpha=0.28, linewidth=0, label=name)


THINNEST_MM = 0.02  # A band narrower than this everywhere is not seen


ARM_FIGURES = ("fig01", "fig02")
TEST_FIGURES = {"fig05": "test 1", "fig08": "test 2", "fig09": "test 3"}
ESTIMATION_FIGURES = {
    "fig06": ("test 1", "cartesian"),
    "fig07": ("test 1", "angular"),
    "fig10": ("test 2", "cartesian"),
    "fig11": ("test 2", "angular"),
}
FIGURES = ("fig01", "fig02", "fig03", "fig04", "fig05", "fig06", "fig07", "fig08", "fig09", "fig10", "fig11")
MOST_COLUMNS = 2  # So many models of one kind of input are drawn beside each other, as in the paper


@dataclass(frozen=True, eq=False)
class PaperResults:
    """What figures are drawn from."""

    measurements: Measurements  # of the study; its first robot is drawn
    fits: Sequence[SwarmFit]  # of that robot, one per model
    bands: pd.DataFrame  # ranges of the drawn robots (see `armscope.paper.bands`); empty for real arms
    arm: Arm | None = None  # the nominal arm, for Figs. 1 and 2
    tracker_mm: Array | None = None  # (3,) where it is measured from, for Fig. 2

    @property
    def by_model(self) -> dict[str, SwarmFit]:
        """The fits of the first robot."""
        return {fit.name: fit for fit in self.fits if fit.label == self.measurements.robots[0]}

    def band(self, trajectory: str, model: str) -> Band | None:
        """Range of the drawn robots' errors on a trajectory, true or estimated."""
        return band_of(self.bands, trajectory, model)


def draw(name: str, shown: PaperResults) -> Figure:
    """One of `FIGURES`. Raises ValueError: a figure whose models are not configured, or of an arm that is not given."""
    measurements, models = shown.measurements, shown.by_model
    if name in ARM_FIGURES:
        if shown.arm is None or shown.tracker_mm is None:
            raise ValueError(f"{name} needs the arm and the tracker's place")
        if name == "fig01":
            return arm_with_frames(shown.arm)
        return measuring_setup(shown.arm, measurements.identification, shown.tracker_mm)
    if name == "fig03":
        rows = measurements.identification
        return _errors_of_positions(rows.errors_mm[0], *(shown.band(rows.name, TRUE) or (None, None)))
    if name == "fig04":
        rows = measurements.identification
        return _modelling_performance(rows.errors_mm[0], _predictions(models, modelled(models), rows.inputs))
    if name in TEST_FIGURES:
        path = measurements[TEST_FIGURES[name]]
        return trajectory(path.nominal_mm, path.motor_angles)
    set_name, space = ESTIMATION_FIGURES[name]
    chosen = estimated(models, space)
    if not chosen:
        raise ValueError(f"{name} needs a model of {space} input, and none is configured")
    path = measurements[set_name]
    bands = {model: band for model in chosen if (band := shown.band(set_name, model)) is not None}
    return _estimation_performance(
        path.errors_mm[0], _predictions(models, chosen, path.inputs), shown.band(set_name, TRUE), bands
    )


def modelled(models: Mapping[str, SwarmFit]) -> list[str]:
    """The models of Fig. 4: the paper's four as far as they are there, else the first four."""
    return [name for name in PRINTED_MODELS if name in models] or list(models)[:4]


def estimated(models: Mapping[str, SwarmFit], space: str) -> list[str]:
    """The models of one kind of input that Figs. 6, 7, 10, 11 show: the first two."""
    return [name for name, fit in models.items() if fit.features.spec.space == space][:MOST_COLUMNS]


def _predictions(fits: Mapping[str, SwarmFit], models: Sequence[str], inputs: Callable[..., Array]) -> dict[str, Array]:
    """By model, the median of the seeds' predictions (N, 3), mm."""
    return {model: np.median(fits[model].predict_all(inputs(fits[model].features.spec)), axis=0) for model in models}
