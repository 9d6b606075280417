"""Numbers that decide whether a recorded motion can be what its arm did; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class MotionRules(Constants):
    """What is odd in a table of an arm in motion."""

    speed_scale: float = 0.05
    """share by which a recorded speed may differ from the angle's derivative; judgement: units differ by far more,
    filters by less"""
    late: float = 1.0
    """that a recorded speed may be late [samples]; judgement: a backward difference is late by half"""
    farthest_lag: int = 40
    """over which a speed's lag is looked for [samples]; judgement: time"""
    clear_derivative: float = 0.5
    """share of the derivative's power that a recorded speed must follow; judgement: too noisy a derivative tells
    neither scale nor lag"""
    same_path: float = 0.01
    """of the joints' ranges, nearer than which one run's path is another's; judgement: above what control leaves, below
    another path"""
    far_turns: float = 4 * np.pi
    """beyond which an angle may be in degrees [rad]; judgement: two turns; most joints have less"""
    rows: int = 3000
    """that are looked at, spread evenly [rows]; judgement: time"""
    coarse: float = 0.05
    """over which positions are differenced [s]; judgement: sign and size show, noise does not"""
    samples: int = 20
    """fewest such samples of a run [samples]; judgement: fewer tell nothing"""
    explained: float = 0.8
    """share of a joint's torque, beyond friction, that masses must explain for its sign, size, unit or order to be
    judged; judgement: where they explain less the rest may be anything"""
    other_size: float = 3.0
    """times the masses' torque, from which most joints' is another quantity; judgement: masses are known better"""
    no_load: float = 30.0
    """times the masses' torque, from which one joint's is another quantity; judgement: ten times that of most"""
    load_within: float = 1.0
    """of the last joint, within which a load's centre lies [m]; judgement: tools are shorter"""
    reading_rows: int = 300
    """that other units and orders are tried on [rows]; judgement: time"""
    reading_samples: int = 60
    """fewest samples on which they are tried [samples]; judgement: fewer tell nothing"""
    clearly: float = 5.0
    """times less than as stated that another reading must leave; judgement: no chance of a few rows does so much"""
    turned: tuple[float, float, float] = (np.pi / 2, np.pi, -np.pi / 2)
    """by which a joint's zero is tried elsewhere [rad]; convention: other D-H tables, and makers' zeros, differ by
    quarter turns"""
    other_zero: float = 2.0
    """times less that joints' torques must leave, shares multiplied, with a zero elsewhere; measured: 1.25 at most in
    416 recordings whose zeros are right; turned by 90 deg at a random joint between the first and the last, 408 of them
    are told, with the right joint; set when half of these had been seen"""
    no_other_zero: float = 100.0
    """times less, from which results of the table mean nothing; judgement: of a wrist that carries little it is less,
    and the rest of the arm can be diagnosed"""
    other_way: float = 3.0
    """times less that joints' torques must leave, shares multiplied, with a joint counted the other way round; within
    it two joints are told as either; measured: of joints before the last 1.03 at most in 103 simulated and three real
    recordings that are counted as they should be, and 1.7 in 660 of arms whose masses and loads are far from stated,
    but for one of 3.0"""
    least_left: float = 1e-6
    """share of a torque that masses leave at the least; judgement: below any recording's noise"""
    driving: float = 0.5
    """of a torque, beyond masses and acceleration, that friction of the wrong sign must explain; judgement: most of it;
    where a sensor sees no friction there is nothing of either sign"""
    of_noise: float = 0.05
    """of a torque that masses, friction and acceleration explain at most where it is noise; judgement: of 100 samples
    of noise five numbers explain about that by chance"""
    clock: tuple[float, float, float] = (0.06, 0.5, 0.01)
    """from which, up to which and in which steps torque is looked for at another time than motion [s]; judgement: a
    diagnosis tries 36 ms, recordings started by hand differ by more; beyond, nobody overlooks it"""
    met_as_recorded: float = 0.03
    """of the power of a torque, or of most, that may be left as recorded where no other clock is looked for; measured:
    put off by 60 to 70 ms, eight simulated recordings leave 3.7 to 9 % in the middle joint; an arm in view that is on
    time leaves 2.6 %"""
    at_another_time: float = 2.0
    """times less that a joint's torque must leave at another time; measured: three real sets leave 1.03 times less at
    most at any other time; put off by 200 ms, EMPS 2.3"""
    standing: float = 0.02
    """of a joint's greatest speed, below which it stands; measured: 0.01 to 0.1 tell the UR10e put off by 100 ms either
    way, and nothing of three sets as they are"""
    around: int = 5
    """samples below that speed for which a joint that turns back may stand between two motions; judgement: a quarter of
    a second, rests are longer"""
    link_factor: float = 0.05
    """of the motor's travel, by which a link's may differ; judgement: no drive winds up so far, and no reduction is so
    wrong"""
    link_travel: float = 0.02
    """travel of a motor below which its link shows nothing [rad or m]; judgement: about a degree"""


MOTION = MotionRules()
