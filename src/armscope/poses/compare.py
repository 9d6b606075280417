"""What a choice is worth: arms with drawn errors are measured at each set of poses, fitted, and asked elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.design.indices import all_indices
from armscope.poses.candidates import candidates
from armscope.poses.choose import Choice, choose, grid_choice, random_choice
from armscope.poses.shown import Shown
from armscope.recordings import Recordings

Array = NDArray[np.float64]

HELD_OUT = 300
"""Possible poses, of another sequence, at which the fitted arm is asked."""
STEPS = 4
"""Gauss-Newton steps of a fit: errors of a millimetre leave less than a nanometre after three."""
KINDS = ("chosen", "random", "grid")


def compare(choice: Choice, noise: float, seeds: int, seed: int = 0, payload_kg: float = 0.0) -> pd.DataFrame:
    """The chosen poses against random ones and a grid of equal number, over seeds.

    For each seed an arm is drawn (each parameter moves the tool by a millimetre RMS, 1-sigma), measured with noise at
    each set of poses, and its parameters are fitted to that (Gauss-Newton on the exact model).

    Args:
        choice: see `choose`.
        noise: 1-sigma per axis, m.
        seeds: how many arms.
        seed: of the arms, the noise and the other sets.
        payload_kg: as for the choice.

    Returns:
        One row per seed and set: seed, set ("chosen", "random", "grid"), O1 ... O5, parameter_rms_mm and
        parameter_worst_mm (errors of the effects' parameters, in millimetres that they move the tool by),
        held_out_rms_mm (3D) and held_out_worst_mm (predicted minus true at poses that took no part).
    """
    seen = choice.shown
    elsewhere = candidates(seen.arm, HELD_OUT, choice.around, seed + 104729, payload_kg).table
    draw: Mapping[str, Callable[[np.random.Generator], Recordings]] = {
        "chosen": lambda rng: choice.table,
        "random": lambda rng: random_choice(choice, rng),
        "grid": lambda rng: grid_choice(choice, rng, payload_kg),
    }
    rows = []
    for number in range(seeds):
        for_arm, for_poses, for_noise = (np.random.default_rng([seed, number, k]) for k in range(3))
        truth = for_arm.normal(size=len(seen.terms))
        held_out = seen.tool(elsewhere, truth)
        for kind in KINDS:
            poses = draw[kind](for_poses)
            measured = seen.tool(poses, truth) + for_noise.normal(0, noise, (len(poses), 3))
            found = _fitted(seen, poses, measured)
            wrong = np.abs(found - truth)[~seen.is_frame]
            missed = np.linalg.norm(seen.tool(elsewhere, found) - held_out, axis=1) * 1e3
            rows.append(
                {
                    "seed": number,
                    "set": kind,
                    **all_indices(seen.jacobian(poses)),
                    "parameter_rms_mm": float(np.sqrt(np.mean(wrong**2))),
                    "parameter_worst_mm": float(wrong.max()),
                    "held_out_rms_mm": float(np.sqrt(np.mean(missed**2))),
                    "held_out_worst_mm": float(missed.max()),
                }
            )
    return pd.DataFrame(rows)


def _fitted(seen: Shown, poses: Recordings, measured: Array) -> Array:
    """(p,) parameters in units of their sizes; the slope is taken at the nominal arm."""
    columns = seen.jacobian(poses).reshape(-1, len(seen.terms))
    inverse, values = np.linalg.pinv(columns), np.zeros(len(seen.terms))
    for _ in range(STEPS):
        values = values + inverse @ (measured - seen.tool(poses, values)).reshape(-1)
    return values


def predicted_errors(choice: Choice, noise: float, sets: Mapping[str, Recordings]) -> pd.DataFrame:
    """1-sigma of every parameter by linear theory, sigma^2 (J'J)^-1, natural units: one row per parameter."""
    seen = choice.shown
    table = pd.DataFrame({"parameter": seen.names, "unit": [term.unit for _, term in seen.terms]})
    for kind, poses in sets.items():
        columns = seen.jacobian(poses).reshape(-1, len(seen.terms))
        spread = np.sqrt(np.diag(np.linalg.inv(columns.T @ columns))) * noise * seen.sizes
        table[f"sd_{kind}"] = spread / [term.si for _, term in seen.terms]
    return table[~seen.is_frame].reset_index(drop=True)


def compare_over_choices(
    first: Choice, noise: float, seeds: int, choices: int, seed: int, payload_kg: float = 0.0
) -> pd.DataFrame:
    """`compare` for several choices, each from candidates of another sequence: the choice itself varies, too."""
    tables = [compare(first, noise, seeds, seed, payload_kg).assign(choice=0)]
    for number in range(1, choices):
        again = choose(
            first.shown.arm, len(first.rows), first.around, first.effects, first.index, len(first.candidates),
            payload_kg, seed + number,
        )  # fmt: skip
        tables.append(compare(again, noise, seeds, seed + number, payload_kg).assign(choice=number))
    return pd.concat(tables, ignore_index=True)
