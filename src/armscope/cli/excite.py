"""The command that plans a motion from which masses, friction and their rivals can be told."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armscope.cli.commands import Commands
from armscope.core.inputs import InputError
from armscope.poses.exciting.constants import MOTION

if TYPE_CHECKING:
    from armscope.poses.exciting.search import Excitation

app = Commands()

MOST_SAMPLES = 1_000_000  # Of a motion: an hour at 250 Hz, which no controller takes as one table


@app.command()
def excite(
    robot: Annotated[Path | None, typer.Argument(help="robot.yaml with masses; limits in `drives` or its URDF")] = None,
    nominal: Annotated[Path | None, typer.Option("--robot", "-r", help="the arm, as for other commands")] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="motion to play; .json and .png beside it")] = Path(
        "trajectory.csv"
    ),
    separate: Annotated[
        Path | None, typer.Option(help="verdict.json: plan a motion that tells its causes from their alternatives")
    ] = None,
    period_s: Annotated[float, typer.Option(min=0.5, help="the motion repeats after this time")] = MOTION.period_s,
    harmonics: Annotated[
        int, typer.Option(min=2, max=50, help="number of harmonics; the highest frequency is harmonics / period")
    ] = MOTION.harmonics,
    rate_hz: Annotated[float, typer.Option(min=1, help="samples per second of the table")] = MOTION.rate_hz,
    floor_mm: Annotated[float | None, typer.Option(help="height of the floor in the base frame")] = None,
    radius_mm: Annotated[
        float | None,
        typer.Option(min=0, help="radius of the links; if left out, the URDF's shapes, or 4 % of the reach"),
    ] = None,
    rounds: Annotated[
        int, typer.Option(min=0, help=f"how many rounds improve the best of {MOTION.starts} random motions")
    ] = MOTION.rounds,
    seed: Annotated[int, typer.Option(min=0, help="seed of the search")] = 0,
) -> None:
    """Plan a motion of turning joints that shows masses and friction best, in all limits, clear of floor and arm."""
    from armscope.cli.robots import tell_guesses
    from armscope.core.streams import is_stream
    from armscope.robot import load_arm

    if output.suffix != ".csv" and not is_stream(output):
        raise InputError("--output", "", str(output), "a table that ends in .csv")
    if rate_hz < 2 * harmonics / period_s:
        rule = "a wave needs two samples at least: twice --harmonics / --period-s"
        raise InputError("--rate-hz", "", rate_hz, rule)
    if rate_hz * period_s > MOST_SAMPLES:
        asked = f"{rate_hz * period_s:.3g} samples"
        raise InputError("--rate-hz", "", asked, f"--rate-hz times --period-s: at most {MOST_SAMPLES:,} samples")
    chosen = _only_one(robot, nominal)
    arm = load_arm(chosen)
    tell_guesses(chosen, arm.description)

    from armscope.poses.exciting.output import pairs_of, trajectory_table, write_excitation
    from armscope.poses.exciting.search import MotionRequest
    from armscope.poses.exciting.search import excite as find
    from armscope.poses.obstacles import Surroundings
    from armscope.report.figures.exciting_motion import motion_figure
    from armscope.report.style import save_figure

    pairs = () if separate is None else pairs_of(separate, arm)
    radius, floor = (None if each is None else each * 1e-3 for each in (radius_mm, floor_mm))
    around = Surroundings(radius, floor)
    wanted = MotionRequest(period_s, harmonics, rounds, seed, pairs, rate_hz)
    found = find(arm, wanted, around, _told if sys.stderr.isatty() else None)
    write_excitation(output, found, rate_hz)
    if not is_stream(output):
        figure = motion_figure(found, trajectory_table(found, rate_hz))
        save_figure(figure, output.with_suffix(".png"), formats=("png", "svg"))
    _tell(found)
    print(output)


def _only_one(robot: Path | None, nominal: Path | None) -> Path:
    """The arm, by whichever of the two ways it was given. Raises InputError: by none, or by both."""
    if robot is not None and nominal is not None:
        raise InputError("--robot", "", str(nominal), f"one arm; {robot} was given before it", "Leave one of them out.")
    arm = robot or nominal
    if arm is None:
        cure = "armscope excite robot.yaml -o trajectory.csv"
        raise InputError("excite", "", "no arm", "needed here: robot.yaml with masses, or a URDF", f"Say: {cure}")
    return arm


def _told(done: int, of: int) -> None:
    if done % 20 == 0 or done == of:
        end = "\n" if done == of else ""
        print(f"\r{done} of {of} motions tried", end=end, file=sys.stderr, flush=True)


def _maximised(found: Excitation) -> str:
    """What this motion is better by than the median random one; the numbers themselves stand in trajectory.json."""
    before, after = found.before, found.after
    if found.pairs:
        worst = f"{before.value:.0%} of the median random motion, {after.value:.0%} of this one"
        return f"least share that can't be imitated: {worst}"
    surer = math.exp((after.value - before.value) / (2 * len(found.shown.base)))
    return f"masses and friction come out {surer:.3g} times as surely as from the median random motion (geometric mean)"


def _tell(found: Excitation) -> None:
    from armscope.poses.exciting.output import motion_notes

    before, after = found.before, found.after
    print(_maximised(found))
    for pair, was, is_now in zip(found.pairs, before.separations, after.separations, strict=True):
        words = " and ".join(" at ".join(cause) for cause in pair)
        print(f"{words}: {was:.0%} of the torque of one can't be imitated by the other, now {is_now:.0%}")
    for pair in found.inseparable:
        words = " and ".join(" at ".join(cause) for cause in pair)
        print(f"no motion tells apart {words}: whatever the motion, the torque of one can be that of the other")
    for pair in found.lawless:
        words = " and ".join(" at ".join(cause) for cause in pair)
        print(f"not planned for: {words}, for one of them has no law from which a motion could be planned")
    if (found.inseparable or found.lawless) and not found.pairs:
        print("so this motion is the one that shows everything best, as without --separate")
    shown = found.shown
    print(f"{len(shown.base)} independent parameters; weakest: {after.weakest}")
    if shown.nothing:
        print(f"moves no motor, whatever the motion: {', '.join(shown.nothing)}")
    if shown.together:
        print(f"shows only as sums with others: {', '.join(shown.together)}")
    for note in motion_notes(found):
        print(f"note: {note}", file=sys.stderr)
