"""Fitting a black-box model to recordings: frames where asked, then the errors of position and orientation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.compensation.black_box import ErrorModel, Turning, domain_of
from armscope.compensation.constants import REFUSED
from armscope.core.averages import rms, rms_distance
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.errormodels.features import FeatureSet, ModelSpec, fit_least_squares
from armscope.errormodels.products import ProductFeatures, fit_products
from armscope.errormodels.regions import Cut, blended, chosen_regions, compare_regions, divide, fit_regions, halvings_of
from armscope.errormodels.swarm_fit import FitProblem, fit_swarms
from armscope.fitting.constants import STEPS
from armscope.fitting.placement import FlangePoses, all_alike, place_frames
from armscope.physics.model import Base
from armscope.recordings import Recordings, numbered_points
from armscope.robot import Arm, chain
from armscope.robot.arm import build_arm


# so many parameters: each is a choice of its own that a user makes by name, and nearly all have a default
def fit_error_model(
    arm: Arm,
    recordings: Recordings,
    spec: ModelSpec,
    method: str = "least squares",
    seed: int = 0,
    register: bool = False,
    regions: int | None = 1,
    products: bool = False,
    orientation: bool = True,
) -> ErrorModel:
    """Fit one of the paper's models to recordings: of the position, and of the orientation where that was measured.

    Args:
        arm: the nominal arm.
        recordings: measured points.
        spec: which model.
        method: "least squares" or "swarm".
        seed: of the swarm.
        register: fit the measurement frame and the tool (offset and turn) with the nominal arm first; without, the
            measurements must stand in the arm's base frame, as in the paper, and the model holds the frames' errors.
        regions: 1, 2, 4, ... models blended across the workspace, by least squares; None lets cross-validation choose
            by the positions.
        products: choose sparsely among products of the inputs' terms, by least squares, in one region.
        orientation: whether measured orientations are fitted.

    Returns:
        The fitted model with its RMS residuals and the range in which it holds.

    Raises:
        InputError: too few rows; several runs or targets; measurements that stand in another frame.
    """
    _check_one_setup(recordings)
    how = _How(spec, method, seed, regions, products)
    _check_rows(how, arm, recordings)
    base = Base(np.eye(3), np.zeros(3))
    if register:
        arm, base = _register_frames(arm, recordings)
    frames = chain(arm, recordings.motor_angles)
    errors = ((recordings.positions - base.translation) @ base.rotation - frames.tool) * 1e3
    off = rms(errors)
    if not register and off > REFUSED.error_mm:
        raise InputError(
            recordings.source,
            "x_mm, y_mm, z_mm",
            f"{off:.0f} mm RMS from the nominal arm",
            f"errors are differences in the arm's base frame, below {REFUSED.error_mm:.0f} mm",
            "Use --register to fit the measurement frame and the tool offset first.",
        )
    inputs = _inputs(arm, spec, recordings.motor_angles)
    try:
        cut = how.cut(inputs, errors)
        fitted = how.fit(inputs, errors, cut, arm.name)
    except ValueError as error:
        raise InputError(recordings.source, "regions", regions, str(error), "Use fewer regions.") from error
    domain = domain_of(arm, spec, recordings.motor_angles)
    turning = _turning(how, cut, arm, recordings, base, register) if orientation else None
    return ErrorModel(arm, fitted.features, fitted.coefficients, method, fitted.rms, base, domain, cut, turning)


@dataclass(frozen=True, eq=False)
class _Fitted:
    """Terms fitted to three axes: coefficients (regions, 3, n), residual RMS (3,)."""

    features: FeatureSet | ProductFeatures
    coefficients: Array
    rms: Array


@dataclass(frozen=True)
class _How:
    """How three axes are fitted; see `fit_error_model`."""

    spec: ModelSpec
    method: str
    seed: int
    regions: int | None
    products: bool

    def cut(self, inputs: Array, errors: Array) -> Cut | None:
        """The borders of the regions; their number by cross-validation where that was left open."""
        count = self.regions
        if count is None:
            compared = compare_regions(self.spec, inputs, errors, np.random.default_rng(self.seed))
            count = chosen_regions(compared)
        return divide(inputs, halvings_of(count))

    def fit(self, inputs: Array, errors: Array, cut: Cut | None, label: str) -> _Fitted:
        """Fit errors (M, 3) within the borders of the regions. Raises ValueError: a region with too few rows."""
        features = self.spec.features(inputs)
        if self.method == "swarm":
            fit = fit_swarms([FitProblem(self.spec, inputs, errors, label)], [self.seed])[0]
            return _Fitted(fit.features, fit.coefficients, fit.fitness_mm[0])
        if self.products:
            chosen, coefficients, _ = fit_products(self.spec, inputs, errors, np.random.default_rng(self.seed))
            return _Fitted(chosen, coefficients[None], _rms(errors - chosen.matrix(inputs) @ coefficients.T))
        if cut is None:
            coefficients, rms = fit_least_squares(features, inputs, errors)
            return _Fitted(features, coefficients[None], rms)
        by_region = fit_regions(features, cut, inputs, errors)
        return _Fitted(features, by_region, _rms(errors - blended(features, cut, by_region, inputs)))


def _rms(left: Array) -> Array:
    """(3,) over the rows."""
    return np.asarray(np.sqrt(np.mean(left**2, axis=0)), dtype=float)


def _turning(
    how: _How, cut: Cut | None, arm: Arm, recordings: Recordings, base: Base, register: bool
) -> Turning | None:
    """The same terms fitted to the orientation's errors; None where none were measured."""
    rows = recordings.rows(recordings.oriented)
    if not len(rows):
        return None
    _check_rows(how, arm, rows, "rows with an orientation")
    turns, tool = _turning_errors(arm, rows, base, register)
    fitted = how.fit(_inputs(arm, how.spec, rows.motor_angles), turns * 1e3, cut, arm.name)
    return Turning(fitted.features, fitted.coefficients, fitted.rms, tool)


def _turning_errors(arm: Arm, rows: Recordings, base: Base, register: bool) -> tuple[Array, Array]:
    """Rotation vectors r (N, 3), rad, measured = exp(r) * nominal in base axes; tool from last frame (3, 3)."""
    measured = Rotation.from_quat(rows.quaternions, scalar_first=True).as_matrix()
    nominal = chain(arm, rows.motor_angles).tool_rotation
    in_base = base.rotation.T @ measured
    tool = np.eye(3)
    if register:
        tool = Rotation.from_matrix(np.swapaxes(nominal, 1, 2) @ in_base).mean().as_matrix()
    turns = Rotation.from_matrix(in_base @ tool.T @ np.swapaxes(nominal, 1, 2)).as_rotvec()
    off = rms_distance(turns)
    if off > REFUSED.turn_rad:
        raise InputError(
            rows.source,
            "qw, qx, qy, qz",
            f"{np.degrees(off):.0f} degrees RMS from the nominal arm",
            f"errors of the orientation are below {np.degrees(REFUSED.turn_rad):.0f} degrees",
            "Is it the order wxyz, measurement frame from tool frame? "
            + ("--no-orientation leaves them out." if register else "--register fits the tool's own turn."),
        )
    return turns, np.asarray(tool, dtype=float)


def _register_frames(arm: Arm, recordings: Recordings) -> tuple[Arm, Base]:
    """The arm with the tool offset, and the measurement frame, that suit it best (least squares, 9 numbers)."""
    frames, one = chain(arm, recordings.motor_angles), np.zeros(len(recordings), dtype=np.intp)
    flange = frames.tool - frames.tool_rotation @ arm.tool
    poses = FlangePoses(flange, frames.tool_rotation, recordings.positions, base=one, tool=one)
    stated = arm.tool[None]
    placed = place_frames(poses, poses.start(stated, 1), STEPS.registration, all_alike, stated).state
    description = arm.description.model_copy(update={"tool_mm": tuple((placed.tools[0] * 1e3).tolist())})
    return build_arm(description), Base(placed.rotations[0], placed.translations[0])


def left_by_frames_alone(arm: Arm, recordings: Recordings) -> float:
    """RMS distance, mm, that base and tool alone leave, fitted to rows of one run and target: no model may be worse."""
    registered, base = _register_frames(arm, recordings)
    points = (recordings.positions - base.translation) @ base.rotation
    return rms_distance(points - chain(registered, recordings.motor_angles).tool) * 1e3


def _inputs(arm: Arm, spec: ModelSpec, angles: Array) -> Array:
    return chain(arm, angles).tool * 1e3 if spec.space == "cartesian" else angles


def _check_rows(how: _How, arm: Arm, recordings: Recordings, what: str = "rows") -> None:
    count = how.spec.features(_inputs(arm, how.spec, recordings.motor_angles)).coefficients_per_axis
    if len(recordings) <= count:
        raise InputError(
            recordings.source, "", f"{len(recordings)} {what}", f"{how.spec.name} has {count} terms: more are needed"
        )


def _check_one_setup(recordings: Recordings) -> None:
    for column, values in (("run", recordings.run), ("target", recordings.target)):
        known = np.unique(values)
        if len(known) > 1 and column == "target" and numbered_points.number_the_rows(values.tolist()):
            found = numbered_points.told_of_names(values.tolist())
            rule = "an error model is fitted to one target: each is another point of the tool"
            raise InputError(recordings.source, "column target", found, rule, numbered_points.CURE)
        if len(known) > 1:
            raise InputError(
                recordings.source,
                f"column {column}",
                ", ".join(map(str, known[: REFUSED.runs_named])),
                f"a black-box model is fitted to one {column}: it has one set of frames",
                f"Choose one with --{column}.",
            )
