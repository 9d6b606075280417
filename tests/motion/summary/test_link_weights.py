"""Where all links weigh other than stated, each that the motion tells has its name, with an interval that holds."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from armscope.motion.library import catalogue
from armscope.motion.library.causes import Cause
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary import link_weights
from armscope.motion.summary.link_weights import rather_all_links
from armscope.motion.verdict import FoundCause
from tests.motion.moving import ROBOT, moved, robot

OFF, LEAN = (1.2, 1.15, 1.17), np.radians(2.0)
"""Of each link's stated mass, with its inertia; and by how much the base leans about its x axis."""


def off_by(shares: tuple[float, ...], **more: Any) -> MotionDiagnosis:
    """A diagnosis of an arm whose links are heavier than stated by these shares, and lean as asked."""
    stated: Any = ROBOT["links"]
    links = [
        {**link, "mass_kg": by * link["mass_kg"], "inertia_kg_m2": [by * each for each in link["inertia_kg_m2"]]}
        for link, by in zip(stated, shares, strict=True)
    ]
    return diagnose_motion(robot(), moved(robot(links=links, **more), 5, seconds=10.0), MotionSettings(cutoff=10.0))


@pytest.fixture(scope="module")
def leaning() -> MotionDiagnosis:
    return off_by(OFF, gravity_m_s2=[0.0, -9.81 * np.sin(LEAN), -9.81 * np.cos(LEAN)])


def told(found: MotionDiagnosis, kind: str) -> dict[str, FoundCause]:
    return {each.location: each for each in found.verdict.effects if each.effect == kind and not each.minor}


@pytest.mark.long
def test_links_that_are_all_off_are_told_one_by_one(leaning: MotionDiagnosis) -> None:
    masses = told(leaning, "link_mass")
    assert [*sorted(masses)] == ["link 2", "link 3"]  # the first one turns about a plumb line: nobody can weigh it
    for place, true in (("link 2", 8 * 0.15), ("link 3", 4 * 0.17)):
        (mass,) = masses[place].parameters
        low, high = mass.interval
        assert low < true < high
        assert high - low < 0.2 * true
    number = leaning.selected.best.chosen[-1]
    assert number.nested  # out of what all links are off by, not instead of it
    assert leaning.verdict.masses_share >= 0.1


def test_a_base_leans_by_what_it_does_though_all_masses_are_off(leaning: MotionDiagnosis) -> None:
    """By the torque of the stated masses it would lean by 2.3 degrees."""
    lean = {each.name: each for each in told(leaning, "gravity_direction")["base"].parameters}
    assert lean["x"].value == pytest.approx(LEAN, rel=0.02)
    low, high = lean["x"].interval
    assert low < LEAN < high


def test_the_model_holds_links_without_a_name_in_proportion(leaning: MotionDiagnosis) -> None:
    """Whether a link has its name or not, the model file and the corrected arm have its mass."""
    fitted = leaning.model.followed().inertial[::10]
    np.testing.assert_allclose(fitted[1:], [8 * OFF[1], 4 * OFF[2]], rtol=0.02)


@pytest.mark.long
def test_a_link_that_alone_is_off_has_its_name_as_ever() -> None:
    found = off_by((1.0, 1.2, 1.0))
    assert [*told(found, "link_mass")] == ["link 2"]
    assert found.verdict.masses_share == 0.0


@pytest.mark.parametrize(("kind", "stays"), [(catalogue.BODY, True), (catalogue.LINK_MASS, False)])
def test_a_body_that_is_missing_is_not_weighed_against_all_links(
    kind: Cause, stays: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A hand that was not on a real arm lost its name to links that are all off a little, by 1.3 nats."""
    placed = SimpleNamespace(inertial=np.ones((10, 1)), runs=(), cause=kind)
    best = SimpleNamespace(candidates=frozenset([0]), background=(0, 0), log_posterior=100.0)
    families = [SimpleNamespace(name=name) for name in ("masses", "link masses")]
    selected: Any = Selection(best, SimpleNamespace(layout=SimpleNamespace(placed=[placed])), families)
    nearly = SimpleNamespace(candidates=frozenset(), background=(2, 2), log_posterior=98.7)
    search = SimpleNamespace(on=lambda problem: SimpleNamespace(best=lambda starts: nearly))
    monkeypatch.setattr(link_weights, "Search", search)
    monkeypatch.setattr(link_weights, "at_own_gain", lambda found: found)
    assert (rather_all_links(selected, (2, 2)).best is best) == stays


@dataclass(frozen=True)
class Selection:
    """As much of one as is looked at."""

    best: Any
    rows: Any
    families: Any
    problem: Any = None

    @property
    def space(self) -> Any:
        return SimpleNamespace(families=self.families)


def test_one_heavier_link_alone_explains_all_that_there_is() -> None:
    """Half of it was told as masses of other links that are off without a name, which are as stated."""
    found = off_by((1.0, 1.0, 1.15))
    (mass,) = told(found, "link_mass").values()
    assert mass.location == "link 3"
    assert mass.share > 0.95
    assert found.verdict.masses_share == 0
    assert "without a name" not in found.verdict.headline
