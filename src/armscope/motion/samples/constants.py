"""Numbers that decide how samples become rows; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class TimingRules(Constants):
    """When time stamps are mended."""

    uneven: float = 0.05
    """steps that differ from the usual one by this share are uneven; judgement: jitter of a real clock"""
    rebuilt: float = 0.5
    """share of what angle and velocity disagree by that must go for time to be rebuilt from them; judgement: whole
    steps always fit a little better; measured on the Panda 0.1, on the UR10e 1.0"""
    slower: float = 1.2
    """a run sampled more slowly than the common rate by this factor has its positions laid by a spline; one sampled
    faster is low-passed before; judgement: beyond jitter"""
    gap: float = 5.0
    """a longer step than this parts a run in two [usual steps]; judgement: a line across more is a guess"""
    gap_s: float = 0.05
    """a shorter step parts no run [s]; judgement: arms hardly bend their path in it"""
    named: int = 5
    """gaps in time that are named of a run; convention: more is a list, not a sentence"""
    told_apart: float = 0.1
    """error of a step, from angle and velocity, with which it is whole [periods]; judgement: rounding is then sure"""
    resolved: float = 3.0
    """that a moving arm travels between two samples; one that stays is a repetition [digits of the table]; judgement:
    more than rounding"""
    slowest_hz: float = 5.0
    """a motion is sampled at least this often [Hz]; judgement: joints turn through a cycle in seconds; slower stamps
    are milliseconds called seconds"""


@dataclass(frozen=True)
class FilterRules(Constants):
    """How samples become rows."""

    order: int = 4
    """of the Butterworth low-pass, run forward and back; convention"""
    position_band: float = 5.0
    """cut-off of the positions, before they are derived [cut-offs]; convention: of the motions' protocol"""
    nyquist: float = 0.8
    """largest cut-off [half sampling rates]; convention: of the protocol"""
    edge_s: float = 0.5
    """left out at both ends of every stretch [s]; convention: of the protocol"""
    shortest_s: float = 2.0
    """a stretch that is no longer takes no part [s]; derived: half of it is ends that are left out"""
    rows_per_cutoff: float = 3.0
    """rows kept, per cycle of the cut-off frequency; derived: a fourth-order filter's noise is independent from about
    here; the rest is measured"""
    formed_per_cutoff: float = 8.0
    """at which the model is formed, per cycle of the positions' cut-off [samples]; derived: a fourth-order filter, run
    forward and back, leaves 2e-5 of what is beyond half of it"""
    most_rows: int = 30_000
    """kept of all runs [rows]; judgement: more neighbours say the same; memory and time"""
    coulomb_width_rad_s: float = 0.01
    """speed within which friction changes sides [rad/s]; convention: of the protocol"""
    coulomb_width_m_s: float = 0.001
    """the same of a joint that slides [m/s]; convention: of the protocol"""
    reach: float = 6.0
    """of the low-pass's weights either way [periods of the cut-off]; derived: a fourth-order Butterworth filter has
    forgotten all but a millionth"""
    rows_at_once: int = 16
    """filtered at a time [rows]; measured: the fastest of 8, 16, 32"""
    sharper: float = 5.0
    """that friction may change sides more sharply than within the width; judgement: no filter shows more"""
    wider: tuple[float, ...] = (2.0, 4.0, 8.0)
    """within which a joint's friction may change sides instead, where its motion says so [widths]; judgement: grease
    and preloaded slides; wider is a curve of friction over speed"""
    blunter: float = 2.0
    """that friction may change sides less sharply than within the chosen width; derived: a step of `wider`"""
    sharper_at_rest: float = 5.0
    """more sharply still, where torque is predicted: fits leave joints out that stand, predictions begin with them;
    judgement: above what positions' steps make of a speed at rest"""
    one_side: float = 20.0
    """from rest, beyond which friction's side is 1 to all digits [widths]; derived: it differs by twice e to the power
    of -40"""
    alike: float = 1e-3
    """change of speed within a sample below which friction's mean over it is that in its middle [widths]; derived: they
    differ by a millionth"""
    single: float = 1e-6
    """of the largest column, or of one beyond the others, up to which it is rounding; derived: above that of columns,
    which are held in single precision"""
    rounding: float = 1e-9
    """share of a slope's square that is its own, from which it tells anything; derived: far above rounding"""
    still: float = 2.0
    """a joint slower than this stands: its friction may be anything [widths]; judgement: in the band where it changes
    sides"""
    still_s: float = 0.25
    """how long, to stand and not to turn back [s]; judgement: a reversal is shorter"""
    pause_s: float = 0.05
    """that a joint stays where it is, for a pause [s]; judgement: turning back is shorter"""
    pause_travel: float = 0.05
    """of the width within which friction changes sides: a joint that is slower stays where it is [widths]; judgement:
    friction needs more way to come to its other side"""
    pause_shown: float = 0.03
    """of the strongest force in a pause, below which one is hidden by the low-pass; judgement: noise is more"""
    pause_blurred: float = 0.5
    """periods of the positions' cut-off by which a pause seems longer or shorter at either end [periods]; derived: of
    the low-pass's impulse response, nearly all is within"""
    pause_piece: float = 0.5
    """in which the force of a pause is constant [periods of the higher cut-off]; derived: a low-pass shows nothing
    finer"""
    pause_reach: float = 2.0
    """of the torques' cut-off, by which rows about a pause hold of it [periods]; derived: the impulse response beyond
    is below a hundredth"""
    pauses_at_once: int = 20
    """whose rows overlap, taken together [pauses]; judgement: time"""
    chunk: int = 30_000
    """worked on at a time [samples]; judgement: memory"""


@dataclass(frozen=True)
class ReadingRules(Constants):
    """What a channel shows of itself."""

    at_the_limit: int = 5
    """in a row at a channel's largest value that mean it was cut off there [samples]; judgement: noise repeats no
    value"""
    fine: float = 200.0
    """in a channel's range, from which noise is more than a step as a rule and repeats no value [steps]; judgement: a
    step of half a percent; eight bits have 256"""
    unread_s: float = 0.5
    """for which a channel repeats one value that was not read [s]; judgement: fifty samples at 100 Hz"""
    spike: int = 3
    """in a row that may stand alone [samples]; judgement: a frame that was lost"""
    usual_off: float = 99.0
    """of a channel's readings that are as near to their neighbours as is usual; judgement: spikes are rare"""
    far_off: float = 12.0
    """times farther from its neighbours than is usual that a reading must be to stand alone; measured: up to 10 times
    in 20 x 5,000 samples of noise with Student's tails, three degrees of freedom"""
    back: float = 0.15
    """of how far it is off, within which a channel is back after it; judgement: a blow rings on"""
    least_off: float = 2e-3
    """of a channel's range, below which nothing is far off; judgement: of a channel without noise"""
    part_turn: float = np.pi / 2
    """by which a step may differ from a whole turn, or from standing still, where an angle is recorded within one
    [rad]; derived: a joint at 450 deg/s, faster than most, at the slowest sampling that is taken"""
    usual_steps: float = 95.0
    """of an angle's steps that are usual [%]; judgement: jumps are fewer than one in twenty"""
    leap: float = 10.0
    """times the usual steps, from which one is no motion; judgement: no arm speeds up so from rest to a step"""
    rounding: float = 1e-9
    """of a channel's range, below which a change is rounding of the computer; derived: of double precision"""
    temperature: tuple[float, float] = (-50.0, 150.0)
    """between which the temperature of an arm lies [degrees C]; judgement: drives' windings stand 155 at the most
    (insulation class F), and kelvin begin at 220 outdoors"""
    cut_reach: float = 1.0
    """of the torques' cut-off, within which a row holds some of what was cut off [periods]; derived: of the low-pass's
    impulse response 1 % is beyond"""


@dataclass(frozen=True)
class CutoffRules(Constants):
    """How the cut-off is chosen."""

    widest: float = 0.2
    """largest cut-off, as a share of the sampling rate; judgement: derivatives are noise above"""
    widest_hz: float = 50.0
    """largest cut-off [Hz]; judgement: arms' drives do not follow faster"""
    least_hz: float = 2.0
    """smallest cut-off [Hz]; judgement: motions of arms"""
    window: int = 256
    """of the spectra [rows]; judgement: some tenths of a hertz"""
    above_noise: float = 10.0
    """of the positions' noise, from which their spectrum shows motion; derived: a chi-squared of some ten degrees of
    freedom hardly ever reaches it"""
    beyond_motion: float = 2.0
    """times the highest frequency of motion at which positions are low-passed; derived: the filter then takes 0.4 % of
    that frequency"""
    close_to_motion: float = 1.4
    """times that frequency, where torques are low-passed at a higher one; derived: where the spectrum of positions
    falls with the 6th to 12th power of the frequency, what the filter takes of an acceleration and the noise that it
    lets through are least together at 1.2 to 1.5"""
    slower_run: float = 0.7
    """of the widest band of positions, below which a run has one of its own; judgement: half the noise's power"""
    drowned: float = 2.0
    """of what is left, below which the model drowns; judgement: neither is exact"""
    bins: int = 4
    """in a row that must be drowned [bins]; judgement: gaps in a spectrum are no end"""
    fallback: float = 0.05
    """of the sampling rate, where no spectrum can be taken; judgement: as in the sets"""


TIMING = TimingRules()
FILTER = FilterRules()
CUTOFF = CutoffRules()
READING = ReadingRules()
