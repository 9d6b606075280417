"""How well regions that took no part are foretold, as a table in words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from armscope.core.words import table_lines
from armscope.real.protocol import ARMSCOPE
from armscope.report.html import significant

INTRODUCTION = """\
Whole regions left out, 30 % of the configurations each, where a random split leaves neighbours in: RMS of the 3D
distance there, its median in brackets (single bad shots move the RMS of few rows, not the median); bold is the lowest
RMS. Points alone, as above."""
PLUS = {"compliance": "+ compliance"}
"""What a level is called at the head of a column: it comes on top of the one before it."""


def region_lines(folder: Path) -> str:
    """A paragraph and a table from regions.csv in a folder of results; nothing where there is none."""
    if not (folder / "regions.csv").exists():
        return ""
    table = pd.read_csv(folder / "regions.csv")
    models = list(dict.fromkeys(table["model"]))
    rows = []
    for (run, region, test), group in table.groupby(["run", "region", "test"], sort=False):
        of = group.set_index("model")
        lowest = of["rms_mm"].min()
        cells = [_cell(of.loc[model], lowest) if model in of.index else "–" for model in models]
        rows.append((str(run), f"{region} ({test} rows)", *cells))
    head = ["run", "left out", *(PLUS.get(model, model) for model in models)]
    return "\n".join([INTRODUCTION, "", *table_lines(head, rows)])


def _cell(found: pd.Series, lowest: float) -> str:
    told = significant(found["rms_mm"])
    return f"{f'**{told}**' if found['rms_mm'] <= lowest else told} ({significant(found['median_mm'])})"


def regions_won(folders: list[Path]) -> str:
    """One sentence over all arms: in how many of the regions no plain calibration foretells better; "" without any."""
    found = [pd.read_csv(folder / "regions.csv") for folder in folders if (folder / "regions.csv").exists()]
    if not found:
        return ""
    ratios = []
    for table in found:
        by_model = table.pivot(index=["run", "region"], columns="model", values="rms_mm")
        ratios += (by_model[ARMSCOPE] / by_model.drop(columns=ARMSCOPE).min(axis=1)).tolist()
    won = int(np.sum(np.array(ratios) <= 1))
    return (
        f"Where whole regions are left out (the last rows, the farthest, the highest, one side), armscope foretells "
        f"{won} of {len(ratios)} at least as well as the best plain calibration does; its error there is "
        f"{significant(float(np.median(ratios)))} times that one's (median; at worst {significant(max(ratios))})."
    )
