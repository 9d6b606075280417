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
    wander_shares: tuple[float, ...] = constant(
        (0.0, 0.03, 0.1, 0.3, 1.0),
        "the same of the set-up's wander",
        "judgement: from a hundredth of a millimetre to a workshop between morning and noon",
    )
    starts: tuple[tuple[int, ...], ...] = constant(
        ((0, 0, 0, 0), (2, 0, 0, 0), (4, 0, 0, 0), (3, 3, 2, 2)),
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
    surely_negative: float = constant(
        3.0,
        "by which a compliance about one of two axes must be negative to be taken out",
        "convention: three; less is a stiff axis and noise",
        unit="standard errors",
    )
    sample_rows: int = constant(3000, "longer tables are diagnosed on so many first", "judgement: time", unit="rows")
    rows_of_a_group: int = constant(
        20, "of every run and target that the sample holds at least", "judgement: a base takes six numbers", unit="rows"
    )
    promising: int = constant(
        60, "beside the chosen ones, weighed again on all rows of a long table", "judgement: time", unit="effects"
    )
    scatter_rows: int = constant(4000, "on which scatter is looked for", "judgement: time", unit="rows")


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
    judged_rows: int = constant(
        20_000,
        "whose held-out errors are computed, spread evenly; folds are fitted to all",
        "derived: their RMS is within 0.3 % of that of all rows",
        unit="rows",
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


@dataclass(frozen=True)
class TellingRules(Constants):
    """What is told of the effects and of the rows."""

    listed_suspects: int = constant(200, "at most", "judgement: nobody reads more", unit="rows")
    noise_excess: float = constant(
        1.15,
        "times the stated noise beyond which a residual is more than the noise",
        "judgement: statements are rounded",
    )
    same_size: float = constant(
        0.05,
        "of an effect's size by which parts of the rows may differ and still give the same",
        "judgement: seen with bench cases in view; who cures an effect by it takes 95 % away",
    )
    background_seen_nats: float = constant(
        5.0, "evidence from which a background is said to be there", "judgement: 150 to 1", unit="nats"
    )
    determined: float = constant(
        0.5,
        "of a value's prior width that its standard error must be below to be told",
        "judgement: half of it is data",
    )
    most_bad_shots: float = constant(
        0.1, "share of rows that fit nothing beyond which they are no bad shots", "judgement: a tenth is a pattern"
    )
    rest_of_a_curve: float = constant(
        2.0,
        "times a joint's scatter that a curve must exceed to be told beside it",
        "judgement: less is the scatter's own",
    )
    telling_share: float = constant(
        0.7,
        "of a curve's variation that a simple shape must explain to be named",
        "judgement: half of a curve is no name",
    )
    grid: int = constant(361, "at which a curve is told", "convention: a turn in degrees", unit="points")
    atlas_rows: int = constant(4000, "that the atlas looks at, spread evenly", "judgement: time", unit="rows")
    implausible_values: int = constant(3, "told at most", "judgement: nobody reads more", unit="values")
    undetermined: float = constant(
        0.7,
        "of a plausible size, beyond which a value's standard error leaves it undetermined",
        "derived: the rows then halve what was believed before, at most",
    )
    chance: float = constant(
        0.99, "with which all agreeing subsets of a verdict stay below the limit", "convention: 99 %"
    )
    most_payloads: int = constant(6, "compared one by one", "judgement: time", unit="payloads")
    curve_rows: int = constant(
        50_000, "from which the range of what drives a curve is taken, spread evenly", "judgement: memory", unit="rows"
    )
    homogeneity_rows: int = constant(
        3000, "on which payloads and halves of the workspace are compared", "judgement: time", unit="rows"
    )


@dataclass(frozen=True)
class NextPoseRules(Constants):
    """Which measurements are asked for next."""

    tried: int = constant(400, "from which they are chosen", "judgement: time", unit="poses")
    asked: int = constant(12, "asked for", "judgement: an hour's work", unit="poses")
    decisive_nats: float = constant(
        10.5,
        "that they should tell two readings apart by on average",
        "derived: D - 1.645 sqrt(2 D) = 3: D expected nats scatter by sqrt(2 D), so 95 of 100 cases "
        "exceed the 3 nats of 20 to 1",
        unit="nats",
    )
    most_repeats: int = constant(200, "of a pose", "judgement: nobody measures one more often", unit="visits")
    payload_kg: float = constant(
        10.0, "tried where the recordings never carried one", "judgement: what a mid-sized arm carries", unit="kg"
    )


BACKGROUNDS = BackgroundPriors()
LOOP = LoopBudget()
SCANS = ScanBudget()
GRAVITY = GravityRules()
FOLDING = FoldRules()
NAMING = NamingRules()
TELLING = TellingRules()
NEXT_POSES = NextPoseRules()
