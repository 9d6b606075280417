"""Numbers that decide which commands correct a path, and which are refused; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class CommandSearch(Constants):
    """How commands are found, and when a command is none; beside what holds of the nominal arm's angles, too."""

    steps: int = 30
    """of Newton's method [steps]; judgement: near its goal each step doubles the digits; more only circle"""
    step_rad: float = 0.3
    """of a motor in one step, at most [rad]; judgement: the nominal arm's solution is near"""
    lever: float = 0.25
    """share of the arm's reach by which a radian of the tool's turn counts as much as a metre; judgement: a wrist's
    length"""
    pole: float = 0.01
    """smallest singular value of the scaled Jacobian below which an arm is at a pole [m/rad]; derived: a wrist 0.8
    degrees from straight"""
    correction_rad: float = float(np.radians(3))
    """by which a command may differ from the nominal one [rad]; judgement: errors of millimetres never ask for more,
    unless the arm is close to a pole"""
    postures: int = 200
    """in which it is tried where an arm can be moved at all [postures]; judgement: far more than it has axes"""
    along_an_axis: float = 1e-3
    """of a direction's square that may lie beside an axis that it is named by; judgement: two degrees"""
    told_m: float = 1e-6
    """left where an arm can't be moved, from which on it is told [m]; judgement: no instrument sees less"""
    out_of_plane_m: float = 0.01
    """off the plane of an arm that can't be led out of it, beyond which a point is none of its own [m]; judgement: arms
    miss by millimetres"""
    rows_at_a_time: int = 5_000
    """whose frames, Jacobians and steps are held [rows]; derived: some fifty megabytes"""


@dataclass(frozen=True)
class BranchSearch(Constants):
    """How the nominal arm's angles along a path are found, and told where there are none."""

    points: int = 400
    """of a path that are solved one after the other, all others between them [points]; judgement: time"""
    poses: int = 100
    """the same of full poses [poses]; judgement: time; a step takes longer"""
    starts: int = 300
    """spread over the limits, for a full pose that is not met from where the arm is [poses]; judgement: time; such
    poses are few"""
    explained: int = 20
    """poses beyond reach that are tried so, to say why [poses]; judgement: time; the first tell why"""


@dataclass(frozen=True)
class IdentifiedRange(Constants):
    """How far beyond the recordings a fitted model is used."""

    allowed: float = 0.2
    """by which a point may lie outside in any case [standard deviations]; derived: 6 % of an evenly filled range, whose
    standard deviation is 1 / sqrt(12) of it"""
    alike: float = 0.95
    """share of rows recorded alike that shall be inside; judgement: one in twenty is worth a second look"""
    still_rad: float = 0.02
    """span of an angle that stands still [rad]; judgement: a degree"""
    still_mm: float = 5.0
    """the same of a coordinate [mm]; judgement: poses that fill a volume span a hundred times it"""
    still_kg: float = 0.1
    """the same of a payload [kg]; judgement: a screw or a cable"""
    still_k: float = 2.0
    """the same of a temperature [K]; judgement: a metre of aluminium grows by 0.05 mm"""
    time: float = 0.1
    """share of the recordings' time by which a row may come before or after; judgement: as a drift goes on"""
    rows_at_a_time: int = 50_000
    """whose extents in all directions are held [rows]; derived: some tens of megabytes"""
    neighbours: int = 2000
    """rows of a larger table, evenly spread, among which the nearest one is looked for [rows]; judgement: size of the
    file"""

    @property
    def still(self) -> dict[str, float]:
        """By unit."""
        return {"rad": self.still_rad, "mm": self.still_mm, "kg": self.still_kg, "degC": self.still_k}


@dataclass(frozen=True)
class RefusedTables(Constants):
    """Which tables are no path, or no recordings of an arm's errors."""

    error_mm: float = 50.0
    """RMS error beyond which the measurements stand in another frame than the arm's base [mm]; judgement: positioning
    errors are a tenth of it"""
    turn_rad: float = 0.1
    """RMS error of the orientation beyond which the measured tool frame is not the arm's last frame [rad]; judgement:
    six degrees; errors are a tenth of it"""
    far: float = 50.0
    """times the reach, farther than which the path's usual point is stated in a smaller unit; judgement: far from 1,
    where all paths are, and from 1000, where millimetres taken for metres are"""
    near: float = 200.0
    """times nearer than the reach, from which it is stated in a larger one; judgement: far from 1, and from 1000, where
    metres taken for millimetres are"""
    runs_named: int = 5
    """that are told by name where one is needed; judgement: as many are read"""
    columns_named: int = 6
    """of a table that is no path; judgement: as many are read"""


@dataclass(frozen=True)
class MomentFit(Constants):
    """How mass moments are fitted to recorded torques, where a model needs a path's torques."""

    rows: int = 20_000
    """on which they are fitted, spread evenly; as many are computed at a time [rows]; judgement: a hundred for each"""
    unseen: float = 1e-8
    """share of the largest singular value, below which moments are not told; derived: far above rounding"""


@dataclass(frozen=True)
class RapidFile(Constants):
    """What a RAPID module of commands holds."""

    digits: int = 7
    """of a degree, behind the point [digits]; derived: to 2e-9 rad"""


COMMANDS, BRANCH, RANGE = CommandSearch(), BranchSearch(), IdentifiedRange()
REFUSED, MOMENTS, RAPID = RefusedTables(), MomentFit(), RapidFile()
