"""Do the drives' compliances agree between runs of one arm? Each run by itself under the same model, then compared.

The model is the same for every run and chosen by nothing in it: base and tool free, D-H values of all links with priors
of tolerance size, the drives of all loaded joints and the tilt of all bearings with one common, wide prior. Loads of
drives are gravity's torques of mass moments fitted to the recorded ones; those of bearings are gravity's by the stated
masses, scaled to the recorded torques.

What else a real arm does a little of would make such a model too sure of itself: where drives and bearings are loaded
nearly alike, a wave of a tenth of a milliradian decides. So low waves of every moving joint's angle and of its axis'
direction are allowed for, too. And as residuals hang together from row to row, the rows' part of each covariance comes
from a jackknife over blocks of consecutive rows, the rest from the priors.

Runs are compared in all combinations of compliances that both determine: an arm that moves two joints alone hardly
tells its drives and bearings apart, but together they must give way as the other run says.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import f as f_distribution

from armscope.check.orientations import trusted_channels
from armscope.check.preconditions import check_table
from armscope.core.location import Location
from armscope.core.types import Array
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.gauss_newton import Quadratic, gauss_newton
from armscope.fitting.linearisation import residuals
from armscope.fitting.model_fit import ModelFit
from armscope.fitting.parameter_layout import ParameterLayout, parameter_layout
from armscope.fitting.registration import fit_frames
from armscope.inference.normal_equations import NormalEquations, total
from armscope.measurement.channel import supported
from armscope.measurement.row_weights import RowNoise
from armscope.physics import elastic, geometric, tilting
from armscope.physics.effect import Part, Placed
from armscope.physics.form_constants import FORM
from armscope.physics.frames import free_frames
from armscope.physics.model import FittedModel
from armscope.physics.placing import moving_joints
from armscope.physics.transmission import mesh
from armscope.physics.wobble import about_their_origins
from armscope.real.constants import COMPLIANCE
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.robot.arm import build_arm
from armscope.robot.gravity import gravity_torques, mass_moment_regressor


@dataclass(frozen=True, eq=False)
class Give:
    """What a run alone says of how the arm gives way."""

    run: str
    rows: int
    # (m + n,) compliances of all motors' drives, then of all joints' bearings, rad/(N m); what carries no load keeps
    # its prior
    mean: Array
    covariance: Array  # (m + n, m + n)
    posterior: Array  # the same as if the model were true; what two runs share through the prior follows from it
    noise_mm: float  # what the model leaves, per axis
    masses: float  # by how much the stated masses were scaled

    @property
    def stderr(self) -> Array:
        """(m + n,) rad/(N m)."""
        return np.sqrt(np.diag(self.covariance))


def fit_give(arm: Arm, recordings: Recordings, run: str) -> Give:
    """Compliances of all drives and bearings from one run, or from several with a base and a tool each.

    Args:
        arm: the nominal arm, with masses.
        recordings: rows with recorded torques; their orientations are used where they were measured.
        run: what to call them.

    Returns:
        Compliances, rad/(N m), with covariances; the noise and masses that they were fitted with.
    """
    table = check_table(arm, recordings).recordings
    tool_per_run = len(np.unique(table.run)) > 1
    arm, masses = as_heavy_as_recorded(arm, table)
    table = replace(table, torque=gravity_as_recorded(arm, table))
    model = fit_frames(arm, table, tool_per_run)
    _, table, _ = trusted_channels(supported(table), table, residuals(model, table))
    drives = [placed for placed in elastic.JOINT_COMPLIANCE.place(arm, table) if placed.variant == ""]
    bearings = [placed for placed in tilting.BEARING_COMPLIANCE.place(arm, table) if placed.variant == ""]
    waves = [mesh(j, per_turn) for j in moving_joints(table) for per_turn in COMPLIANCE.waves]
    families = [geometric.background(arm), [*drives, *bearings], [*waves, *about_their_origins(arm, table)]]
    parts = parameter_layout(free_frames(table, tool_per_run), families, [])
    small = [p for family in families for p in family]
    precision = _precision(parts)
    blocks, noise = _settled(parts, model, small, table, precision)
    mean, posterior, covariance = _jackknifed(blocks, noise, precision)
    at = np.concatenate([parts.of(placed) for placed in (*drives, *bearings)])
    joint = [Location.of(placed.location).index for placed in (*drives, *bearings)]
    number = np.array(joint) + arm.n_motors * (np.arange(len(joint)) >= len(drives))

    def of_all(matrix: Array) -> Array:
        full = COMPLIANCE.prior_rad_nm**2 * np.eye(arm.n_motors + arm.n_joints)
        full[np.ix_(number, number)] = matrix[np.ix_(at, at)]
        return full

    values = np.zeros(arm.n_motors + arm.n_joints)
    values[number] = mean[at]
    return Give(run, len(table), values, of_all(covariance), of_all(posterior), noise, masses)


def as_heavy_as_recorded(arm: Arm, table: Recordings) -> tuple[Arm, float]:
    """The arm with all stated masses scaled by one factor to the recorded torques, and the factor."""
    assert table.torque is not None
    frames = chain(arm, table.motor_angles)
    stated = gravity_torques(arm, frames)
    carried = gravity_torques(arm, frames, table.payload) - stated
    known = np.isfinite(table.torque)
    factor = float(stated[known] @ (table.torque - carried)[known] / (stated[known] @ stated[known]))
    links = [link.model_copy(update={"mass_kg": factor * link.mass_kg}) for link in arm.description.links or []]
    return build_arm(arm.description.model_copy(update={"links": links})), factor


def gravity_as_recorded(arm: Arm, table: Recordings) -> Array:
    """(N, m) gravity's torques of the mass moments that explain a run's recorded ones best, N m.

    An arm that stands still carries nothing else; the sensors' ripple is no load, but would be taken for one where
    loads hardly differ.
    """
    assert table.torque is not None
    smooth = np.empty_like(table.torque)
    for run in np.unique(table.run):
        mine = table.run == run
        regressor = mass_moment_regressor(arm, chain(arm, table.motor_angles[mine]))
        columns = regressor.reshape(-1, regressor.shape[-1])
        torque = table.torque[mine].ravel()
        known = np.isfinite(torque)
        moments = np.linalg.lstsq(columns[known], torque[known], rcond=COMPLIANCE.unseen)[0]
        smooth[mine] = (columns @ moments).reshape(-1, arm.n_motors)
    return smooth


def _precision(parts: ParameterLayout) -> Array:
    """(p,) prior precisions, SI units; frames are free."""
    precision = np.zeros(len(parts.terms))
    for columns, size in zip(
        parts.background, (FORM.tolerance, COMPLIANCE.prior_rad_nm, COMPLIANCE.wave_rad), strict=True
    ):
        precision[columns] = size**-2
    return precision


def _settled(
    parts: ParameterLayout, model: FittedModel, small: Sequence[Placed], table: Recordings, precision: Array
) -> tuple[list[NormalEquations], float]:
    """Sums over each block of rows where the exact fit settles, and the noise there (mm)."""
    rows = RowNoise(np.ones(len(table)), np.ones(len(table)))
    model = replace(model, background=tuple(Part(placed, np.zeros(len(placed.terms))) for placed in small))
    problem = ModelFit(
        parts, table, lambda left: rows.weights(left, 0.0), lambda gram: precision, 0.0, COMPLIANCE.negligible
    )
    found = gauss_newton(problem, model, COMPLIANCE.steps)
    block = np.arange(len(table)) * COMPLIANCE.blocks // len(table)
    return normal_equations_by_block(parts, found.state, table, rows.weights(found.residual, 0.0), block), problem.noise


def _jackknifed(blocks: Sequence[NormalEquations], noise: float, precision: Array) -> tuple[Array, Array, Array]:
    """Posterior mean, posterior covariance if the model were true, and with the rows' part as the blocks scatter.

    Without block b the mean is theta_b; the rows' part is (B-1)/B sum (theta_b - mean)(theta_b - mean)' (Tukey 1958).
    """
    gram, start = total(blocks), np.zeros(len(precision))

    def solved(sums: NormalEquations) -> Quadratic:
        return Quadratic(sums.G / noise**2 + np.diag(precision), sums.b / noise**2, start)

    whole = solved(gram)
    posterior = whole.inverse
    without = np.array([solved(gram - block).values for block in blocks if block.n > 0])
    off = without - without.mean(axis=0)
    rows = (len(off) - 1) / len(off) * off.T @ off
    return whole.values, posterior, posterior * precision @ posterior + rows


@dataclass(frozen=True, eq=False)
class Agreement:
    """Two runs' compliances, compared where both tell them."""

    one: str
    other: str
    directions: Array  # (k, m + n) combinations of the compliances that both determine, unit vectors, the surest first
    difference: Array  # (k,) of these combinations, one minus other, rad/(N m)
    stderr: Array  # (k,) of the differences
    statistic: float  # Hotelling's T^2 of the difference
    probability: float  # of such a difference or a larger one, if the compliances are the same


def compare_compliances(one: Give, other: Give) -> Agreement:
    """Whether two runs agree about the compliances, in what both determine.

    Both means lean to the same prior, so their errors have a part in common:
    Cov(m1 - m2) = C1 + C2 - (P1 P^-1 P2 + transposed) with the posteriors P1, P2 and the prior P.
    """
    size, vectors = np.linalg.eigh(one.posterior + other.posterior)
    directions = vectors[:, size < (COMPLIANCE.determined * COMPLIANCE.prior_rad_nm) ** 2].T
    common = one.posterior @ other.posterior / COMPLIANCE.prior_rad_nm**2
    covariance = directions @ (one.covariance + other.covariance - common - common.T) @ directions.T
    difference = directions @ (one.mean - other.mean)
    k = len(directions)
    if not k:
        return Agreement(one.run, other.run, directions, difference, np.empty(0), np.nan, np.nan)
    statistic = float(difference @ np.linalg.solve(covariance, difference))
    # two covariances of so many blocks each: Hotelling's T^2 is an F
    free = 2 * (COMPLIANCE.blocks - 1)
    chance = float(f_distribution.sf(statistic * (free - k + 1) / (free * k), k, free - k + 1))
    return Agreement(one.run, other.run, directions, difference, np.sqrt(np.diag(covariance)), statistic, chance)
