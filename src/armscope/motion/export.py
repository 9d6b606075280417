"""A fitted model as files for simulators: a URDF with corrected inertias, damping, friction; MuJoCo's joints; a table.

What these formats have no place for (springs, cables, load friction, delays, offsets, gains) is named in the files.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.core.files import write_table, write_text
from armscope.core.types import Array
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.layout import OWN
from armscope.motion.library.remedies_of_curves import CURVES
from armscope.motion.model.curve_table import curve_table
from armscope.motion.model.file import save_motion_model
from armscope.motion.model.fitted import MotionModel
from armscope.motion.mujoco_model import mujoco_model
from armscope.motion.pipeline import MotionDiagnosis
from armscope.motion.simulated_bodies import (
    as_comment,
    bodies,
    joint_numbers,
    not_in_a_file,
    one_to_one,
    stated_payloads,
)
from armscope.motion.verdict import write_motion_verdict
from armscope.robot.dynamics import PARAMETERS, UNITS, MovingArm
from armscope.robot.model import TIP
from armscope.robot.urdf import held_joints
from armscope.robot.urdf_file import root_of
from armscope.robot.urdf_writing import (
    WrittenJoint,
    chain_urdf,
    fix_joint,
    keep_meshes,
    set_inertial,
    urdf_text,
    what_drives_can,
)
from armscope.verdict.files import atlas_table

URDF, MUJOCO, TABLE = "corrected.urdf", "mujoco.xml", "parameters.csv"
FILES = (URDF, MUJOCO, TABLE)

WRITTEN = (
    "armscope: inertias, damping and friction as fitted, a tool load in the last link; rotors' inertia stands in "
    "mujoco.xml (armature)"
)


def write_motion(found: MotionDiagnosis, folder: Path | str) -> None:
    """Write all but the page: verdict.json, model.yaml, atlas.csv, curves.csv, and what `export_motion` writes.

    Args:
        found: the diagnosis.
        folder: where to.
    """
    write_motion_verdict(found.verdict, folder)
    save_motion_model(Path(folder) / "model.yaml", found.model)
    write_table(Path(folder) / "atlas.csv", atlas_table(found.atlas))
    write_table(Path(folder) / CURVES, curve_table(found.model))
    export_motion(found.model, found.selected, found.sure.factor, folder)


def export_motion(model: MotionModel, selected: SelectedCauses, factor: Array, folder: Path | str) -> None:
    """Write ``corrected.urdf``, ``mujoco.xml`` and ``parameters.csv``.

    Args:
        model: the fitted model.
        selected: the selection that it is of, for standard errors.
        factor: (p,) on each of these, see `intervals`.
        folder: where to.
    """
    folder = Path(folder)
    payloads = stated_payloads(selected)
    write_text(folder / URDF, corrected_urdf(model, folder, payloads))
    write_text(folder / MUJOCO, mujoco_model(model, payloads))
    write_table(folder / TABLE, parameter_table(model, selected, factor))


def corrected_urdf(model: MotionModel, folder: Path, payloads: Sequence[float] = ()) -> str:
    """The arm as a URDF: an arm that came from one keeps its links, meshes and names; others get their chain alone.

    Args:
        model: the model.
        folder: where the file will stand, for paths of meshes.
        payloads: kg, that the model's samples state, see `bodies`.

    Returns:
        The file's text; a comment names what it has no place for.
    """
    source = model.arm.description.urdf
    robot = _fresh(model.arm) if source is None else _kept(Path(source), model.arm, folder)
    made, notes = bodies(model, payloads)
    numbers, also = joint_numbers(model)
    joints = {element.get("name"): element for element in robot.findall("joint")}
    links = {element.get("name"): element for element in robot.findall("link")}
    for name, body, (dry, damping, _) in zip(model.arm.joint_names, made, numbers, strict=True):
        child = joints[name].find("child")
        assert child is not None
        set_inertial(links[child.get("link")], body.mass, body.lever, body.inertia)
        for old in joints[name].findall("dynamics"):
            joints[name].remove(old)
        ET.SubElement(joints[name], "dynamics", damping=repr(float(damping)), friction=repr(float(dry)))
    left = not_in_a_file(model)
    told = [WRITTEN, *notes, *also, *([f"not in this file: {'; '.join(left)}"] if left else [])]
    robot.insert(0, ET.Comment(as_comment(told)))
    return urdf_text(robot)


def parameter_table(model: MotionModel, selected: SelectedCauses, factor: Array) -> pd.DataFrame:
    """Regressor parameters: of every link the ten inertial ones, of every motor friction and rotor, SI.

    Args:
        model: the model.
        selected: the selection that it is of.
        factor: (p,) on the standard error of each column, see `intervals`.

    Returns:
        Columns place, parameter, unit, stated, fitted, stderr. Standard errors hold the priors, too: where they are as
        large as what a drawing leaves open, the motion does not tell the number by itself.
    """
    arm, layout = model.arm, selected.rows.layout
    columns = selected.best.columns
    covariance = selected.best.covariance(columns) / np.outer(*[selected.problem.scale[columns] / factor[columns]] * 2)
    of_links, of_joints = np.zeros((len(arm.inertial), layout.width)), np.zeros((OWN * arm.n_motors, layout.width))
    of_links[:, layout.inertial] = np.diag(layout.inertial_scale)
    for number, cause in enumerate(layout.placed):
        if cause.inertial is not None and not cause.runs:
            of_links[:, layout.columns[number]] = cause.inertial
    of_joints[:, layout.own] = np.eye(OWN * arm.n_motors)
    errors = [np.sqrt(np.maximum(np.einsum("ip,pq,iq->i", each[:, columns], covariance, each[:, columns]), 0.0))
              for each in (of_links, of_joints)]  # fmt: skip
    fitted = model.followed().inertial
    rows: list[tuple[str, str, str, float, float, float]] = [
        (f"link {n // 10 + 1}", PARAMETERS[n % 10], UNITS[n % 10], arm.inertial[n], fitted[n], errors[0][n])
        for n in range(len(fitted))
    ]
    for j in range(arm.n_motors):
        torque, turn, inertia = ("N", "m", "kg") if arm.sliding[j] else ("N m", "rad", "kg m^2")
        units = (torque, torque, f"{torque} s/{turn}", inertia)
        for k, name in enumerate(("offset", "coulomb", "viscous", "inertia")):
            stated, error = float(arm.stated_background[j, k]), errors[1][OWN * j + k]
            rows.append((f"joint {j + 1}", name, units[k], stated, float(model.joints[j, k]), error))
    return pd.DataFrame(rows, columns=["place", "parameter", "unit", "stated", "fitted", "stderr"])


def _fresh(arm: MovingArm) -> ET.Element:
    """The chain of a D-H arm."""
    limits = arm.description.joint_limits_deg if one_to_one(arm) else None  # they are the motors'
    within = None if limits is None else np.sort(np.radians(limits) * np.diag(arm.actuation)[:, None], axis=1)
    drives = (what_drives_can(arm.description) if one_to_one(arm) else []) or [{}] * arm.n_links
    joints = []
    for n, name in enumerate(arm.joint_names):
        placement, limit = arm.model.jointPlacements[n + 1].homogeneous, None if within is None else tuple(within[n])
        joints.append(WrittenJoint(name, placement, limit, **drives[n]))
    tip = arm.model.frames[arm.model.getFrameId(TIP)]
    return chain_urdf(arm.name, joints, "flange", tip.placement.homogeneous)


def _kept(source: Path, arm: MovingArm, folder: Path) -> ET.Element:
    """The arm's own URDF: joints outside its chain fixed where they are held, what they carry part of its moving link.

    A gripper's fingers without mass that slide freely could not be simulated.
    """
    robot = root_of(str(source))
    keep_meshes(robot, source, folder)
    moving = set(arm.joint_names)
    held = held_joints(arm.description)
    for each in robot.findall("joint"):
        if each.get("name") in held:
            fix_joint(each, held[str(each.get("name"))])
    children = {child.get("link"): joint for joint in robot.findall("joint") for child in joint.findall("child")}
    for link in robot.findall("link"):
        joint = children.get(link.get("name"))
        if joint is not None and joint.get("name") not in moving and _hangs_on(joint, children, moving):
            for inertial in link.findall("inertial"):
                link.remove(inertial)
    return robot


def _hangs_on(joint: ET.Element | None, children: dict[str | None, ET.Element], moving: set[str]) -> bool:
    """Whether a moving joint of the chain carries this one."""
    while joint is not None:
        if joint.get("name") in moving:
            return True
        parent = joint.find("parent")
        joint = None if parent is None else children.get(parent.get("link"))
    return False
