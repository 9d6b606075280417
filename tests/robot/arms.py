"""Arms for the tests: one six-axis arm written in three forms, and random ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.robot.arm import Arm, build_arm
from armscope.robot.description import RobotDescription

CONFIG = Path(__file__).parents[2] / "config"
SK120 = CONFIG / "robots" / "sk120.yaml"

STANDARD = [
    (300, -90, 800, 0),
    (1150, 0, 0, -90),
    (250, -90, 0, 0),
    (0, 90, 1225, 0),
    (0, -90, 0, 0),
    (0, 0, 342.65, 0),
]
TOOL_MM = (205.32, 10.0, -20.0)


def dh_arm(rows, convention="standard", **more) -> Arm:
    joints = [dict(zip(("a_mm", "alpha_deg", "d_mm", "theta_offset_deg"), row, strict=True)) for row in rows]
    content = {"name": "test arm", "dh": {"convention": convention, "joints": joints}, **more}
    return build_arm(RobotDescription.model_validate(content))


def as_modified(rows):
    """The same chain in Craig's rows: (a, alpha) move to the next row; the last row's must be zero."""
    shifted = [(0.0, 0.0), *((a, alpha) for a, alpha, _, _ in rows[:-1])]
    return [(a, alpha, d, theta) for (a, alpha), (_, _, d, theta) in zip(shifted, rows, strict=True)]


def standard_transform(row, angle):
    """One row written out, as in Paul (1981), m."""
    a, alpha, d, theta = row[0] * 1e-3, np.radians(row[1]), row[2] * 1e-3, np.radians(row[3]) + angle
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]])


def as_urdf(rows) -> str:
    """The same chain as a URDF with joints about z: joint j's origin is what row j-1 puts behind its joint."""
    parts = ['<?xml version="1.0"?><robot name="test"><link name="base"/>']
    xyz, rpy, parent = "0 0 0", "0 0 0", "base"
    for number, (a, alpha, d, theta) in enumerate(rows, start=1):
        parts.append(
            f'<link name="l{number}"><inertial><mass value="{number}"/><origin xyz="0.1 0.02 0.{number}"/>'
            '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="j{number}" type="revolute"><parent link="{parent}"/><child link="l{number}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>'
            '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        )
        parent = f"l{number}"
        turn = Rotation.from_euler("z", theta, degrees=True) * Rotation.from_euler("x", alpha, degrees=True)
        shift = Rotation.from_euler("z", theta, degrees=True).apply([a, 0, d]) * 1e-3
        xyz = " ".join(repr(float(value)) for value in shift)
        rpy = " ".join(repr(float(value)) for value in turn.as_euler("xyz"))
    parts.append(
        f'<link name="flange"/><joint name="fixed" type="fixed"><parent link="{parent}"/><child link="flange"/>'
    )
    parts.append(f'<origin xyz="{xyz}" rpy="{rpy}"/></joint></robot>')
    return "".join(parts)


def random_rows(rng, n_joints):
    return [
        (
            rng.uniform(-500, 500),
            rng.choice([-90, 0, 90, rng.uniform(-180, 180)]),
            rng.uniform(-500, 500),
            rng.uniform(-180, 180),
        )
        for _ in range(n_joints)
    ]


def random_masses(rng, n_joints):
    return [
        {"mass_kg": float(rng.uniform(1, 50)), "com_mm": rng.uniform(-300, 300, 3).tolist()} for _ in range(n_joints)
    ]
