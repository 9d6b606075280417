"""Commands for a path of 10,000 points by a physical model, beside scipy's root finder row by row, in one run.

CPU time on one thread; the ratio of every round counts, order alternating. Both must bring the modelled arm to the
wanted points within a micrometre. Aim: less than a second for the path.

    python -m benchmarks.compensation [--rounds 5]
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

import numpy as np
import pandas as pd
from scipy.optimize import least_squares

from armscope.compensation.compensate import compensate_physical
from armscope.compensation.forward import PhysicalArm
from armscope.compensation.path import as_path
from armscope.compensation.physical import Identified, identified_on
from armscope.compensation.task import Options
from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel
from armscope.physics.registry import library
from armscope.recordings import Recordings
from armscope.robot import chain, load_arm

ROBOT = Path(__file__).parents[1] / "config" / "robots" / "six-axis.yaml"
POINTS, POINTS_BY_ROW = 10_000, 100
AIM_S, CLOSE_M = 1.0, 1e-6
MIDDLE = np.array([0.1, 0.2, 0.3, 0.2, 0.6, 0.1])
WRONG = {("joint_offset", "joint 3"): 8e-4, ("joint_compliance", "joint 2"): 2e-6}


def arm_that_misses() -> tuple[FittedModel, Identified]:
    """A six-axis arm with a wrong zero and a drive that gives way, and where it is known."""
    arm = load_arm(ROBOT)
    rng, rows = np.random.default_rng(0), 200
    angles = MIDDLE + rng.uniform(-0.8, 0.8, (rows, arm.n_motors))
    blank, payload = np.full(rows, ""), np.full(rows, 5.0)
    table = Recordings(angles, chain(arm, angles).tool, blank, blank, np.arange(rows).astype(str), payload=payload)
    placed = [next(p for p in library(arm, table) if p.key == key) for key in WRONG]
    parts = tuple(Part(p, np.array([value])) for p, value in zip(placed, WRONG.values(), strict=True))
    return FittedModel(arm, {"": Base(np.eye(3), np.zeros(3))}, (), parts), identified_on(arm, table)


def curve(model: FittedModel, count: int) -> pd.DataFrame:
    """A closed curve of wanted points, with the payload."""
    phi = np.linspace(0, 2 * np.pi, count)
    around = 0.08 * np.column_stack([np.cos(phi) - 1, np.sin(phi), 0.4 * np.sin(2 * phi)])
    points = chain(model.arm, MIDDLE[None]).tool[0] + around
    return pd.DataFrame(points * 1e3, columns=["x_mm", "y_mm", "z_mm"]).assign(payload_kg=5.0)


def row_by_row(model: FittedModel, table: pd.DataFrame) -> float:
    """Largest distance (m) from the wanted points that scipy leaves, each row starting where the one before ended."""
    path = as_path(table, "path", model.arm).table
    real, wanted = PhysicalArm(model, path, False), table[["x_mm", "y_mm", "z_mm"]].to_numpy() * 1e-3
    angles, worst = MIDDLE, 0.0
    for row in range(len(table)):
        at = np.array([row])

        def missed(q: np.ndarray, at: np.ndarray = at, row: int = row) -> np.ndarray:
            return real.at(q[None], at).points[0] - wanted[row]

        def slope(q: np.ndarray, at: np.ndarray = at) -> np.ndarray:
            return real.at(q[None], at).jacobian[0, :3]

        angles = least_squares(missed, angles, jac=slope, xtol=1e-12, ftol=1e-12, gtol=1e-12).x
        worst = max(worst, float(np.linalg.norm(missed(angles))))
    return worst


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    model, identified = arm_that_misses()
    tables = {count: curve(model, count) for count in (POINTS, POINTS_BY_ROW)}
    path = as_path(tables[POINTS], "path", model.arm)
    options = Options(start_rad=MIDDLE)

    def together() -> None:
        found = compensate_physical(model, identified, path, options)
        assert found.reached.all()
        stands = PhysicalArm(model, path.table, False).at(found.commands, np.arange(POINTS))
        assert np.linalg.norm(stands.points - tables[POINTS][["x_mm", "y_mm", "z_mm"]] * 1e-3, axis=1).max() < CLOSE_M

    def alone() -> None:
        assert row_by_row(model, tables[POINTS_BY_ROW]) < CLOSE_M

    seconds = np.empty((rounds + 1, 2))
    for number in range(rounds + 1):
        for which in np.roll([0, 1], number):
            start = time.process_time()
            (together, alone)[which]()
            seconds[number, which] = time.process_time() - start
    per_point = seconds[1:] / [POINTS, POINTS_BY_ROW]
    ratios, whole = per_point[:, 1] / per_point[:, 0], seconds[1:, 0]
    met = "met" if np.median(whole) <= AIM_S else "NOT MET"
    print(
        f"{model.arm.name}: {POINTS} points in {np.median(whole):.2f} s ({whole.min():.2f}-{whole.max():.2f}), "
        f"aim {AIM_S:g} s {met}; {np.median(ratios):.0f} x scipy row by row ({ratios.min():.0f}-{ratios.max():.0f})"
    )


if __name__ == "__main__":
    main()
