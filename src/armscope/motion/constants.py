"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class CheckRules(Constants):
    """When a table is doubtful."""

    one_way: float = constant(
        0.02, "share of the way back below which a joint moves one way only", "judgement: servo noise"
    )
    rows_per_parameter: int = constant(
        2, "numbers for each value of friction and masses", "judgement: fewer fit anything"
    )
    well_excited: float = constant(
        100.0,
        "condition number of what a motion tells of masses, beyond which it is said",
        "convention: of exciting motions (Gautier & Khalil 1992); three real sets and a generated one have 3 to 7",
    )


@dataclass(frozen=True)
class LibraryRules(Constants):
    """Where the library stops."""

    wide_load_m: float = constant(0.1, "from a load's centre to most of it", "judgement: a gripper", unit="m")
    least_shown: float = constant(
        1e-3,
        "of the arm's own torque that a change by one unit must show for its column to compete",
        "judgement: what shows less can't be told",
    )
    heavy_link: float = constant(0.1, "of a link's mass, where more than a kg", "judgement: weights are so far off")
    redundant_columns: float = constant(
        0.02, "of a column, beyond the others of its cause, that must be its own", "judgement: less can't be told apart"
    )
    least_body: float = constant(0.1, "of the moving link's mass, of a body", "judgement: lighter ones show too little")
    swing_poses: int = constant(100, "in which a link's swing is sought", "judgement: a heavy one is among them")
    any_motion: int = constant(
        30,
        "of a motion at which columns of the library are compared",
        "derived: more than links have numbers",
        unit="samples",
    )
    redundant: float = constant(
        1e-5,
        "singular value, to the largest, below which a combination of masses is not told",
        "convention: of the motions' protocol",
    )

    slow: float = constant(
        5.0,
        "a joint that never moves faster either way shows no friction",
        "judgement: beyond the change of sides",
        unit="widths",
    )
    falls: tuple[float, ...] = constant(
        (2.0, 1.0),
        "exponents of the speed over which friction falls from its value near rest; the first where a law says none",
        "convention: Gauss' bell and the exponential, both in use (Armstrong-Helouvry, Dupont, Canudas de Wit 1994)",
    )
    stribeck_widths: int = constant(5, "speeds that are scanned", "judgement: in steps of two", unit="speeds")
    between_speeds: float = constant(0.5, "relative, of a scanned speed, allowed for", "derived: half a scan's step")
    same_unit: float = constant(
        0.05, "by which a gain may differ from another unit of torque", "judgement: masses are known to some percent"
    )
    delay_s: float = constant(0.01, "delay that is tried first", "judgement: of drives and field buses", unit="s")
    joints_of_a_clock: int = constant(3, "for one delay of all", "judgement: two may be alike by chance", unit="joints")
    turns_in_s: float = constant(
        100.0, "of motion, in which it is seen how friction changes sides", "judgement: hundreds of turns", unit="s"
    )
    turnings_s: tuple[float, ...] = constant(
        (0.0, 0.008, 0.016, 0.024, 0.032, 0.04, 0.048, 0.056),
        "by which friction changes sides later than the speed, that are tried first",
        "derived: at 25 Hz the slope of a step tells half of such a distance",
        unit="s",
    )
    filters_s: tuple[float, ...] = constant(
        (0.004, 0.006, 0.008, 0.01, 0.012, 0.016, 0.02, 0.024, 0.032),
        "by which one low-pass of all torques makes them late, that are tried first",
        "judgement: drives and sensors filter at 5 to 50 Hz",
        unit="s",
    )
    turning_steps: int = constant(3, "towards it from there", "judgement: it rests by then", unit="steps")
    few_waves: int = constant(60, "per turn that always compete", "judgement: gears' and motors' low harmonics")
    most_waves: int = constant(400, "per turn that are tried", "derived: two per motor turn behind a gear of 200 to 1")
    waves_at_once: int = constant(50, "formed at a time", "judgement: memory; 30,000 samples of these are 24 MB")
    slow_turn: float = constant(25.0, "percentile of speeds that are slow", "judgement: enough to show waves", unit="%")
    crawling: float = constant(0.05, "of a joint's greatest speed, below it rests", "judgement: it shows no waves")
    most_of_the_rest: float = constant(0.5, "of what friction and masses leave that fast waves are", "derived: most")
    wave_left: float = constant(0.05, "of a wave that is left by low-pass and other columns", "judgement: a trace")
    waves_kept: int = constant(3, "of those tried that compete at a joint", "judgement: time", unit="waves")
    ways: tuple[float, ...] = constant(
        (0.003, 0.01, 0.03, 0.1),
        "over which friction may come back after a reversal",
        "judgement: some mrad of presliding to a tenth of the range",
        unit="ranges of the joint",
    )
    plays: tuple[float, ...] = constant(
        (0.02, 0.05, 0.12, 0.3),
        "half widths of a play in the torque",
        "judgement: from what noise hides to what nobody overlooks",
        unit="RMS of the torque",
    )
    least_waves: float = constant(
        1.5,
        "that a joint's range must hold for ripple to be told from a bend",
        "judgement: less is no wave",
        unit="waves",
    )
    knots_of_position: int = constant(10, "of a free curve of the position", "judgement: a few bends", unit="columns")
    knots_of_bend: int = constant(4, "of a curve that bends once", "derived: the least spline", unit="columns")
    knots_of_others: int = constant(7, "of other free curves", "judgement: a few bends", unit="columns")
    knots_of_time: int = constant(4, "of a drift", "judgement: a cubic; faster is no drift", unit="columns")
    least_warming_k: float = constant(2.0, "by which a temperature must change", "judgement: sensors' error", unit="K")
    least_running_min: float = constant(0.2, "in which friction may change", "judgement: no gear warms in less")
    still_rad: float = constant(0.02, "a joint that spans less stands", "judgement: servo noise", unit="rad")
    still_m: float = constant(0.002, "the same of one that slides", "judgement: servo noise", unit="m")
    powers: tuple[float, ...] = constant(
        (1 / 3, 1 / 2, 2 / 3, 3 / 2, 2.0, 3.0),
        "of speed to which friction may grow",
        "judgement: grease that thins as it is sheared, below 1; oil that is churned, a square",
    )
    close_powers: float = constant(0.12, "of a power, to the next, which no motion tells apart", "judgement: a trace")
    usual_speeds: tuple[float, ...] = constant(
        (5, 20, 35, 50, 65, 80, 95), "at which a power is told from viscous friction", "judgement: all of it", unit="%"
    )


@dataclass(frozen=True)
class PriorRules(Constants):
    """What is believed of masses and drives before the rows speak."""

    inertial_shares: tuple[float, ...] = constant(
        (0.0, 0.003, 0.01, 0.03, 0.1, 0.3),
        "of a link's mass, mass x length, mass x length^2, by which its inertial parameters may be off unnamed",
        "judgement: from a drawing's accuracy to rough guesses; the evidence chooses",
    )
    link_masses: tuple[float, ...] = constant(
        (0.0, 0.01, 0.03, 0.1, 0.3),
        "of a link's mass by which it may be off unnamed, its moments and inertia in proportion",
        "judgement: from scales to guesses of a density; the evidence chooses",
    )
    lightest_share: float = constant(
        0.1, "of the mean mass, that a link counts as at least", "judgement: links of a few grams in a file are stubs"
    )
    reversal: float = constant(
        0.05,
        "of a joint's torque: how far the shape of friction's change of sides over speed is free",
        "judgement: a part of dry friction",
    )
    turning_s: float = constant(
        0.002,
        "by which a joint's torque may change sides sooner or later than its speed, and over which, unnamed",
        "judgement: a milliradian of presliding, or a filter of a drive",
        unit="s",
    )
    longest_turning_s: float = constant(
        0.06,
        "by which a joint's friction is taken to change sides later or sooner",
        "judgement: twice the 27 ms that joint 5 of a UR10e was seen to have",
        unit="s",
    )
    reversal_sizes: tuple[float, ...] = constant(
        (0.0, 1.0, 5.0), "of all three, that compete", "judgement: dry friction may be all of a joint's torque"
    )
    response: float = constant(
        0.16,
        "second derivative of a torque by which drives round it off unnamed",
        "derived: (1 / (2 pi 0.4))^2, of a filter at two fifths of the sampling rate, where half of it must be gone",
        unit="samples^2",
    )
    gain: float = constant(
        0.1,
        "by which a drive gain is off where no uncertainty is stated",
        "measured: two published sets of the UR10e's gains differ by 13 to 49 %",
    )
    torque_gains: tuple[float, ...] = constant(
        (0.0, 0.01, 0.03), "by which recorded torques may each be off unnamed", "judgement: calibrated, or not"
    )
    unsure_gain: float = constant(
        0.3,
        "by which gains may be off where they have a name, or stand in the place of a load",
        "measured: the middle of what two published sets of the UR10e's gains differ by",
    )
    level_of_gains: float = constant(
        0.2,
        "by which the gains of all drives may be off alike where no uncertainty is stated",
        "measured: two published sets of the UR10e's gains differ by 25 % in the mean, 0.7 of which is each one's own",
    )
    largest_gain: float = constant(
        12.0,
        "times too large or too small that a torque may be recorded",
        "derived: of other units, kgf m and lbf in, the farther is 9.8 N m; beyond, another joint is recorded",
        unit="1",
    )
    unit: float = constant(
        0.01,
        "that one standard deviation of a row's noise is scaled to",
        "derived: free columns then have a wide prior beside what torque they make",
        unit="1",
    )


@dataclass(frozen=True)
class RowNoiseRules(Constants):
    """How much rows count."""

    least_share: float = constant(
        1e-4, "of a torque's spread that its noise is at least", "derived: tables hold some six digits of a torque"
    )
    grown: float = constant(4.0, "of an earlier round's lasting noise, at most", "judgement: twice the amplitude")
    longest_lag: int = constant(1000, "over which autocorrelation is summed", "judgement: time", unit="rows")
    window: float = constant(5.0, "autocorrelation times at which the sum ends", "convention: Sokal 1997", unit="times")
    rows_at_once: int = constant(20_000, "summed at a time, in double precision", "judgement: memory", unit="rows")
    names_for_a_curve: int = constant(3, "in place of one curve, at most", "judgement: more are one", unit="causes")
    nearly_all: float = constant(
        0.7, "of a curve's evidence that names must have to take its place", "judgement: most of what it explains"
    )
    nearly_all_of_a_law: float = constant(
        0.95, "of a nameless law's evidence that the name in it must have", "judgement: all but a twentieth"
    )
    rounds: int = constant(
        5, "of noise and selection, at most", "judgement: names rest after two as a rule", unit="rounds"
    )
    refinings: int = constant(
        3,
        "more, where scanned numbers still move",
        "measured: delays of joints that are mostly friction rest after six rounds",
        unit="rounds",
    )
    settled: float = constant(
        0.3, "standard errors within which a number that is refined rests", "judgement: its interval hardly moves"
    )
    same_gain: float = constant(
        1e-4, "by which a gain may lie beside what its columns have", "judgement: no gain is known as well", unit="1"
    )
    parts: int = constant(
        20, "of the motion, every fifth of which is fitted by the rest to see its noise", "judgement: longer than noise"
    )
    blocks_of_time: int = constant(5, "of a single run", "convention: as many as folds", unit="blocks")
    ridge: float = constant(
        1e-6,
        "relative, of the fit of everything at once that starts the noise",
        "derived: keeps what is redundant finite",
    )


@dataclass(frozen=True)
class MotionTelling(Constants):
    """How much is told."""

    minor_share: float = constant(
        0.01,
        "of what friction and rotors leave, below which a cause is apart from the story",
        "judgement: nobody would repair it first",
    )
    of_the_rest: float = constant(
        0.25,
        "of what is left once larger causes are cured, in squares, from which a cause is part of the story, too",
        "judgement: an eighth of the error that is then there; beside a spring of 400 N m a link that is 8 kg heavier "
        "has less than a hundredth of all",
    )
    looked_at: int = constant(40, "rivals of a cause", "judgement: time", unit="causes")
    listed_nats: float = constant(
        20.0, "by which a rival that is listed may fall short", "judgement: told, not hidden", unit="nats"
    )
    listed_share: float = constant(
        0.01,
        "of a cause's own evidence by which a rival that is listed may fall short",
        "judgement: models are a little wrong, and among thousands of nats that costs tens",
    )
    listed: int = constant(4, "rivals of a cause", "judgement: nobody reads more", unit="causes")
    by_chance: float = constant(
        1e-3, "chance that noise alone colours a cell of the atlas", "convention: dozens of cells are looked at"
    )
    in_headline: int = constant(3, "causes", "judgement: a sentence holds no more", unit="causes")


@dataclass(frozen=True)
class ExportRules(Constants):
    """What a simulator takes for a body."""

    least_eigenvalue: float = constant(
        1e-6, "of a link's pseudo-inertia, to its largest", "judgement: simulators refuse bodies without extent"
    )
    lightest_kg: float = constant(0.1, "that a link counts as at least", "judgement: stubs of a few grams", unit="kg")


LIBRARY = LibraryRules()
PRIOR = PriorRules()
NOISE = RowNoiseRules()
TELLING = MotionTelling()
CHECK = CheckRules()
EXPORT = ExportRules()
