"""The page of the reproduction: what the paper claims, what holds, and what is assumed."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from markupsafe import Markup
from numpy.typing import NDArray

from armscope.compensation.closed_loop import NO_MODEL
from armscope.core.config import Paper, stated_numbers
from armscope.core.files import read_table
from armscope.paper.convergence import iterations_needed
from armscope.paper.measurements import ERROR_COLUMNS, pose_arrays
from armscope.paper.printed import AXES, IDENTIFICATION, TRAJECTORIES, UNCOMPENSATED
from armscope.report.figures.error_field import ErrorField, turnable
from armscope.report.html import significant, write_page
from armscope.robot import Arm

TAGS = {"holds": "holds", "does not hold": "fails", "depends": "depends"}


@dataclass(frozen=True)
class Row:
    """One line of the rendered Table 2."""

    label: str
    cells: tuple[str, ...]
    kind: str


@dataclass(frozen=True)
class RealArm:
    """A real arm in the report: the folder of its study, or why it was skipped."""

    title: str
    folder: Path | None
    reason: str | None

    @property
    def figure(self) -> Path:
        """The plot like Fig. 4."""
        assert self.folder is not None
        return self.folder / "figures" / "fig04.svg"

    @property
    def table(self) -> pd.DataFrame:
        """In the form of Table 2: one row per model, RMS (mean) per axis and 3D in mm, identification and held out."""
        assert self.folder is not None
        table = read_table(self.folder / "table2.csv")
        wide = table.pivot_table(index="model", columns=["trajectory", "axis"], values="rms_median", sort=False)
        trajectories, axes = (wide.columns.get_level_values(level) for level in (0, 1))
        short = {"identification": "fitted"}
        names = [f"{short.get(name, name)} {axis}" for name, axis in zip(trajectories, axes, strict=True)]
        return wide.set_axis(names, axis=1).reset_index().rename(columns={"model": "RMS error in mm"})

    @property
    def rows(self) -> dict[str, int]:
        """How many rows were fitted ("identification") and held out."""
        assert self.folder is not None
        points = read_table(self.folder / "table2.csv").groupby("trajectory")["points"].first()
        return {str(name): int(count) for name, count in points.items()}


def table2_blocks(table: pd.DataFrame, reading: str = "rss") -> list[tuple[str, list[Row]]]:
    """The rendered Table 2: by model, one line per quantity, one cell per trajectory and axis.

    Args:
        table: as `armscope.paper.table2` returns it.
        reading: of "RMS": "rss" (root of the sum of squares) or "rms" (of their mean), mm.
    """
    cells = table[table["axis"].isin(AXES)].set_index(["model", "trajectory", "axis"])
    columns = pd.MultiIndex.from_product([TRAJECTORIES, AXES])
    blocks = []
    for model in dict.fromkeys(table["model"]):
        of_model = cells.loc[model].reindex(columns).to_dict("records")
        rows = [
            Row("printed", _numbers(of_model, "printed"), "printed"),
            Row("ours, median over seeds", _numbers(of_model, f"{reading}_median"), "ours"),
        ]
        if model != UNCOMPENSATED:
            rows.append(Row("range over seeds", _ranges(of_model, f"{reading}_low", f"{reading}_high"), "quiet"))
            rows.append(Row("least squares", _numbers(of_model, f"{reading}_least_squares"), "quiet"))
        rows.append(
            Row("ensemble, 5-95 %", _ranges(of_model, f"{reading}_ensemble_low", f"{reading}_ensemble_high"), "quiet")
        )
        rows.append(Row("ours / printed", _numbers(of_model, f"{reading}_ratio", "×"), "ratio"))
        blocks.append((model, [row for row in rows if set(row.cells) != {"–"}]))
    return blocks


def _numbers(cells: list[Any], column: str, sign: str = "") -> tuple[str, ...]:
    return tuple("–" if pd.isna(cell[column]) else f"{sign}{significant(cell[column], 2)}" for cell in cells)


def _ranges(cells: list[Any], low: str, high: str) -> tuple[str, ...]:
    pairs = [
        ("–", "–") if pd.isna(cell[low]) else (significant(cell[low], 2), significant(cell[high], 2)) for cell in cells
    ]
    return tuple(first if first == second else f"{first}–{second}" for first, second in pairs)


def _claimed(claim: dict[str, Any]) -> str:
    """A claim's number with its range over the robots; what is nothing in practice is not spelled out."""
    unit = "" if pd.isna(claim["unit"]) else f" {claim['unit']}"
    if unit == " %" and abs(claim["number_high"]) < 0.01:
        return "under 0.01 %"
    number, low, high = (significant(claim[name]) for name in ("number", "number_low", "number_high"))
    return f"{number}{unit} ({low}–{high})"


def _needed(history: pd.DataFrame) -> pd.DataFrame:
    """By model and rule, the iterations after which 90 % of the swarms are within 1 % of least squares."""
    table = iterations_needed(history)
    far = "never; " + table["final_excess_percent"].map(lambda excess: significant(excess, 2)) + " % above"
    table["shown"] = table["iterations"].astype("Int64").astype("string").fillna(far)
    wide = table.pivot_table(index="model", columns="rule", values="shown", aggfunc="first", sort=False)
    return wide.rename_axis(columns=None).reset_index()


def write_table2(path: Path, table: pd.DataFrame) -> None:
    """Table 2 as a page of its own."""
    write_page(path, "table2.html.j2", blocks=table2_blocks(table), trajectories=TRAJECTORIES)


def error_field(arm: Arm, poses: pd.DataFrame, left_over: pd.DataFrame) -> Markup:
    """The errors of the first robot before and after, to be turned.

    Args:
        arm: the nominal arm.
        poses: see `armscope.paper.measurements.pose_table`.
        left_over: see `armscope.compensation.closed_loop.remaining_errors`.
    """
    left_over = left_over.assign(stage=left_over["stage"].replace("fit", "prediction"))
    vectors = left_over.set_index(["model", "stage", "trajectory", "point"])[ERROR_COLUMNS]
    rows = list(zip(poses["trajectory"], poses["point"], strict=True))

    def errors(model: str, stage: str) -> NDArray[np.float64]:
        keys = [(model, stage, trajectory, point) for trajectory, point in rows]
        return vectors.reindex(keys).to_numpy(dtype=np.float64)

    before = errors(NO_MODEL, "prediction")
    angles, nominal_mm = pose_arrays(poses)
    shown = ErrorField(
        points_mm=nominal_mm,
        motor_angles=angles,
        ids=poses["point"].astype(str).tolist(),
        groups=poses["trajectory"].tolist(),
        group_word="trajectory",
        row_word="point",
        stages=(
            ("before", "measured minus nominal"),
            ("after prediction", "measured minus predicted"),
            ("compensated", "where the arm really goes under the corrected commands, minus where it should"),
        ),
        errors_mm={
            model: (before, errors(model, "prediction"), errors(model, "closed loop"))
            for model in dict.fromkeys(left_over["model"])
            if model != NO_MODEL
        },
        missing="only the test paths were compensated, and a command may be refused",
        paths=[name for name in dict.fromkeys(poses["trajectory"]) if name != IDENTIFICATION],
    )
    return turnable(arm, shown)


@dataclass(frozen=True)
class Outlook:
    """What goes beyond the paper's models: the folder with the closed loop, sub-volumes and products."""

    folder: Path

    @property
    def virtual(self) -> pd.DataFrame:
        """3D RMS in mm by model, per trajectory and stage, of the virtual arm."""
        table = self._spatial
        wide = table[table["arm"] == "virtual"].pivot_table(
            index="model", columns=["trajectory", "stage"], values="rms_mm", sort=False
        )
        names = {"identification": "", "prediction": "predicted"}
        levels = (wide.columns.get_level_values(level) for level in (0, 1))
        columns = [
            f"{names.get(path, path)} {names.get(stage, stage)}".strip() for path, stage in zip(*levels, strict=True)
        ]
        return wide.set_axis(columns, axis=1).reset_index().rename(columns={"model": "3D RMS error in mm"})

    @property
    def real(self) -> pd.DataFrame:
        """3D RMS in mm by model, held-out rows of every real arm."""
        table = self._spatial
        held_out = table[(table["arm"] != "virtual") & (table["stage"] == "prediction")]
        wide = held_out.pivot_table(index="model", columns="arm", values="rms_mm", sort=False)
        wide.columns = [str(name).partition(" (")[0] for name in wide.columns]
        return wide.reset_index().rename(columns={"model": "held out, 3D RMS in mm"})

    @property
    def full_pose(self) -> pd.DataFrame:
        """Position (mm) and orientation (mrad) by model: fit, and closed loop on every trajectory."""
        table = read_table(self.folder / "full_pose.csv")
        kept = table[table["stage"] != "prediction"].rename(columns={"rms_mm": "mm", "rms_mrad": "mrad"})
        wide = kept.pivot_table(index="model", columns="trajectory", values=["mm", "mrad"], sort=False)
        paths = list(dict.fromkeys(kept["trajectory"]))
        wide = wide[[(unit, path) for path in paths for unit in ("mm", "mrad")]]
        short = {"identification": "fit"}
        levels = (wide.columns.get_level_values(level) for level in (0, 1))
        columns = [f"{short.get(path, path)} ({unit})" for unit, path in zip(*levels, strict=True)]
        return wide.set_axis(columns, axis=1).reset_index()

    @property
    def products(self) -> pd.DataFrame:
        """Sums against products."""
        return read_table(self.folder / "products.csv")

    @property
    def _spatial(self) -> pd.DataFrame:
        table = read_table(self.folder / "cross_table.csv")
        return table[table["axis"] == "3D"]


def write_paper_page(
    path: Path,
    paper: Paper,
    seed: int,
    results: Path,
    proof: Path,
    real: list[RealArm],
    field: Markup,
    outlook: Outlook,
) -> None:
    """The report of the reproduction.

    Args:
        path: report.html.
        paper: the configuration of the study.
        seed: of the study.
        results: the folder with its tables and figures (SVG).
        proof: the folder of the small proof of the diagnosis.
        real: real arms.
        field: see `error_field`.
        outlook: corrected commands, sub-volumes, products.
    """
    table = read_table(results / "table2.csv")
    claims = read_table(results / "claims.csv")
    audit = read_table(results / "audit.csv")
    write_page(
        path,
        "paper.html.j2",
        seed=seed,
        swarm=paper.swarm,
        robots=paper.ensemble.robots,
        poses=paper.identification.poses.value,
        claims=claims.to_dict("records"),
        tags=TAGS,
        verdicts=claims["verdict"].value_counts().to_dict(),
        significant=significant,
        claimed=_claimed,
        points=table.groupby("trajectory")["points"].first().to_dict(),
        blocks=table2_blocks(table),
        trajectories=TRAJECTORIES,
        coefficients=read_table(results / "coefficients.csv").astype({"equation": "Int64"}),
        needed=_needed(read_table(results / "convergence.csv")),
        audit=audit,
        audited=audit[audit["check"] == "all together"],
        untold=read_table(results / "cross_check.csv"),
        reading=read_table(results / "reading.csv"),
        observability=read_table(results / "observability.csv"),
        anchored=read_table(results / "robots.csv"),
        assumptions=pd.DataFrame(stated_numbers(paper)),
        figures=results / "figures",
        field=field,
        proof=proof / "figures" / "aims.svg",
        proof_page=os.path.relpath(proof / "report.html", path.parent),
        real=real,
        outlook=outlook,
    )
