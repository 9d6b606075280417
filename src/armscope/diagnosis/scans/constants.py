"""Numbers that decide what scans look at, and what of it goes on to compete; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class ScanBudget(Constants):
    """How numbers that enter non-linearly are looked for."""

    scanned_rows: int = constant(4000, "looked at, spread evenly", "judgement: time", unit="rows")
    lines_kept: int = constant(2, "per joint that go on to compete", "judgement: time", unit="mesh counts")
    ordinary_lines: int = constant(
        128, "up to which lines are scanned in every round", "judgement: time", unit="periods per turn"
    )
    scan_of_fine_lines: int = constant(
        2, "in which finer ones are scanned, too", "judgement: the largest effects are known then; time", unit="round"
    )
    shortest_piece: int = constant(
        8, "on either side of a jump", "judgement: fewer do not tell a jump from bad shots", unit="rows"
    )
    nearest_edge: int = constant(
        3,
        "of a run to which a jump that shows farther from it may turn out to be",
        "judgement: the rows before it must have been at one place",
        unit="rows",
    )
    most_times: int = constant(600, "of a jump that compete", "judgement: time", unit="moments")
    lengths_of_pauses: int = constant(
        20, "of a pause that compete at each row", "convention: one number's price, ln 20", unit="lengths"
    )
    most_pauses: int = constant(4, "in a table", "judgement: time", unit="pauses")
    worth_setting_right: float = constant(
        1.0, "that better lengths of known pauses must promise", "judgement: less changes no name", unit="nats"
    )
    worth_a_look: float = constant(
        8.0,
        "that a scanned number must promise, before its price, to go on to compete",
        "judgement: with less it can't pay its price",
        unit="nats",
    )


SCANS = ScanBudget()
