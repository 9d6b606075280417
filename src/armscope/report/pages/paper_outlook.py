"""What goes beyond the paper's virtual study: its models on real arms, and its outlook carried out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from armscope.core.files import read_table


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
