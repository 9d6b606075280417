"""Arms with known errors: a black-box model planted on the SK120, and physics planted on a six-axis arm."""

import functools
from dataclasses import replace

import numpy as np
import pandas as pd

from armscope.compensation.black_box import error_model
from armscope.compensation.physical import Identified, identified_on
from armscope.errormodels.features import SDP_AI, SDP_CI, ModelSpec
from armscope.errormodels.swarm_fit import FitProblem, fit_swarms
from armscope.physics.effect import Part
from armscope.physics.frames import free_frames
from armscope.physics.model import Base, FittedModel
from armscope.physics.registry import library
from armscope.robot import chain, load_arm
from armscope.swarm.settings import SwarmSettings
from tests.physics.scenes import arm_named, full_table
from tests.robot.arms import SK120

HALF = np.array([0.5, 0.4, 0.5, 0.0, 0.0, 1.0])
MIDDLE = np.array([0.1, 0.2, 0.3, 0.0, 0.0, 0.0])


@functools.cache
def sk120():
    return load_arm(SK120)


def identification_angles(count=150, seed=3):
    return MIDDLE + HALF * np.random.default_rng(seed).uniform(-1, 1, (count, 6))


@functools.cache
def black_box(space: str = "cartesian"):
    """An SDP whose errors are a few mm, fitted to rows that it describes exactly."""
    spec: ModelSpec = SDP_CI if space == "cartesian" else SDP_AI
    arm, angles = sk120(), identification_angles()
    nominal = chain(arm, angles).tool * 1e3
    inputs = nominal if space == "cartesian" else angles
    terms = spec.features(inputs).matrix(inputs)
    rng = np.random.default_rng(8)
    errors = (terms / np.abs(terms).max(axis=0)) @ rng.normal(0, 2.0, (terms.shape[1], 3))
    fit = fit_swarms([FitProblem(spec, inputs, errors)], [0], SwarmSettings(iterations=3))[0]
    return error_model(arm, fit, angles, seed=-1)


def wanted_points(count=60, radius=0.1):
    """A closed curve in the middle of the identification rows, m."""
    centre = chain(sk120(), MIDDLE[None]).tool[0]
    phi = np.linspace(0, 2 * np.pi, count)
    return centre + radius * np.column_stack([np.cos(phi), np.sin(phi), 0.5 * np.sin(2 * phi)])


def table_of(points, **more):
    return pd.DataFrame(points * 1e3, columns=["x_mm", "y_mm", "z_mm"]).assign(**more)


@functools.cache
def physical() -> tuple[FittedModel, Identified]:
    """A six-axis arm with offset, compliance and warmth planted, far from the tracker; and its identification rows."""
    arm = arm_named("six-axis")
    rows = full_table(arm, 200, 5)
    rows = replace(rows, run=np.full(200, "monday"), target=np.full(200, "ball"))
    wanted = {
        ("joint_offset", "joint 3"): 8e-4,
        ("joint_compliance", "joint 2"): 2e-6,
        ("thermal_expansion", "link 2"): 5e-5,
    }
    parts = []
    for key, value in wanted.items():
        placed = next(p for p in library(arm, rows) if p.key == key)
        parts.append(Part(placed, np.full(len(placed.terms), value)))
    tool = next(p for p in free_frames(rows, False) if p.name == "tool_frame")
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    base = Base(turn, np.array([3.0, -2.0, 0.5]))
    model = FittedModel(arm, {"monday": base}, (Part(tool, np.array([1e-3, -2e-3, 5e-4])),), tuple(parts))
    return model, identified_on(arm, rows)


def physical_path(count=40, radius=0.08):
    """(N, 3) points in the base frame, m, and the motor angles in their middle."""
    model, identified = physical()
    middle = identified.domain.mean[:6] + np.array([0, 0, 0, 0, 0.5, 0])
    centre = chain(model.arm, middle[None]).tool[0]
    phi = np.linspace(0, 2 * np.pi, count)
    points = centre + radius * np.column_stack([np.cos(phi) - 1, np.sin(phi), 0.4 * np.sin(2 * phi)])
    return points, middle


CONTEXT = {"payload_kg": 5.0, "temperature_c": 24.0}
