"""A stated load that is wrong may be told of the link that carries it: that it may be the load is said beside it."""

from types import SimpleNamespace

import pytest

from armscope.motion.summary.stated_load import load_or_link
from tests.motion.moving import robot

STATED = {"mass_kg": 8.0, "com_mm": [0, 0, 60]}


def with_name(location: str, runs: tuple[str, ...] = (), **arm: object) -> SimpleNamespace:
    """A selection of one name of masses of an arm of three links."""
    name = SimpleNamespace(location=location, inertial=[1.0], runs=runs)
    layout = SimpleNamespace(arm=robot(**arm), placed=[name])
    return SimpleNamespace(rows=SimpleNamespace(layout=layout), best=SimpleNamespace(candidates=(0,)))


def test_what_is_told_of_the_last_link_may_be_the_stated_loads() -> None:
    (told,) = load_or_link(with_name("link 3", tool_load=STATED))
    assert "a load of 8 kg" in told.text
    assert "correct it before link 3" in told.text


@pytest.mark.parametrize(
    "selected",
    [
        with_name("link 3"),
        with_name("link 2", tool_load=STATED),
        with_name("link 3", runs=("a",), tool_load=STATED),
    ],
)
def test_nothing_is_said_without_a_load_or_of_another_link_or_run(selected: SimpleNamespace) -> None:
    assert load_or_link(selected) == []
