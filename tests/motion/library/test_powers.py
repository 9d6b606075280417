"""Powers of the speed that compete at a joint, and closer ones about the one that was chosen."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from armscope.motion.constants import LIBRARY
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law
from armscope.motion.library.powers import closer, with_power

LAW = Law("power of speed", (1,), (0.005, 1.0, 1.0, 1.0, 0.1, 0.5, 1.0))
ANY = PlacedCause(catalogue.VISCOUS_CURVE, "joint 2", "speed", (("bent", ""),), (1,), LAW)


def powers(causes: dict[int, PlacedCause]) -> list[float]:
    return [cause.scanned[0][2] for cause in causes.values()]


def test_a_power_has_its_unit_and_its_law() -> None:
    found = with_power(ANY, 1.5, sliding=False)
    assert found.parameters == (("bent", "N m s^1.5/rad^1.5"),)
    assert isinstance(found.columns, Law)
    assert found.columns.numbers == (0.005, 1.5, 1.0, 1.0, 0.1, 0.5, 1.0)
    assert with_power(ANY, 0.5, sliding=True).parameters == (("bent", "N s^0.5/m^0.5"),)


@pytest.mark.parametrize("chosen", range(len(LIBRARY.powers)))
def test_any_power_about_a_chosen_one_has_one_close_to_it_and_none_is_viscous(chosen: int) -> None:
    placed = {n: with_power(ANY, power, sliding=False) for n, power in enumerate(LIBRARY.powers)}
    found = closer(placed[chosen], {n: each for n, each in placed.items() if n != chosen}, sliding=False)
    assert found.keys() == placed.keys() - {chosen}
    power = LIBRARY.powers[chosen]
    assert max(np.diff(np.log(sorted([power, *powers(found)])))) < LIBRARY.close_powers
    assert all((each < 1) == (power < 1) and abs(np.log(each)) > 0.1 for each in powers(found))


def test_half_the_way_to_the_next_power_is_covered_from_both_sides() -> None:
    placed = {n: with_power(ANY, power, sliding=False) for n, power in enumerate(LIBRARY.powers)}
    found = [
        powers(closer(each, {n: other for n, other in placed.items() if other is not each}, sliding=False))
        for each in placed.values()
    ]
    for (lower, below), (upper, above) in itertools.pairwise(zip(LIBRARY.powers, found, strict=True)):
        if lower < 1 < upper:
            continue
        assert max(below) == pytest.approx(min(above)) == pytest.approx(np.sqrt(lower * upper))


def test_powers_that_are_close_stay() -> None:
    close = {n: with_power(ANY, 0.6 * 1.04**n, sliding=False) for n in range(-3, 4)}
    assert not closer(close[0], {n: each for n, each in close.items() if n}, sliding=False)
