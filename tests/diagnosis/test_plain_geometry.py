"""A link's own error, what can't be told from it, and a zero beside what follows its joint's angle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.plain_geometry import as_plain_geometry
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import Candidate, ModelSpace
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem, SelectedEffect, build_problem
from armscope.inference.search import Search
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.physics.tilting import tilting_joints
from armscope.physics.uneven_bearing import uneven_bearings
from armscope.recordings import Recordings
from armscope.robot import Arm, load_arm
from armscope.robot.library import nominal_file
from armscope.verdict.corrections import corrected_rows, unsettled
from tests.diagnosis.planted import Wanted, one_run, recorded
from tests.physics.scenes import full_table

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM = 0.03


def without_payload(arm: Arm, rows: int, seed: int) -> Recordings:
    """Random poses with nothing in hand, and no other context."""
    table = one_run(arm, rows, seed)
    return replace(table, payload=None, temperature=None, time=None, approach=None)


def told(arm: Arm, wanted: Wanted, rows: int, seed: int) -> set[tuple[str, str, str]]:
    table = recorded(arm, without_payload(arm, rows, seed), wanted, NOISE_MM, seed + 1)
    return {(e.effect, e.location, e.named_as) for e in diagnose(arm, table, QUICK).effects}


@pytest.fixture(scope="module")
def arm() -> Arm:
    return load_arm(nominal_file("ur10e"))


def test_a_link_that_is_twisted_is_no_bearing_under_a_load_that_is_always_the_same(arm: Arm) -> None:
    """Joint 2 carries all that lies beside its axis, in every pose alike: 16 urad/(N m) would be half a milliradian."""
    assert told(arm, {("link_geometry", "link 1"): [0.0, 5e-4, 0.0]}, 100, 3) == {("link_geometry", "link 1", "effect")}


def test_a_bearing_competes_where_its_load_varies(arm: Arm) -> None:
    table = full_table(arm, 60, 1)
    bare = replace(table, payload=None)
    assert "joint 2" in set(tilting_joints(Scene(arm, table)))
    assert "joint 2" not in set(tilting_joints(Scene(arm, bare)))
    assert {"joint 1", "joint 3"} <= set(tilting_joints(Scene(arm, bare)))
    for recordings in (table, bare):
        there = set(tilting_joints(Scene(arm, recordings)))
        assert {p.location for p in library(arm, recordings) if p.name == "bearing_compliance"} == there
        assert {p.location for p in uneven_bearings(arm, recordings)} == there


def test_a_zero_and_a_ratio_of_one_joint_are_two_names_and_nothing_unknown(arm: Arm) -> None:
    """The free curve of the joint's angle holds both, and fits worse by 12 nats: it pays for one name."""
    wanted = {("joint_offset", "joint 5"): [-6.7e-4], ("gear_ratio", "joint 5"): [5e-4]}
    found = told(arm, wanted, 160, 5)
    assert {(effect, place) for effect, place, _ in found} == set(wanted)


EFFECT, LINK, OTHER_LINK = range(3)


def problem_where(kind: str, alike: float) -> Problem:
    """An effect of one column, which made all there is, and two links of three; one of these columns is nearly its own.

    Args:
        kind: of the effect.
        alike: correlation of that column with the effect's.
    """
    rng = np.random.default_rng(6)
    X = rng.normal(size=(200, 9))
    X[:, 3] = alike * X[:, 2] + np.sqrt(1 - alike**2) * X[:, 3]
    y = 0.3 * X[:, 2] + rng.normal(0, 0.1, len(X))
    at = (np.array([2]), np.arange(3, 6), np.arange(6, 9))
    kinds = ((kind, "joint 2"), ("link_geometry", "link 1"), ("link_geometry", "link 4"))
    candidates = tuple(Candidate(*key, columns, np.ones(len(columns))) for key, columns in zip(kinds, at, strict=True))
    space = ModelSpace(np.arange(2), (), candidates)
    return build_problem(space, NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(len(y))), 0.05)


def problem_of_a_turned_link() -> Problem:
    """A wobble that is what a link and a zero do together, and as much of another kind of effect."""
    rng = np.random.default_rng(7)
    X = rng.normal(size=(200, 9))
    X[:, 2] = 0.7 * X[:, 3] - 0.7 * X[:, 6] + 1e-3 * X[:, 2]
    y = 0.3 * X[:, 2] + rng.normal(0, 0.02, len(X))
    at = np.array([2]), np.arange(3, 6), np.array([6]), np.array([7])
    kinds = (
        ("axis_wobble", "joint 4"),
        ("link_geometry", "link 4"),
        ("joint_offset", "joint 5"),
        ("gear_ratio", "joint 1"),
    )
    candidates = tuple(Candidate(*key, columns, np.ones(len(columns))) for key, columns in zip(kinds, at, strict=True))
    space = ModelSpace(np.arange(2), (), candidates)
    return build_problem(space, NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(len(y))), 0.01)


def named_alone(problem: Problem) -> Hypothesis:
    """The effect by itself, at the size that suits it best."""
    sized = [evaluate(problem, (SelectedEffect(EFFECT, n),), (), 0.1) for n in range(len(problem.sizes))]
    return max(sized, key=lambda hypothesis: hypothesis.log_posterior)


@pytest.mark.parametrize("kind", ["bearing_compliance", "axis_wobble", "link_bending", "instrument_scale"])
def test_the_link_whose_rows_say_the_same_has_the_name_though_it_pays_for_more_numbers(kind: str) -> None:
    problem = problem_where(kind, 0.9999)
    alone = named_alone(problem)
    found = as_plain_geometry(Search.on(problem), alone)
    assert found.candidates == {LINK}
    assert found.log_posterior < alone.log_posterior


def test_a_wobble_that_turns_with_its_joint_is_a_twisted_link_and_the_next_zero() -> None:
    """A sound bearing was to be replaced: link 4 was twisted, and the zero of joint 5 off, which is the same."""
    problem = problem_of_a_turned_link()
    found = as_plain_geometry(Search.on(problem), named_alone(problem))
    assert found.candidates == {1, 2}


@pytest.mark.parametrize("alike", [0.0, 0.9])
def test_what_rows_tell_from_every_link_keeps_its_name(alike: float) -> None:
    problem = problem_where("bearing_compliance", alike)
    assert as_plain_geometry(Search.on(problem), named_alone(problem)).candidates == {EFFECT}


def test_a_drive_turns_a_joint_and_is_no_links_error() -> None:
    problem = problem_where("joint_compliance", 0.9999)
    assert as_plain_geometry(Search.on(problem), named_alone(problem)).candidates == {EFFECT}


@pytest.mark.parametrize(
    ("wanted", "names"),
    [
        (
            {("link_geometry", "link 4"): [0.0, 5e-4, 0.0], ("joint_offset", "joint 5"): [-4e-4]},
            {("link_geometry", "link 4"), ("joint_offset", "joint 5")},
        ),
        ({("axis_wobble", "joint 4"): [5e-4, 0.0, 0.0, 0.0]}, {("axis_wobble", "joint 4")}),
    ],
)
def test_only_a_tilt_that_turns_with_its_joint_is_a_twisted_link(wanted: Wanted, names: set[tuple[str, str]]) -> None:
    """A tilt in one plane is a bearing's. Which of the others it is stays open, and need not be found out."""
    iiwa = load_arm(nominal_file("iiwa7"))
    table = recorded(iiwa, without_payload(iiwa, 140, 3), wanted, NOISE_MM, 4)
    verdict = diagnose(iiwa, table, QUICK)
    assert {(e.effect, e.location) for e in verdict.effects} == names
    link = next((e for e in verdict.effects if e.effect == "link_geometry"), None)
    if link is None:
        return
    wobbles = [rival for rival in link.alternatives if rival.effect == "axis_wobble"]
    assert [(rival.location, rival.same_motion) for rival in wobbles] == [("joint 4", True)]
    assert link.named_as == "region"
    assert link.same_cure
    rows = corrected_rows(verdict)
    assert rows is not None
    assert rows.set_index("row").loc[4, "correction_alpha_deg"] == pytest.approx(np.degrees(5e-4), rel=0.1)
    assert not unsettled(verdict)


def test_a_zero_counts_beside_two_that_follow_its_angle_and_not_beside_one() -> None:
    """Of a free curve's special cases: a counterbalance was told as a wave, a ratio and a zero."""
    zero, ratio, wave = 0, 1, 2
    none = np.arange(0)
    curve = Candidate(
        "unknown", "joint 2", none, none, special_cases=frozenset({zero, ratio, wave}), common=frozenset({zero})
    )
    excess = [curve.excess(frozenset(names)) for names in ([zero, ratio], [ratio, wave], [zero, ratio, wave])]
    assert excess == [0, 1, 2]
