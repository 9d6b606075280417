"""What a choice is worth: arms with drawn errors are measured at each set of poses, fitted, and asked elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.design.indices import all_indices
from armscope.poses.candidates import candidates
from armscope.poses.choose import Choice, by_other_criteria, grid_choice, random_choice
from armscope.poses.constants import CHOOSING
from armscope.poses.options import PoseOptions
from armscope.poses.target_parameters import TargetParameters
from armscope.recordings import Recordings


@dataclass(frozen=True)
class RivalOptions:
    """What a choice is compared with, by the names of the command line."""

    seeds: int = 0  # simulated arms in the comparison with random poses and a grid; 0: none is made
    noise_mm: float | None = None  # 1-sigma per axis; None: robot.yaml's, else `CHOOSING.noise_mm`
    all_criteria: bool = False  # whether the choices by the other four criteria are compared, too

    def noise(self, sigma: float | None) -> tuple[float, str]:
        """Noise of an arm's points, m, and who says so; `sigma` is robot.yaml's, m."""
        if self.noise_mm is not None:
            return self.noise_mm * 1e-3, "stated by --noise-mm"
        return (CHOOSING.noise_mm * 1e-3, "assumed") if sigma is None else (sigma, "stated by robot.yaml")

    def compare(self, choice: Choice, asked: PoseOptions) -> pd.DataFrame | None:
        """A choice as it was asked for, against its rivals, see `compare_sets`; None where no arm is simulated."""
        if not self.seeds:
            return None
        noise, _ = self.noise(choice.targets.arm.sigma)
        others = by_other_criteria(choice, asked.seed, asked.starts) if self.all_criteria else {}
        return compare_sets(choice, noise, self.seeds, asked.seed, asked.payload_kg, others)


RIVALS = ("random", "grid")


def compare_sets(
    choice: Choice,
    noise: float,
    seeds: int,
    seed: int = 0,
    payload_kg: float = 0.0,
    others: Mapping[str, Recordings] | None = None,
) -> pd.DataFrame:
    """The chosen poses against random ones and a grid of equal number, over seeds.

    For each seed an arm is drawn (each parameter moves the tool by a millimetre RMS, 1-sigma), measured with noise at
    each set of poses, and its parameters are fitted to that (Gauss-Newton on the exact model).

    Args:
        choice: see `choose`.
        noise: 1-sigma per axis, m.
        seeds: how many arms.
        seed: of the arms, the noise and the other sets.
        payload_kg: as for the choice.
        others: further sets of poses by name.

    Returns:
        One row per seed and set: seed, set ("chosen", others, "random", "grid"), O1 ... O5, parameter_rms_mm and
        parameter_worst_mm (errors of the effects' parameters, in millimetres that they move the tool by),
        held_out_rms_mm (3D) and held_out_worst_mm (predicted minus true at poses that took no part).
    """
    targets = choice.targets
    elsewhere = candidates(targets.arm, CHOOSING.held_out, choice.around, seed + 104729, payload_kg).table
    fixed = {"chosen": choice.table, **(others or {})}
    draw: dict[str, Callable[[np.random.Generator], Recordings]] = {
        **{name: _always(table) for name, table in fixed.items()},
        "random": lambda rng: random_choice(choice, rng),
        "grid": lambda rng: grid_choice(choice, rng, payload_kg),
    }
    rows = []
    for number in range(seeds):
        for_arm, for_poses, for_noise = (np.random.default_rng([seed, number, k]) for k in range(3))
        truth = for_arm.normal(size=len(targets.terms))
        held_out = targets.tool(elsewhere, truth)
        for kind, drawn in draw.items():
            poses = drawn(for_poses)
            measured = targets.tool(poses, truth) + for_noise.normal(0, noise, (len(poses), 3))
            found = _fitted(targets, poses, measured)
            wrong = np.abs(found - truth)[~targets.is_frame]
            missed = np.linalg.norm(targets.tool(elsewhere, found) - held_out, axis=1) * 1e3
            rows.append(
                {
                    "seed": number,
                    "set": kind,
                    **all_indices(targets.jacobian(poses)),
                    "parameter_rms_mm": rms(wrong),
                    "parameter_worst_mm": float(wrong.max()),
                    "held_out_rms_mm": rms(missed),
                    "held_out_worst_mm": float(missed.max()),
                }
            )
    return pd.DataFrame(rows)


def _always(table: Recordings) -> Callable[[np.random.Generator], Recordings]:
    return lambda rng: table


def summary(table: pd.DataFrame) -> dict[str, dict[str, float]]:
    """By set: medians over the seeds of everything that `compare_sets` tabulates."""
    medians = table.drop(columns="seed").groupby("set", sort=False).median()
    return {str(kind): {str(name): float(value) for name, value in row.items()} for kind, row in medians.iterrows()}


def share_won(table: pd.DataFrame, column: str, against: str) -> float:
    """The share of seeds in which the chosen poses' error is the smaller one; the arm and its noise are the same.

    Args:
        table: one row per seed and set of poses, with columns seed and set.
        column: which error.
        against: the set that the chosen one is compared with.

    Returns:
        The share, 0 ... 1.
    """
    by_seed = table.pivot(index="seed", columns="set", values=column)
    return float(np.mean(by_seed["chosen"] < by_seed[against]))


def _fitted(targets: TargetParameters, poses: Recordings, measured: Array) -> Array:
    """(p,) parameters in units of their sizes; the slope is taken at the nominal arm."""
    columns = targets.jacobian(poses).reshape(-1, len(targets.terms))
    inverse, values = np.linalg.pinv(columns), np.zeros(len(targets.terms))
    for _ in range(CHOOSING.steps):
        values = values + inverse @ (measured - targets.tool(poses, values)).reshape(-1)
    return values


def predicted_errors(choice: Choice, noise: float, sets: Mapping[str, Recordings]) -> pd.DataFrame:
    """1-sigma of every parameter by linear theory, sigma^2 (J'J)^-1, natural units: one row per parameter.

    Args:
        choice: whose parameters are asked for.
        noise: 1-sigma per axis, m.
        sets: poses by name.

    Returns:
        A row per parameter with a column ``sd_NAME`` per set; frames are left out.
    """
    targets = choice.targets
    table = pd.DataFrame({"parameter": targets.names, "unit": [term.unit for _, term in targets.terms]})
    for kind, poses in sets.items():
        columns = targets.jacobian(poses).reshape(-1, len(targets.terms))
        spread = np.sqrt(np.diag(np.linalg.inv(columns.T @ columns))) * noise * targets.sizes
        table[f"sd_{kind}"] = spread / [term.si for _, term in targets.terms]
    return table[~targets.is_frame].reset_index(drop=True)
