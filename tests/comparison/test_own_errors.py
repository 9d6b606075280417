"""Of several arms each has small errors of its own: their size is learned, and what stands out of them is told."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.comparison import compare
from armscope.comparison.own_errors import OwnErrors, learned, moderated, no_own_errors
from armscope.comparison.penalised import HeldColumns
from armscope.recordings import as_recordings
from armscope.robot import chain, load_arm
from armscope.robot.gravity import gravity_torques

ARM = load_arm("ur5e")


def of_an_arm(seed, zeros=(), softness=0.0):
    """80 rows of an arm as it is built: zeros to 0.3 mrad, axes to 0.2 mrad and 0.1 mm, and zeros by joint besides.

    Its drives give way by some 0.4 mrad each, by a share that is drawn: with a standard deviation of ``softness``.
    """
    rng = np.random.default_rng(seed)
    small = np.tile(np.eye(4), (6, 1, 1))
    for joint in range(6):
        small[joint, :3, :3] = Rotation.from_rotvec([*rng.normal(0, 2e-4, 2), 0]).as_matrix()
        small[joint, :3, 3] = rng.normal(0, 1e-4, 3)
    built = replace(ARM, before=ARM.before @ small)
    q = rng.uniform(-1, 1, (80, 6)) * [2, 0.6, 0.6, 2, 1.5, 2]
    off = rng.normal(0, 3e-4, 6)
    for joint, size in dict(zeros).items():
        off[joint - 1] += size
    if softness:
        gives = np.array([0.0, 4e-6, 8e-6, 4e-5, 4e-5, 0.0]) * (1 + softness * rng.normal(0, 1, 6))
        off = off + gives * gravity_torques(ARM, chain(ARM, q), None)
    points = Rotation.from_rotvec(rng.normal(0, 0.5, 3)).apply(chain(built, q + off).tool) + rng.normal(0, 1, 3)
    points = points * 1e3 + rng.normal(0, 0.03, (80, 3))
    columns = {f"q{j + 1}_rad": q[:, j] for j in range(6)} | {f"{a}_mm": points[:, k] for k, a in enumerate("xyz")}
    return as_recordings(pd.DataFrame(columns), "made", 6)


def drawn(size: float, outlier: float = 0.0) -> tuple[OwnErrors, np.ndarray, HeldColumns]:
    """300 rows by 40 errors of a size, of which the first is an outlier."""
    rng = np.random.default_rng(2)
    columns = rng.normal(size=(300, 40))
    values = rng.normal(0, size, 40)
    values[0] += outlier
    own = OwnErrors(columns, np.zeros(40, int), np.repeat([0, 1], 20), np.zeros(1, int), np.ones(1), np.ones(1))
    return own, columns @ values + rng.normal(0, 0.1, 300), HeldColumns(columns, np.full(40, 0.01), drawn=40)


@pytest.mark.parametrize(("size", "of_most"), [(0.3, False), (0.03, False), (0.3, True)])
def test_the_size_that_is_learned_is_that_of_the_errors(size, of_most) -> None:
    own, rows, base = drawn(size)
    for _ in range(8):
        own = learned(own, rows, HeldColumns(own.sized, base.penalty, base.drawn), of_most)
    assert own.size[0] == pytest.approx(size, rel=0.35)
    assert 20 < own.numbers[0] <= 40


def test_one_that_stands_out_does_not_count_where_most_do() -> None:
    sizes = {}
    for of_most in (False, True):
        own, rows, base = drawn(0.3, outlier=10.0)
        for _ in range(8):
            own = learned(own, rows, HeldColumns(own.sized, base.penalty, base.drawn), of_most)
        sizes[of_most] = own.size[0]
    assert sizes[True] < 0.5 < 1 < sizes[False]


def test_what_is_the_same_as_a_column_is_known() -> None:
    own, *_ = drawn(0.3)
    other = own.other_than(own.columns[:, :1])
    assert not other[0]
    assert other[1:].all()


def test_recordings_of_one_arm_have_none_of_their_own() -> None:
    none = no_own_errors(12)
    assert none.sized.shape == (12, 0)
    assert not none.size.size


def test_places_that_have_alike_tell_of_each_other_and_those_that_have_not_tell_little() -> None:
    """40 places of four numbers each: of one variance, known from all; or of 0.01 to 100, each known from its own."""
    rng = np.random.default_rng(3)
    chance, four = rng.chisquare(4, 40), np.full(40, 4.0)
    variance, known = moderated(2.0 * chance, four)
    assert variance == pytest.approx(2.0, rel=0.35)
    assert known.min() > 30
    true = np.geomspace(0.01, 100, 40)
    variance, known = moderated(true * chance, four)
    assert np.corrcoef(np.log(variance), np.log(true))[0, 1] > 0.9
    assert 4 < known.max() < 8


def test_a_place_of_which_nothing_is_told_has_what_is_usual() -> None:
    variance, known = moderated(np.array([8.0, 8.0, 8.0, 0.0]), np.array([4.0, 4.0, 4.0, 0.0]))
    assert variance == pytest.approx(2.0)
    assert known == pytest.approx(12.0)
    assert moderated(np.zeros(1), np.zeros(1))[0] == pytest.approx(0.0)


@pytest.mark.long
@pytest.mark.parametrize("seed", [40, 50, 60])
def test_drives_that_differ_in_how_they_give_way_are_alike(seed) -> None:
    """Joint 2 carries most, so that a share of its softness moves the tool by most: it was named nearly always."""
    arms = {name: of_an_arm(seed + n, softness=0.15) for n, name in enumerate("ABCDE")}
    assert compare(ARM, arms, of_arms=True).changes == ()


@pytest.mark.long
def test_arms_that_differ_as_arms_of_a_type_do_are_alike() -> None:
    """Every small error is surer than chance; eight of them were named on any set of arms, bearings to be replaced."""
    for seed in (10, 20):
        assert compare(ARM, {name: of_an_arm(seed + n) for n, name in enumerate("ABCDE")}, of_arms=True).changes == ()


@pytest.mark.long
@pytest.mark.parametrize("seed", [10, 20])
def test_the_arm_that_stands_out_of_its_type_is_told(seed) -> None:
    arms = {name: of_an_arm(seed + n, {3: 4e-3} if name == "C" else {}) for n, name in enumerate("ABCDE")}
    (found,) = compare(ARM, arms, of_arms=True).changes
    assert (found.effect, found.location, found.where) == ("joint_offset", "joint 3", ("C",))
    low, high = found.parameters[0].interval_95
    assert 3e-3 < low < high < 5e-3
