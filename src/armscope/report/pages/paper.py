"""The page of the reproduction: what was claimed, what holds by which method and under which assumptions."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from markupsafe import Markup

from armscope.core.config import Paper
from armscope.core.files import read_table
from armscope.paper.printed import PRINTED_MODELS, TRAJECTORIES
from armscope.report.html import significant, write_page
from armscope.report.pages import paper_tables as shown
from armscope.report.pages.paper_claims import claim_rows, first_screen, sensitivity_table
from armscope.report.text.audit import ROMAN, audit_sentence, contradictions


def _heads(wide: pd.DataFrame) -> Iterator[tuple[str, str]]:
    """Both levels of every column's head."""
    return zip(*(wide.columns.get_level_values(level) for level in (0, 1)), strict=True)


@dataclass(frozen=True)
class ReproducedArm:
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
        names = [f"{'fitted' if name == 'identification' else name} {axis}" for name, axis in _heads(wide)]
        return wide.set_axis(names, axis=1).reset_index().rename(columns={"model": "RMS error in mm"})

    @property
    def rows(self) -> dict[str, int]:
        """How many rows were fitted ("identification") and held out."""
        assert self.folder is not None
        points = read_table(self.folder / "table2.csv").groupby("trajectory")["points"].first()
        return {str(name): int(count) for name, count in points.items()}


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
        columns = [f"{names.get(path, path)} {names.get(stage, stage)}".strip() for path, stage in _heads(wide)]
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
        columns = [f"{'fit' if path == 'identification' else path} ({unit})" for unit, path in _heads(wide)]
        return wide.set_axis(columns, axis=1).reset_index()

    @property
    def products(self) -> pd.DataFrame:
        """Sums against products: 3D RMS error in mm."""
        table = read_table(self.folder / "products.csv")
        names = {
            "kind": "terms are", "terms": "terms chosen", "fit_rms_mm": "fitted", "held_out_rms_mm": "held-out folds",
            "stderr_mm": "their standard error",
        }  # fmt: skip
        return table.rename(columns=names)

    @property
    def _spatial(self) -> pd.DataFrame:
        table = read_table(self.folder / "cross_table.csv")
        return table[table["axis"] == "3D"]


FIGURES_OF_INPUT = {"cartesian": ("Figs. 6 and 10", "fig06"), "angular": ("Figs. 7 and 11", "fig07")}


def write_table2(path: Path, table: pd.DataFrame, audit: pd.DataFrame) -> None:
    """Table 2 as a page of its own.

    Args:
        path: of the page.
        table: the rendered Table 2.
        audit: what contradicts itself in the printed one.
    """
    marks = contradictions(audit)
    blocks = shown.table2_blocks(table, marks)
    write_page(path, "table2.html.j2", blocks=blocks, trajectories=TRAJECTORIES, marks=marks, romans=ROMAN)


@dataclass(frozen=True, eq=False)
class PaperPage:
    """What the page is made of."""

    paper: Paper  # the configuration of the study
    seed: int
    results: Path  # the folder with its tables and figures (SVG)
    proof: Path  # the folder of the small proof of the diagnosis
    real: list[ReproducedArm]
    field: Markup  # see `armscope.report.pages.paper_field.error_field`
    outlook: Outlook  # corrected commands, sub-volumes, products

    def write(self, path: Path) -> None:
        """Render the page to ``path``."""
        names = ("table2", "claims", "audit", "why", "sensitivity", "method", "method_claims", "coefficients")
        tables = {name: read_table(self.results / f"{name}.csv") for name in names}
        write_page(
            path,
            "paper.html.j2",
            **self._study(),
            **_judged(tables),
            **_printed(tables),
            **self._checked(),
            figures=self.results / "figures",
            skipped=self._skipped(),
            field=self.field,
            proof=self.proof / "figures" / "aims.svg",
            proof_page=os.path.relpath(self.proof / "report.html", path.parent),
            real=[arm for arm in self.real if arm.folder is not None],
            missing=[arm.title for arm in self.real if arm.folder is None],
            outlook=self.outlook,
        )

    def _study(self) -> dict[str, object]:
        paper = self.paper
        return {
            "seed": self.seed,
            "swarm": paper.swarm,
            "robots": paper.ensemble.robots,
            "ensemble_seeds": paper.ensemble.seeds,
            "method_robots": paper.method.robots,
            "sensitivity_robots": paper.sensitivity.robots,
            "poses": paper.identification.poses.value,
            "assumptions": shown.assumption_rows(paper),
            "significant": significant,
        }

    def _checked(self) -> dict[str, object]:
        """Tables that stand by themselves."""
        reading = read_table(self.results / "reading.csv")
        untold = read_table(self.results / "cross_check.csv")
        observability = read_table(self.results / "observability.csv")
        enough = read_table(self.results / "enough_poses.csv")
        groups = enough.groupby("poses")["rms_mm"]
        by_count = pd.concat([groups.quantile(share) for share in (0.05, 0.5, 0.95)], axis=1).reset_index()
        return {
            "needed": shown.needed(read_table(self.results / "convergence.csv")),
            "untold": shown.untold_rows(untold),
            "untold_inside": int(untold["inside"].sum()),
            "reading": reading,
            "reading_values": reading.set_index("quantity")["value"].to_dict(),
            "observability": observability.rename(columns=lambda name: name.replace("_", " ")),
            "anchored": shown.robot_rows(read_table(self.results / "robots.csv")),
            "enough": by_count.set_axis(["poses", "5 % of the robots", "median", "95 %"], axis=1),
        }

    def _skipped(self) -> list[str]:
        """Figures of the paper whose models are not configured."""
        spaces = {model.space for model in self.paper.models}
        return [
            f"{words} need a model of {'Cartesian' if space == 'cartesian' else 'angular'} input; none is configured."
            for space, (words, _) in FIGURES_OF_INPUT.items()
            if space not in spaces
        ]


def _judged(tables: dict[str, pd.DataFrame]) -> dict[str, object]:
    """Claims, method and sensitivity."""
    claims = tables["claims"]
    shares, scenarios = sensitivity_table(claims, tables["sensitivity"])
    return {
        "groups": claim_rows(claims, tables["why"]),
        "first": first_screen(claims),
        "shares": shares,
        "scenarios": scenarios,
        "method": shown.method_rows(tables["method"]),
        "method_claims": shown.method_claim_rows(tables["method_claims"]),
    }


def _printed(tables: dict[str, pd.DataFrame]) -> dict[str, object]:
    """Table 2, the audit and the coefficients."""
    table, audit, coefficients = tables["table2"], tables["audit"], tables["coefficients"]
    marks = contradictions(audit)
    large = coefficients[~coefficients["model"].isin(PRINTED_MODELS)].groupby("model", sort=False).size()
    return {
        "points": table.groupby("trajectory")["points"].first().to_dict(),
        "blocks": shown.table2_blocks(table, marks),
        "trajectories": TRAJECTORIES,
        "marks": marks,
        "romans": ROMAN,
        "audit_sentence": audit_sentence(audit),
        "audited": shown.audit_rows(audit[audit["check"] == "all together"]).drop(columns=["axis", "check"]),
        "audit": shown.audit_rows(audit),
        "rank": shown.anchored_rank(table),
        "coefficients": {
            str(model): shown.coefficient_rows(rows) for model, rows in coefficients.groupby("model", sort=False)
        },
        "large": {str(model): int(count) for model, count in large.items()},
    }
