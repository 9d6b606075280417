"""What the proof counts as right, written down once: every table, figure and aim follows these definitions.

**Names.** A name is (effect, location). A verdict's names are all its effects, minor ones too, except `unknown`, which
says "something is here" without a name. Several waves or jumps of one effect at one place are one name.

**Acceptable.** A name is right if it is that of a concealed effect, or one of the alternatives that stand in the
sealed truth (within 5 nats of evidence for whoever knows everything else; decided before anybody diagnosed). Each
concealed effect is matched with at most one name. What a verdict itself lists as an alternative is no name: it counts
only where that is said (`listed`, and the aim for ambiguous worlds).

**Exact.** A set is exact if every concealed effect has an acceptable name and nothing else is said; an `unknown`
beside them makes it inexact, too.

**Minor.** On most arms a name is a name, minor or not: a wrong minor name makes a set inexact. "Exact, minor names
aside" is the same without the wrong minor ones. Arms as real ones are have small effects everywhere, which the truth
lists as minor: naming one of those is right, leaving it out is right, too; their set is exact if the effect that
dominates is named and nothing that isn't concealed.

**Rough arms** have small errors of every kind, all of them true names (`minor`), and break what a diagnosis assumes;
upon that, no to three causes stand out. The answer is right if every cause is named, the largest name (constant
geometry competes with its like only) is a cause's or of something as large, and nothing is named that isn't there;
where there is no cause: nothing that isn't there, and no name that claims more than a third of the squared error that
frames and D-H values leave, or 1.5 times its own size. An `unknown` is never wrong there. A value is absurd if it is a
D-H error above 20 mm or 50 mrad, or a compliance, amplitude or play 50 times the true one. The oracle of such an arm
knows every effect, where it is and about how large, of a gear's waves their numbers and how they fall; it fits frames
and sizes to the recorded rows. What follows a column that the table lacks it can't predict; where times are not
recorded, held-out rows are as the recorded ones were on average, and so it is of a diagnosis's model. The diagnosis is
near the oracle if its held-out RMS is at most 10 % larger. A cause is *tellable* if the oracle's own evidence for it,
the log Bayes factor against its absence, is 20 nats or more: a cause three times the noise at the tool may be nothing
that the poses could tell from small errors beside it. A name is of something as large if that is within 5 %: an offset
stated on the next row makes two rows wrong by the same.

**Outcome** of a concealed effect: `named` (its own name), `acceptable` (a sealed alternative), `listed` (only among
the alternatives of another name), `located` (another name, or `unknown`, at its place), `missed`.

**Outcome of a world outside the library**: `located` (`unknown` at the place, no name), `acceptable`, `partly named`
(`unknown` at the place, and names at the same place only), `misnamed` (any other name), `elsewhere` (`unknown`, but at
other places only), `cannot tell`, `missed` (nothing said). The aim counts the first two.

**Silent** on a clean arm: no effect is listed, and no mismatch stated.

**Found** on a power curve: `seen` means that the verdict states a mismatch, whatever it names (false alarms on clean
arms say what that is worth); `right` that the effect has an acceptable name. The oracle knows which effect to test and
uses one F test at 1 % false alarms; it fits the frames that the diagnosis must fit, too: a base in each run that the
table tells apart, and a tool point. Sizes are in multiples of the size at which that oracle finds the effect in nine
of ten cases in the same poses; so the 90 % point of the diagnosis's own curve, the monotone one that fits the cases
best (isotonic regression, interval by bootstrap), is directly "times the oracle's threshold".

**Coverage**: share of 95 % intervals that hold the true number, over the parameters of effects found under their own
name in worlds whose inputs are right. Left out: numbers that the given masses make incomparable, and scanned numbers
(count of waves, time of a jump), which have no interval and are scored as right or wrong. Directions and phases are
compared modulo what makes the same motion.

**Held out**: RMS per axis between predicted and measured points on 100 rows whose readings the diagnosis never saw,
divided by the RMS of the true model there (which is the noise). Who knew every effect and had to fit but their numbers
and the frames (six per run and three), k in all, to N rows would be off by about sqrt(1 + k / 3 N): that is the `price
of fitting`, and stands beside it. The aim is met if the median world of those that hold nothing, one or several
effects is.

**Rates** come with exact binomial (Clopper-Pearson) 95 % intervals; intervals of one world hang together, which they
don't allow for. An aim is `met` if the estimate reaches it, `open` if it does not but lies within the interval, `not
met` if it lies outside, and `too few cases` below ten: missing evidence is never a pass. Worlds whose diagnosis failed
count as wrong everywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.location import Location

Name = tuple[str, str]

CLEAR_STRENGTH = 2.95  # What counts as three times the noise: strengths are reached to within a per cent
HELD_OUT_TOLERANCE = 1.05
NEAR_ORACLE = 1.10
FALSE_ALARMS_OF_ORACLE = 0.01
ROUGH = ("rough", "rough_misleading")
LARGEST_SMALL = 0.35
"""Share of the squared error left after frames and D-H values that no name may claim where nothing stands out."""
AS_LARGE = 0.95
"""From which share of the largest cause's strength another may come first: judgement, set after one rough world had two
rows of geometry off by the same. That world is right by it and was wrong without: one of sixty fresh ones."""
TELLABLE_NATS = 20.0
"""From which the oracle itself is sure of a cause: three for a name, some ten for where and how large, and to spare.
Judgement, set when causes that the oracle has 9.8, 11.7, 27, 135 and 317 nats for were in view: so rates by it stand
beside those of all causes, never in their place."""
MOST_MAJOR = 4
ABSURD_MM, ABSURD_RAD, ABSURD_TIMES = 20.0, 0.05, 50.0
RELIABLE = 0.9  # Share of cases in which an effect of threshold size is found
RIGHT_INPUTS = ("single", "multiple", "bad_shots", "faint", "inseparable", "real")
"""Categories in which what the diagnosis is told about the arm is right (as far as it is told)."""
FEWEST_CASES = 10
SEEDS = ("fixed", "fresh", "all")


def place(location: str) -> str:
    """Where along the arm: joint 2, link 2 and "joint 2 from joint 1" are one place."""
    return Location.of(location).region


@dataclass(frozen=True)
class Aim:
    """One of the aims."""

    text: str  # as the aims say it
    table: str  # which table of cases it is counted in: worlds, effects, names or intervals
    column: str  # the column of that table that says right or wrong
    bounds: tuple[float, float]  # the least and the most that the rate may be
    among: Callable[[pd.DataFrame], pd.Series]


def category(name: str) -> Callable[[pd.DataFrame], pd.Series]:
    """Cases of a category."""
    return lambda rows: rows["category"] == name


def clear(name: str) -> Callable[[pd.DataFrame], pd.Series]:
    """Those of them in which everything concealed is three times the noise."""
    return lambda rows: (rows["category"] == name) & (rows["weakest"] >= CLEAR_STRENGTH)


def _rough_cause(rows: pd.DataFrame) -> pd.Series:
    return rows["category"].isin(ROUGH) & ~rows["minor"].astype(bool)


AIMS: tuple[Aim, ...] = (
    Aim(
        "rough arms: every cause named, the largest first, nothing false", "worlds", "right", (0.90, 1.0),
        category("rough"),
    ),
    Aim(
        "the same where the oracle itself could tell every cause", "worlds", "right", (0.90, 1.0),
        lambda rows: (rows["category"] == "rough") & rows["tellable"].astype(bool),
    ),
    Aim(
        "rough arms where times, temperatures or poses mislead: the same", "worlds", "right", (0.90, 1.0),
        category("rough_misleading"),
    ),
    Aim("causes that stand out of rough arms: named", "effects", "right", (0.95, 1.0), _rough_cause),
    Aim(
        "the same of those that the oracle itself could tell", "effects", "right", (0.95, 1.0),
        lambda rows: _rough_cause(rows) & rows["tellable"].astype(bool),
    ),
    Aim(
        "rough arms: held-out RMS within 10 % of the oracle's", "worlds", "near_oracle", (0.90, 1.0),
        lambda rows: rows["category"].isin(ROUGH),
    ),
    Aim(
        "rough arms: 95 % intervals of causes hold the true number", "intervals", "covered", (0.93, 0.97),
        lambda rows: _rough_cause(rows) & rows["covered"].notna(),
    ),
    Aim("no name on clean arms", "worlds", "silent", (0.99, 1.0), category("clean")),
    Aim(
        "exact set of names, single effects at 3x the noise and above", "worlds", "exact", (0.95, 1.0), clear("single")
    ),
    Aim("exact set of names, two to six effects at 3x and above", "worlds", "exact", (0.90, 1.0), clear("multiple")),
    Aim(
        "location right whenever the name is", "names", "right", (1.0, 1.0),
        lambda rows: rows["effect_right"].astype(bool),
    ),
    Aim(
        "95 % intervals hold the true number", "intervals", "covered", (0.93, 0.97),
        lambda rows: rows["category"].isin(RIGHT_INPUTS) & rows["covered"].notna(),
    ),
    Aim("outside the library: located and not misnamed", "worlds", "outside_right", (0.90, 1.0), category("outside")),
    Aim(
        "ambiguous: the truth among effects or alternatives", "effects", "among_all", (0.95, 1.0),
        lambda rows: rows["ambiguous"].astype(bool) & ~rows["minor"].astype(bool) & (rows["category"] != "faint"),
    ),
    Aim(
        "held-out RMS within 5 % of the true model's (share of worlds; clean, single, multiple)", "worlds",
        "held_out_close", (0.5, 1.0), lambda rows: rows["category"].isin(("clean", "single", "multiple")),
    ),
)  # fmt: skip
"""Counted aims. Held-out RMS: met in the median world; the threshold of detection is fitted, see `power`."""

THRESHOLD_AIM = (0.0, 1.25)  # The 90 % point of the diagnosis in multiples of the oracle's


def judged(cases: int, estimate: float, low: float, high: float, aim: tuple[float, float]) -> str:
    """ "met", "open", "not met" or "too few cases" for an estimate with an interval, against the aim's bounds.

    Args:
        cases: how many; too few are not judged.
        estimate: of the share or ratio.
        low, high: its 95 % interval.
        aim: least and most that are aimed at.

    Returns:
        One of the four.
    """
    if cases < FEWEST_CASES or not np.isfinite(estimate):
        return "too few cases"
    least, most = aim
    if least <= estimate <= most:
        return "met"
    return "open" if low <= most and high >= least else "not met"
