"""False targets: commands under which the real arm reaches the wanted points, by either kind of error model.

What is used is imported when it is first asked for: a diagnosis needs `armscope.compensation.physical` alone.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.compensation.black_box import ErrorModel, Turning, error_model
    from armscope.compensation.compensate import Options, compensate_black_box, compensate_physical
    from armscope.compensation.domain import Domain
    from armscope.compensation.error_model_file import load_error_model, save_error_model
    from armscope.compensation.fitting import fit_error_model
    from armscope.compensation.path import WantedPath, as_path, read_path
    from armscope.compensation.physical import Identified, identified_on, load_identified, save_identified
    from armscope.compensation.result import Compensated

__all__ = [
    "Compensated",
    "Domain",
    "ErrorModel",
    "Identified",
    "Options",
    "Turning",
    "WantedPath",
    "as_path",
    "compensate_black_box",
    "compensate_physical",
    "error_model",
    "fit_error_model",
    "identified_on",
    "load_error_model",
    "load_identified",
    "read_path",
    "save_error_model",
    "save_identified",
]

_HOME = {
    "Compensated": "result",
    "Domain": "domain",
    "ErrorModel": "black_box",
    "Identified": "physical",
    "Options": "compensate",
    "Turning": "black_box",
    "WantedPath": "path",
    "as_path": "path",
    "compensate_black_box": "compensate",
    "compensate_physical": "compensate",
    "error_model": "black_box",
    "fit_error_model": "fitting",
    "identified_on": "physical",
    "load_error_model": "error_model_file",
    "load_identified": "physical",
    "read_path": "path",
    "save_error_model": "error_model_file",
    "save_identified": "physical",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
