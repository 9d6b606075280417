"""Of few joints, one name is told where masses all over the arm say as much; where all of them are off, none."""

from __future__ import annotations

import pytest

from armscope.motion.pipeline import diagnose_motion
from armscope.motion.summary import names_of_masses
from armscope.motion.summary.names_of_masses import NameOfMasses
from tests.motion.moving import moved
from tests.motion.planar import planar
from tests.seeds import seeds


@pytest.mark.parametrize(
    ("nats", "all_alone", "told"),
    [(3.1, False, True), (2.9, False, False), (2.9, True, True), (-2.9, True, True), (-3.1, True, False)],
)
def test_a_name_that_is_all_that_masses_lack_is_told_where_it_is_as_likely_as_none(
    monkeypatch: pytest.MonkeyPatch, nats: float, all_alone: bool, told: bool
) -> None:
    monkeypatch.setattr(names_of_masses, "says_all_alone", lambda selected, number: all_alone)
    assert NameOfMasses(None, 0, nats).is_told is told  # type: ignore[arg-type]


@pytest.mark.parametrize("seed", seeds(2, 3))
def test_one_link_of_few_joints_is_named_though_all_links_a_little_off_say_as_much(seed: int) -> None:
    """Nothing was missing there: masses near the stated ones held a link of 1.3 times its weight."""
    verdict = diagnose_motion(planar(), moved(planar((1.0, 1.3)), seed)).verdict
    (found,) = verdict.effects
    assert (found.effect, found.location) == ("link_mass", "link 2")
    assert found.parameters[0].value == pytest.approx(1.8, rel=0.1)
    assert "Links that are all off a little fit about as well" in found.doubt
    assert ", in doubt" in verdict.headline


@pytest.mark.parametrize("seed", seeds(1, 3))
@pytest.mark.parametrize("by", [((1.2, 0.85), 10.0), pytest.param(((0.85, 1.2), -10.0), marks=pytest.mark.long)])
def test_no_link_of_few_joints_is_named_where_all_are_off(seed: int, by: tuple[tuple[float, float], float]) -> None:
    verdict = diagnose_motion(planar(), moved(planar(*by), seed)).verdict
    assert (verdict.answer, verdict.effects) == ("cannot tell", ())
    assert verdict.headline.startswith("Masses of the links are not as stated")


def test_masses_as_stated_are_no_mismatch_of_few_joints() -> None:
    assert diagnose_motion(planar(), moved(planar(), 1)).verdict.answer == "nothing missing"
