"""A simulated fleet: arms of three types, each with a weakness of its own, and one arm that is unlike the others."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.core.files import copy_file, new_folder, write_table
from armscope.fleet.constants import SIMULATED
from armscope.world.folder import build
from armscope.world.spec import NOISE_MM, EffectSpec, WorldSpec

WEAKNESSES = {
    "six-axis": ("joint_compliance", "joint 2"),
    "seven-axis": ("gear_eccentricity", "joint 4"),
    "parallelogram-120kg": ("backlash", "joint 1"),
}
"""What many arms of each type have."""
FEW = ("joint_offset", "link_geometry")  # What each arm may have besides


def simulate(count: int, seed: int, robots: Path, output: Path) -> None:
    """Recordings of simulated arms and their fleet.csv; the last arm's errors are ten times the others'.

    Args:
        count: arms.
        seed: of everything random.
        robots: folder of the arms' descriptions.
        output: new folder.
    """
    new_folder(output)
    rows = []
    with tempfile.TemporaryDirectory() as made:
        for number in range(count):
            spec = arm_spec(number, count, seed)
            visible = build(spec, Path(made), robots) / "visible"
            for file in ("robot.yaml", "recordings.csv"):
                copy_file(visible / file, output / spec.id / file)
            home = output / spec.id
            rows.append(
                (spec.id, spec.arm, f"2026-{1 + number % 12:02d}", home / "robot.yaml", home / "recordings.csv")
            )
    write_table(output / "fleet.csv", pd.DataFrame(rows, columns=["arm", "type", "date", "robot", "recordings"]))


def arm_spec(number: int, count: int, seed: int) -> WorldSpec:
    """What one arm of a fleet conceals.

    Args:
        number: of the arm, from 0; its type is the number's turn.
        count: arms; the last one's errors are ten times the others'.
        seed: of everything random.

    Returns:
        The world to make.
    """
    rng = np.random.default_rng([seed, number])
    arm = list(WEAKNESSES)[number % len(WEAKNESSES)]
    unlike = SIMULATED.unlike if number == count - 1 else 1.0
    effects = [EffectSpec(kind=str(rng.choice(FEW)), strength=unlike * float(rng.uniform(*SIMULATED.few)))]
    if rng.random() < SIMULATED.usual:
        kind, place = WEAKNESSES[arm]
        effects.append(EffectSpec(kind=kind, location=place, strength=unlike * float(rng.uniform(*SIMULATED.weakness))))
    return WorldSpec(
        id=f"arm-{number:03d}", category="multiple", arm=arm, seed=int(rng.integers(2**31)), fresh=True,
        rows=SIMULATED.rows, sigma_mm=float(np.mean(NOISE_MM[arm])), effects=tuple(effects),
    )  # fmt: skip
