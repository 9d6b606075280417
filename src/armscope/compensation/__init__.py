"""False targets: commands under which the real arm reaches the wanted points, by either kind of error model."""

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
