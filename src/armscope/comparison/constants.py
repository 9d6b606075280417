"""Numbers that decide what changed between recordings; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class ComparingRules(Constants):
    """What is compared with what, and what of it is told."""

    level: float = 0.05
    """how often something is named although nothing changed; convention"""
    power: float = 0.9
    """share of cases in which a change is named that would be seen; convention"""
    enough_arms: int = 5
    """of one type, with fewer of which none is unlike the others for certain [arms]; judgement: a zero off by 5 mrad
    among zeros of 0.4 mrad was named in six arms, and not in four"""
    changes: int = 8
    """changes of one comparison, at most; judgement: with more, it is another arm"""
    better_nats: float = 1e-6
    """by which as many numbers in a change's place must be likelier [nats]; derived: rounding, so that the search
    ends"""
    surely_negative: float = 3.0
    """below zero, from which a number that cannot be is, and its name with it [standard errors]; convention: three;
    less is nothing and noise"""
    beyond_all: float = 10.0
    """times what arms show, from which half an interval about nothing says that the rows leave a change open;
    judgement: ten times as much is on no arm"""
    clearly_worse: float = 3.0
    """by which rows leave more once a change is taken back, or less, from which that is said [standard errors];
    convention: three"""
    named: int = 3
    """recordings with a change that are told by name; judgement: as many are read"""
    moved_point: float = 3.0
    """times the noise per axis, beyond which a measured point surely sits elsewhere on the flange; judgement: a
    reflector that is put on again comes back to less"""
    named_shots: int = 5
    """bad shots that are told by name [rows]; judgement: as many are looked at"""
    many_alike: int = 8
    """causes that explain a change as well, more of which leave it without a name; judgement: nobody tests more"""
    same_poses: float = 0.5
    """share of each joint's range (5 to 95 % of its angles) that recordings of the same poses have in common;
    judgement: the half"""
    still_rad: float = 0.02
    """motion below which a joint stands still [rad]; judgement: a degree"""
    same_payload_kg: float = 0.1
    """difference up to which payloads are the same [kg]; judgement: a screw or a cable"""
    no_surprise: float = 0.5
    """probability, times the number of halves, from which the halves differ by chance; convention: as every other
    time"""
    halving_axes: int = 3
    """of the poses, along which a recording is halved, beside early and late; judgement: the largest; time"""
    most_dispersion: float = 1e4
    """factor that makes the halves' differences no surprise, at most; judgement: noise a hundred times as large"""
    dispersions: int = 400
    """that are tried up to it; derived: each is larger by 2.3 %"""
    covered: tuple[float, float] = (0.05, 0.95)
    """quantiles of a joint's angles between which its range is; convention: nine in ten"""
    interval: float = 0.975
    """quantile to which a change's interval goes from its middle, on either side; convention: 95 % intervals"""


@dataclass(frozen=True)
class SharedModelRules(Constants):
    """The model that all recordings share, and what of it may differ."""

    prior_mm: float = 3.0
    """size of a shared effect at the tool [mm]; judgement: an arm's own errors are of this size (ISO 9283 accuracies of
    uncalibrated arms)"""
    terms: int = 12
    """of an effect whose change is tested, at most; judgement: free curves are left out, which would stand for any
    other"""
    unseen: float = 1e-3
    """share of a column's square that must be left beside what is shared for its change to be seen; derived: 3 % of its
    size at the tool"""
    weighings: int = 4
    """rounds in which short recordings get their weight; judgement: in the first a noisy one pulls the fit of a quiet
    one"""
    free_alone: float = 20.0
    """numbers that are free when a recording is fitted alone, from which its noise is known by that; derived: to 1 /
    sqrt(2 x 20) = 16 %; with one free, eight pairs of 20 seemed to have changed"""
    row_weighings: int = 6
    """of rows by how far off they lie, at most [rounds]; judgement: bad rows then count for nothing"""
    most_bad: float = 0.05
    """share of a recording's rows that may hide each other; judgement: one in twenty; more are no bad shots"""
    left_out: float = 1e-6
    """weight of a row that is left out; judgement: a thousandth of its size"""
    same_weight: float = 0.01
    """change of a row's weight below which they are settled; judgement: a hundredth of a row"""
    widened: float = 10.0
    """times the size of a shared effect, as the prior of a change that is told; judgement: freely, but not where one
    recording alone does not tell it"""
    first_noise: float = 100.0
    """times below the mean square of the residuals, from which the variance of the noise is looked for; judgement: an
    arm's errors are about ten times the noise"""
    noise_rounds: int = 4
    """in which it is found [rounds]; judgement: it then changes by less than it is uncertain"""
    size_rounds: int = 6
    """in which it is learned how large errors of each arm's own are [rounds]; judgement: sizes then change by less than
    they are uncertain"""
    least_size: float = 0.1
    """by which errors of each arm's own become smaller in a round, at most; judgement: none goes at once"""
    hidden: int = 3
    """differences, each of which is tried as no part of what is usual of arms; judgement: of five planted zeros the
    first alone missed two, three miss one"""
    least_told: float = 1.0
    """numbers from which a place says how large an error of each arm's own is; derived: fewer are none"""
    least_worth: float = 2.0
    """numbers that all places of a kind are worth for one, at least; judgement: two; else a place of which the rows
    tell little has any size"""
    least_variance: float = 1e-12
    """of the noise [mm2]; derived: far below any instrument's; exact rows would have none"""
    least_square: float = 1e-24
    """added to each recording's variance where it is weighed [mm2]; derived: far below any instrument's"""
    least_left: float = 1e-12
    """share of the squares that a change leaves at least; derived: some thousand times rounding"""
    held: float = 1e-9
    """penalty on frames and changes of unit length; judgement: too little for any that the rows tell"""


@dataclass(frozen=True)
class GrownRest(Constants):
    """When more is left of a recording than of others."""

    times: float = 2.0
    """what is left of it, in standard deviations of the other; judgement: an instrument that stands twice as far away
    is as noisy; less is no finding"""


COMPARING, SHARED, GROWN = ComparingRules(), SharedModelRules(), GrownRest()
