"""Which motor turns which row of a pasted D-H table, and which way, as its column theta says it: "q2 - 90", "-q3"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from armscope.core.inputs import InputError
from armscope.robot.dh_cells import DHCell

TABLE = "D-H table"


@dataclass(frozen=True)
class ThetaCell:
    """What a row of the table says about its angle.

    Args:
        line: the row's.
        text: as it is written; "" where nothing is.
        read: what it says; None where nothing is written.
        degrees: what is added to the joint's angle.
    """

    line: int
    text: str
    read: DHCell | None
    degrees: float

    @property
    def turns(self) -> int:
        """1 where a joint's angle stands in it, -1 where it is taken away, else 0."""
        return self.read.turns if self.read is not None else 0


def motors_of_rows(thetas: Sequence[ThetaCell], source: dict[str, str]) -> tuple[dict[str, float], ...] | None:
    """What turns each row, by motor.

    Returns:
        `actuation` of robot.yaml; None where each row's joint turns it as it is counted.

    Raises:
        InputError: the joints' numbers are not those of the rows, or a row says nothing where others do.
    """
    if not any(theta.turns for theta in thetas):
        silent = [str(theta.line) for theta in thetas if theta.read is None]
        if silent and any(theta.text for theta in thetas):
            source["dh theta"] = (
                f"guessed: nothing is added to the joints' angles where none is written (line {silent[0]})"
            )
        return None
    for theta in thetas:
        if theta.read is None:
            rule = "every row says its theta where one names its joint"
            raise _refused(theta, rule, "Write the joint's angle, q1, or 0 where nothing turns.")
    counts = _joints_by_row(thetas, source)
    source |= dict(_told(thetas, counts))
    if all(count == row and theta.turns >= 0 for row, (count, theta) in enumerate(zip(counts, thetas, strict=True), 1)):
        return None
    return tuple(
        {f"q{count}": float(theta.turns or 1)} if count else {} for count, theta in zip(counts, thetas, strict=True)
    )


def _joints_by_row(thetas: Sequence[ThetaCell], source: dict[str, str]) -> list[int]:
    """The joint of each row, from 1; 0 where no motor turns it."""
    running = [
        sum(each.turns != 0 for each in thetas[: row + 1]) * abs(theta.turns) for row, theta in enumerate(thetas)
    ]
    by_row = list(range(1, len(thetas) + 1))
    if _agree(thetas, running, 0):
        return running
    if _agree(thetas, by_row, 0):
        return by_row
    if _agree(thetas, running, -1):
        source["dh joints"] = "guessed: the table counts its joints from 0; here they are q1, q2, ..."
        return running
    row = next(row for row, theta in enumerate(thetas) if _number(theta) not in (None, running[row]))
    rule = f"the joint of this row is number {running[row]}"
    raise _refused(thetas[row], rule, "Joints are numbered from the base on, one a row: q1, q2, q3, ...")


def _agree(thetas: Sequence[ThetaCell], counts: Sequence[int], start: int) -> bool:
    return all(_number(theta) in (None, count + start) for theta, count in zip(thetas, counts, strict=True))


def _number(theta: ThetaCell) -> int | None:
    return theta.read.joint if theta.read is not None else None


def _told(thetas: Sequence[ThetaCell], counts: Sequence[int]) -> Iterator[tuple[str, str]]:
    """What was made of each row that is more than its joint's own angle."""
    for row, (theta, count) in enumerate(zip(thetas, counts, strict=True)):
        place = f"dh.joints[{row}]"
        if not count:
            yield place, f"guessed: no motor turns it, since {theta.text!r} names no joint and other rows do"
        elif not theta.turns:
            yield place, f"guessed: q{count} turns it, {theta.degrees:g} degrees added ({theta.text!r} names no joint)"
        elif theta.turns < 0 or theta.degrees:
            way = ", counted the other way (actuation -1)" if theta.turns < 0 else ""
            added = f", {theta.degrees:g} degrees added" if theta.degrees else ""
            yield place, f"guessed: {theta.text!r} is q{count}{way}{added}"


def _refused(theta: ThetaCell, rule: str, cure: str) -> InputError:
    return InputError(TABLE, f"line {theta.line}, column theta", theta.text or "nothing", rule, cure)
