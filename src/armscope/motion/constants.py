"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class CheckRules(Constants):
    """When a table is doubtful."""

    one_way: float = 0.02
    """share of the way back below which a joint moves one way only; judgement: servo noise"""
    rows_per_parameter: int = 2
    """numbers for each value of friction and masses; judgement: fewer fit anything"""
    well_excited: float = 100.0
    """condition number of what a motion tells of masses, beyond which it is said; convention: of exciting motions
    (Gautier & Khalil 1992); three real sets and a generated one have 3 to 7"""


@dataclass(frozen=True)
class LibraryRules(Constants):
    """Where the library stops."""

    wide_load_m: float = 0.1
    """from a load's centre to most of it [m]; judgement: a gripper"""
    least_shown: float = 1e-3
    """of the arm's own torque that a change by one unit must show for its column to compete; judgement: what shows less
    can't be told"""
    heavy_link: float = 0.1
    """of a link's mass, where more than a kg; judgement: weights are so far off"""
    redundant_columns: float = 0.02
    """of a column, beyond the others of its cause, that must be its own; judgement: less can't be told apart"""
    least_body: float = 0.1
    """of the moving link's mass, of a body; judgement: lighter ones show too little"""
    swing_poses: int = 100
    """in which a link's swing is sought; judgement: a heavy one is among them"""
    any_motion: int = 30
    """of a motion at which columns of the library are compared [samples]; derived: more than links have numbers"""
    redundant: float = 1e-5
    """singular value, to the largest, below which a combination of masses is not told; convention: of the motions'
    protocol"""

    slow: float = 5.0
    """a joint that never moves faster either way shows no friction [widths]; judgement: beyond the change of sides"""
    falls: tuple[float, ...] = (2.0, 1.0)
    """exponents of the speed over which friction falls from its value near rest; the first where a law says none;
    convention: Gauss' bell and the exponential, both in use (Armstrong-Helouvry, Dupont, Canudas de Wit 1994)"""
    stribeck_widths: int = 5
    """speeds that are scanned [speeds]; judgement: in steps of two"""
    between_speeds: float = 0.5
    """relative, of a scanned speed, allowed for; derived: half a scan's step"""
    same_unit: float = 0.05
    """by which a gain may differ from another unit of torque; judgement: masses are known to some percent"""
    delay_s: float = 0.01
    """delay that is tried first [s]; judgement: of drives and field buses"""
    joints_of_a_clock: int = 3
    """for one delay of all [joints]; judgement: two may be alike by chance"""
    turns_in_s: float = 100.0
    """of motion, in which it is seen how friction changes sides [s]; judgement: hundreds of turns"""
    turnings_s: tuple[float, ...] = (0.0, 0.008, 0.016, 0.024, 0.032, 0.04, 0.048, 0.056)
    """by which friction changes sides later than the speed, that are tried first [s]; derived: at 25 Hz the slope of a
    step tells half of such a distance"""
    filters_s: tuple[float, ...] = (0.004, 0.006, 0.008, 0.01, 0.012, 0.016, 0.02, 0.024, 0.032)
    """by which one low-pass of all torques makes them late, that are tried first [s]; judgement: drives and sensors
    filter at 5 to 50 Hz"""
    turning_steps: int = 3
    """towards it from there [steps]; judgement: it rests by then"""
    few_waves: int = 60
    """per turn that always compete; judgement: gears' and motors' low harmonics"""
    most_waves: int = 400
    """per turn that are tried; derived: two per motor turn behind a gear of 200 to 1"""
    waves_at_once: int = 50
    """formed at a time; judgement: memory; 30,000 samples of these are 24 MB"""
    slow_turn: float = 25.0
    """percentile of speeds that are slow [%]; judgement: enough to show waves"""
    crawling: float = 0.05
    """of a joint's greatest speed, below it rests; judgement: it shows no waves"""
    most_of_the_rest: float = 0.5
    """of what friction and masses leave that fast waves are; derived: most"""
    wave_left: float = 0.05
    """of a wave that is left by low-pass and other columns; judgement: a trace"""
    waves_kept: int = 3
    """of those tried that compete at a joint [waves]; judgement: time"""
    ways: tuple[float, ...] = (0.003, 0.01, 0.03, 0.1)
    """over which friction may come back after a reversal [ranges of the joint]; judgement: some mrad of presliding to a
    tenth of the range"""
    plays: tuple[float, ...] = (0.02, 0.05, 0.12, 0.3)
    """half widths of a play in the torque [RMS of the torque]; judgement: from what noise hides to what nobody
    overlooks"""
    least_waves: float = 1.5
    """that a joint's range must hold for ripple to be told from a bend [waves]; judgement: less is no wave"""
    knots_of_position: int = 10
    """of a free curve of the position [columns]; judgement: a few bends"""
    knots_of_bend: int = 4
    """of a curve that bends once [columns]; derived: the least spline"""
    knots_of_others: int = 7
    """of other free curves [columns]; judgement: a few bends"""
    knots_of_time: int = 4
    """of a drift [columns]; judgement: a cubic; faster is no drift"""
    least_warming_k: float = 2.0
    """by which a temperature must change [K]; judgement: sensors' error"""
    least_running_min: float = 0.2
    """in which friction may change; judgement: no gear warms in less"""
    still_rad: float = 0.02
    """a joint that spans less stands [rad]; judgement: servo noise"""
    still_m: float = 0.002
    """the same of one that slides [m]; judgement: servo noise"""
    powers: tuple[float, ...] = (1 / 3, 1 / 2, 2 / 3, 3 / 2, 2.0, 3.0)
    """of speed to which friction may grow; judgement: grease that thins as it is sheared, below 1; oil that is churned,
    a square"""
    close_powers: float = 0.12
    """of a power, to the next, which no motion tells apart; judgement: a trace"""
    usual_speeds: tuple[float, ...] = (5, 20, 35, 50, 65, 80, 95)
    """at which a power is told from viscous friction [%]; judgement: all of it"""


@dataclass(frozen=True)
class PriorRules(Constants):
    """What is believed of masses and drives before the rows speak."""

    inertial_shares: tuple[float, ...] = (0.0, 0.003, 0.01, 0.03, 0.1, 0.3)
    """of a link's mass, mass x length, mass x length^2, by which its inertial parameters may be off unnamed; judgement:
    from a drawing's accuracy to rough guesses; the evidence chooses"""
    link_masses: tuple[float, ...] = (0.0, 0.01, 0.03, 0.1, 0.3)
    """of a link's mass by which it may be off unnamed, its moments and inertia in proportion; judgement: from scales to
    guesses of a density; the evidence chooses"""
    lightest_share: float = 0.1
    """of the mean mass, that a link counts as at least; judgement: links of a few grams in a file are stubs"""
    reversal: float = 0.05
    """of a joint's torque: how far the shape of friction's change of sides over speed is free; judgement: a part of dry
    friction"""
    turning_s: float = 0.002
    """by which a joint's torque may change sides sooner or later than its speed, and over which, unnamed [s];
    judgement: a milliradian of presliding, or a filter of a drive"""
    longest_turning_s: float = 0.06
    """by which a joint's friction is taken to change sides later or sooner [s]; judgement: twice the 27 ms that joint 5
    of a UR10e was seen to have"""
    reversal_sizes: tuple[float, ...] = (0.0, 1.0, 5.0)
    """of all three, that compete; judgement: dry friction may be all of a joint's torque"""
    response: float = 0.16
    """second derivative of a torque by which drives round it off unnamed [samples^2]; derived: (1 / (2 pi 0.4))^2, of a
    filter at two fifths of the sampling rate, where half of it must be gone"""
    gain: float = 0.1
    """by which a drive gain is off where no uncertainty is stated; measured: two published sets of the UR10e's gains
    differ by 13 to 49 %"""
    torque_gains: tuple[float, ...] = (0.0, 0.01, 0.03)
    """by which recorded torques may each be off unnamed; judgement: calibrated, or not"""
    unsure_gain: float = 0.3
    """by which gains may be off where they have a name, or stand in the place of a load; measured: the middle of what
    two published sets of the UR10e's gains differ by"""
    level_of_gains: float = 0.2
    """by which the gains of all drives may be off alike where no uncertainty is stated; measured: two published sets of
    the UR10e's gains differ by 25 % in the mean, 0.7 of which is each one's own"""
    largest_gain: float = 12.0
    """times too large or too small that a torque may be recorded [1]; derived: of other units, kgf m and lbf in, the
    farther is 9.8 N m; beyond, another joint is recorded"""
    unit: float = 0.01
    """that one standard deviation of a row's noise is scaled to [1]; derived: free columns then have a wide prior
    beside what torque they make"""


@dataclass(frozen=True)
class RowNoiseRules(Constants):
    """How much rows count."""

    least_share: float = 1e-4
    """of a torque's spread that its noise is at least; derived: tables hold some six digits of a torque"""
    grown: float = 4.0
    """of an earlier round's lasting noise, at most; judgement: twice the amplitude"""
    longest_lag: int = 1000
    """over which autocorrelation is summed [rows]; judgement: time"""
    window: float = 5.0
    """autocorrelation times at which the sum ends [times]; convention: Sokal 1997"""
    rows_at_once: int = 20_000
    """summed at a time, in double precision [rows]; judgement: memory"""
    names_for_a_curve: int = 3
    """in place of one curve, at most [causes]; judgement: more are one"""
    nearly_all: float = 0.7
    """of a curve's evidence that names must have to take its place; judgement: most of what it explains"""
    nearly_all_of_a_law: float = 0.95
    """of a nameless law's evidence that the name in it must have; judgement: all but a twentieth"""
    rounds: int = 5
    """of noise and selection, at most [rounds]; judgement: names rest after two as a rule"""
    refinings: int = 3
    """more, where scanned numbers still move [rounds]; measured: delays of joints that are mostly friction rest after
    six rounds"""
    settled: float = 0.3
    """standard errors within which a number that is refined rests; judgement: its interval hardly moves"""
    same_gain: float = 1e-4
    """by which a gain may lie beside what its columns have [1]; judgement: no gain is known as well"""
    parts: int = 20
    """of the motion, every fifth of which is fitted by the rest to see its noise; judgement: longer than noise"""
    blocks_of_time: int = 5
    """of a single run [blocks]; convention: as many as folds"""
    ridge: float = 1e-6
    """relative, of the fit of everything at once that starts the noise; derived: keeps what is redundant finite"""


@dataclass(frozen=True)
class MotionTelling(Constants):
    """How much is told."""

    minor_share: float = 0.01
    """of what friction and rotors leave, below which a cause is apart from the story; judgement: nobody would repair it
    first"""
    of_the_rest: float = 0.25
    """of what is left once larger causes are cured, in squares, from which a cause is part of the story, too;
    judgement: an eighth of the error that is then there; beside a spring of 400 N m a link that is 8 kg heavier has
    less than a hundredth of all"""
    looked_at: int = 40
    """rivals of a cause [causes]; judgement: time"""
    listed_nats: float = 20.0
    """by which a rival that is listed may fall short [nats]; judgement: told, not hidden"""
    listed_share: float = 0.01
    """of a cause's own evidence by which a rival that is listed may fall short; judgement: models are a little wrong,
    and among thousands of nats that costs tens"""
    listed: int = 4
    """rivals of a cause [causes]; judgement: nobody reads more"""
    by_chance: float = 1e-3
    """chance that noise alone colours a cell of the atlas; convention: dozens of cells are looked at"""
    in_headline: int = 3
    """causes [causes]; judgement: a sentence holds no more"""


@dataclass(frozen=True)
class ExportRules(Constants):
    """What a simulator takes for a body."""

    least_eigenvalue: float = 1e-6
    """of a link's pseudo-inertia, to its largest; judgement: simulators refuse bodies without extent"""
    lightest_kg: float = 0.1
    """that a link counts as at least [kg]; judgement: stubs of a few grams"""


LIBRARY = LibraryRules()
PRIOR = PriorRules()
NOISE = RowNoiseRules()
TELLING = MotionTelling()
CHECK = CheckRules()
EXPORT = ExportRules()
