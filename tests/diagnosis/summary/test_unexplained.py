"""Small errors everywhere: where they are largest is told, if it is clearly one place."""

from __future__ import annotations

import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.verdict.schema import Background

from ..planted import planted

QUICK = Settings(resamples=0, cross_validation=False)


def geometry_of(link_2: float) -> Background:
    """Of an arm with errors of 0.04 mm and mrad in every row, those of link 2 so many times as large."""
    wanted = {("link_geometry", f"link {j}"): [0.04e-3, -0.04e-3, 0.04e-3] for j in (1, 2, 3, 4, 5)}
    wanted[("link_geometry", "link 2")] = [link_2 * 0.04e-3] * 3
    verdict = diagnose(*planted("six-axis", wanted, 150, 0.02, seed=3), QUICK)
    assert not any(effect.location == "link 2" for effect in verdict.effects)
    return next(family for family in verdict.background_families if family.family == "geometric")


@pytest.mark.long
@pytest.mark.parametrize(("times", "worst"), [(2.5, "link 2"), (1.0, "")])
def test_the_worst_place_of_a_family_is_told_where_there_is_one(times: float, worst: str) -> None:
    family = geometry_of(times)
    assert family.present
    assert family.worst == worst
