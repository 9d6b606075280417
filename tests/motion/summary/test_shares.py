"""What each cause explains, and masses without a name: together all that the model does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.summary.shares import shares_of
from tests.motion.moving import ROBOT, moved, robot


def pulled(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A sensor of joint 3 that reads too much."""
    extra = np.zeros_like(q)
    extra[:, 2] = 0.3
    return extra


def off(share: float) -> dict[str, Any]:
    """Links of the same arm that are heavier and lighter, and have their centres elsewhere."""
    links: list[dict[str, Any]] = ROBOT["links"]  # type: ignore[assignment]
    by = [(-0.04, (6, -8, 5)), (0.05, (12, 15, -9)), (-0.03, (-14, 6, 11))]
    return {
        "links": [
            {
                **link,
                "mass_kg": (1 + share * more) * link["mass_kg"],
                "com_mm": [a + share * b for a, b in zip(link["com_mm"], way, strict=True)],
            }
            for link, (more, way) in zip(links, by, strict=True)
        ]
    }


@pytest.mark.parametrize("share", [1.0, 2.0])
def test_a_headline_tells_what_masses_without_a_name_explain(share: float) -> None:
    """A small cause with a name is not left alone beside an error that falls for another reason."""
    found = diagnose_motion(robot(), moved(robot(**off(share)), 1, pulled, noise=0.005))
    explained, by_masses = shares_of(found.selected)
    assert {each.effect for each in found.verdict.effects if not each.minor} == {"torque_offset"}
    assert by_masses > 0.5 > sum(explained)
    left = found.verdict.fitted.fitted / found.verdict.waterfall[0].fitted
    assert sum(explained) + by_masses == pytest.approx(1 - left**2, abs=0.03)
    assert f"Masses of the links that are off without a name: {100 * by_masses:.0f} %" in found.verdict.headline


def test_masses_that_are_as_stated_explain_nothing() -> None:
    found = diagnose_motion(robot(), moved(robot(), 1, pulled, noise=0.005))
    explained, by_masses = shares_of(found.selected)
    assert (sum(explained) > 0.9, by_masses) == (True, pytest.approx(0, abs=0.01))
    assert "without a name" not in found.verdict.headline
