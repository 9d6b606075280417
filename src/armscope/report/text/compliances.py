"""What runs of one arm say of its compliances, in words and a table: which agree, and in what others do not."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from armscope.core.words import table_lines
from armscope.real.compliance_tables import half_width
from armscope.real.constants import COMPLIANCE

WAVE, PRIOR = COMPLIANCE.wave_rad, COMPLIANCE.prior_rad_nm
INTRODUCTION = f"""\
Do the runs say the same of how this arm gives way? Each run by itself was fitted with one and the same model: base and
tool free, every D-H value within tolerance, low waves of every angle and axis ({1e3 * WAVE:g} mrad), and the compliance
of every drive (under gravity's torque as recorded) and every bearing (under gravity's moment) with one wide prior
({1e6 * PRIOR:g} µrad/(N m)). Intervals (95 %) own up to the model's error by a jackknife over blocks of rows."""


def compliance_lines(folder: Path, title: str, picture: str) -> str:
    """Paragraphs and a table from compliances*.csv in a folder of results; nothing where there are none.

    Args:
        folder: of results.
        title: of the section.
        picture: path of the figure.

    Returns:
        Markdown.
    """
    if not (folder / "compliances.csv").exists():
        return ""
    values, pairs, simulated = (
        pd.read_csv(folder / f"{name}.csv") for name in ("compliances", "compliances_agree", "compliances_simulated")
    )
    parts = [
        INTRODUCTION,
        *(_told(str(learned), rows, pairs) for learned, rows in values.groupby("learned", sort=False)),
    ]
    return "\n\n".join(
        [*parts, _table(pairs), _simulated_comparison(simulated), f"![{title}: compliances run by run]({picture})"]
    )


def _told(learned: str, values: pd.DataFrame, pairs: pd.DataFrame) -> str:
    """Two sentences: what the runs tell best, each joint alone, and how many pairs of runs agree."""
    together = values["of"].iloc[-1]
    best = "; ".join(f"{row['run']} {_interval(row)}" for row in values[values["of"] == together].to_dict("records"))
    alone = values[values["reference"].notna()]
    joints = ", ".join(
        f"{row['of']} {_interval(row)} (others: {row['reference']:g})" for row in alone.to_dict("records")
    )
    mine = pairs[pairs["learned"] == learned].drop_duplicates(["one", "other"])
    apart = mine[mine["probability"] < COMPLIANCE.agrees]
    verdict = f"All {len(mine)} pairs of runs agree within their intervals"
    if len(apart):
        names = "; ".join(f"{row['one']} and {row['other']}" for row in apart.to_dict("records"))
        verdict = f"{len(mine) - len(apart)} of {len(mine)} pairs of runs agree, **these do not: {names}**"
    return (
        f"*From {learned}*, in µrad/(N m): drives on {alone['run'].iloc[0]}: {joints}. What the runs determine best is "
        f"{together}: {best}. {verdict} (at {100 * COMPLIANCE.agrees:g} %)."
    )


def _interval(row: Mapping[Hashable, Any]) -> str:
    return f"{row['value']:.0f} ± {half_width(row['stderr']):.0f}"


def _table(pairs: pd.DataFrame) -> str:
    """One line per pair of runs: probability of so large a difference, and where it is largest."""
    head = ("learned from", "runs", "combinations both determine", "probability", "the largest difference, µrad/(N m)")
    lines = []
    for _, rows in pairs.groupby(["learned", "one", "other"], sort=False):
        row = max(rows.to_dict("records"), key=lambda row: abs(row["difference"] / row["stderr"]))
        chance = row["probability"]
        told = f"{chance:.2f}" if chance >= 0.01 else f"**{chance:.0e}**"
        apart = f"{row['difference']:.0f} ± {half_width(row['stderr']):.0f}"
        largest = f"{row['of']}: {row['one_value']:.0f} and {row['other_value']:.0f}, apart by {apart}"
        lines.append((row["learned"], f"{row['one']}, {row['other']}", row["directions"], told, largest))
    return "\n".join(table_lines(head, lines))


def _simulated_comparison(simulated: pd.DataFrame) -> str:
    """The same procedure on simulated arms."""
    told = []
    for learned, rows in simulated.groupby("learned", sort=False):
        kinds = ", ".join(f"{row['agree']} of {row['arms']} on {row['arm']}" for row in rows.to_dict("records"))
        share = 100 * rows["held"].sum() / rows["numbers"].sum()
        told.append(f"{learned}: {kinds} agree, {share:.0f} % of the drives' intervals hold the truth")
    runs = f"{simulated['one'].iloc[0]} and {simulated['other'].iloc[0]}"
    return (
        f"The same on simulated arms, wrong in more ways than the model knows, at the angles and torques of {runs}: "
        f"{'; '.join(told)}. (Their instruments err by chance, not with the view.)"
    )
