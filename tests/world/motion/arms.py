"""The arms of the moving worlds, and a motion to try them on."""

from pathlib import Path

import numpy as np

from armscope.design.fourier import Limits, random_path
from armscope.robot.description_file import load_description
from armscope.world.layout import Geometry
from armscope.world.motion.mechanism import stated_dynamics

FOLDER = Path(__file__).parents[3] / "config" / "motion"
NAMES = ("two-axis", "six-axis", "seven-axis")


def arm(name):
    description = load_description(FOLDER / f"{name}.yaml")
    return description, Geometry(description), stated_dynamics(description)


def limits_of(description):
    return Limits(
        np.radians(description.joint_limits_deg),
        np.radians([drive.speed_deg_s for drive in description.drives]),
        np.radians([drive.acceleration_deg_s2 for drive in description.drives]),
    )


def motion(description, seed=0, count=200, period=10.0):
    path = random_path(limits_of(description), 5, period, np.random.default_rng(seed))
    return path.at(np.linspace(0, period, count, endpoint=False))
