"""What may be looked at first where masses are off without a name."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from benchmarks.motion_changing_load import World

from armscope.motion.summary.likeliest import likeliest_in_words
from armscope.motion.summary.names_of_masses import NameOfMasses
from armscope.verdict.effects import INTERVAL
from tests.motion.test_changing_load import diagnosed
from tests.seeds import seeds


@pytest.mark.parametrize(
    ("nats", "words"),
    [
        (-0.5, "too unsure to be told as one (no likelier than none): link mass at link 5, mass −0.34 kg. "),
        (0.5, "too unsure to be told as one (hardly likelier than none): link mass at link 5, mass −0.34 kg. "),
        (2.5, "too unsure to be told as one (12 to 1): "),
        (18.43, "not told as one because all links and all motion together do without it (far beyond a thousand to 1 "),
    ],
)
def test_odds_that_leave_no_doubt_are_not_called_unsure(
    monkeypatch: pytest.MonkeyPatch, nats: float, words: str
) -> None:
    """One link's odds count that link alone; whatever keeps such a name from being told, it is not these."""
    placed = SimpleNamespace(parameters=(("mass", "kg"),), location="link 5", cause=SimpleNamespace(name="link_mass"))
    layout = SimpleNamespace(placed=[placed], columns=[np.array([0])])
    found = SimpleNamespace(rows=SimpleNamespace(layout=layout), coefficients=np.array([-0.34]))
    name = NameOfMasses(found, 0, nats)  # type: ignore[arg-type]
    monkeypatch.setattr("armscope.motion.summary.likeliest.likely_names", lambda selected: [name])
    monkeypatch.setattr("armscope.motion.summary.likeliest.title", lambda each: "link mass at link 5")
    assert likeliest_in_words(found).startswith(f"The likeliest name, {words}")  # type: ignore[arg-type]
    monkeypatch.setattr("armscope.motion.summary.likeliest.likely_names", lambda selected: [name, name])
    several = likeliest_in_words(found)  # type: ignore[arg-type]
    assert several.startswith(
        f"The likeliest names, of which these rows tell none from the next, {words.split(':')[0]}"
    )
    assert several.endswith("link mass at link 5, mass −0.34 kg or link mass at link 5, mass −0.34 kg. ")


def test_six_numbers_of_an_inertia_do_not_stand_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    placed = SimpleNamespace(parameters=6 * (("Ixx", "kg m^2"),))
    layout = SimpleNamespace(placed=[placed], columns=[np.arange(6)])
    found: Any = SimpleNamespace(rows=SimpleNamespace(layout=layout), coefficients=np.ones(6))
    monkeypatch.setattr("armscope.motion.summary.likeliest.likely_names", lambda _: [NameOfMasses(found, 0, 2.5)])
    monkeypatch.setattr("armscope.motion.summary.likeliest.title", lambda each: "link inertia at link 2")
    assert likeliest_in_words(found).endswith("told as one (12 to 1): link inertia at link 2. ")


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(4, 8))
def test_a_load_that_nobody_stated_is_told_though_the_last_link_may_be_off_in_any_way(seed: int) -> None:
    """Three joints from point to point: that link would need ten numbers of its own, and to be the only one."""
    world = World("always", 3, seed, by_points=True)
    (found,) = diagnosed(world)[0].verdict.effects
    assert (found.effect, found.location) == ("payload_error", "payload")
    mass = found.parameters[0]
    assert abs(mass.value - world.mass) < INTERVAL * mass.stderr < 0.6 * world.mass


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(204))
def test_a_load_that_masses_without_a_name_may_be_is_named_and_in_doubt(seed: int) -> None:
    """Here the same arm moves so that all links a little off say it nearly as well."""
    world = World("always", 3, seed, by_points=True)
    (found,) = diagnosed(world)[0].verdict.effects
    assert (found.effect, found.location) == ("payload_error", "payload")
    assert "Links that are all off a little fit about as well" in found.doubt
    assert found.parameters[0].value == pytest.approx(world.mass, rel=0.15)


@pytest.mark.long
def test_nothing_is_likely_where_masses_are_as_stated() -> None:
    assert likeliest_in_words(diagnosed(World("none", 3, 1))[0].selected) == ""
