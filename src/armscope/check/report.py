"""`armscope check`: what a recordings table holds and what looks wrong in it, in words."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from armscope.check.constants import TABLE
from armscope.check.contents import Contents, Context, RunContents, contents_of
from armscope.check.enough_rows import still, too_few
from armscope.check.quantities import of_quantities
from armscope.check.suspicion import BESIDE, SAYS_MORE, TOO_SHORT, Suspicion, first_of_suspicions, verdict_lines
from armscope.check.suspicions import Consistency, against_arm
from armscope.check.targets import named_row_by_row
from armscope.core.files import plain_values
from armscope.core.told import InWords
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.schema import ANOTHER_MODEL

NOT_A_DRIVER = ("orientation", "sigma")
"""What may well be the same in every row."""


@dataclass(frozen=True, repr=False)
class CheckReport(InWords):
    """Contents of a table and, where an arm was given, how they fit it."""

    contents: Contents
    consistency: Consistency | None
    suspicions: tuple[Suspicion, ...]

    @property
    def has_problems(self) -> bool:
        """Whether anything makes results from this table meaningless."""
        return any(each.weight == "problem" for each in self.suspicions)

    def to_json(self) -> dict[str, Any]:
        """The contents, how they fit the arm, and what looks wrong, as plain data."""
        fit = None if self.consistency is None else asdict(self.consistency)
        content: dict[str, Any] = {
            "problems": self.has_problems,
            "suspicions": [vars(each) for each in self.suspicions],
            "contents": asdict(self.contents),
            "consistency": fit and {key: value for key, value in fit.items() if key != "suspicions"},
        }
        return dict(plain_values(content))

    def sentences(self) -> tuple[str, ...]:
        """What looks wrong, in which table, and what says more."""
        about = f"{self.contents.source}: {self.contents.rows} rows, {len(self.contents.runs)} run(s)."
        return first_of_suspicions(self.suspicions), about, SAYS_MORE

    def text(self) -> str:
        """The report as plain text."""
        return "\n".join(
            [
                *_table_lines(self.contents),
                *_arm_lines(self.consistency, self.contents.rows),
                *verdict_lines(self.suspicions),
            ]
        )


def check(recordings: Recordings, arm: Arm | None = None) -> CheckReport:
    """Look through a table.

    Args:
        recordings: the table; read it without a number of motors, so that a wrong one can be reported.
        arm: the robot it should belong to; None looks at the table alone.
    """
    contents = contents_of(recordings)
    consistency = None if arm is None else against_arm(arm, recordings)
    fits = arm if arm is not None and arm.n_motors == recordings.n_motors else None
    of_arm = consistency.suspicions if consistency else ()
    found = [*_of_table(contents), *still(recordings), *of_quantities(recordings, fits)]
    found += [] if any(each.kind == TOO_SHORT for each in found) else too_few(recordings, fits)
    alone = [] if arm else [*named_row_by_row(recordings), *_of_units(contents)]
    return CheckReport(contents, consistency, (*of_arm, *found, *alone))


def what_forbids(recordings: Recordings, arm: Arm) -> tuple[Suspicion, ...]:
    """What `check` finds of the kinds that make results meaningless; nothing else in the table is counted for it.

    Args:
        recordings: the table, of as many motors as the arm has.

    Returns:
        Its problems, whether it is another model's, and whether gravity or sides of approach seem to be turned round.
    """
    found = (*against_arm(arm, recordings).suspicions, *still(recordings), *of_quantities(recordings, arm))
    return tuple(each for each in found if each.weight == "problem" or each.kind in (ANOTHER_MODEL, *BESIDE))


def _of_table(contents: Contents) -> tuple[Suspicion, ...]:
    found = []
    constant = [each.name for each in contents.context if each.constant and not each.name.startswith(NOT_A_DRIVER)]
    if constant:
        verb, it = ("never changes", "it") if len(constant) == 1 else ("never change", "them")
        found.append(Suspicion("hint", f"{', '.join(constant)} {verb}, so nothing shows what changes with {it}"))
    if contents.repeats.copies:
        statement = f"{contents.repeats.copies} rows are copies of other rows, to the last digit"
        found.append(Suspicion("hint", statement, "A table pasted twice? `armscope diagnose` leaves them out."))
    for run in contents.runs:
        found += _of_extent(run)
    return tuple(found)


def _of_units(contents: Contents) -> list[Suspicion]:
    """What an arm would say better, where there is none to ask."""
    found = []
    widest = max(motor.high - motor.low for motor in contents.motors)
    for run in contents.runs:
        if widest > TABLE.far and run.moved and not TABLE.extent[0] < max(run.extent) < TABLE.extent[1]:
            size = f"{max(run.extent) * 1e3:.3g} mm"
            statement = f"the points{_of(run.name)} lie within {size}, though joints move by up to {widest:.2g} rad"
            found.append(Suspicion("hint", statement, "Are the positions in the unit that their columns' names say?"))
    if 0 < max(max(abs(motor.low), abs(motor.high)) for motor in contents.motors) <= TABLE.radians_as_degrees:
        statement = "no joint stands further from zero than 6.3 degrees"
        found.append(Suspicion("hint", statement, "Are the angles radians that were declared as degrees?"))
    return found


def _of_extent(run: RunContents) -> list[Suspicion]:
    """What the extent of a run's points says."""
    extent = np.sort(run.extent)
    if extent[2] < TABLE.one_point:
        statement = f"all rows{_of(run.name)} are at one point"
        return [Suspicion("hint", statement, "They tell the noise, and nothing about the arm.")]
    if run.rows > 3 and run.flatness < TABLE.flat:  # three points always do
        statement = f"all points{_of(run.name)} lie in one plane"
        return [
            Suspicion(
                "hint",
                statement,
                "Where that is not how the arm moves, spread the poses: they tell little of what acts across it.",
            )
        ]
    return []


def _of(run: str) -> str:
    return f" of run {run}" if run else ""


def _table_lines(contents: Contents) -> list[str]:
    lines = [f"{contents.source}: {contents.rows} rows, {len(contents.runs)} run(s)"]
    for run in contents.runs:
        listed = ", ".join(run.targets[: TABLE.listed]) + ", ..." * (len(run.targets) > TABLE.listed)
        targets = f", targets {listed}" if run.targets else ""
        size = " x ".join(f"{length * 1e3:.4g}" for length in run.extent)
        lines.append(
            f"  run {run.name or '(no name)'}: {run.rows} rows, {run.configurations} configurations{targets}; "
            f"points within {size} mm{_moved(contents, run)}"
        )
    lines.append("joints (degrees):")
    for motor in contents.motors:
        state = "" if motor.moved else "  held"
        lines.append(f"  q{motor.motor}: {np.degrees(motor.low):8.2f} ... {np.degrees(motor.high):8.2f}{state}")
    lines.append("context:" if contents.context else "context: none recorded")
    lines += [f"  {_context_line(context)}" for context in contents.context]
    repeats = contents.repeats
    seen = f" (first {repeats.looked_at} rows)" if repeats.looked_at < contents.rows else ""
    if repeats.visits:
        poses = "1 pose was" if repeats.visits == 1 else f"{repeats.visits} poses were"
        lines.append(
            f"repeats{seen}: {poses} visited again, {repeats.rows} rows, "
            f"scatter {repeats.scatter * 1e3:.3g} mm per axis"
        )
    else:
        lines.append(f"repeats{seen}: no pose was visited again")
    return lines + [f"note: {note}" for note in contents.notes]


def _moved(contents: Contents, run: RunContents) -> str:
    """Which joints move in a run, where others move elsewhere."""
    if len(run.moved) == sum(motor.moved for motor in contents.motors):
        return ""
    return "; only q" + ", q".join(map(str, run.moved)) + " move" if run.moved else "; no joint moves"


def _context_line(context: Context) -> str:
    missing = f", missing in {context.missing} rows" if context.missing else ""
    if context.name == "orientation":
        return f"orientation{missing}"
    unit = f" {context.unit}" if context.unit else ""
    if context.constant:
        return f"{context.name}: {context.low:.6g}{unit} throughout{missing}"
    return f"{context.name}: {context.low:.6g} ... {context.high:.6g}{unit}{missing}"


def _arm_lines(consistency: Consistency | None, rows: int) -> list[str]:
    if consistency is None:
        return ["no robot was given (--robot): nothing was tried against an arm"]
    if np.isnan(consistency.rms):
        return []
    return [
        f"nominal arm, base and tool fitted: {consistency.rms * 1e3:.4g} mm RMS distance "
        f"of a {consistency.spread * 1e3:.4g} mm spread, over {consistency.rows} of {rows} rows"
    ]
