"""Numbers that decide what can be a recorded value, and how tables are read; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class PossibleValues(Constants):
    """Beyond what no recorded value lies in its unit; a larger one stands in another, or for no value."""

    number: float = 1e15
    """of any quantity; judgement: none reaches it in its unit; what lies beyond stands for no value, or overflows when
    squared"""
    angle_rad: float = 4 * np.pi
    """of a joint where the arm stands [rad]; judgement: no arm's joint stands beyond two turns"""
    angle_deg: int = 720
    """the same in degrees [degrees]; derived: two turns"""
    turn_rad: float = 100 * np.pi
    """of a joint in motion [rad]; judgement: no arm's joint stands beyond fifty turns"""
    slide_m: float = 200.0
    """of a joint that slides [m]; judgement: the longest tracks and gantries that carry robots are 150 m long (makers'
    catalogues)"""
    position_m: float = 1e4
    """of a measured point [m]; judgement: no instrument sees further, and tables with ten digits hold less than a
    micrometre up to here"""
    least_sigma_m: float = 1e-10
    """stated uncertainty of a point below which it is none; 0 stands for what is not known [m]; judgement: the size of
    an atom"""
    off_unit: float = 1e-2
    """by which a quaternion's length, or a matrix column's, differs from 1; judgement: what few printed digits do, not
    errors"""
    coldest_c: float = -273.15
    """temperature [degrees C]; convention: absolute zero"""
    warmest_c: float = 2000.0
    """temperature [degrees C]; judgement: steel melts before"""
    payload_kg: float = 20_000.0
    """of what an arm carries [kg]; judgement: the strongest arm that is sold carries 2300 kg (FANUC M-2000iA/2300)"""
    speed_rad_s: float = 1000.0
    """of a joint [rad/s]; judgement: the fastest arms turn one at 42 rad/s (delta robots' fourth axis, makers' data
    sheets)"""
    torque_nm: float = 1e7
    """at a joint [N m]; judgement: the heaviest arm that is sold (11,000 kg, reach 4.7 m) needs less than 1e6 N m"""
    unscaled: float = 3.5
    """largest of four numbers beyond which they are angles, no quaternion that lacks its scale; judgement: beyond pi,
    with room"""


@dataclass(frozen=True)
class ColumnReading(Constants):
    """What a table's columns and words are taken for."""

    alike: float = 0.75
    """likeness (0 to 1) from which a column that is not known is taken for a misspelt one; judgement: so are "payload"
    and "payload_kg" """
    still_rad: float = 1e-2
    """span of a joint's commanded angles below which they tell nothing about what follows its angle [rad]; judgement:
    servo noise"""
    fewest_names: int = 10
    """of points, from which they may number the rows; judgement: nobody puts so many reflectors on a tool"""
    names_per_row: float = 0.5
    """from which they do; derived: fewer than two rows each leave nothing but tool offsets to fit"""
    fewest_values: int = 10
    """different angles of a joint below which round numbers are how the poses were chosen; judgement: who chooses poses
    by hand chooses fewer"""
    decimals: int = 4
    """of a degree or radian to which angles may be rounded; judgement: what is written more finely moves no tool by
    what an instrument sees"""
    off_a_step: float = 1e-6
    """share of a step by which an angle may lie beside it; derived: conversion between units, and nothing else, leaves
    that"""


@dataclass(frozen=True)
class TablePieces(Constants):
    """How much of a file is read at once, and how much it may hold."""

    rows: int = 50_000
    """of a table that is read by one process [rows]; judgement: memory"""
    size: int = 1 << 22
    """of a file that one process takes where several share the work [bytes]; judgement: memory; parts even enough"""
    columns: int = 2000
    """of a table, at most [columns]; judgement: no log has as many; with 90,000 `armscope init` took 3 s"""
    length_from: int = 1 << 16
    """from which the length of a line is taken [characters]; judgement: hundreds of lines"""
    signature: int = 16
    """by which a file's kind is told [bytes]; judgement: the longest known, MATLAB's, has ten"""
    unpacked: int = 100
    """bytes for each packed one, beyond which a file is not unpacked; judgement: recordings unpack to ten times their
    size, a bomb to a thousand times"""
    unpacked_at_once: int = 1 << 20
    """while they are counted [bytes]; judgement: memory"""
    before_a_byte: int = 20
    """told before one that is no text [bytes]; judgement: enough to find it by"""


POSSIBLE, READING, PIECES = PossibleValues(), ColumnReading(), TablePieces()
