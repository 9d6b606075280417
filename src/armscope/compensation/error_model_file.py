"""errormodel.json: a fitted black-box model as a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from armscope.compensation.black_box import ErrorModel, Turning
from armscope.compensation.domain import Domain
from armscope.compensation.file_contents import ErrorModelContent, ProductsContent, SumsContent, TurningContent
from armscope.core.files import read_json, write_json
from armscope.core.inputs import InputError, format_of, nearest, validate
from armscope.core.types import Array
from armscope.errormodels.features import FeatureSet
from armscope.errormodels.products import ProductFeatures
from armscope.errormodels.regions import Cut, weights
from armscope.physics.model import Base
from armscope.robot import Arm
from armscope.robot.arm import build_arm

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
