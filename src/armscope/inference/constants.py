"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class SelectionPriors(Constants):
    """What is believed before the rows speak."""

    frame_mm: float = constant(
        50.0,
        "size of what the free frames may do at the tool",
        "judgement: wide, and the same in all hypotheses, so that it cancels",
        unit="mm",
    )
    sure_nats: float = constant(
        3.0,
        "price of any name on top of its share of the library",
        "convention: 20 times as likely as nothing in its place, ln 20",
        unit="nats",
    )
    excess_special_case_nats: float = constant(
        15.0,
        "price of every further effect that follows one joint's own angle; waves once and twice per turn are one",
        "measured: in development worlds two names for one kink beat the free curve by at most 22 nats, "
        "half of them by less than 10, and 38 of 40 true pairs by more than 15; twice and half change no "
        "golden verdict",
        unit="nats",
    )
    sizes: int = constant(
        5,
        "of effects that compete, evenly in the logarithm between what is barely seen and the mismatch",
        "judgement: enough for a prior that is wider than the steps",
        unit="sizes",
    )
    barely_seen: float = constant(
        4.0,
        "of all residuals together, where the sizes start",
        "judgement: a larger one pays for a prior that is wider than any effect near the threshold",
        unit="standard errors",
    )


@dataclass(frozen=True)
class DetectionRules(Constants):
    """When something is said to be missing, and where."""

    detected_nats: float = constant(
        2.0,
        "log odds from which something is said to be missing",
        "measured: no false alarm in 600 simulated clean arms; where nothing is missing, an average of "
        "evidence exceeds x nats with a chance of exp(-x) at most; twice and half change no golden "
        "verdict",
        unit="nats",
    )
    sure_of_place: float = constant(
        0.95, "posterior share from which a place is said", "convention: 95 %; twice and half change no golden verdict"
    )
    listed: int = constant(
        3,
        "the likeliest, told where none is sure",
        "judgement: nobody reads more; twice and half change no golden verdict",
        unit="effects",
    )


@dataclass(frozen=True)
class SearchBudget(Constants):
    """How much is searched before the best found is called best."""

    beam: int = constant(3, "that go on after every round", "judgement: time grows in proportion", unit="hypotheses")
    branches: int = constant(3, "tried from each hypothesis", "judgement: time grows in proportion", unit="additions")
    slack_nats: float = constant(
        3.0,
        "a predicted value that falls short by more is not computed",
        "judgement: predictions are wrong by less; twice and half change no golden verdict",
        unit="nats",
    )
    special_cases: int = constant(
        7,
        "a curve's likeliest special cases that are tried in its place",
        "judgement: time; twice and half change no golden verdict",
        unit="effects",
    )
    named_at_once: int = constant(
        3,
        "taken out of a background in one step",
        "judgement: time; twice and half change no golden verdict",
        unit="names",
    )
    locally_searched: int = constant(2, "from which the local search starts", "judgement: time", unit="hypotheses")
    local_steps: int = constant(6, "of the local search", "judgement: time", unit="steps")
    local_steps_of_large: int = constant(
        2, "of the local search from a large hypothesis", "judgement: time", unit="steps"
    )
    large: int = constant(
        150, "from which a hypothesis is large: several free curves", "judgement: time", unit="columns"
    )
    gain: float = constant(
        1e-3,
        "by which a move must better a hypothesis",
        "derived: far above rounding, far below any evidence",
        unit="nats",
    )
    most_orders: int = constant(
        120,
        "of members in which Shapley shares are averaged",
        "derived: all orders of five members; of more, as many are drawn, with their reverses",
        unit="orders",
    )


@dataclass(frozen=True)
class Numerics(Constants):
    """Where rounding and time ask for a limit."""

    least_seen: float = constant(
        0.02,
        "share of a column beyond the frames below which it is scaled as if this share were left",
        "judgement: what frames absorb all but is not blown up",
    )
    cancelling: float = constant(
        3e-3,
        "RMS at the tool of frames that move against each other, as a share of each one's, below which they are held",
        "judgement: the axes of a planar arm are parallel to some milliradians",
    )
    noise_steps: int = constant(3, "of the noise's own estimate", "judgement: time", unit="steps")
    noise_settled: float = constant(
        3e-3, "relative change of the noise at which its estimate ends", "judgement: far below what any evidence feels"
    )
    rounding: float = constant(
        1e-11,
        "least ridge, relative to a column's own square",
        "derived: far above the rounding of doubles; twice and half change no golden verdict",
    )
    nothing_left: float = constant(
        1e-9,
        "of a noise's square that each number is off at least: sums of what is fitted to all digits may be below zero",
        "derived: far below any noise",
    )
    rounded: float = constant(
        1e-12,
        "relative difference below which prior variances are the same",
        "derived: far above the rounding of doubles",
    )
    absorbed: float = constant(
        1e-6,
        "share of a direction that must be left for it to explain something",
        "derived: far above the rounding of sums over rows",
    )
    rooms: tuple[int, ...] = constant(
        (1, 4, 12),
        "for how many of its columns there is room in a group of candidates scored together; larger ones go by size",
        "judgement: time; the result is the same",
        unit="columns",
    )
    beside: int = constant(
        300,
        "from which a hypothesis is evaluated beside a known one",
        "judgement: time; the result is the same but for rounding",
        unit="columns",
    )
    departs: float = constant(
        0.4,
        "share of a hypothesis' columns that may change for another to follow from its factor",
        "judgement: time; the result is the same",
    )
    inverted_at_once: int = constant(
        64,
        "up to which a triangular matrix is inverted in one piece",
        "judgement: time; the result is the same",
        unit="columns",
    )


@dataclass(frozen=True)
class ConfidenceSet(Constants):
    """Which models held-out rows exclude."""

    chance: float = constant(
        0.05, "of excluding a model that is as good as any", "convention: 95 % confidence, as all intervals"
    )
    draws: int = constant(
        500, "of blocks", "derived: at a chance of 0.05 its standard error is then 0.01", unit="draws"
    )
    fewest_blocks: int = constant(
        8, "below which nothing is excluded", "judgement: fewer are no sample of rows", unit="blocks"
    )


@dataclass(frozen=True)
class SizesByGroup(Constants):
    """How sizes of a background's values are learned."""

    freedoms: tuple[float, ...] = constant(
        (1.0, 4.0, float("inf")),
        "of Student's t that compete, by what held-out rows say",
        "judgement: seen with bench cases in view; a few waves of thirty, most of them, all alike",
        unit="values",
    )
    weight_of_stated: float = constant(
        4.0, "as which the stated size of a large group counts", "judgement: two waves", unit="values"
    )
    steps: int = constant(
        10, "in turns with the fit", "judgement: time; sizes then change by less than they are uncertain", unit="steps"
    )


PRIORS = SelectionPriors()
DETECTION = DetectionRules()
BUDGET = SearchBudget()
NUMERICS = Numerics()
CONFIDENCE = ConfidenceSet()
SIZES_BY_GROUP = SizesByGroup()
