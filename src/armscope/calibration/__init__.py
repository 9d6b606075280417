"""Plain geometric calibration: frames in closed form, identifiable constants, covariance, held-out numbers, export."""

from armscope.calibration.calibrate import calibrate
from armscope.calibration.held_out import HeldOutLevel, held_out_levels
from armscope.calibration.result import Calibration
from armscope.calibration.solve import Priors

__all__ = ["Calibration", "HeldOutLevel", "Priors", "calibrate", "held_out_levels"]
