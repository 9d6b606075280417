"""Plain geometric calibration: frames in closed form, identifiable constants, covariance, held-out numbers, export."""
