"""Measured arms with planted errors, for the tests of calibration."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.calibration.geometry import constants_of, corrected
from armscope.recordings import Recordings, as_recordings
from armscope.robot import chain
from tests.robot.arms import dh_arm

UR_LIKE = [
    (0, 90, 127.3, 0),
    (-612, 0, 0, 0),
    (-572.3, 0, 0, 0),
    (0, 90, 163.9, 0),
    (0, -90, 115.7, 0),
    (0, 0, 92.2, 0),
]


def poses(rng, n_poses, n_motors):
    return rng.uniform(-2.5, 2.5, (n_poses, n_motors))


def planted(arm, rng, length=1e-3, angle=2e-3):
    """The arm with every constant off by a tolerance."""
    constants = constants_of(arm)
    sizes = np.array([length if each.unit == "m" else angle for each in constants])
    return corrected(arm, constants, rng.normal(size=len(constants)) * sizes)


def far_away(rng):
    """A measurement frame metres away, turned anyhow."""
    return Rotation.random(rng=rng).as_matrix(), rng.uniform(-8, 8, 3)


def measured(arm, angles, base, tools, noise=0.0, rng=None, run="a") -> Recordings:
    """What an instrument would say of every tool (name: offset m) at every pose."""
    rotation, translation = base
    frames = chain(arm, angles)
    flange = frames.tool - np.einsum("nij,j->ni", frames.tool_rotation, arm.tool)
    rows = []
    for name, offset in tools.items():
        points = (flange + frames.tool_rotation @ np.asarray(offset)) @ rotation.T + translation
        if noise:
            points = points + rng.normal(scale=noise, size=points.shape)
        rows.append((name, points))
    return table(angles, rows, run)


def table(angles, rows, run) -> Recordings:
    import pandas as pd

    parts = []
    for name, points in rows:
        content = {"id": np.arange(1, len(angles) + 1).astype(str), "run": run, "target": name}
        content |= {f"q{j + 1}_rad": angles[:, j] for j in range(angles.shape[1])}
        content |= {f"{axis}_m": points[:, k] for k, axis in enumerate("xyz")}
        parts.append(pd.DataFrame(content))
    return as_recordings(pd.concat(parts, ignore_index=True))


def together(*parts: Recordings) -> Recordings:
    """Several runs as one table."""
    joined = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("motor_angles", "positions", "run", "target", "id")
    }
    return replace(parts[0], **joined)


def ur_like(**more):
    return dh_arm(UR_LIKE, **more)


def urdf_of_any_axes() -> str:
    """Six joints about axes that are not z, fixed links and a held joint between them, as URDFs from the field have."""
    rng = np.random.default_rng(0)
    parts, parent = ['<robot name="any"><link name="base"/>'], "base"

    def add(name, kind, axis=""):
        nonlocal parent
        xyz, rpy = (" ".join(map(repr, rng.uniform(-size, size, 3).tolist())) for size in (0.3, 3))
        limit = '<limit lower="-3" upper="3" effort="1" velocity="1"/>' if kind == "revolute" else ""
        parts.append(
            f'<link name="l_{name}"/><joint name="{name}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="l_{name}"/><origin xyz="{xyz}" rpy="{rpy}"/>{axis}{limit}</joint>'
        )
        parent = f"l_{name}"

    for joint, axis in enumerate(("0 1 0", "1 0 0", "0 -1 0", "0.6 0 0.8", "0 0 -1", ""), start=1):
        add(f"j{joint}", "revolute", f'<axis xyz="{axis}"/>' if axis else "")
        if joint in (2, 4):
            add(f"fixed{joint}", "fixed")
        if joint == 3:
            add("held", "revolute", '<axis xyz="0 1 0"/>')
    parts.append(f'<link name="flange"/><joint name="last" type="fixed"><parent link="{parent}"/>')
    parts.append('<child link="flange"/><origin xyz="0 0 0.1" rpy="0.1 0.2 0.3"/></joint></robot>')
    return "".join(parts)
