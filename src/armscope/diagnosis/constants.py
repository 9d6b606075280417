"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class BackgroundPriors(Constants):
    """What small errors everywhere may amount to."""

    tolerance_shares: tuple[float, ...] = constant(
        (0.0, 0.03, 0.1, 0.3, 1.0),
        "shares of it that the geometric background may have",
        "judgement: from a perfect arm to an ordinary one; none is among them, since two dozen free "
        "values, however small, take up any single one that is barely seen",
    )
    elastic_shares: tuple[float, ...] = constant(
        (0.0, 0.003, 0.01, 0.03, 0.1, 0.3),
        "shares of what is plausible that an elastic background may have",
        "judgement: from a stiff arm to a soft one; what is larger has a name",
    )
    gear_shares: tuple[float, ...] = constant(
        (0.0, 0.003, 0.01, 0.03, 0.1),
        "the same of the gears' waves",
        "judgement: seen with bench cases in view; from ground gears to ordinary ones; what is larger has a name",
    )
    structure_shares: tuple[float, ...] = constant(
        (0.0, 0.003, 0.01, 0.03, 0.1),
        "the same of links, pedestals and uneven bearings",
        "judgement: links and pedestals are stiffer than drives, and what is larger has a name; chosen with a real arm "
        "in view, the third of whose drives, at 0.3, was taken for a bending link",
    )
    wander_shares: tuple[float, ...] = constant(
        (0.0, 0.03, 0.1, 0.3, 1.0),
        "the same of the set-up's wander, and of orientations' errors",
        "judgement: from a hundredth of a millimetre to a workshop between morning and noon",
    )
    starts: tuple[tuple[int, ...], ...] = constant(
        (
            (0, 0, 0, 0, 0, 0, 0, 0, 0),
            (2, 0, 0, 0, 0, 0, 0, 0, 0),
            (4, 0, 0, 0, 0, 0, 0, 0, 0),
            (3, 3, 2, 2, 0, 3, 3, 2, 2),
        ),
        "sizes of the backgrounds from which searches start",
        "judgement: a perfect arm, two with geometric tolerances, one with a little of everything",
        unit="indices",
    )


@dataclass(frozen=True)
class LoopBudget(Constants):
    """When the rounds of selection end, and what they look at."""

    rounds: int = constant(7, "at most", "judgement: more than most tables take", unit="rounds")
    full_rounds: int = constant(
        2, "that search from all starts; later ones start where the last one ended", "judgement: time", unit="rounds"
    )
    scanning_rounds: int = constant(4, "that scan", "judgement: the last only settle", unit="rounds")
    late_scans: int = constant(
        3, "for lines of gears once all else is known", "judgement: most tables end after one; time", unit="scans"
    )
    scatter_settled: float = constant(
        0.1, "relative change of scatter's size at which the rounds may end", "judgement: far below what a name feels"
    )
    flickering: float = constant(
        0.002,
        "share of the rows that may still come and go when the rounds end",
        "judgement: less than a row in most tables",
    )
    size_of_gears: int = constant(
        2,
        "of all gears' waves from which the search with finer ones starts",
        "judgement: seen with bench cases in view; of ordinary gears; time",
        unit="index",
    )
    within: float = constant(
        0.3,
        "width of the prior of a name within a background",
        "judgement: free, but not so that several run against each other",
        unit="sizes",
    )
    taken_back: float = constant(
        1.1,
        "times the noise that a name leaves, up to which something else takes it back",
        "judgement: two cases were in view, 1.0006 where waves take a gear's ratio back, 13 to 770 for two wrong rows",
    )
    nearer: float = constant(
        0.5,
        "times the distance from any arm that was built, to which it must fall without such a name",
        "judgement: the same cases were in view, 0.03, for both values are gone without one, and 0.98 to 1",
    )
    surely_negative: float = constant(
        3.0,
        "by which a compliance about one of two axes must be negative to be taken out",
        "convention: three; less is a stiff axis and noise",
        unit="standard errors",
    )
    surely_wanders: float = constant(
        20.0,
        "that a wander in the order of rows must gain not to be asked whether it predicts other rows better",
        "judgement: well above the price of a name; one real arm, whose poses came in order, was in view",
        unit="nats",
    )
    sample_rows: int = constant(3000, "longer tables are diagnosed on so many first", "judgement: time", unit="rows")
    rows_of_a_group: int = constant(
        20, "of every run and target that the sample holds at least", "judgement: a base takes six numbers", unit="rows"
    )
    promising: int = constant(
        60, "beside the chosen ones, weighed again on all rows of a long table", "judgement: time", unit="effects"
    )
    far_off_together: int = constant(
        8,
        "of twice as many in succession that are far off, from which they are no bad shots",
        "derived: where a tenth of the rows are bad shots, strewn at random, one such stretch of sixteen in 10,000 has "
        "so many",
        unit="rows",
    )
    rounds_of_outliers: int = constant(
        3, "that such rows are looked at", "judgement: as many jumps, one after the other; time", unit="times"
    )
    still_apart: float = constant(
        0.5,
        "share of them that may stay far off where a jump is taken to explain them",
        "judgement: most are explained, or it is no explanation",
    )
    at_turn: float = constant(
        2.0,
        "within which of zero a load may have the other side than computed",
        "convention: one load in twenty lies farther from what was computed",
        unit="standard errors",
    )
    scatter_rows: int = constant(4000, "on which scatter is looked for", "judgement: time", unit="rows")


@dataclass(frozen=True)
class GravityRules(Constants):
    """Where gravity's direction is looked for."""

    leans_tried: tuple[float, ...] = constant(
        (0.2, 0.5, 0.9, 1.6, 2.4, 3.1),
        "from the stated direction, where the search starts besides",
        "judgement: from a badly levelled floor to a ceiling",
        unit="rad",
    )
    azimuths: int = constant(8, "to which each lean is tried", "judgement: every 45 degrees", unit="sides")
    as_good: float = constant(
        1.05,
        "times the error along the stated direction, up to which another is used that the check of the table asks for",
        "judgement: springs that push foretell as well as those that give way along gravity turned round",
    )
    close_rad: float = constant(
        1e-3, "at which the search ends", "derived: far below the intervals that it gives", unit="rad"
    )
    first_step_rad: float = constant(
        0.1, "first step of the search", "judgement: less than from one start to the next", unit="rad"
    )
    step_rad: float = constant(
        0.02,
        "of the differences that give the interval",
        "derived: small beside the valley, large beside rounding",
        unit="rad",
    )
    rows: int = constant(400, "looked at, spread evenly", "judgement: time", unit="rows")


@dataclass(frozen=True)
class FoldRules(Constants):
    """How rows are held out."""

    folds: int = constant(5, "of the cross-validation", "convention", unit="parts")
    blocks: int = constant(
        20,
        "of configurations that stay together, or runs that are held out whole, at most",
        "judgement: four to a fold",
        unit="blocks",
    )
    overfitted: float = constant(
        1.5,
        "times the noise that held-out errors exceed where free curves are asked whether they predict rows",
        "derived: as where a fit's free values are four tenths of its numbers, sqrt((1 + 0.4) / (1 - 0.4))",
        unit="times",
    )
    judged_rows: int = constant(
        20_000,
        "whose held-out errors are computed, spread evenly; folds are fitted to all",
        "derived: their RMS is within 0.3 % of that of all rows",
        unit="rows",
    )
    seen_elsewhere: float = constant(
        0.5,
        "share of rows at other runs' poses from which no run is held out whole",
        "judgement: half of them are known",
    )
    fewest_rows_per_run: int = constant(
        30, "of every run, for whole runs to be held out", "judgement: fewer do not fit a base", unit="rows"
    )
    fewest_runs: int = constant(3, "for whole runs to be held out", "judgement: two to learn from", unit="runs")


@dataclass(frozen=True)
class NamingRules(Constants):
    """What gets a name, beside what else, and what is listed."""

    line_share: float = constant(
        0.9,
        "of a curve of load that its line explains, from which it is told as the line and the rest",
        "judgement: the rest is then a tenth",
    )
    main_share: float = constant(
        0.9,
        "of a curve of a joint's angle, of what only it explains, that one line or wave must be to be told as that",
        "judgement: the rest is then a third as large as it; three quarters, tried first, named a wave in a curve "
        "without a name (a world of the proof, two bench cases in view)",
    )
    stands_out_nats: float = constant(
        20.0,
        "that holding a background's member right must lose for it to be named",
        "judgement: well above the price of a name",
        unit="nats",
    )
    stands_out: float = constant(
        0.25, "share of the RMS that it must be worth", "judgement: less is one of many small errors"
    )
    beyond_family: float = constant(
        2.5,
        "times the usual value of its family that a background's member must have to be named",
        "convention: one in eighty of a family's values is farther out; that gears are measured at the tool, too, was "
        "decided with a bench case in view",
    )
    minor_share: float = constant(
        0.025,
        "of the residual variance, below which an effect is apart from the story, in an arm with small "
        "errors everywhere",
        "judgement: nobody looks for so little first; that it counts of what geometry leaves was decided with a bench "
        "case in view",
    )
    minor_share_of_perfect_arm: float = constant(
        0.001, "the same in an arm that is perfect but for what is named", "judgement: there, less stands out"
    )
    unlawful_give: float = constant(
        0.03,
        "of the nats that a link's bending is worth, within which soft drives explain the rows as well",
        "judgement: torques off by a sixth, as masses are, leave as much; with other simulators' arms in view",
    )
    listed_nats: float = constant(
        10.0, "alternatives that lose more are not listed", "judgement: 20000 to 1", unit="nats"
    )
    listed_nats_of_special_cases: float = constant(
        40.0,
        "the same for a curve's special cases, and for effects of more freedom that fit alike",
        "judgement: most of the curve may be one of them; what freedom costs is no measurement",
        unit="nats",
    )
    alike_nats: float = constant(
        1.0, "by which what fits alike may fit worse", "derived: a likelihood ratio of e is no evidence", unit="nats"
    )
    looked_at: int = constant(12, "weighed in an effect's place", "judgement: time", unit="additions")
    asked_elsewhere: int = constant(
        24, "of which held-out rows are asked, the nearest first", "judgement: time", unit="alternatives"
    )
    coarsely: float = constant(
        0.25,
        "share of what taking an effect out costs by which predictions may miss",
        "judgement: the noise is another one without it",
    )


BACKGROUNDS = BackgroundPriors()
LOOP = LoopBudget()
GRAVITY = GravityRules()
FOLDING = FoldRules()
NAMING = NamingRules()
