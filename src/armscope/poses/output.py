"""A choice of poses as files: poses.csv to measure (columns of the recordings contract), poses.json to judge it by."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.files import write_json, write_table
from armscope.core.streams import is_stream
from armscope.design.indices import SOURCES
from armscope.physics.effect import Driver
from armscope.poses.choose import Choice
from armscope.poses.compare import RIVALS, predicted_errors, share_won, summary
from armscope.poses.constants import BODY
from armscope.poses.obstacles import body_in_words, thinned
from armscope.recordings.columns import angle_columns

UNITS = (
    "of O1 to O5: each parameter is counted in a unit that moves the tool by 1 mm RMS over the candidates, tool points "
    "in m; under parameters each has the unit that stands beside it"
)
FOLLOW_APPROACH = {"approach", "lost motion"}


def poses_table(choice: Choice) -> pd.DataFrame:
    """The poses in the order to measure: id, q1_rad, ..., and the context that the effects follow."""
    table = choice.table
    columns: dict[str, Any] = {"id": table.id}
    columns |= angle_columns(table.motor_angles)
    if table.payload is not None:
        columns["payload_kg"] = table.payload
    if table.approach is not None and _follows_approach(choice):
        columns |= {f"approach{motor}": sides for motor, sides in enumerate(table.approach.T, start=1)}
    return pd.DataFrame(columns)


def write_choice(path: Path, choice: Choice, compared: pd.DataFrame | None, noise: float, noise_source: str) -> None:
    """Write poses.csv, and poses.json beside it (a pipe gets the table alone).

    Args:
        path: of the table.
        choice: the poses.
        compared: see `compare`; None leaves the comparison out.
        noise: 1-sigma per axis, m, and where it comes from.
        noise_source: "stated" or "assumed".
    """
    write_table(path, poses_table(choice))
    if not is_stream(path):
        write_json(path.with_suffix(".json"), _content(choice, compared, noise, noise_source))


def _content(choice: Choice, compared: pd.DataFrame | None, noise: float, noise_source: str) -> dict[str, Any]:
    targets, pool, around = choice.targets, choice.candidates, choice.around
    stated = np.isfinite(targets.arm.limits).all(axis=1)
    content: dict[str, Any] = {
        "robot": targets.arm.name,
        "poses": len(choice.rows),
        "criterion": choice.index,
        "criterion_is": SOURCES[choice.index],
        "effects": list(choice.effects),
        "indices": {name: {"value": value, "source": SOURCES[name]} for name, value in choice.indices.items()},
        "units_of_parameters": UNITS,
        "parameters": predicted_errors(choice, noise, {"chosen": choice.table}).to_dict("records"),
        "noise_mm": noise * 1e3,
        "noise_is": noise_source,
        "not_told_apart": list(targets.hidden),
        "candidates": {"possible": len(pool), "drawn": pool.drawn, "refused": dict(pool.refused)},
        "assumed": {
            "body": body_in_words(targets.arm, around),
            "checked_less": list(thinned(targets.arm, around)),
            "not_checked": "links that share a joint",
            "floor_mm": None if around.floor is None else around.floor * 1e3,
            "tracker_mm": None if around.tracker is None else (around.tracker * 1e3).tolist(),
            "motors_without_limits": [
                f"q{j + 1}: +-{np.degrees(BODY.unstated_rad):g} deg" for j in np.flatnonzero(~stated)
            ],
        },
    }
    if compared is not None:
        content["compared"] = {
            "seeds": int(compared["seed"].nunique()),
            "medians": summary(compared),
            "share_of_seeds_in_which_chosen_is_better": {
                f"{column} than {other}": share_won(compared, column, other)
                for column in ("parameter_rms_mm", "held_out_rms_mm")
                for other in RIVALS
            },
        }
    return content


def _follows_approach(choice: Choice) -> bool:
    def follows(driver: Driver) -> bool:
        nested = any(follows(each) for each in driver.arguments if isinstance(each, Driver))
        return driver.kind in FOLLOW_APPROACH or nested

    return any(follows(product.driver) for _, term in choice.targets.terms for product in term.products)
