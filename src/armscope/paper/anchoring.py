"""Robots that stand in for the lost one: geometric errors of tolerance size that agree with the printed equations.

The fit of FDP(CI) by least squares is linear in the measured errors, and these are nearly linear in the geometric
errors e (in tolerances, prior N(0, 1)): the orthonormal coordinates of the fit are A e + noise. The printed
Eqs. (15)-(17) are 12 such numbers b. Then

    most likely e  =  A' (A A')^-1 b                      (the anchored robot)
    drawn given b  =  e0 + A' (A A')^-1 (b - A e0)        (the ensemble; e0 drawn from the prior)

and the same step, repeated with the exact model in place of A e, makes each robot agree with b exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.paper.printed import printed_matrix
from armscope.robot import chain
from armscope.world.tolerances import GeometricErrors

ANCHORED = "anchored"
AGREEMENT_MM = 1e-6
ITERATIONS = 20


@dataclass(frozen=True, eq=False)
class AnchoredRobots:
    """Robots that agree with the printed equations."""

    names: tuple[str, ...]  # "anchored", "ensemble 1", ...
    in_sigmas: Array  # (R, K) geometric errors in tolerances
    errors: GeometricErrors  # which errors these are
    information: Array  # (K,) share of each error's prior variance that the printed equations take away
    # (R,) largest difference at an identification pose between the refitted and the printed FDP(CI)
    disagreement_mm: Array

    def to_table(self) -> pd.DataFrame:
        """One row per geometric error.

        Columns: error, unit ("mm" or "mrad"), tolerance, anchored, anchored_in_sigmas, ensemble_median_in_sigmas,
        ensemble_std_in_sigmas, information (share of the prior variance that the printed equations determine).
        """
        scale = np.full(len(self.errors.sigmas), 1e3)  # m to mm, rad to mrad
        ensemble = self.in_sigmas[1:] if len(self.names) > 1 else np.full((1, len(scale)), np.nan)
        return pd.DataFrame(
            {
                "error": self.errors.names,
                "unit": np.where(self.errors.angular, "mrad", "mm"),
                "tolerance": self.errors.sigmas * scale,
                "anchored": self.in_sigmas[0] * self.errors.sigmas * scale,
                "anchored_in_sigmas": self.in_sigmas[0],
                "ensemble_median_in_sigmas": np.median(ensemble, axis=0),
                "ensemble_std_in_sigmas": ensemble.std(axis=0),
                "information": self.information,
            }
        )

    def in_tolerances(self) -> pd.DataFrame:
        """One row per robot: its name and each geometric error in tolerances."""
        table = pd.DataFrame(self.in_sigmas, columns=list(self.errors.names))
        table.insert(0, "robot", self.names)
        return table


def anchor(
    errors: GeometricErrors, motor_angles: Array, noise_m: Array, ensemble: int, rng: np.random.Generator
) -> AnchoredRobots:
    """The most likely robot, and ``ensemble`` more, whose least-squares FDP(CI) is Eqs. (15)-(17) as printed.

    Args:
        errors: the possible geometric errors and their tolerances.
        motor_angles: (N, m) identification poses, rad.
        noise_m: (N, 3) what the tracker adds at these poses, m.
        ensemble: how many robots to draw beside the most likely one.
        rng: draws them.

    Returns:
        The robots' errors, in sigmas and natural units, and how far their equations are from the printed ones.

    Raises:
        RuntimeError: a robot that can't be made to agree (tolerances far too large for the linear step).
    """
    frames = chain(errors.arm, motor_angles)
    nominal_mm = frames.tool * 1e3
    q, r = np.linalg.qr(np.column_stack([np.ones(len(nominal_mm)), nominal_mm]))
    printed = (printed_matrix("FDP(CI)") @ r.T).ravel()  # coordinates of the printed fit in the orthonormal basis q

    def coordinates(in_sigmas: Array) -> Array:
        measured_mm = (errors.positions(motor_angles, in_sigmas) + noise_m) * 1e3 - nominal_mm
        return np.asarray(np.einsum("nc,rna->rac", q, measured_mm).reshape(len(in_sigmas), -1))

    slope = np.einsum("nc,nak->ack", q, errors.jacobian(frames) * 1e3).reshape(len(printed), -1)
    gain = slope.T @ np.linalg.inv(slope @ slope.T)
    in_sigmas = np.vstack([np.zeros(slope.shape[1]), rng.standard_normal((ensemble, slope.shape[1]))])
    gap = printed - coordinates(in_sigmas)
    for _ in range(ITERATIONS):
        in_sigmas = in_sigmas + gap @ gain.T
        gap = printed - coordinates(in_sigmas)
        disagreement = np.abs(np.einsum("nc,rac->rna", q, gap.reshape(len(gap), 3, 4))).max(axis=(1, 2))
        if disagreement.max() < AGREEMENT_MM:
            break
    else:
        raise RuntimeError(f"anchoring stopped {disagreement.max():.3g} mm away from the printed equations")
    names = (ANCHORED, *(f"ensemble {number}" for number in range(1, ensemble + 1)))
    information = np.einsum("kc,ck->k", gain, slope)
    return AnchoredRobots(names, in_sigmas, errors, information, disagreement)
