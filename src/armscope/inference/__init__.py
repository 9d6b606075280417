"""Linear-Gaussian model selection on normal equations; knows no robot."""
