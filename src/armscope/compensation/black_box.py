"""One fitted black-box model as a file: the nominal arm, its tool point's error, where that was identified."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.compensation.domain import Domain
from armscope.errormodels import FeatureSet, FitProblem, ModelSpec, fit_least_squares, fit_swarms
from armscope.errormodels import FittedModel as Fit
from armscope.errormodels.products import ProductFeatures, fit_products
from armscope.errormodels.regions import (
    Cut,
    blended,
    chosen_regions,
    compare_regions,
    divide,
    fit_regions,
    halvings_of,
    weights,
)
from armscope.files import read_json, write_json
from armscope.inputs import InputError, validate
from armscope.physics.model import Base
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription

Array = NDArray[np.float64]
FORMAT = "armscope error model 1"
LARGEST_PLAIN_ERROR_MM = 50.0
"""Errors beyond this are no positioning errors: the measurements stand in another frame than the arm's base."""


@dataclass(frozen=True, eq=False)
class ErrorModel:
    """Real tool point = nominal tool point + error(nominal position or motor angles), in the arm's base frame (Eq. 8).

    Attributes:
        arm: the nominal arm (with the fitted tool offset, where frames were registered).
        features: the model's terms.
        coefficients: (regions, 3, n) mm per unit of the terms.
        cut: the borders of the regions; None for a single one.
        method: how they were found.
        rms_mm: (3,) residual on the identification rows.
        base: measurement frame from base frame.
        domain: where it was identified.
    """

    arm: Arm
    features: FeatureSet | ProductFeatures
    coefficients: Array
    method: str
    rms_mm: Array
    base: Base
    domain: Domain
    cut: Cut | None = None

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

    def error_and_slope(self, angles: Array, nominal: Array) -> tuple[Array, Array]:
        """Errors (N, 3), m, and their derivatives (N, 3, 3) by the nominal position (m/m) or (N, 3, m) by the angles.

        Args:
            angles: (N, m) rad.
            nominal: (N, 3) nominal tool points in the base frame, m.
        """
        cartesian = self.space == "cartesian"
        inputs = nominal * 1e3 if cartesian else angles
        # the blend's own slope is left out: models of neighbouring regions nearly agree where they are blended
        coefficients = np.einsum("nr,rat->nat", weights(self.cut, inputs), self.coefficients)
        error = np.einsum("nat,nt->na", coefficients, self.features.matrix(inputs)) * 1e-3
        slope = np.einsum("nat,ntk->nak", coefficients, self.features.slopes(inputs))
        return error, slope if cartesian else slope * 1e-3


def error_model(arm: Arm, fit: Fit, angles: Array, seed: int | None = None, base: Base | None = None) -> ErrorModel:
    """A fit of `armscope.errormodels` as a model to compensate with.

    Args:
        arm: the nominal arm.
        fit: fitted to x, y and z.
        angles: (M, m) its identification rows, rad.
        seed: whose swarm; None takes, per axis, the one with the smallest residual; -1 the least-squares fit.
        base: measurement frame from base frame; None: they are the same.
    """
    axes = np.arange(len(fit.axes))
    if seed == -1:
        chosen, rms, method = fit.least_squares, fit.least_squares_mm, "least squares"
    else:
        number = fit.best_seeds if seed is None else np.full(len(axes), fit.seeds.index(seed))
        chosen, rms, method = fit.coefficients[number, axes], fit.fitness_mm[number, axes], fit.method
    domain = domain_of(arm, fit.features.spec, angles)
    return ErrorModel(arm, fit.features, chosen[None], method, rms, base or _same_frame(), domain)


def fit_error_model(
    arm: Arm,
    recordings: Recordings,
    spec: ModelSpec,
    method: str = "least squares",
    seed: int = 0,
    register: bool = False,
    regions: int | None = 1,
    products: bool = False,
) -> ErrorModel:
    """Fit one of the paper's models to recordings.

    Args:
        arm: the nominal arm.
        recordings: measured points.
        spec: which model.
        method: "least squares" or "swarm".
        seed: of the swarm.
        register: fit the measurement frame and the tool offset with the nominal arm first; without, the measurements
            must stand in the arm's base frame, as in the paper, and the model holds the frames' errors, too.
        regions: 1, 2, 4, ... models blended across the workspace, by least squares; None lets cross-validation choose.
        products: choose sparsely among products of the inputs' terms, by least squares, in one region.

    Raises:
        InputError: too few rows; several runs or targets; measurements that stand in another frame.
    """
    _check_one_setup(recordings)
    count = spec.features(_inputs(arm, spec, recordings.motor_angles)).coefficients_per_axis
    if len(recordings) <= count:
        raise InputError(
            recordings.source, "", f"{len(recordings)} rows", f"{spec.name} has {count} terms: more rows are needed"
        )
    base = _same_frame()
    if register:
        arm, base = register_frames(arm, recordings)
    nominal = chain(arm, recordings.motor_angles).tool
    errors = ((recordings.positions - base.translation) @ base.rotation - nominal) * 1e3
    rms = float(np.sqrt(np.mean(errors**2)))
    if not register and rms > LARGEST_PLAIN_ERROR_MM:
        raise InputError(
            recordings.source,
            "x_mm, y_mm, z_mm",
            f"{rms:.0f} mm RMS from the nominal arm",
            f"errors are differences in the arm's base frame, below {LARGEST_PLAIN_ERROR_MM:.0f} mm",
            "Use --register to fit the measurement frame and the tool offset first.",
        )
    inputs = _inputs(arm, spec, recordings.motor_angles)
    if method == "swarm":
        fit = fit_swarms([FitProblem(spec, inputs, errors, arm.name)], [seed])[0]
        return error_model(arm, fit, recordings.motor_angles, seed, base)
    features = spec.features(inputs)
    domain = domain_of(arm, spec, recordings.motor_angles)
    if products:
        chosen, coefficients, _ = fit_products(spec, inputs, errors, np.random.default_rng(seed))
        rms_mm = np.sqrt(np.mean((errors - chosen.matrix(inputs) @ coefficients.T) ** 2, axis=0))
        return ErrorModel(arm, chosen, coefficients[None], "least squares", rms_mm, base, domain)
    if regions is None:
        regions = chosen_regions(compare_regions(spec, inputs, errors, np.random.default_rng(seed)))
    if regions == 1:
        coefficients, rms_mm = fit_least_squares(features, inputs, errors)
        return ErrorModel(arm, features, coefficients[None], "least squares", rms_mm, base, domain)
    try:
        cut = divide(inputs, halvings_of(regions))
        by_region = fit_regions(features, cut, inputs, errors)
    except ValueError as error:
        raise InputError(recordings.source, "regions", regions, str(error), "Use fewer regions.") from error
    left = errors - blended(features, cut, by_region, inputs)
    rms_mm = np.sqrt(np.mean(left**2, axis=0))
    return ErrorModel(arm, features, by_region, "least squares", rms_mm, base, domain, cut)


def domain_of(arm: Arm, spec: ModelSpec, angles: Array) -> Domain:
    """Where a black-box model holds: the range of its own inputs, and motors that stood still stay where they were."""
    names = [f"q{motor}" for motor in range(1, arm.n_motors + 1)]
    if spec.space == "angular":
        return Domain.of(angles, names, ["rad"] * len(names))
    still = np.flatnonzero(np.ptp(angles, axis=0) <= 0.02)
    inputs = np.column_stack([chain(arm, angles).tool * 1e3, angles[:, still]])
    return Domain.of(inputs, ["x", "y", "z", *(names[j] for j in still)], ["mm"] * 3 + ["rad"] * len(still))


def domain_inputs(model: ErrorModel, angles: Array) -> Array:
    """(N, k) the inputs of a model's domain at motor angles (N, m)."""
    by_name = {f"q{motor}": values for motor, values in enumerate(angles.T, start=1)}
    by_name |= dict(zip("xyz", chain(model.arm, angles).tool.T * 1e3, strict=True))
    return np.column_stack([by_name[name] for name in model.domain.names])


def register_frames(arm: Arm, recordings: Recordings) -> tuple[Arm, Base]:
    """The measurement frame and the tool offset that suit the nominal arm best (least squares, 9 numbers).

    Returns:
        The arm with that tool offset, and measurement frame from base frame.
    """
    frames = chain(arm, recordings.motor_angles)
    last = frames.tool - frames.tool_rotation @ arm.tool
    tool, measured = arm.tool.copy(), recordings.positions
    rotation = _aligned(measured, frames.tool)
    translation = np.zeros(3)
    for _ in range(100):
        points = last + frames.tool_rotation @ tool
        turned = points @ rotation.T
        turning = np.swapaxes(np.cross(np.eye(3)[None], turned[:, None, :]), 1, 2)
        shifting = np.broadcast_to(np.eye(3), turning.shape)
        columns = np.concatenate([turning, shifting, rotation @ frames.tool_rotation], axis=2)
        gap = measured - turned - translation
        step = np.linalg.lstsq(columns.reshape(-1, 9), gap.reshape(-1), rcond=1e-10)[0]
        rotation = Rotation.from_rotvec(step[:3]).as_matrix() @ rotation
        translation, tool = translation + step[3:6], tool + step[6:]
        if np.abs(step).max() < 1e-12:
            break
    description = arm.description.model_copy(update={"tool_mm": tuple(float(value) for value in tool * 1e3)})
    return build_arm(description), Base(rotation, translation)


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
            "base": {"rotation": model.base.rotation, "translation_m": model.base.translation},
            "domain": model.domain.to_dict(),
        },
    )


def load_error_model(path: Path | str) -> ErrorModel:
    """Read errormodel.json.

    Raises:
        InputError: it is no model of this format.
    """
    content = read_json(path, "an error model")
    found = content.get("format", "no key format") if isinstance(content, dict) else "no mapping"
    if found != FORMAT:
        cure = "`armscope fit-error-model` writes one."
        raise InputError(path, "format", found, f"an error model says {FORMAT!r}", cure)
    try:
        return _from_content(content, path)
    except KeyError as error:
        raise InputError(path, str(error.args[0]), "nothing", "this key is missing", "Was the file edited?") from error
    except InputError:
        raise
    except (ValueError, TypeError) as error:
        raise InputError(path, "", str(error), "this must hold a fitted model", "Was the file edited?") from error


def _from_content(content: dict[str, Any], path: Path | str) -> ErrorModel:
    kind = ProductFeatures if "products" in content["features"] else FeatureSet
    features = kind.from_dict(content["features"])
    coefficients = np.array(content["coefficients"], dtype=float)
    cut = Cut.from_dict(content["regions"])
    regions = weights(cut, np.zeros((1, len(features.inputs)))).shape[1]
    if coefficients.shape != (regions, 3, features.coefficients_per_axis) or not np.isfinite(coefficients).all():
        expected = f"{features.spec.name} has {regions} x 3 x {features.coefficients_per_axis} finite numbers"
        raise InputError(path, "coefficients", f"shape {coefficients.shape}", expected, "Was the file edited?")
    base = content["base"]
    return ErrorModel(
        build_arm(validate(RobotDescription, content["robot"], path)),
        features,
        coefficients,
        content["method"],
        np.array(content["rms_mm"], dtype=float),
        Base(np.array(base["rotation"], dtype=float), np.array(base["translation_m"], dtype=float)),
        Domain.from_dict(content["domain"]),
        cut,
    )


def _inputs(arm: Arm, spec: ModelSpec, angles: Array) -> Array:
    return chain(arm, angles).tool * 1e3 if spec.space == "cartesian" else angles


def _check_one_setup(recordings: Recordings) -> None:
    for column, values in (("run", recordings.run), ("target", recordings.target)):
        known = np.unique(values)
        if len(known) > 1:
            raise InputError(
                recordings.source,
                f"column {column}",
                ", ".join(map(str, known[:5])),
                f"a black-box model is fitted to one {column}: it has one set of frames",
                f"Choose one with --{column}.",
            )


def _same_frame() -> Base:
    return Base(np.eye(3), np.zeros(3))


def _aligned(measured: Array, points: Array) -> Array:
    """The rotation that turns points into measured ones best, both about their middle."""
    turn, _ = Rotation.align_vectors(measured - measured.mean(axis=0), points - points.mean(axis=0))
    matrix: Array = turn.as_matrix()
    return matrix
