"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class FittingSteps(Constants):
    """How fits are computed, and when they end."""

    first_damping: float = 1e-4
    """of Gauss-Newton, first share of each column's own square that is tried; convention: Marquardt's, small"""
    most_damping: float = 1e8
    """share at which trying ends; judgement: such a step goes nowhere"""
    refit: int = 6
    """of the exact refit [steps]; judgement: more than it takes"""
    refit_of_many_rows: int = 12
    """of the exact refit to a table that is not quickly passed over [steps]; judgement: with a thousand columns, whose
    values the rows' weights follow slowly, it took ten"""
    on_the_way: int = 3
    """of a refit after which another one follows [steps]; judgement: it is then nearer than the noise, and what no arm
    can have shows"""
    quickly_passed: int = 3500
    """up to which fits pass over a table quickly [rows]; judgement: time; what is diagnosed first of a longer table is
    as long"""
    converged_mm: float = 1e-6
    """change of the residuals at which the exact refit ends [mm]; derived: far below any instrument"""
    converged_share: float = 0.05
    """the same as a share of what the noise leaves uncertain; judgement: nobody sees it"""
    steady: float = 0.3
    """share of the step before that a step on a long table must stay below for the next one to be predicted by it;
    judgement: a fit that shrinks its steps so has left what damping is for"""
    free: float = 10.0
    """width of the prior of a named effect's values [sizes]; judgement: freely, but not where poses hardly tell it"""
    registration: int = 12
    """of the fit of base and tool [steps]; judgement: more than it takes"""
    turn_steps: int = 3
    """of the robust mean of turns [steps]; judgement: more than it takes"""
    negligible_m: float = 1e-9
    """change of tool points that ends the fit of base and tool [m]; derived: far above rounding, far below any
    instrument"""
    transfer: int = 8
    """of the fit of another run's frames [steps]; judgement: more than it takes"""
    negligible_mm: float = 1e-6
    """change of tool points that ends it [mm]; derived: far above rounding, far below any instrument"""
    smallest_group: int = 16
    """of one direction, from which they are multiplied together [terms]; judgement: time; the result is the same; twice
    and half change no golden verdict"""
    chunk_rows: int = 1500
    """linearised at a time [rows]; judgement: memory; the result is the same"""
    chunks_of_a_part: int = 16
    """summed up by one process, part by part, where several are allowed [chunks]; judgement: parts even enough for a
    few processes; the result does not depend on their number"""
    kept_rows: int = 15_000
    """tables up to this long keep their drivers between passes [rows]; derived: at most some 150 MB"""
    telling_rows: int = 10_000
    """of a longer table that tell what of a fit is not linear, and where base and tool stand at first [rows];
    judgement: time; by 3,000 of 30,000 rows a fit ended within a thousandth of a standard error of where passes over
    all rows ended"""


@dataclass(frozen=True)
class ExchangeRules(Constants):
    """When a tool counts as exchanged between runs."""

    worse: float = 2.0
    """times what one tool per run leaves that one tool for all runs must leave; judgement: lesser shifts are effects
    and compete with the others"""
    apart: float = 3.0
    """times that by which the tools must lie apart; judgement: lesser shifts are effects and compete with the others"""
    least_numbers: int = 2
    """measured numbers per number of a frame, for frames to tell anything; judgement: with as many as there are free,
    anything fits"""


@dataclass(frozen=True)
class SetUpRules(Constants):
    """When a base counts as set up anew between runs."""

    settled_mm: float = 3.0
    """that one base for two set-ups may leave more than one for each, RMS distance at the tool [mm]; judgement: bolted
    bases and levelled instruments settle by tenths of a millimetre, who sets up anew by hand misses the old place by
    centimetres; the geometric middle of 0.3 and 30 mm. Less is a shift, which competes with the other effects; an arm's
    own errors, seen in other poses, seldom pass for more"""
    most_runs: int = 20
    """compared; of more, each keeps a base of its own [runs]; judgement: time"""


@dataclass(frozen=True)
class GaugeRules(Constants):
    """Where a tool point stays as stated, since rows do not tell it from the base."""

    stated_tool_mm: float = 1.0
    """standard error of a tool point, the arm being as it is, from which rows do not tell it from the base [mm];
    judgement: who measures a tool point and types it in is off by about as much"""
    refuted: float = 4.0
    """by which rows must contradict a stated tool point, for it to be fitted all the same [standard errors];
    convention: one in 16,000 by chance"""
    least_noise_mm: float = 1e-3
    """that is ever believed there [mm]; derived: recordings state their points to a micrometre"""
    share: float = 0.1
    """of what moves most along an axis, from which another axis is named beside it; judgement: less is a lean"""


@dataclass(frozen=True)
class DiscrepancyRules(Constants):
    """How smooth errors that nobody named are looked for."""

    sizes: tuple[float, ...] = (0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0)
    """sizes of a process that compete, RMS at the tool [noise]; judgement: from a sixteenth to four times the noise;
    together as likely as none"""
    waves: int = 2
    """over a motor's range, alone and in products of two [half waves]; judgement: finer ones are effects' own"""
    slow_waves: int = 40
    """over the order of rows [half waves]; judgement: finer ones are hardly slow"""
    rows_per_wave: int = 6
    """for each of them at least [rows]; judgement: fewer do not tell a wave from noise"""
    most_rows: int = 2000
    """looked at, spread evenly [rows]; judgement: time"""
    tiny_mm: float = 1e-6
    """a motor that moves the tool by less does not move it [mm/rad]; derived: far above rounding, far below any
    instrument"""


@dataclass(frozen=True)
class ScatterRules(Constants):
    """When a joint is said to scatter."""

    ratios: tuple[float, ...] = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
    """scatter at the tool that competes [noise]; judgement: half the noise to sixteen times, doubling"""
    price_nats: float = 15.0
    """of a place of scatter [nats]; judgement: its share of a library of joints and sizes, and caution"""
    price_of_rounding_nats: float = 3.0
    """of rounded angles [nats]; judgement: their size is known and what is asked is yes or no; odds of 20"""
    most_places: int = 3
    """that may scatter [joints]; judgement: more are better called noise"""
    largest_rad: float = 0.02
    """a joint that would have to be this loose is not where the scatter is [rad]; judgement: the tool hardly sees it
    turn"""
    shares_of_size: tuple[float, ...] = (0.5, 0.7, 1.0, 1.4, 2.0)
    """of the scatter found that compete where it may follow a law; judgement: steps of the root of two, to half and
    double"""
    strays: tuple[float, ...] = (0.003, 0.03, 0.3)
    """share of bad shots that competes; judgement: hardly any, some, as many as a table bears"""
    width_of_strays: float = 5.0
    """of the rows' own scatter, within which half the bad shots are; judgement: bad shots are far out"""
    steps_of_noise: int = 20
    """in which the noise beside them is found; judgement: more than it takes"""


STEPS = FittingSteps()
EXCHANGE = ExchangeRules()
SET_UPS = SetUpRules()
GAUGE = GaugeRules()
DISCREPANCY = DiscrepancyRules()
SCATTER = ScatterRules()
