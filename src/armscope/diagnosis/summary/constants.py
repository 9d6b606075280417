"""Numbers that decide what is told of a finished selection; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class TellingRules(Constants):
    """What is told of the effects and of the rows."""

    listed_suspects: int = 200
    """at most [rows]; judgement: nobody reads more"""
    reads_as_sigmas: float = 3
    """times the noise of a distance within which a bad shot is a point of another target; derived: of three axes, one
    in 200,000 lies beyond"""
    labels_told: int = 10
    """at most, of rows with a wrong label [rows]; judgement: suspects.csv has all"""
    noise_excess: float = 1.15
    """times the stated noise beyond which a residual is more than the noise; judgement: statements are rounded"""
    coarsest_noise: float = 5e-3
    """of the arm's reach, per axis, beyond which nothing that measures arms is as coarse; judgement: a camera that sees
    a board is off by 1 to 3 mm at a reach of a metre"""
    same_size: float = 0.05
    """of an effect's size by which parts of the rows may differ and still give the same; judgement: seen with bench
    cases in view; who cures an effect by it takes 95 % away"""
    parallel_rad: float = 0.02
    """between axes that count as parallel [rad]; judgement: far beyond what a drawing is off"""
    another_payload_nats: float = 1.1
    """evidence, without a name's price, from which rows would rather have another payload [nats]; convention: odds of
    three to one are positive evidence (Kass and Raftery 1995); with other arms in view"""
    runs_round: float = 2.45
    """standard errors within which a tilt's part that turns the other way is none; convention: 95 % of a point about
    zero in the plane lie within"""
    runs_round_at_least: float = 0.5
    """of a tilt's size, within which that must be told; judgement: of what no row tells nothing is known to run
    round"""
    law_of_scatter_nats: float = 5.0
    """by which scatter must grow with a load, its own or an unsaid one, to be told so [nats]; judgement: odds of 150"""
    noise_shortfall: float = 0.75
    """of the stated noise, below which a residual makes it doubtful; judgement: statements are rounded"""
    run_apart: float = 0.5
    """share of a run's rows that fit nothing beyond which it is told by name; convention: most of them"""
    background_seen_nats: float = 5.0
    """evidence from which a background is said to be there [nats]; judgement: 150 to 1"""
    worst_place: float = 1.5
    """times what small errors of any other place do at the tool, from which a family's worst place is told; judgement:
    less is a matter of the poses"""
    relieves: float = 0.7
    """cosine of the phase from which a wave works against what its drive gives like a balancing spring; judgement:
    within 45 degrees of it; a spring's anchor need not stand upright"""
    unstated_load_kg: float = 1.0
    """at the flange of an arm of which no load is stated [kg]; judgement: a target's holder, a gripper's plate; nobody
    states them"""
    few_left_out: float = 0.05
    """share of rows that look like bad shots up to which they are taken to be that without a word; judgement: one
    reading in twenty; an outsider's arms with play had 15 to 25 %"""
    left_out_matters: float = 1.25
    """times the held-out error that it is with such rows, from which that is told; judgement: a quarter"""
    masses_off: float = 0.3
    """share of a drive's load by the stated masses up to which masses that are off take it away, and no spring;
    judgement: masses that are stated are off by 10 to 30 %"""
    most_bad_shots: float = 0.1
    """share of rows that fit nothing beyond which they are no bad shots; judgement: a tenth is a pattern"""
    rest_of_a_curve: float = 2.0
    """times a joint's scatter that a curve must exceed to be told beside it; judgement: less is the scatter's own"""
    play_by_order: float = 4.0
    """standard errors by which scatter must follow the side of approach that the order of rows tells [standard errors];
    derived: one in 30,000 by chance, of a handful of joints"""
    telling_share: float = 0.7
    """of a curve's variation that a simple shape must explain to be named; judgement: half of a curve is no name"""
    grid: int = 361
    """at which a curve is told [points]; convention: a turn in degrees"""
    atlas_rows: int = 4000
    """that the atlas looks at, spread evenly [rows]; judgement: time"""
    implausible_values: int = 3
    """told at most [values]; judgement: nobody reads more"""
    undetermined: float = 0.7
    """of a plausible size, beyond which a value's standard error leaves it undetermined; derived: the rows then halve
    what was believed before, at most"""
    chance: float = 0.99
    """with which all agreeing subsets of a verdict stay below the limit; convention: 99 %"""
    most_payloads: int = 6
    """compared one by one [payloads]; judgement: time"""
    curve_rows: int = 50_000
    """from which the range of what drives a curve is taken, spread evenly [rows]; judgement: memory"""
    homogeneity_rows: int = 3000
    """on which payloads and halves of the workspace are compared [rows]; judgement: time"""


@dataclass(frozen=True)
class NextPoseRules(Constants):
    """Which measurements are asked for next."""

    tried: int = 400
    """from which they are chosen [poses]; judgement: time"""
    asked: int = 12
    """asked for [poses]; judgement: an hour's work"""
    draws: int = 8
    """of what would be measured, by which it is judged whether poses settle a question; judgement: time"""
    clear_deviations: float = 2.0
    """by which a number of a reading must stand out to be taken as there [sigma]; convention: 95 %"""
    settled: float = 0.75
    """of them in which the right reading must then lead by odds of 20 to 1; judgement: three of four"""
    most_repeats: int = 64
    """of a pose [visits]; judgement: nobody measures one more often"""
    rounds: int = 20
    """of so many draws until as many are possible as compete; judgement: one in twenty is enough to choose from"""


TELLING = TellingRules()
NEXT_POSES = NextPoseRules()
