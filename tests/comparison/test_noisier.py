"""A recording of which more is left is told, with the joint along which it is; equal noise is not."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison import Comparison, compare
from armscope.comparison.constants import COMPARING
from armscope.comparison.noisier import LeftOver, Noisier, Scatter, along_joints, by_chance
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.robot import chain
from armscope.robot.gravity import gravity_torques
from tests.comparison.test_changes import ARM, OWN, session, wandering
from tests.seeds import seeds

JOINT, SIZE = 3, 3e-4


def loose(table: Recordings, turn: Callable[[Array], Array]) -> Recordings:
    """The same rows of an arm whose joint turns by something that no effect of the library is; seen from elsewhere."""
    q = table.motor_angles
    turned = q.copy()
    turned[:, JOINT - 1] += turn(q[:, JOINT - 1])
    # as `session` puts the instrument somewhere, which base and tool take up
    at, seen = chain(ARM, q).tool, table.positions
    centre, there = at.mean(axis=0), seen.mean(axis=0)
    u, _, vt = np.linalg.svd((at - centre).T @ (seen - there))
    return replace(table, positions=seen + (chain(ARM, turned).tool - at) @ (u @ vt))


def scattering(q: Array) -> Array:
    return np.random.default_rng(5).normal(0, SIZE, len(q))


def bumpy(q: Array) -> Array:
    """A wave that no single gear makes."""
    return 1.4 * SIZE * np.sin(9 * q + 2 * np.sin(2 * q))


@pytest.mark.parametrize("rows", seeds(70, 40))
@pytest.mark.parametrize("turn", seeds(scattering, bumpy))
def test_a_joint_that_became_loose_is_told_though_no_cause_changed(turn: Callable[[Array], Array], rows: int) -> None:
    found = compare(ARM, {"before": session(61, rows), "after": loose(session(62, rows), turn)})
    (told,) = found.noisier
    assert (told.name, told.than) == ("after", "before")
    assert told.scatter[0].location == f"joint {JOINT}"
    # of few rows, what is fitted takes part of it along
    assert (0.7 if rows == 70 else 0.2) * SIZE < told.scatter[0].size_rad < 1.2 * SIZE
    assert f"as if joint {JOINT}" in found.headline
    assert "Nothing changed" not in found.headline


def test_more_noise_has_no_joint() -> None:
    found = compare(ARM, {"before": session(63), "after": session(64, noise_mm=0.12)})
    (told,) = found.noisier
    assert not told.scatter
    assert told.left_mm / told.usual_mm == pytest.approx(4, rel=0.35)
    assert "more noise" in found.headline


def test_the_one_of_several_is_told() -> None:
    tables = {f"arm {k}": session(70 + k, noise_mm=0.12 if k == 1 else 0.03) for k in range(4)}
    assert [each.name for each in compare(ARM, tables, of_arms=True).noisier] == ["arm 1"]


@pytest.mark.parametrize("worlds", seeds(1, 12))
def test_equal_noise_is_not_told(worlds: int) -> None:
    """Nor rows that wander, nor fewer of them, nor a cause that changed."""
    found: list[Comparison] = []
    for n in range(9000, 9000 + 2 * worlds, 2):
        before, after = session(n), session(n + 1)
        found.append(compare(ARM, {"a": before, "b": session(n + 1, rows=45)}))
        found.append(compare(ARM, {"a": wandering(before, n), "b": wandering(after, n + 77)}))
        found.append(compare(ARM, {"a": before, "b": session(n + 1, offsets={3: 8e-4})}))
    assert not any(each.noisier for each in found)
    assert any(each.changes for each in found)


def test_chance_is_what_drawn_noise_has() -> None:
    """Medians of drawn noise are as far apart as said: p below 5 % in some 5 % of cases (binomial, 4 sigma)."""
    rng, often, draws = np.random.default_rng(8), 0, 400
    for _ in range(draws):
        one, other = (LeftOver(e, e.size, e, e[None]) for e in (rng.normal(0, 1, (80, 3)), rng.normal(0, 1, (60, 3))))
        often += by_chance(one, other, 1.0) < COMPARING.level
    assert abs(often - COMPARING.level * draws) < 4 * np.sqrt(COMPARING.level * draws)


def test_what_is_left_along_a_joint_lies_in_one_direction_of_three() -> None:
    """Drawn: 0.03 mm of noise, and 0.15 mm along one direction of each row."""
    rng = np.random.default_rng(6)
    along = rng.normal(size=(200_000, 3))
    along /= np.linalg.norm(along, axis=1)[:, None]
    left = rng.normal(0, 0.03, along.shape) + rng.normal(0, 0.15, (len(along), 1)) * along
    per_axis = float(np.mean(left**2))
    told = Noisier("b", "a", np.sqrt(per_axis), 0.03, 0.0, (Scatter("joint 2", 1e-4),))
    assert along_joints([told]) == pytest.approx(np.mean(np.sum(left * along, axis=1) ** 2) / per_axis, rel=0.02)
    assert along_joints([replace(told, scatter=())]) == along_joints([]) == 1


@pytest.mark.long
@pytest.mark.parametrize("seed", [902, 911])
def test_play_whose_side_nobody_recorded_names_no_other_cause(seed: int) -> None:
    """As noise it made something else sure beside the right remark, in these two of sixteen."""
    before, after = session(2 * seed), session(2 * seed + 1)
    turned = after.motor_angles + OWN
    turned[:, 1] += 1.5e-7 * gravity_torques(ARM, chain(ARM, after.motor_angles), None)[:, 1]
    turned[:, 3] += np.random.default_rng(seed).choice([-4e-4, 4e-4], len(after))
    noise = np.random.default_rng(seed).normal(0, 3e-5, after.positions.shape)
    found = compare(ARM, {"a": before, "b": replace(after, positions=chain(ARM, turned).tool + noise)})
    assert "joint 4" in [each.location for each in found.noisier[0].scatter]
    assert found.changes == ()
