"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class SelectionPriors(Constants):
    """What is believed before the rows speak."""

    frame_mm: float = 50.0
    """size of what the free frames may do at the tool [mm]; judgement: wide, and the same in all hypotheses, so that it
    cancels"""
    sure_nats: float = 3.0
    """price of any name on top of its share of the library [nats]; convention: 20 times as likely as nothing in its
    place, ln 20"""
    excess_special_case_nats: float = 15.0
    """price of every further effect that follows one joint's own angle; waves once and twice per turn are one [nats];
    measured: in development worlds two names for one kink beat the free curve by at most 22 nats, half of them by less
    than 10, and 38 of 40 true pairs by more than 15; twice and half change no golden verdict"""
    sizes: int = 5
    """of effects that compete, evenly in the logarithm between what is barely seen and the mismatch [sizes]; judgement:
    enough for a prior that is wider than the steps"""
    barely_seen: float = 4.0
    """of all residuals together, where the sizes start [standard errors]; judgement: a larger one pays for a prior that
    is wider than any effect near the threshold"""


@dataclass(frozen=True)
class DetectionRules(Constants):
    """When something is said to be missing, and where."""

    detected_nats: float = 2.0
    """log odds from which something is said to be missing [nats]; measured: no false alarm in 600 simulated clean arms;
    where nothing is missing, an average of evidence exceeds x nats with a chance of exp(-x) at most; twice and half
    change no golden verdict"""
    sure_of_place: float = 0.95
    """posterior share from which a place is said; convention: 95 %; twice and half change no golden verdict"""
    listed: int = 3
    """the likeliest, told where none is sure [effects]; judgement: nobody reads more; twice and half change no golden
    verdict"""


@dataclass(frozen=True)
class SearchBudget(Constants):
    """How much is searched before the best found is called best."""

    beam: int = 3
    """that go on after every round [hypotheses]; judgement: time grows in proportion"""
    branches: int = 3
    """tried from each hypothesis [additions]; judgement: time grows in proportion"""
    slack_nats: float = 3.0
    """a predicted value that falls short by more is not computed [nats]; judgement: predictions are wrong by less;
    twice and half change no golden verdict"""
    special_cases: int = 7
    """a curve's likeliest special cases that are tried in its place [effects]; judgement: time; twice and half change
    no golden verdict"""
    named_at_once: int = 3
    """taken out of a background in one step [names]; judgement: time; twice and half change no golden verdict"""
    locally_searched: int = 2
    """from which the local search starts [hypotheses]; judgement: time"""
    local_steps: int = 6
    """of the local search [steps]; judgement: time"""
    local_steps_of_large: int = 2
    """of the local search from a large hypothesis [steps]; judgement: time"""
    large: int = 150
    """from which a hypothesis is large: several free curves [columns]; judgement: time"""
    gain: float = 1e-3
    """by which a move must better a hypothesis [nats]; derived: far above rounding, far below any evidence"""
    most_orders: int = 120
    """of members in which Shapley shares are averaged [orders]; derived: all orders of five members; of more, as many
    are drawn, with their reverses"""


@dataclass(frozen=True)
class Numerics(Constants):
    """Where rounding and time ask for a limit."""

    least_seen: float = 0.02
    """share of a column beyond the frames below which it is scaled as if this share were left; judgement: what frames
    absorb all but is not blown up"""
    cancelling: float = 3e-3
    """RMS at the tool of frames that move against each other, as a share of each one's, below which they are held;
    judgement: the axes of a planar arm are parallel to some milliradians"""
    noise_steps: int = 3
    """of the noise's own estimate [steps]; judgement: time"""
    noise_settled: float = 3e-3
    """relative change of the noise at which its estimate ends; judgement: far below what any evidence feels"""
    rounding: float = 1e-11
    """least ridge, relative to a column's own square; derived: far above the rounding of doubles; twice and half change
    no golden verdict"""
    nothing_left: float = 1e-9
    """of a noise's square that each number is off at least: sums of what is fitted to all digits may be below zero;
    derived: far below any noise"""
    rounded: float = 1e-12
    """relative difference below which prior variances are the same; derived: far above the rounding of doubles"""
    absorbed: float = 1e-6
    """share of a direction that must be left for it to explain something; derived: far above the rounding of sums over
    rows"""
    rooms: tuple[int, ...] = (1, 4, 12)
    """for how many of its columns there is room in a group of candidates scored together; larger ones go by size
    [columns]; judgement: time; the result is the same"""
    beside: int = 300
    """from which a hypothesis is evaluated beside a known one [columns]; judgement: time; the result is the same but
    for rounding"""
    departs: float = 0.4
    """share of a hypothesis' columns that may change for another to follow from its factor; judgement: time; the result
    is the same"""
    inverted_at_once: int = 64
    """up to which a triangular matrix is inverted in one piece [columns]; judgement: time; the result is the same"""


@dataclass(frozen=True)
class ConfidenceSet(Constants):
    """Which models held-out rows exclude."""

    chance: float = 0.05
    """of excluding a model that is as good as any; convention: 95 % confidence, as all intervals"""
    draws: int = 500
    """of blocks [draws]; derived: at a chance of 0.05 its standard error is then 0.01"""
    fewest_blocks: int = 8
    """below which nothing is excluded [blocks]; judgement: fewer are no sample of rows"""


@dataclass(frozen=True)
class SizesByGroup(Constants):
    """How sizes of a background's values are learned."""

    freedoms: tuple[float, ...] = (1.0, 4.0, float("inf"))
    """of Student's t that compete, by what held-out rows say [values]; judgement: seen with bench cases in view; a few
    waves of thirty, most of them, all alike"""
    weight_of_stated: float = 4.0
    """as which the stated size of a large group counts [values]; judgement: two waves"""
    steps: int = 10
    """in turns with the fit [steps]; judgement: time; sizes then change by less than they are uncertain"""


PRIORS = SelectionPriors()
DETECTION = DetectionRules()
BUDGET = SearchBudget()
NUMERICS = Numerics()
CONFIDENCE = ConfidenceSet()
SIZES_BY_GROUP = SizesByGroup()
