"""A fitted black-box model, ready to predict: nominal arm, its tool's error, where that was identified; its file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.compensation.domain import Domain
from armscope.compensation.file_contents import ErrorModelContent, ProductsContent, SumsContent, TurningContent
from armscope.core.files import read_json, write_json
from armscope.core.inputs import InputError, format_of, nearest, validate
from armscope.core.types import Array
from armscope.errormodels.features import FeatureSet, ModelSpec
from armscope.errormodels.fitted import SwarmFit
from armscope.errormodels.products import ProductFeatures
from armscope.errormodels.regions import Cut, weights
from armscope.physics.model import Base
from armscope.recordings.motion import moving
from armscope.robot import Arm, chain
from armscope.robot.arm import build_arm


@dataclass(frozen=True, eq=False)
class Turning:
    """The orientation's error: measured = exp(r) * nominal, with a rotation vector r in the arm's base axes."""

    features: FeatureSet | ProductFeatures  # the terms, of the same inputs as the position's
    coefficients: Array  # (regions, 3, n) mrad per unit of the terms
    rms_mrad: Array  # (3,) residual on the identification rows
    tool: Array  # (3, 3) the measured tool frame seen from the arm's last frame


@dataclass(frozen=True, eq=False)
class ErrorModel:
    """Real tool point = nominal tool point + error(nominal position or motor angles), in the arm's base frame (Eq. 8).

    With a `Turning`, the same for the orientation.
    """

    arm: Arm  # the nominal arm (with the fitted tool offset, where frames were registered)
    features: FeatureSet | ProductFeatures  # the model's terms
    coefficients: Array  # (regions, 3, n) mm per unit of the terms
    method: str  # how they were found
    rms_mm: Array  # (3,) residual on the identification rows
    base: Base  # measurement frame from base frame
    domain: Domain  # where it was identified
    cut: Cut | None = None  # the borders of the regions; None for a single one
    turning: Turning | None = None  # the orientation's error; None where no orientations were measured

    @property
    def name(self) -> str:
        """The model's name: "FDP(CI)"."""
        if isinstance(self.features, ProductFeatures):
            return self.features.name
        return self.features.spec.name

    @property
    def space(self) -> str:
        """What the error follows: "cartesian" (nominal position) or "angular" (motor angles)."""
        return self.features.spec.space

    @property
    def left_mm(self) -> float:
        """RMS distance that it leaves on the rows that it was fitted to: what its corrections leave at least."""
        return float(np.linalg.norm(self.rms_mm))

    def error_and_slope(self, angles: Array, nominal: Array) -> tuple[Array, Array]:
        """Errors (N, 3), m, and their derivatives (N, 3, 3) by the nominal position (m/m) or (N, 3, m) by the
        angles. ``angles``: (N, m) rad; ``nominal``: (N, 3) nominal tool points in the base frame, m."""
        # the blend's own slope is left out: models of neighbouring regions nearly agree where they are blended
        inputs = self.inputs(angles, nominal)
        error, slope = _blend(self.features, weights(self.cut, inputs), self.coefficients, inputs)
        return error * 1e-3, slope if self.space == "cartesian" else slope * 1e-3

    def turn_and_slope(self, angles: Array, nominal: Array) -> tuple[Array, Array]:
        """As `error_and_slope` for the orientation: rotation vectors (N, 3), rad, base axes; zero without a `Turning`.

        The slopes are in rad/m (by the nominal position) or rad/rad (by the angles).
        """
        inputs = self.inputs(angles, nominal)
        if self.turning is None:
            return np.zeros((len(inputs), 3)), np.zeros((len(inputs), 3, inputs.shape[1]))
        shares = weights(self.cut, inputs)
        turn, slope = _blend(self.turning.features, shares, self.turning.coefficients, inputs)
        return turn * 1e-3, slope if self.space == "cartesian" else slope * 1e-3

    def inputs(self, angles: Array, nominal: Array) -> Array:
        """What the terms take: nominal positions (N, 3) in mm or motor angles (N, m) in rad."""
        return nominal * 1e3 if self.space == "cartesian" else angles

    def tool_pose(self, angles: Array) -> tuple[Array, Array]:
        """Real tool points (N, 3), m, and orientations of the last frame (N, 3, 3), in base axes."""
        frames = chain(self.arm, angles)
        turn = Rotation.from_rotvec(self.turn_and_slope(angles, frames.tool)[0]).as_matrix()
        return frames.tool + self.error_and_slope(angles, frames.tool)[0], turn @ frames.tool_rotation

    def as_measured(self, angles: Array) -> tuple[Array, Array]:
        """The same as an instrument reads it: in the measurement frame, the orientation of the measured tool frame."""
        points, rotations = self.tool_pose(angles)
        mounted = rotations if self.turning is None else rotations @ self.turning.tool
        return points @ self.base.rotation.T + self.base.translation, self.base.rotation @ mounted


def _blend(
    features: FeatureSet | ProductFeatures, shares: Array, coefficients: Array, inputs: Array
) -> tuple[Array, Array]:
    """Values (N, 3) and slopes (N, 3, k) of blended terms."""
    here = np.einsum("nr,rat->nat", shares, coefficients)
    values: Array = np.einsum("nat,nt->na", here, features.matrix(inputs))
    slopes: Array = np.einsum("nat,ntk->nak", here, features.slopes(inputs))
    return values, slopes


def error_model(arm: Arm, fit: SwarmFit, angles: Array, seed: int | None = None) -> ErrorModel:
    """A fit of `armscope.errormodels` as a model to compensate with.

    Args:
        arm: the nominal arm.
        fit: fitted to x, y and z.
        angles: (M, m) its identification rows, rad.
        seed: whose swarm; None takes, per axis, the one with the smallest residual; -1 the least-squares fit.

    Returns:
        The model with the range in which it holds.
    """
    axes = np.arange(len(fit.axes))
    if seed == -1:
        chosen, rms, method = fit.least_squares, fit.least_squares_mm, "least squares"
    else:
        number = fit.best_seeds if seed is None else np.full(len(axes), fit.seeds.index(seed))
        chosen, rms, method = fit.coefficients[number, axes], fit.fitness_mm[number, axes], fit.method
    domain = domain_of(arm, fit.features.spec, angles)
    return ErrorModel(arm, fit.features, chosen[None], method, rms, Base(np.eye(3), np.zeros(3)), domain)


def domain_of(arm: Arm, spec: ModelSpec, angles: Array) -> Domain:
    """Where a black-box model holds: the range of its own inputs, and motors that stood still stay where they were.

    Args:
        arm: the nominal arm.
        spec: which inputs the model has.
        angles: (M, m) its identification rows, rad.

    Returns:
        The domain; its inputs are mm or rad.
    """
    names = [f"q{motor}" for motor in range(1, arm.n_motors + 1)]
    if spec.space == "angular":
        return Domain.of(angles, names, ["rad"] * len(names))
    still = np.flatnonzero(~moving(angles))
    inputs = np.column_stack([chain(arm, angles).tool * 1e3, angles[:, still]])
    return Domain.of(inputs, ["x", "y", "z", *(names[j] for j in still)], ["mm"] * 3 + ["rad"] * len(still))


def domain_inputs(model: ErrorModel, angles: Array) -> Array:
    """(N, k) the inputs of a model's domain at motor angles (N, m)."""
    by_name = {f"q{motor}": values for motor, values in enumerate(angles.T, start=1)}
    by_name |= dict(zip("xyz", chain(model.arm, angles).tool.T * 1e3, strict=True))
    return np.column_stack([by_name[name] for name in model.domain.inputs])


FORMAT = "armscope error model 1"


def save_error_model(path: Path | str, model: ErrorModel) -> None:
    """Write errormodel.json; the robot's description is part of it (a URDF by its path)."""
    write_json(
        path,
        {
            "format": FORMAT,
            "name": model.name,
            "method": model.method,
            "rms_mm": model.rms_mm,
            "robot": model.arm.description.model_dump(mode="json", exclude_none=True),
            "features": model.features.to_dict(),
            "terms": list(model.features.term_names),
            "coefficients": model.coefficients,
            "regions": None if model.cut is None else model.cut.to_dict(),
            "turning": None if model.turning is None else _turning_out(model.turning),
            "base": {"rotation": model.base.rotation, "translation_m": model.base.translation},
            "domain": model.domain.to_dict(),
        },
    )


def _turning_out(turning: Turning) -> dict[str, Any]:
    return {
        "rms_mrad": turning.rms_mrad,
        "features": turning.features.to_dict(),
        "terms": list(turning.features.term_names),
        "coefficients": turning.coefficients,
        "tool": turning.tool,
    }


def load_error_model(path: Path | str) -> ErrorModel:
    """Read errormodel.json. Raises InputError: it is no model of this format."""
    content = read_json(path, "an error model")
    found = format_of(content)
    if found != FORMAT:
        cure = "`armscope fit-error-model` writes one."
        raise InputError(path, "format", found, f"an error model says {FORMAT!r}", cure)
    stated = validate(ErrorModelContent, content, path)
    arm = build_arm(stated.robot)
    cut = None if stated.regions is None else Cut.from_dict(stated.regions.model_dump())
    features, coefficients = _terms(stated, stated.features, cut, arm, path)
    _check_domain(stated, arm, path)
    return ErrorModel(
        arm,
        features,
        coefficients,
        stated.method,
        np.array(stated.rms_mm),
        Base(np.array(stated.base.rotation), np.array(stated.base.translation_m)),
        Domain.from_dict(stated.domain.model_dump()),
        cut,
        None if stated.turning is None else _turning_in(stated.turning, cut, arm, path),
    )


def _turning_in(content: TurningContent, cut: Cut | None, arm: Arm, path: Path | str) -> Turning:
    features, coefficients = _terms(content, content.features, cut, arm, path)
    return Turning(features, coefficients, np.array(content.rms_mrad), np.array(content.tool))


def _terms(
    content: ErrorModelContent | TurningContent,
    stated: SumsContent | ProductsContent,
    cut: Cut | None,
    arm: Arm,
    path: Path | str,
) -> tuple[FeatureSet | ProductFeatures, Array]:
    kind = ProductFeatures if isinstance(stated, ProductsContent) else FeatureSet
    features: FeatureSet | ProductFeatures = kind.from_dict(stated.model_dump())
    inputs = 3 if features.spec.space == "cartesian" else arm.n_motors
    if len(features.inputs) != inputs:
        raise InputError(path, "features", f"{len(features.inputs)} inputs", f"{arm.name} has {inputs} of this kind")
    if cut is not None and any(axis >= inputs for axis in _axes(cut)):
        raise InputError(path, "regions", "an axis too many", f"there are {inputs} inputs")
    regions = weights(cut, np.zeros((1, inputs))).shape[1]
    shapes = {len(numbers) for region in content.coefficients for numbers in region}
    if len(content.coefficients) != regions or shapes != {features.coefficients_per_axis}:
        expected = f"{features.spec.name} has {regions} x 3 x {features.coefficients_per_axis} finite numbers"
        found = f"{len(content.coefficients)} x 3 x {sorted(shapes)}"
        raise InputError(path, "coefficients", found, expected, "Was the file edited?")
    return features, np.array(content.coefficients)


def _axes(cut: Cut | None) -> set[int]:
    return set() if cut is None else {cut.axis} | _axes(cut.below) | _axes(cut.above)


def _check_domain(stated: ErrorModelContent, arm: Arm, path: Path | str) -> None:
    """The domain's inputs are motor angles and nominal coordinates of this arm, in the order of their kinds."""
    known = {*"xyz", *(f"q{motor}" for motor in range(1, arm.n_motors + 1))}
    for name in stated.domain.inputs:
        if name not in known:
            raise InputError(path, "domain.inputs", name, "no input of this arm", nearest(name, known))
