"""What each cause is worth, and what masses without a name add to those that are told."""

from __future__ import annotations

import functools
import itertools
from typing import Any

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.constants import TELLING
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.motion.summary.shares import worth_of
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


def contributions(selected: SelectedCauses) -> tuple[list[Array], Array]:
    """By cause, then masses without a name, (K * m,) of each in units of noise; and what no cause explains.

    Both without what friction and rotors take up, row by row.
    """
    rows, best, layout = selected.rows, selected.best, selected.rows.layout
    members = [layout.columns[effect.candidate] for effect in best.chosen]
    named = {int(column) for columns in members for column in columns}
    masses = np.array([column for column in layout.masses if column in best.columns and int(column) not in named])
    others = [int(c) for c in best.columns if int(c) not in named and c not in masses]

    def weighed(torque: Array) -> Array:
        unit = selected.weights.sigma * np.sqrt(selected.weights.correlated)
        return np.asarray(rows.without_pauses(torque) / unit * np.sqrt(selected.weights.row)).ravel()

    def of(columns: Array) -> Array:
        only = np.zeros(layout.width)
        only[columns] = selected.coefficients[columns]
        return weighed(rows.modelled(only))

    base = np.column_stack([weighed(rows.modelled(np.eye(layout.width)[c])) for c in others])
    base /= np.linalg.norm(base, axis=0)
    plain = lambda values: values - base @ np.linalg.lstsq(base, values, rcond=1e-10)[0]
    parts = [plain(of(columns)) for columns in [*members, masses.astype(int)]]
    return parts, plain(weighed(selected.residuals))


def by_orders(parts: list[Array], left: Array) -> Array:
    """Of the squared torque, what curing each takes away, averaged over all orders of curing."""
    whole = np.sum((sum(parts) + left) ** 2)
    shares, orders = np.zeros(len(parts)), list(itertools.permutations(range(len(parts))))
    for order in orders:
        torque = sum(parts) + left
        for n in order:
            cured = torque - parts[n]
            shares[n] += np.sum(torque**2) - np.sum(cured**2)
            torque = cured
    return shares / len(orders) / whole


def weighty(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A counterweight at joint 2 that is not in the model, a sensor that reads a little too much, a stiffer hose."""
    extra = np.zeros_like(q)
    extra[:, 1], extra[:, 2] = 60 * np.cos(q[:, 1] - 0.4), 1.2
    extra[:, 0] = 0.02
    return extra


@functools.cache
def beside_a_counterweight() -> MotionDiagnosis:
    return diagnose_motion(robot(), moved(robot(), 1, weighty, noise=0.002))


def test_a_share_is_what_curing_takes_away_averaged_over_all_orders() -> None:
    selected = beside_a_counterweight().selected
    worth, masses = worth_of(selected)
    assert len(worth) >= 3
    assert [*(each.share for each in worth), masses] == pytest.approx(by_orders(*contributions(selected)), abs=2e-4)


def test_what_is_large_beside_what_a_larger_cause_leaves_is_part_of_the_story() -> None:
    """A hundredth of all, in squares, and most of what there is once the counterweight is in the model."""
    found = {(each.effect, each.location): each for each in beside_a_counterweight().verdict.effects}
    spring, offset, little = (
        found[key]
        for key in (
            ("gravity_balance", "joint 2"),
            ("torque_offset", "joint 3"),
            ("torque_offset", "joint 1"),
        )
    )
    assert (spring.minor, offset.minor, little.minor) == (False, False, True)
    assert offset.share < TELLING.minor_share < spring.share


@pytest.mark.long
@pytest.mark.parametrize("share", [1.0, pytest.param(2.0, marks=pytest.mark.long)])
def test_a_headline_tells_what_masses_without_a_name_add(share: float) -> None:
    """A small cause with a name is not left alone beside an error that falls for another reason."""
    found = diagnose_motion(robot(), moved(robot(**off(share)), 1, pulled, noise=0.005, seconds=15.0))
    worth, added = worth_of(found.selected)
    assert {each.effect for each in found.verdict.effects} == {"torque_offset"}
    assert [*(each.share for each in worth), added] == pytest.approx(
        by_orders(*contributions(found.selected)), abs=2e-4
    )
    assert added > 0.1
    assert (
        f"Masses of the links that are off without a name add {percent(added)} of what friction"
        in found.verdict.headline
    )
    told = sum(each.share for each in worth) + added
    parts, remains = contributions(found.selected)  # what either of them explains is not told twice
    assert told == pytest.approx(1 - np.sum(remains**2) / np.sum((sum(parts) + remains) ** 2), abs=2e-4)


@pytest.mark.long
def test_masses_that_are_as_stated_explain_nothing() -> None:
    found = diagnose_motion(robot(), moved(robot(), 1, pulled, noise=0.005))
    worth, by_masses = worth_of(found.selected)
    assert (sum(each.share for each in worth) > 0.9, by_masses) == (True, pytest.approx(0, abs=0.01))
    assert "without a name" not in found.verdict.headline
