"""Real recordings with something concealed in them: what may be seen in one tree, the truth sealed in an archive.

A batch is one arm's original (`original`), or it altered by every effect at every size (`fixed`, `fresh`: places drawn
from a seed that stays or one that nobody knows beforehand), or the original without columns (`withheld`). Folders'
names say nothing about what is inside.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from armscope.core.files import copy_file, write_table, write_yaml
from armscope.proof.making import TEST_POSES, sealing
from armscope.real.planting import CannotPlantError, NotPlanted, Planted, plant, truth_of
from armscope.real.prepared_recordings import PreparedRecordings
from armscope.real.simulated_effects import SimulatedEffects
from armscope.recordings.columns import AXES_MM, QUATERNION


@dataclass(frozen=True)
class Places:
    """The nominal robot.yaml, the folder for what may be seen, and the archive for the truth."""

    robot: Path
    visible: Path
    sealed: Path


LEFT_MM = ["left_x_mm", "left_y_mm", "left_z_mm"]
WITHHELD: dict[str, tuple[str, ...]] = {
    "all columns": (),
    "payload withheld": ("payload_kg",),
    "torques withheld": ("tau",),
    "payload and torques withheld": ("payload_kg", "tau"),
}


def _write_world(
    home: Path,
    places: Places,
    prepared: PreparedRecordings,
    table: pd.DataFrame,
    truth: dict[str, Any],
    planted: Planted | None = None,
) -> None:
    """One world: its visible files in the visible tree, its truth below ``home``."""
    visible = places.visible / home.name
    copy_file(places.robot, visible / "robot.yaml")
    write_table(visible / "recordings.csv", table.iloc[prepared.train])
    test = table.iloc[prepared.test]
    write_table(visible / TEST_POSES, test.drop(columns=[*AXES_MM, *QUATERNION], errors="ignore"))
    left = np.zeros((len(test), 3)) if planted is None else planted.left[prepared.test] * 1e3
    readings = pd.concat([test[AXES_MM].reset_index(drop=True), pd.DataFrame(left, columns=LEFT_MM)], axis=1)
    write_table(home / "sealed" / "test.csv", readings)
    write_yaml(home / "sealed" / "truth.yaml", truth)


def make_original(prepared: PreparedRecordings, places: Places) -> None:
    """The recordings as they are, with the columns that all altered ones have, too."""
    with sealing(places.visible, places.sealed) as made:
        _write_world(made / "original", places, prepared, prepared.table, {"kind": "original"})


def make_altered(
    prepared: PreparedRecordings,
    effects: Sequence[str],
    sizes: Sequence[float],
    level: float,
    seed: Sequence[int],
    places: Places,
) -> None:
    """Every effect at every size.

    Args:
        prepared: the arm's rows.
        effects: keys of the worlds' catalogue.
        sizes: RMS at the tool in multiples of the level.
        level: what the diagnosis of the original leaves, RMS per axis, m.
        seed: places and numbers follow from it.
        places: where everything goes.
    """
    simulated = SimulatedEffects(prepared)
    judge = simulated.judge()
    made: list[tuple[dict[str, Any], Planted]] = []
    skipped = []
    for number, name in enumerate(effects):
        rng = np.random.default_rng([*seed, number])
        try:
            for each in plant(simulated, judge, name, sizes, level, rng):
                if isinstance(each, NotPlanted):
                    skipped.append({"effect": name, "size": each.size, "reason": each.reason})
                else:
                    made.append((truth_of(simulated, each), each))
        except CannotPlantError as error:
            skipped += [{"effect": name, "size": size, "reason": str(error)} for size in sizes]
    with sealing(places.visible, places.sealed) as folder:
        order = np.random.default_rng([*seed, len(effects)]).permutation(len(made))
        for place, (truth, planted) in zip(order.tolist(), made, strict=True):
            content = {"kind": "altered", **truth, "level_mm": level * 1e3, "skipped": skipped}
            home = folder / f"world-{place:03d}"
            _write_world(home, places, prepared, moved_table(prepared, planted), content, planted)


def moved_table(prepared: PreparedRecordings, planted: Planted) -> pd.DataFrame:
    """The recordings with every measured point, and orientation, moved by what the effect does there."""
    points = prepared.table[AXES_MM].to_numpy(dtype=float) + planted.moved * 1e3
    table = prepared.table.assign(**{name: points[:, axis].round(5) for axis, name in enumerate(AXES_MM)})
    if not prepared.recordings.oriented.any():
        return table
    quaternions = prepared.recordings.quaternions.copy()
    known = np.isfinite(quaternions).all(axis=1)
    measured = Rotation.from_quat(quaternions[known], scalar_first=True)
    turned = Rotation.from_matrix(planted.turned[known]) * measured
    quaternions[known] = turned.as_quat(canonical=True, scalar_first=True)
    return table.assign(**{name: quaternions[:, k].round(9) for k, name in enumerate(QUATERNION)})


def make_withheld(by_name: Mapping[str, PreparedRecordings], places: Places) -> None:
    """Recordings without the columns that say how loaded the arm was; ``by_name`` by what to call their rows.

    Where orientations were measured, each case is made without these, too.
    """
    with sealing(places.visible, places.sealed) as folder:
        for name, prepared in by_name.items():
            turns = [name for name in QUATERNION if name in prepared.table]
            cases = itertools.product((False, True) if turns else (False,), WITHHELD.items())
            for number, (oriented, (what, prefixes)) in enumerate(cases):
                gone = [[c for c in map(str, prepared.table) if c.startswith(prefix)] for prefix in prefixes]
                if not all(gone):
                    continue  # not recorded: nothing to withhold
                left_out = [*itertools.chain.from_iterable(gone), *([] if oriented else turns)]
                truth = {"kind": "withheld", "rows": name, "withheld": what, "orientations": oriented}
                _write_world(
                    folder / f"{name}-{number}", places, prepared, prepared.table.drop(columns=left_out), truth
                )
