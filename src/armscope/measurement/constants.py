"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class NoiseRules(Constants):
    """When noise is called known, growing, or tied to the pose."""

    trusted: float = 0.97
    """part of a stated noise that is taken as its lower bound; judgement: this much below it is left to chance"""
    fewest_repeats: int = 6
    """beyond the first to poses, from which their scatter is taken for the noise [visits]; judgement: fewer give a
    scale that is wrong by a third; twice and half change no golden verdict"""
    repeats_trusted: float = 0.8
    """part of the scatter between repeats that is taken as the noise's lower bound; derived: the scatter of six
    repeats, 18 numbers, is known to a sixth; as much lower"""
    sure_nats: float = 3.0
    """evidence that noise grows with the distance, or stays with the pose, beyond what one number more costs [nats];
    convention: 20 to 1, ln 20; twice and half change no golden verdict"""


@dataclass(frozen=True)
class WeightRules(Constants):
    """Which rows count, and how much."""

    tuning_constant: float = 4.5
    """beyond which a row is weighted down [scales]; derived: one clean row in 6000 lies farther"""
    inlier_weight: float = 0.5
    """part of its clean weight below which a row does not count as a measurement; judgement: it then lies 5.4 scales
    off"""
    fewest_orientations: int = 15
    """fewer orientations are not used [rows]; judgement: the frames of the tools take up too much of what they tell"""
    least_freedom: float = 0.5
    """share of a channel's numbers that tell its noise, beside values of its own; derived: all rows have two numbers
    for each such value, some of the rows may have fewer"""


NOISE = NoiseRules()
WEIGHTS = WeightRules()
