"""Numbers that decide what of a verdict is told, and in which order it is cured; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class RepairRules(Constants):
    """What each cause moves, and what is left of the error once it is cured."""

    rows: int = 1500
    """that contributions are calculated on, spread evenly [rows]; judgement: of speed"""
    motion_rows: int = 20_000
    """over which a repair's motion and a curve's mean are taken [rows]; derived: all frames of a million rows would
    take four gigabytes"""
    trusted_weight: float = 0.5
    """weight below which a row looks like a bad shot and takes no part; convention: the half"""
    switch_seen: float = 0.01
    """share of the error from which small errors of a family have a switch; judgement: less is not seen"""
    far_turn_rad: float = 2e-3
    """turn beyond which a base is turned back exactly [rad]; derived: its second order is two micrometres at a metre"""
    constant_felt: float = 0.01
    """share of what a curve moves from which its constant is told; derived: its square is a ten-thousandth"""
    major_apart: int = 6
    """major effects, more of which are taken together with the minor ones; judgement: nobody tries out more"""


@dataclass(frozen=True)
class CalibratedRules(Constants):
    """What counts where the geometry is calibrated."""

    stands_out: float = 0.1
    """share of the squared error that a calibration leaves from which a cause is major, however little of the whole it
    is; judgement: its cure lowers by a twentieth what a calibrated arm misses by, more than a task must"""
    most_taken_up: float = 0.5
    """of all coordinates, that frames and geometry may take up where shares of the rest are told; judgement: beyond it,
    a fit to so few rows leaves too little to tell shares of"""
    same_column: float = 1e-6
    """of the largest, below which a direction in which geometry moves the tool is none; derived: rounding"""


@dataclass(frozen=True)
class OrderRules(Constants):
    """What is a task of the work order."""

    least_gain: float = 0.03
    """share of the error that a task must take away in its turn; judgement: less is not felt"""
    worth_together: float = 0.1
    """share of the error from which all that is left in the fitted model is commanded away together; judgement: less is
    not worth other commands"""
    worth_of_minor: float = 0.25
    """share from which a minor effect is a task in its turn; judgement: with two real arms in view"""
    as_good: float = 0.03
    """share of the error within which fewer causes do as well as more; judgement: as least_gain"""
    tried_together: int = 8
    """causes of which all sets are tried: those that move most; judgement: of speed, 255 sets"""
    moves_that_way: float = 0.01
    """of how far motors move the tool the way they do most, below which they do not move it another way; judgement: a
    milliradian of twist would lift the tool of a planar arm by a thousandth; a command a hundred times what it corrects
    is none"""
    least_turn_rad: float = 5e-5
    """turn of a jump below which it is not told [rad]; judgement: at a metre it is less than what jumps are measured
    by"""
    turned_origin_rad: float = 1e-5
    """turn of a joint's origin up to which it keeps its stated angles [rad]; derived: 0.01 mm at a metre"""


@dataclass(frozen=True)
class WordingRules(Constants):
    """What is told in words, and how surely."""

    causes: int = 3
    """in a headline; more are counted, not told; judgement: as many are kept in mind"""
    places: int = 4
    """in a sentence; more are counted, not told; judgement: as many are read"""
    rivals: int = 2
    """of a cause that a task tells: the nearest; judgement: as many are looked for"""
    told_first: float = 0.05
    """share of the squared error from which a cause is told first; smaller ones come after, and are counted where none
    of their members stands out; judgement: less is not what the arm misses by"""
    spread_told_first: float = 0.15
    """the same for a cause of which no member stands out: below it, it is one of the rest; judgement: nothing can be
    done about it by itself"""
    hidden_by_geometry: float = 1.5
    """times its share of the whole from which a cause's share of what calibration leaves is told beside it; judgement:
    less is the same in words"""
    about_as_much: float = 0.5
    """of the largest share in a cause, from which a member with a sure name and more evidence is told before one
    without; judgement: what is sure to be half of it is more to a reader than what may be all"""
    large_anyway: float = 0.15
    """share of the whole from which a cause's share of what calibration leaves is not told beside it; judgement: nobody
    overlooks it, and a second share only makes one ask what the first is of"""
    told_at_all: float = 1e-3
    """share from which a cause that is not worth a clause is counted; judgement: less is nothing to look for"""
    told_though_unsure: float = 0.01
    """share from which small errors are told that the evidence does not ask for; judgement: less is noise"""
    clearly_worse: float = 1.1
    """times the error without a model from which one with it is said to be worse on rows that took no part; judgement:
    less is a matter of which rows"""
    rounding: float = 1e-6
    """share by which errors must differ to be larger or smaller at all; derived: sums of squares of millions of rows
    agree to a millionth in double precision"""
    faint: float = 0.7
    """share of the residual below which something unexplained is hidden in the noise; derived: half of its square"""
    sure: float = 5.0
    """standard errors from zero at which a value is no open one; judgement: one chance in two million"""
    left_open: float = 10.0
    """times as far as its effect moves the tool, from which a value's standard error would move it, it is not told;
    judgement: other values take it back in these poses"""
    reliable: float = 0.5
    """share of resampled tables below which an effect that is chosen is not to be relied on; convention: most"""
    nearly_always: float = 0.8
    """share of resampled tables below which the evidence of one table is told as some, however large its odds;
    judgement: one table in five says otherwise"""
    more_than_all: float = 1.05
    """share of the squared error above which a cause is more than all of it: others cancel a part; judgement: less is
    rounding"""
    steady: float = 0.02
    """share of its size below which a motion's range is told as one number; judgement: two digits"""
    countable_times: float = 1000.0
    """times up to which a factor is told by its digits; judgement: beyond it what is left is noise, and digits say
    nothing"""
    countable_odds: float = 9.0
    """evidence up to which odds are told by their digits [nats]; judgement: 8000 to 1 is beyond doubt"""


REPAIRS, CALIBRATED, ORDER, WORDS = RepairRules(), CalibratedRules(), OrderRules(), WordingRules()
