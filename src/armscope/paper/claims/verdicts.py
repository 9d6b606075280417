"""What a share of robots supports: a verdict only where an exact interval stays on one side of the lines."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

HOLDS_FROM, FAILS_TO = 0.95, 0.05
"""A claim holds if it is true of at least this share of the robots, fails if of at most that one."""

HOLDS, FAILS, DEPENDS, OPEN = "holds", "fails", "depends on the robot", "too few robots to tell"
DECISIVE = (HOLDS, FAILS, DEPENDS)


@cache
def interval(true: int, robots: int) -> tuple[float, float]:
    """Exact 95 % interval of a share (Clopper & Pearson 1934)."""
    from scipy.stats import binomtest  # takes half a second: seldom needed

    found = binomtest(true, robots).proportion_ci(0.95, "exact")
    return float(found.low), float(found.high)


def verdict(true: int, robots: int) -> str:
    """`HOLDS`, `FAILS` or `DEPENDS` where the 95 % interval lies on one side of both lines, else `OPEN`.

    So 100 of 100 robots hold a claim, and 96 of 101 say nothing: the share may be 90 % or 98 %.
    """
    low, high = interval(true, robots)
    if low >= HOLDS_FROM:
        return HOLDS
    if high <= FAILS_TO:
        return FAILS
    return DEPENDS if low > FAILS_TO and high < HOLDS_FROM else OPEN


def under_assumptions(base: str, varied: Iterable[tuple[str, str]]) -> tuple[str, tuple[str, ...]]:
    """What remains of a verdict when the assumptions are varied.

    Args:
        varied: (which assumption was varied, the verdict then), in the order of the scenarios.

    Returns:
        (verdict, assumptions that decide it): "holds under all", "fails under all", "depends on the robot", "depends on
        the assumption" with the assumptions whose change alone gives another decisive verdict ("several at once" if
        only changes together do), or `OPEN`. Scenarios with too few robots to tell contradict nothing.
    """
    rows = [("", base), *varied]
    decisive = [(factor, each) for factor, each in rows if each in DECISIVE]
    verdicts = {each for _, each in decisive}
    if not verdicts:
        return OPEN, ()
    if len(verdicts) == 1:
        only = verdicts.pop()
        return (only if only == DEPENDS else f"{only} under all"), ()
    reference = base if base in DECISIVE else decisive[0][1]
    return "depends on the assumption", tuple(dict.fromkeys(f for f, each in decisive if each != reference))
