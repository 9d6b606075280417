"""Sizes learned from other arms take the place of what is plausible, within bounds, and of nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Placed
from armscope.physics.registry import library
from armscope.robot.arm_type import ArmType, LearnedSize
from tests.physics.scenes import arm_named, full_table

ARM = arm_named("six-axis")
TABLE = full_table(ARM, 40, 1)


def with_sizes(cause: str, parameter: str, size: LearnedSize) -> dict[str, list[Placed]]:
    """The library of an arm of whose type one size is known, by name."""
    found: dict[str, list[Placed]] = {}
    for placed in library(replace(ARM, type=ArmType("priors.yaml", "arms", {cause: {parameter: size}})), TABLE):
        found.setdefault(" at ".join(placed.key), []).append(placed)
    return found


def test_nothing_is_learned_where_no_fleet_is_given() -> None:
    assert all(term.learned is None for placed in library(ARM, TABLE) for term in placed.terms)


def test_many_arms_outweigh_what_is_plausible_and_one_hardly_does() -> None:
    sizes = {}
    for arms in (1, 10_000):
        (found,) = with_sizes("joint_offset at joint 3", "offset", LearnedSize(unit="rad", rms=0.01, arms=arms))[
            "joint_offset at joint 3"
        ]
        sizes[arms] = found.terms[0].prior_size
    assert sizes[10_000] == pytest.approx(0.01, rel=1e-3)
    assert sizes[1] == pytest.approx(np.sqrt((PLAUSIBLE.zero_rad**2 + 0.01**2) / 2))


@pytest.mark.parametrize(("rms", "factor"), [(0.0, 1 / PLAUSIBLE.learned_within), (1e6, PLAUSIBLE.learned_within)])
def test_no_fleet_moves_a_size_out_of_bounds(rms: float, factor: float) -> None:
    name = "joint_offset at joint 3"
    (found,) = with_sizes(name, "offset", LearnedSize(unit="rad", rms=rms, arms=1000))[name]
    assert found.terms[0].prior_size == pytest.approx(factor * PLAUSIBLE.zero_rad)
    assert found.terms[0].plausible == PLAUSIBLE.zero_rad


def test_an_amplitude_is_shared_by_its_waves_parts() -> None:
    name = "gear_eccentricity at joint 4"
    for found in with_sizes(name, "amplitude", LearnedSize(unit="rad", rms=2e-3, arms=10**6))[name]:
        assert sum(term.prior_size**2 for term in found.terms) == pytest.approx(2e-3**2, rel=1e-3)


def test_lengths_are_learned_in_their_files_unit() -> None:
    name = "link_geometry at link 2"
    for found in with_sizes(name, "a", LearnedSize(unit="mm", rms=2.0, arms=10**6))[name]:
        learned = {term.name: term.learned for term in found.terms}
        assert learned.pop("a") == pytest.approx(2e-3, rel=1e-3)
        assert set(learned.values()) == {None}


def test_another_unit_or_parameter_changes_nothing_and_an_unknown_effect_is_an_error() -> None:
    size = LearnedSize(unit="deg", rms=1.0, arms=9)
    name = "joint_offset at joint 3"
    assert with_sizes(name, "offset", size)[name][0].terms[0].learned is None
    with pytest.raises(InputError, match="Did you mean 'joint_offset'"):
        with_sizes("joint_ofset at joint 3", "offset", size)
