"""errormodel.json: a fitted black-box model as a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from armscope.compensation.black_box import ErrorModel, Turning
from armscope.compensation.domain import Domain
from armscope.core.files import read_json, write_json
from armscope.core.inputs import InputError, validate
from armscope.core.types import Array
from armscope.errormodels import FeatureSet
from armscope.errormodels.products import ProductFeatures
from armscope.errormodels.regions import Cut, weights
from armscope.physics.model import Base
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription

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
    cut = Cut.from_dict(content["regions"])
    features, coefficients = _terms(content, cut, path)
    base, turning = content["base"], content.get("turning")
    return ErrorModel(
        build_arm(validate(RobotDescription, content["robot"], path)),
        features,
        coefficients,
        content["method"],
        np.array(content["rms_mm"], dtype=float),
        Base(np.array(base["rotation"], dtype=float), np.array(base["translation_m"], dtype=float)),
        Domain.from_dict(content["domain"]),
        cut,
        None if turning is None else _turning_in(turning, cut, path),
    )


def _turning_in(content: dict[str, Any], cut: Cut | None, path: Path | str) -> Turning:
    features, coefficients = _terms(content, cut, path)
    tool = np.array(content["tool"], dtype=float)
    return Turning(features, coefficients, np.array(content["rms_mrad"], dtype=float), tool)


def _terms(content: dict[str, Any], cut: Cut | None, path: Path | str) -> tuple[FeatureSet | ProductFeatures, Array]:
    kind = ProductFeatures if "products" in content["features"] else FeatureSet
    features: FeatureSet | ProductFeatures = kind.from_dict(content["features"])
    coefficients = np.array(content["coefficients"], dtype=float)
    regions = weights(cut, np.zeros((1, len(features.inputs)))).shape[1]
    if coefficients.shape != (regions, 3, features.coefficients_per_axis) or not np.isfinite(coefficients).all():
        expected = f"{features.spec.name} has {regions} x 3 x {features.coefficients_per_axis} finite numbers"
        raise InputError(path, "coefficients", f"shape {coefficients.shape}", expected, "Was the file edited?")
    return features, coefficients
