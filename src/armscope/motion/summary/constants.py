"""Numbers that decide how wide intervals are, what is told with care, or as lasting; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class PlausibleRules(Constants):
    """What an arm may be."""

    slowest_swing_hz: float = 5.0
    """at which a link swings on its drive, below which that is told as doubtful [Hz]; convention: lowest resonances of
    industrial arms lie at 5 to 25 Hz (Good, Sweet & Strobel 1985); belts are softer, so no name is refused by it"""
    samples_near_rest: int = 2
    """that most reversals must have below the speed of a friction near rest; derived: what one sample has of it, how
    friction changes sides within a sample has as well"""
    poses: int = 200
    """in which a link's inertia is looked at [rows]; judgement: it changes slowly"""


@dataclass(frozen=True)
class NamingRules(Constants):
    """What a name and its number must be worth to be told."""

    another_link: tuple[float, ...] = (1.0, 3.0)
    """shares, beyond those of all links, by which inertial parameters of links with a name may be off without it;
    judgement: a link that is another one than stated"""
    far_off: float = 10.0
    """times the least share by which masses are off, from which one number that says as much is rather told; judgement:
    3 %, more than a drawing and a scale leave"""
    beyond_gains: float = 2.5
    """times its stated uncertainty that a drive's gain must be off to have a name; convention: one in eighty is farther
    out; of poses, what a background holds has a name from there, too"""
    gain_that_matters: float = 0.03
    """by which a drive's gain must be off for it to be told, by name where no uncertainty of it is stated; judgement:
    masses that are stated from a drawing leave as much"""
    determined: float = 0.8
    """of a number that its 95 % interval reaches either way, from which the number is not determined [1]; judgement: a
    fifth of it is then as likely as nearly twice of it"""
    later_than_all_s: float = 0.006
    """by which one joint's friction must change sides later than any other's to be told as that [s]; judgement: as far
    as joints of one arm differ; decided with one arm in view, a delay of 8 ms at one joint"""
    numbers_in_a_sentence: int = 3
    """of a likely name, beyond which it stands without them; judgement: six of an inertia hid the names"""
    at_the_flange: float = 1 / 3
    """share of the flange's lever about the last joint within which a load is none that hangs at it; judgement: a load
    hangs at the flange or beyond, which may be stated too far out; where the last axis goes through the flange it asks
    for nothing"""


@dataclass(frozen=True)
class HeldOutRules(Constants):
    """What names must do for motion that took no part."""

    clearly_better: float = 0.8
    """of the held-out error without causes, below which they help although not found anew; so do nameless masses;
    judgement: a fifth is more than folds differ by"""
    as_good_anew: float = 1.05
    """times the held-out error without causes, up to which causes that are found anew do as well as none; judgement:
    folds differ by as much; decided with an outsider's recordings in view"""
    any_better: float = 0.99
    """of the held-out error without causes, below which they help at all; judgement: two percent of its power; decided
    with two of an outsider's recordings in view"""
    harm: float = 0.1
    """of the power of noise in a block, by which a background must make motion that took no part worse to go;
    judgement: less is chance, and what it fits may be there; decided with recordings in view"""
    leaves_more: float = 2.0
    """times the power that masses as stated leave at a joint, from which masses without a name go; judgement: what says
    what is there leaves less at every joint; decided with one arm in view (5.7 times)"""
    badly: float = 3.0
    """times the error on the motion that was fitted, above which a run that was held out is met badly; judgement: other
    paths are met up to twice as badly"""
    little_share: float = 0.05
    """of what friction and rotors leave, below which causes that help nothing are no part of the story; judgement: a
    fault that anybody looks for leaves more; decided with a clean recording in view"""


@dataclass(frozen=True)
class IntervalRules(Constants):
    """How wide intervals are."""

    agreeing: float = 2.0
    """paths by which agreement is believed before any is seen [paths]; judgement: what two paths differ by is hardly
    known"""
    reach_nats: float = 7.0
    """below the best, down to which models share in intervals [nats]; derived: a thousandth"""
    link_known: float = 0.1
    """of a link's mass, as far as which what it carries can't be told from it; judgement: drawings and densities tell
    masses to some percent"""
    held: float = 0.95
    """of what is believed that intervals hold; convention: 95 % intervals"""


@dataclass(frozen=True)
class LastingRules(Constants):
    """When torque that lasts and repeats is told although it has no law."""

    rows: int = 2000
    """of a joint that are looked at [rows]; judgement: what lasts needs few"""
    knots: int = 9
    """of what is looked for over one driver; judgement: as many as of a free curve"""
    knots_of_pairs: int = 6
    """of each of two drivers; judgement: a bend or two each way"""
    knots_of_time: int = 24
    """of the time in a run; judgement: some seconds each"""
    least_rows: int = 200
    """that must move [rows]; judgement: fewer repeat nothing"""
    repeats: float = 0.1
    """of the power that the model leaves at a joint, that what is learned from other motion must foretell; judgement: a
    third of its RMS; of 180 joints of arms all of whose causes have laws 0.02 at most was foretold"""
    share: float = 0.04
    """of the power that friction and rotors leave at the joint, below which nothing is told; judgement: a fifth of its
    RMS; causes' own laws are a little wrong, too"""
    shifts: int = 49
    """of the residual in time that tell what chance foretells; judgement: time"""
    by_chance: float = 0.1
    """of them that may be foretold as well; judgement: a motion that repeats itself makes some shifts alike; noise that
    lasts a second or more passes this and the share above at one joint in 60 (320 drawn)"""
    beyond: tuple[float, float] = (0.1, 0.9)
    """of the rows, by which it is shifted; judgement: beyond what lasts"""
    seconds: tuple[float, ...] = (0.5, 2.0, 8.0)
    """that torque may be remembered [s]; judgement: from a filter's time to a run's"""


@dataclass(frozen=True)
class WanderingRules(Constants):
    """When torque is told that is off for seconds at a time and follows nothing."""

    seconds: float = 1.0
    """over which its mean is taken [s]; judgement: no noise of a drive or sensor lasts as long"""
    of_torque: float = 0.05
    """of a joint's RMS torque, from which it is told; judgement: noise that lasts is less; set with two arms in view (6
    % and 38 %), where clean ones have 0.7 % at most, and the Panda's joints 2.4 %"""
    share: float = 0.25
    """of the power that friction and rotors leave at the joint, from which it is told; judgement: half of its RMS;
    where causes explain more they may be a little wrong, which lasts as well; set with two arms in view (58 % and 98
    %), where clean ones have 3 % at most"""


@dataclass(frozen=True)
class DifferingRules(Constants):
    """When runs are told to differ."""

    clear: float = 1.0
    """RMS of what a joint leaves about its runs' own lines, by which a run must read otherwise; judgement: nobody
    overlooks it in a plot; set with eight simulated arms in view (3 was too much for two of them), where clean ones
    have 0.4"""
    independent: float = 2.0
    """residuals, by what lasts in the other runs, that a run must hold for each knot of what is slow [rows]; judgement:
    fewer are as slow by chance; without it noise that lasts a second was told at 47 of 100 joints of three runs of ten
    seconds, with it at 12 (150 drawn), shorter noise at none; set with eight arms in view"""
    alike: float = 2.0
    """of what one reason leaves, up to which another is named beside it; judgement: torque of one sign"""
    widths: float = 5.0
    """standard errors of that, too; convention: all joints and runs are looked at; noise that lasts one or two seconds
    is told at 5 to 12 of 100 joints of three runs of ten seconds (150 drawn), shorter noise at none"""
    knots: int = 8
    """of what is slow in a run; judgement: a jump or a drift"""
    slow: float = 0.75
    """of the power that a run leaves, that must be slow; judgement: noise is faster, friction, too"""


PLAUSIBLE = PlausibleRules()
NAMING = NamingRules()
LASTING = LastingRules()
WANDERING = WanderingRules()
DIFFERING = DifferingRules()
INTERVALS = IntervalRules()
HELD_OUT = HeldOutRules()
