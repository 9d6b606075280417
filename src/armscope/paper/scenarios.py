"""Which assumptions of a study are varied, and how: one at a time, and all together on a space-filling design."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd

from armscope.core.config import Point
from armscope.core.inputs import InputError
from armscope.paper.virtual import PlannedPaths, Sizes, StudyPlan
from armscope.robot import Arm

Corners = tuple[Point, Point, Point, Point]
Change = Callable[[StudyPlan], StudyPlan]

GEOMETRY, TOLERANCES, POSE_RANGES = "arm geometry", "size of the tolerances", "ranges of the poses"
THETA_6, CORNERS, RISE, NOISE = "range of theta6", "corners of trajectory I", "rise of II and III", "noise"
JOINTLY = "several at once"


@dataclass(frozen=True, eq=False)
class Varied:
    """The other values of each assumption."""

    arms: tuple[Arm, ...]
    tolerances: tuple[float, ...]  # factors on all sizes
    margins_rad: tuple[float, ...]  # by which the poses' joint ranges are wider than the paths'
    motor_6_rad: tuple[float, ...]  # ranges of theta6, +-
    corners_mm: tuple[Corners, ...]
    rises_mm: tuple[float, ...]  # of trajectories II and III
    repeats_mm: tuple[float, ...]  # how well the arm repeats, 1-sigma
    together: int  # how many scenarios of the joint design
    seed: int

    def levels(self) -> dict[str, list[tuple[str, Change]]]:
        """By assumption, its other values: how they read, and what they change."""
        return {
            GEOMETRY: [(arm.name, _arm(arm)) for arm in self.arms],
            TOLERANCES: [(f"times {factor:g}", _sizes(factor)) for factor in self.tolerances],
            POSE_RANGES: [(f"paths' ranges + {value:g} rad", _poses(margin_rad=value)) for value in self.margins_rad],
            THETA_6: [(f"within ± {value:g} rad", _poses(motor_6_rad=value)) for value in self.motor_6_rad],
            CORNERS: [(_corner_words(corners), _paths(corners_mm=corners)) for corners in self.corners_mm],
            RISE: [(f"{value:g} mm", _paths(rise_mm=value)) for value in self.rises_mm],
            NOISE: [(f"arm repeats to {value:g} mm", _repeat(value * 1e-3)) for value in self.repeats_mm],
        }


@dataclass(frozen=True, eq=False)
class Scenario:
    """One set of assumptions: which of them differ from the study's (`factor`), how (`level`), and all of them."""

    name: str
    factor: str
    level: str
    plan: StudyPlan


def scenarios(base: StudyPlan, varied: Varied) -> list[Scenario]:
    """Each value of each assumption by itself, then the joint design."""
    levels = varied.levels()
    singles = [(factor, words, change(base)) for factor, choices in levels.items() for words, change in choices]
    rows = [*singles, *((JOINTLY, words, plan) for words, plan in _together(base, levels, varied))]
    return [Scenario(f"s{number:02}", *row) for number, row in enumerate(rows, start=1)]


def _together(
    base: StudyPlan, levels: Mapping[str, Sequence[tuple[str, Change]]], varied: Varied
) -> Iterator[tuple[str, StudyPlan]]:
    """A Latin hypercube over the levels of all assumptions, the study's own among them."""
    from scipy.stats import qmc  # takes half a second: seldom needed

    if not varied.together:
        return
    design = qmc.LatinHypercube(len(levels), rng=varied.seed).random(varied.together)
    for row in design:
        plan, words = base, []
        for place, (factor, choices) in zip(row, levels.items(), strict=True):
            number = int(place * (len(choices) + 1))
            if number:
                text, change = choices[number - 1]
                plan = change(plan)
                words.append(f"{factor}: {text}")
        yield "; ".join(words) or "none", plan


def check_reach(plans: Sequence[tuple[str, StudyPlan]]) -> pd.DataFrame:
    """Follow the paths of all scenarios before anything else is done with them. Raises InputError: names every
    scenario with a point that its arm can't reach, and why."""
    rows, missed = [], []
    followed: dict[tuple[int, PlannedPaths], int | InputError] = {}  # most scenarios change neither arm nor paths
    for name, plan in plans:
        asked = id(plan.arm), plan.paths
        if asked not in followed:
            followed[asked] = _points_followed(plan)
        found = followed[asked]
        if isinstance(found, InputError):
            missed.append((name, found))
        else:
            rows.append({"scenario": name, "arm": plan.arm.name, "points": found})
    if missed:
        name, first = missed[0]
        rest = f" (as in {len(missed) - 1} more scenarios)" if len(missed) > 1 else ""
        raise InputError(f"{name}{rest}: {first.file}", first.place, first.found, first.rule, first.cure)
    return pd.DataFrame(rows)


def _points_followed(plan: StudyPlan) -> int | InputError:
    """How many points of its test paths a plan's arm follows, or why it can't."""
    try:
        return len(plan.follow())
    except InputError as error:
        return error


def _arm(arm: Arm) -> Change:
    return lambda plan: replace(plan, arm=arm)


def _sizes(factor: float) -> Change:
    def change(plan: StudyPlan) -> StudyPlan:
        sizes: Sizes = plan.sizes.times(factor)
        return replace(plan, sizes=sizes)

    return change


def _poses(**values: Any) -> Change:
    return lambda plan: replace(plan, poses=replace(plan.poses, **values))


def _paths(**values: Any) -> Change:
    return lambda plan: replace(plan, paths=replace(plan.paths, **values))


def _repeat(size_m: float) -> Change:
    return lambda plan: replace(plan, repeat_m=size_m)


def _corner_words(corners: Corners) -> str:
    return " – ".join(" ".join(f"{value:g}" for value in corner) for corner in corners[1:])
