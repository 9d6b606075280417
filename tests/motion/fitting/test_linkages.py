"""A gas spring between two links is a balancer, mounted as it is; a cable that no spring makes stays a cable."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from benchmarks.motion_own_arms import MIDDLE
from benchmarks.motion_springs import SPRINGS, World, said

from armscope.motion.fitting.linkages import _Judged, mount_unsure, remounted
from armscope.motion.library import catalogue
from armscope.motion.library.linkage import BETWEEN_LINKS
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm
from tests.seeds import seeds


@functools.cache
def asked(kind: str, n: int, seed: int) -> tuple[World, MotionDiagnosis]:
    """A world on waves, and what is said of it: several tests ask the same one."""
    world = World(kind, n, seed)
    arm = build_moving_arm(RobotDescription.model_validate(world.arm.robot(stated=world.seed % 2 == 0)))
    return world, diagnose_motion(arm, as_motions(world.recorded(), "motions.csv", world.n))


@pytest.mark.long
@pytest.mark.parametrize("kind", [*(pytest.param(kind, marks=pytest.mark.long) for kind in ("even", "near")), "over"])
@pytest.mark.parametrize("seed", seeds(4, 1, 2, 3))
def test_a_gas_spring_is_a_balancer_mounted_as_it_is(kind: str, seed: int) -> None:
    (world, found), spring = asked(kind, 3 + seed % 4, seed), SPRINGS[kind]
    right, words = said(world, found.verdict)
    assert right, words
    numbers = {each.name: each for each in found.verdict.effects[0].parameters}
    if kind == "even":  # a curve without a bend: where its ends are is hardly told
        return
    assert "gas spring or balancer between two links" in found.verdict.headline
    ratio = min(spring.before, spring.behind) / max(spring.before, spring.behind)
    assert numbers["ratio"].value == pytest.approx(ratio, abs=min(0.05, 3 * numbers["ratio"].stderr))
    apart, unsure = numbers["phase"].value - (spring.between - MIDDLE[world.joint]), numbers["phase"].stderr
    assert unsure < 0.1
    assert np.sin(apart) == pytest.approx(0, abs=min(max(0.05, 2 * unsure), 3 * unsure))
    assert np.cos(apart) > 0


@pytest.mark.long
def test_a_mount_is_known_as_far_as_half_a_nat_is_lost() -> None:
    """One standard deviation away either way, with all else fitted and the best of the mount's other number."""
    (world, found), spring = asked("over", 3, 4), SPRINGS["over"]
    selected = found.selected
    (number,) = selected.best.candidates
    placed = selected.rows.layout.placed[number]
    *mount, middle = placed.columns.numbers
    _, variance = mount_unsure(selected, number)
    judged = _Judged(selected, placed.joints[0], [number])
    (best,) = judged.nats([mount], middle)
    for which in range(2):
        lost = []
        for way in (1, -1):
            there = [
                mount[0] + way * np.sqrt(variance[0]) * (which == 0),
                mount[1] + way * np.sqrt(variance[1]) * which,
            ]
            other = np.linspace(-4, 4, 161)[:, None] * np.sqrt(variance) * (np.arange(2) != which)
            lost.append(best - judged.nats(there + other, middle).max())
        assert np.mean(lost) == pytest.approx(0.5, rel=0.3)
    told = {each.name: each for each in found.verdict.effects[0].parameters}
    true = {"phase": spring.between - MIDDLE[world.joint], "ratio": spring.behind / spring.before}
    for name, value in true.items():
        assert abs(told[name].value - value) < 3 * told[name].stderr < 0.3


@pytest.mark.parametrize("kind", ["taut", *(pytest.param(kind, marks=pytest.mark.long) for kind in ("harness", "end"))])
@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(4, 1, 2))
def test_a_cable_stays_a_cable(kind: str, seed: int) -> None:
    world, found = asked(kind, 3 + seed % 4, seed)
    right, words = said(world, found.verdict)
    assert right, words


def test_where_nothing_follows_the_angle_no_mount_is_looked_for() -> None:
    _, found = asked("taut", 3, 4)
    layout = found.selected.rows.layout
    springs = [n for n, cause in enumerate(layout.placed) if cause.variant == BETWEEN_LINKS]
    cables = {
        layout.placed[n].joints for n in found.selected.best.candidates if layout.placed[n].cause is catalogue.CABLE
    }
    assert cables == {(1,)}
    for number in springs:
        placed, rests = remounted(found.selected, number)
        if placed.joints not in cables:
            assert placed is layout.placed[number]
            assert rests
