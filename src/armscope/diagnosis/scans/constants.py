"""Numbers that decide what scans look at, and what of it goes on to compete; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class ScanBudget(Constants):
    """How numbers that enter non-linearly are looked for."""

    scanned_rows: int = 4000
    """looked at, spread evenly [rows]; judgement: time"""
    lines_kept: int = 2
    """per joint that go on to compete [mesh counts]; judgement: time"""
    ordinary_lines: int = 128
    """up to which lines are scanned in every round [periods per turn]; judgement: time"""
    scan_of_fine_lines: int = 2
    """in which finer ones are scanned, too [round]; judgement: the largest effects are known then; time"""
    shortest_piece: int = 8
    """on either side of a jump [rows]; judgement: fewer do not tell a jump from bad shots"""
    nearest_edge: int = 3
    """of a run to which a jump that shows farther from it may turn out to be [rows]; judgement: the rows before it must
    have been at one place"""
    most_times: int = 600
    """of a jump that compete [moments]; judgement: time"""
    lengths_of_pauses: int = 20
    """of a pause that compete at each row [lengths]; convention: one number's price, ln 20"""
    most_pauses: int = 4
    """in a table [pauses]; judgement: time"""
    worth_setting_right: float = 1.0
    """that better lengths of known pauses must promise [nats]; judgement: less changes no name"""
    worth_a_look: float = 8.0
    """that a scanned number must promise, before its price, to go on to compete [nats]; judgement: with less it can't
    pay its price"""


SCANS = ScanBudget()
