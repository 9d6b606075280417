"""Particle swarm optimisation: the paper's method, in NumPy for any objective and compiled for least squares."""

from armscope.swarm.engine import Objective, minimise
from armscope.swarm.least_squares import LeastSquares, minimise_least_squares
from armscope.swarm.random_search import random_search
from armscope.swarm.result import StopReason, SwarmResult
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import spawn_generators
from armscope.swarm.update import PRESETS, Coefficients, UpdateRule, velocity_update

__all__ = [
    "PRESETS",
    "Coefficients",
    "LeastSquares",
    "Objective",
    "StopReason",
    "SwarmResult",
    "SwarmSettings",
    "UpdateRule",
    "minimise",
    "minimise_least_squares",
    "random_search",
    "spawn_generators",
    "velocity_update",
]
