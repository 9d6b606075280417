"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class BackgroundPriors(Constants):
    """What small errors everywhere may amount to."""

    tolerance_shares: tuple[float, ...] = (0.0, 0.03, 0.1, 0.3, 1.0)
    """shares of it that the geometric background may have; judgement: from a perfect arm to an ordinary one; none is
    among them, since two dozen free values, however small, take up any single one that is barely seen"""
    elastic_shares: tuple[float, ...] = (0.0, 0.003, 0.01, 0.03, 0.1, 0.3)
    """shares of what is plausible that an elastic background may have; judgement: from a stiff arm to a soft one; what
    is larger has a name"""
    gear_shares: tuple[float, ...] = (0.0, 0.003, 0.01, 0.03, 0.1)
    """the same of the gears' waves; judgement: seen with bench cases in view; from ground gears to ordinary ones; what
    is larger has a name"""
    structure_shares: tuple[float, ...] = (0.0, 0.003, 0.01, 0.03, 0.1)
    """the same of links, pedestals and uneven bearings; judgement: links and pedestals are stiffer than drives, and
    what is larger has a name; chosen with a real arm in view, the third of whose drives, at 0.3, was taken for a
    bending link"""
    wander_shares: tuple[float, ...] = (0.0, 0.03, 0.1, 0.3, 1.0)
    """the same of the set-up's wander, and of orientations' errors; judgement: from a hundredth of a millimetre to a
    workshop between morning and noon"""
    starts: tuple[tuple[int, ...], ...] = (
        (0, 0, 0, 0, 0, 0, 0, 0, 0),
        (2, 0, 0, 0, 0, 0, 0, 0, 0),
        (4, 0, 0, 0, 0, 0, 0, 0, 0),
        (3, 3, 2, 2, 0, 3, 3, 2, 2),
    )
    """sizes of the backgrounds from which searches start [indices]; judgement: a perfect arm, two with geometric
    tolerances, one with a little of everything"""


@dataclass(frozen=True)
class LoopBudget(Constants):
    """When the rounds of selection end, and what they look at."""

    rounds: int = 7
    """at most [rounds]; judgement: more than most tables take"""
    full_rounds: int = 2
    """that search from all starts; later ones start where the last one ended [rounds]; judgement: time"""
    scanning_rounds: int = 4
    """that scan [rounds]; judgement: the last only settle"""
    late_scans: int = 3
    """for lines of gears once all else is known [scans]; judgement: most tables end after one; time"""
    scatter_settled: float = 0.1
    """relative change of scatter's size at which the rounds may end; judgement: far below what a name feels"""
    flickering: float = 0.002
    """share of the rows that may still come and go when the rounds end; judgement: less than a row in most tables"""
    size_of_gears: int = 2
    """of all gears' waves from which the search with finer ones starts [index]; judgement: seen with bench cases in
    view; of ordinary gears; time"""
    within: float = 0.3
    """width of the prior of a name within a background [sizes]; judgement: free, but not so that several run against
    each other"""
    taken_back: float = 1.1
    """times the noise that a name leaves, up to which something else takes it back; judgement: two cases were in view,
    1.0006 where waves take a gear's ratio back, 13 to 770 for two wrong rows"""
    nearer: float = 0.5
    """times the distance from any arm that was built, to which it must fall without such a name; judgement: the same
    cases were in view, 0.03, for both values are gone without one, and 0.98 to 1"""
    surely_negative: float = 3.0
    """by which a compliance about one of two axes must be negative to be taken out [standard errors]; convention:
    three; less is a stiff axis and noise"""
    surely_wanders: float = 20.0
    """that a wander in the order of rows must gain not to be asked whether it predicts other rows better [nats];
    judgement: well above the price of a name; one real arm, whose poses came in order, was in view"""
    sample_rows: int = 3000
    """longer tables are diagnosed on so many first [rows]; judgement: time"""
    rows_of_a_group: int = 20
    """of every run and target that the sample holds at least [rows]; judgement: a base takes six numbers"""
    promising: int = 60
    """beside the chosen ones, weighed again on all rows of a long table [effects]; judgement: time"""
    far_off_together: int = 8
    """of twice as many in succession that are far off, from which they are no bad shots [rows]; derived: where a tenth
    of the rows are bad shots, strewn at random, one such stretch of sixteen in 10,000 has so many"""
    rounds_of_outliers: int = 3
    """that such rows are looked at [times]; judgement: as many jumps, one after the other; time"""
    still_apart: float = 0.5
    """share of them that may stay far off where a jump is taken to explain them; judgement: most are explained, or it
    is no explanation"""
    at_turn: float = 2.0
    """within which of zero a load may have the other side than computed [standard errors]; convention: one load in
    twenty lies farther from what was computed"""
    scatter_rows: int = 4000
    """on which scatter is looked for [rows]; judgement: time"""


@dataclass(frozen=True)
class GravityRules(Constants):
    """Where gravity's direction is looked for."""

    leans_tried: tuple[float, ...] = (0.2, 0.5, 0.9, 1.6, 2.4, 3.1)
    """from the stated direction, where the search starts besides [rad]; judgement: from a badly levelled floor to a
    ceiling"""
    azimuths: int = 8
    """to which each lean is tried [sides]; judgement: every 45 degrees"""
    as_good: float = 1.05
    """times the error along the stated direction, up to which another is used that the check of the table asks for;
    judgement: springs that push foretell as well as those that give way along gravity turned round"""
    close_rad: float = 1e-3
    """at which the search ends [rad]; derived: far below the intervals that it gives"""
    first_step_rad: float = 0.1
    """first step of the search [rad]; judgement: less than from one start to the next"""
    step_rad: float = 0.02
    """of the differences that give the interval [rad]; derived: small beside the valley, large beside rounding"""
    rows: int = 400
    """looked at, spread evenly [rows]; judgement: time"""


@dataclass(frozen=True)
class FoldRules(Constants):
    """How rows are held out."""

    folds: int = 5
    """of the cross-validation [parts]; convention"""
    blocks: int = 20
    """of configurations that stay together, or runs that are held out whole, at most [blocks]; judgement: four to a
    fold"""
    overfitted: float = 1.5
    """times the noise that held-out errors exceed where free curves are asked whether they predict rows [times];
    derived: as where a fit's free values are four tenths of its numbers, sqrt((1 + 0.4) / (1 - 0.4))"""
    judged_rows: int = 20_000
    """whose held-out errors are computed, spread evenly; folds are fitted to all [rows]; derived: their RMS is within
    0.3 % of that of all rows"""
    seen_elsewhere: float = 0.5
    """share of rows at other runs' poses from which no run is held out whole; judgement: half of them are known"""
    fewest_rows_per_run: int = 30
    """of every run, for whole runs to be held out [rows]; judgement: fewer do not fit a base"""
    fewest_runs: int = 3
    """for whole runs to be held out [runs]; judgement: two to learn from"""


@dataclass(frozen=True)
class NamingRules(Constants):
    """What gets a name, beside what else, and what is listed."""

    line_share: float = 0.9
    """of a curve of load that its line explains, from which it is told as the line and the rest; judgement: the rest is
    then a tenth"""
    main_share: float = 0.9
    """of a curve of a joint's angle, of what only it explains, that one line or wave must be to be told as that;
    judgement: the rest is then a third as large as it; three quarters, tried first, named a wave in a curve without a
    name (a world of the proof, two bench cases in view)"""
    stands_out_nats: float = 20.0
    """that holding a background's member right must lose for it to be named [nats]; judgement: well above the price of
    a name"""
    stands_out: float = 0.25
    """share of the RMS that it must be worth; judgement: less is one of many small errors"""
    beyond_family: float = 2.5
    """times the usual value of its family that a background's member must have to be named; convention: one in eighty
    of a family's values is farther out; that gears are measured at the tool, too, was decided with a bench case in
    view"""
    minor_share: float = 0.025
    """of the residual variance, below which an effect is apart from the story, in an arm with small errors everywhere;
    judgement: nobody looks for so little first; that it counts of what geometry leaves was decided with a bench case in
    view"""
    minor_share_of_perfect_arm: float = 0.001
    """the same in an arm that is perfect but for what is named; judgement: there, less stands out"""
    unlawful_give: float = 0.03
    """of the nats that a link's bending is worth, within which soft drives explain the rows as well; judgement: torques
    off by a sixth, as masses are, leave as much; with other simulators' arms in view"""
    listed_nats: float = 10.0
    """alternatives that lose more are not listed [nats]; judgement: 20000 to 1"""
    listed_nats_of_special_cases: float = 40.0
    """the same for a curve's special cases, and for effects of more freedom that fit alike [nats]; judgement: most of
    the curve may be one of them; what freedom costs is no measurement"""
    alike_nats: float = 1.0
    """by which what fits alike may fit worse [nats]; derived: a likelihood ratio of e is no evidence"""
    looked_at: int = 12
    """weighed in an effect's place [additions]; judgement: time"""
    asked_elsewhere: int = 24
    """of which held-out rows are asked, the nearest first [alternatives]; judgement: time"""
    coarsely: float = 0.25
    """share of what taking an effect out costs by which predictions may miss; judgement: the noise is another one
    without it"""


BACKGROUNDS = BackgroundPriors()
LOOP = LoopBudget()
GRAVITY = GravityRules()
FOLDING = FoldRules()
NAMING = NamingRules()
