"""Numbers that decide how foreign files are read, guessed at and written; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class DraftGuesses(Constants):
    """What a foreign table's columns and units are guessed to be."""

    fewest_motors: int = 2
    """of an arm; judgement: one that turns alone is none"""
    radians_up_to: float = 2 * np.pi + 0.01
    """largest angle up to which all are radians [rad]; derived: a whole turn, and what rounding to two decimals adds"""
    unit_length: float = 1e-3
    """by which the length of a quaternion may differ from 1; derived: three decimals round by half of it"""
    metres_up_to: float = 30.0
    """largest coordinate up to which all are metres; judgement: no arm stays within 30 mm of the origin"""
    seconds_up_to: float = 0.5
    """from one sample to the next, up to which time is in seconds [s]; judgement: a controller that logs more slowly
    than that logs no motion"""
    most_closing: int = 5
    """of statistics below a table [lines]; judgement: mean, least, most, range and scatter"""
    clearly_alike: float = 0.05
    """share of the lines by which more of them must be cut alike for another delimiter; judgement: the first is as good
    where a few lines differ"""
    decimal_commas: float = 0.1
    """share of the cells from which a comma is a decimal one; judgement: whole numbers and words have none"""
    last_row: float = 1e-9
    """by which a homogeneous matrix' last row may differ from 0 0 0 1; derived: far above rounding"""


@dataclass(frozen=True)
class ImportLimits(Constants):
    """How much of a file is looked at, held and told."""

    lines: int = 2000
    """that guesses rest on [lines]; judgement: time"""
    name: int = 200
    """of a column's name [characters]; judgement: nobody writes more, and guessing looks through it again and again"""
    rows: int = 20_000
    """of a raw file that are held [rows]; judgement: memory"""
    unused_named: int = 12
    """columns of a draft, and words for no value, that are told by name; judgement: as many are read"""
    columns_named: int = 3
    """that an error names one by one; judgement: more are told as first ... last"""
    rows_named: int = 8
    """that were left out, told by their number; judgement: as many are read"""


@dataclass(frozen=True)
class WrittenDigits(Constants):
    """How finely an imported table is written."""

    values: int = 10
    """of a number [digits]; derived: a micrometre in 10 km, and the last of a radian moves a tool 10 m away by 0.01
    micrometres"""
    time: int = 15
    """of a time [digits]; derived: ten microseconds in seconds since 1970; numbers of 64 bits hold 15 to 17"""


@dataclass(frozen=True)
class FetchingRules(Constants):
    """How public sets are fetched."""

    block: int = 1 << 20
    """read at once [bytes]; judgement: memory"""
    timeout_s: int = 60
    """without an answer, after which it is given up [s]; judgement: a slow line"""
    too_large: int = 2
    """times its stated size at which a file is refused; judgement: it is another file"""


DRAFT, LIMITS, DIGITS, FETCHING = DraftGuesses(), ImportLimits(), WrittenDigits(), FetchingRules()
