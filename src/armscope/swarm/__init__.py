"""Particle swarm optimisation: the paper's method, in NumPy for any objective and compiled for least squares."""
