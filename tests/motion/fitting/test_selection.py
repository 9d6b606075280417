"""What a selection starts from: noise, and not the causes that are to be found."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import build_rows
from armscope.motion.fitting.selection import _at_rest, starting_weights
from armscope.motion.fitting.space import build_space
from armscope.motion.library.layout import OWN, OWN_NAMES, TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.samples.preparation import preparation
from armscope.motion.samples.timing import stretches
from tests.motion.cured import JOINT, LONG, STATED, Motion, diagnosed
from tests.motion.moving import Plant, moved, robot
from tests.seeds import seeds


def cable(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A cable at joint 2, half as large as friction: it follows the angle, and so it lasts."""
    extra = np.zeros_like(q)
    extra[:, 1] = np.exp(1.2 * q[:, 1]) - 1
    return extra


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2))
def test_a_slow_cause_of_a_short_motion_is_no_noise(seed: int) -> None:
    """It counted for so few rows, as what it left of other motion lasted, that nothing asked for a cause."""

    def start(plant: Plant | None) -> Array:
        found = diagnose_motion(robot(), moved(robot(), seed, plant, seconds=8.0), MotionSettings(cutoff=10.0))
        weights = starting_weights(found.selected.rows)
        return np.array([weights.sigma, weights.correlated])

    with_it, without = start(cable), start(None)
    assert with_it[0] == pytest.approx(without[0], rel=0.15)
    assert with_it[1] == pytest.approx(without[1], rel=0.5)


def test_at_each_joint_those_weights_count_of_which_less_lasts() -> None:
    rows = diagnose_motion(robot(), moved(robot(), 1, seconds=8.0), MotionSettings(cutoff=10.0)).selected
    one = rows.weights
    other = type(one)(one.sigma * [0.5, 2.0, 1.0], one.correlated * [1.0, 1.0, 3.0], 0 * one.row)
    better = one.where_better(other)
    assert better.sigma == pytest.approx(one.sigma * [0.5, 1.0, 1.0])
    assert better.correlated == pytest.approx(one.correlated)
    assert np.all(better.row[:, 0] == 0)
    assert np.array_equal(better.row[:, 1:], one.row[:, 1:])


@pytest.mark.long
@pytest.mark.parametrize(("bend", "name"), [(0.005, "motor_constant"), (0.05, "unknown")])
def test_a_gain_that_bends_next_to_nothing_is_a_gain(bend: float, name: str) -> None:
    """A law that holds the gain and a little more fitted better, and what everybody calls a gain was unknown."""

    def bent(motion: Motion, torque: Array) -> Array:
        found, own = torque.copy(), torque[:, JOINT]
        found[:, JOINT] = 0.9 * own + bend * own * np.abs(own) / own.std()
        return found

    (cause,) = diagnosed(STATED, bent, 12, paths=LONG)  # the more there is, the better the other law fits
    assert (cause.effect, cause.location) == (name, f"joint {JOINT + 1}")
    if name == "motor_constant":
        assert -0.1 < cause.parameters[0].value < -0.08


@pytest.mark.parametrize("seed", seeds(3, 4))
def test_a_weak_cable_that_a_spring_says_most_of_stays_a_cable(seed: int) -> None:
    """A spring with seven tenths of its evidence took its place, and a spring is built in to hold more than that."""

    def weak(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        extra, turned = np.zeros_like(q), q[:, 1] - 0.2
        pull = 0.4 * turned + turned**3
        extra[:, 1] = 0.25 * pull / pull.std()
        return extra

    found = diagnose_motion(robot(), moved(robot(), seed, weak, seconds=15.0), MotionSettings(cutoff=10.0))
    assert [(each.effect, each.location) for each in found.verdict.effects] == [("cable_torque", "joint 2")]


def test_an_offset_counts_beside_the_laws_of_a_speed_curve() -> None:
    arm = robot()
    placed = place_causes(seen_in(arm, list(stretches(moved(arm, 1))), 0.02))
    space = build_space(TorqueLayout(arm, tuple(placed), False), np.ones(3), 200.0)
    at = {(each.cause.name, each.driver, each.variant): n for n, each in enumerate(placed) if each.joints == (1,)}
    by_name = {name: n for (name, _, _), n in at.items()}
    curve = space.candidates[at["unknown", "speed", "speed"]]
    two = {by_name["asymmetric_friction"], by_name["viscous_curve"]}
    assert curve.excess(frozenset(two | {by_name["torque_offset"]})) == 0
    assert curve.excess(frozenset(two | {by_name["stribeck_friction"]})) == 1


def test_a_link_and_what_turns_with_the_difference_of_its_joints_take_each_other_back() -> None:
    """About parallel axes the two, equally large, ask of the motors what rotors ask of them alone."""
    arm = robot()
    motion = list(stretches(moved(arm, 1)))
    placed = place_causes(seen_in(arm, motion, 0.02))
    layout = TorqueLayout(arm, tuple(placed), False)
    coupled = [n for n, each in enumerate(placed) if each.cause.name == "coupled_inertia" and each.joints == (1, 2)]
    links = [n for n, each in enumerate(placed) if each.cause.name == "link_inertia" and each.location == "link 3"]
    candidates = build_space(layout, np.ones(3), 200.0).candidates
    (difference,) = coupled
    assert set(links) <= candidates[difference].excludes
    assert all(difference in candidates[link].excludes for link in links)

    rows = build_rows(layout, motion, preparation(200.0, 10.0, "given"), stated_model(arm))
    one = next(n for n in links if layout.columns[n].size == 1)
    numbers = np.zeros(layout.width)
    numbers[[*layout.columns[one], *layout.columns[difference]]] = 1.0
    torque = rows.modelled(numbers)[:, 1:]
    numbers[layout.columns[difference]] = 0.0
    alone = rows.modelled(numbers)[:, 1:]
    for j in (1, 2):
        rotor = rows.columns[j][:, [np.searchsorted(rows.at[j], OWN * j + OWN_NAMES.index("inertia"))]]
        left, of_one = (
            each - rotor @ np.linalg.lstsq(rotor, each, rcond=None)[0] for each in (torque.T[j - 1], alone.T[j - 1])
        )
        assert np.linalg.norm(left) < 0.05 * np.linalg.norm(of_one)


def test_inertias_between_axes_that_are_not_parallel_stand_beside_links() -> None:
    arm = robot()
    placed = place_causes(seen_in(arm, list(stretches(moved(arm, 1))), 0.02))
    candidates = build_space(TorqueLayout(arm, tuple(placed), False), np.ones(3), 200.0).candidates
    links = {n for n, each in enumerate(placed) if each.cause.name == "link_inertia"}
    across = [n for n, each in enumerate(placed) if each.cause.name == "coupled_inertia" and each.joints == (0, 1)]
    assert len(across) == 2
    assert not any(links & candidates[n].excludes for n in across)


def test_friction_that_is_not_as_stated_counts_beside_the_laws_of_a_speed_curve() -> None:
    """Where it is not stated it is free: what is known of an arm does not make its friction simpler."""
    arm = robot(**STATED)
    placed = place_causes(seen_in(arm, list(stretches(moved(arm, 1))), 0.02))
    space = build_space(TorqueLayout(arm, tuple(placed), False), np.ones(3), 200.0)
    at = {(each.cause.name, each.driver): n for n, each in enumerate(placed) if each.joints == (1,)}
    curve = space.candidates[at["unknown", "speed"]]
    two = {at["asymmetric_friction", "direction"], at["viscous_curve", "speed"]}
    departures = {at["coulomb_friction", "direction"], at["viscous_friction", "speed"]}
    assert departures <= curve.special_cases
    assert curve.excess(frozenset(two | departures)) == 0


@pytest.mark.parametrize(
    ("rounds", "rests"),
    [
        ([{1, 2}], False),
        ([{1}, {1, 2}], False),
        ([{1}, {1}], True),
        ([{1}, {1, 2}, {1}], True),
        ([{1, 2}, {1}, {1, 2}], False),
        ([{1}, {2}, {1}], False),
        ([{1}, {1, 2}, {1, 2}], True),
    ],
)
def test_of_names_that_come_and_go_the_fewer_stay(rounds: list[set[int]], rests: bool) -> None:
    assert _at_rest([frozenset(each) for each in rounds]) == rests
