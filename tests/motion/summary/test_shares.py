"""What each cause explains, and what masses without a name add to those that are told."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.summary.shares import shares_of
from armscope.verdict.wording import percent
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


def explained_by(selected: SelectedCauses, without: Array) -> float:
    """What the chosen columns explain together, but for some: by solving for them at once."""
    best, problem = selected.best, selected.problem
    kept = ~np.isin(best.columns, without)
    among, ridge = best.columns[kept], best.noise**2 / best.variance[kept]
    G, b = problem.equations.G[np.ix_(among, among)], problem.equations.b[among]
    return float(b @ np.linalg.solve(G + np.diag(ridge), b))


@pytest.mark.long
@pytest.mark.parametrize("share", [1.0, pytest.param(2.0, marks=pytest.mark.long)])
def test_a_headline_tells_what_masses_without_a_name_add(share: float) -> None:
    """A small cause with a name is not left alone beside an error that falls for another reason."""
    found = diagnose_motion(robot(), moved(robot(**off(share)), 1, pulled, noise=0.005, seconds=15.0))
    selected = found.selected
    explained, added = shares_of(selected)
    assert {each.effect for each in found.verdict.effects} == {"torque_offset"}
    (offset,) = (selected.space.candidates[number].columns for number in selected.best.candidates)
    masses = np.asarray(selected.rows.layout.inertial)
    whole, without = (explained_by(selected, columns) for columns in (np.array([-1]), masses))
    least = selected.problem.equations.yy - explained_by(selected, np.concatenate([masses, offset]))
    assert added == pytest.approx((whole - without) / least, rel=1e-6)
    assert added > 0.1
    assert f"Masses of the links that are off without a name add {percent(added)}." in found.verdict.headline
    left = found.verdict.fitted.fitted / found.verdict.waterfall[0].fitted
    assert sum(explained) + added < 1 - left**2  # what either of them explains is not told twice


@pytest.mark.long
def test_masses_that_are_as_stated_explain_nothing() -> None:
    found = diagnose_motion(robot(), moved(robot(), 1, pulled, noise=0.005))
    explained, by_masses = shares_of(found.selected)
    assert (sum(explained) > 0.9, by_masses) == (True, pytest.approx(0, abs=0.01))
    assert "without a name" not in found.verdict.headline
