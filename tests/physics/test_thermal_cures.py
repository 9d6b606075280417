"""Every thermal cause's cure, executed as it is worded, on an arm whose kinematics stand in NumPy alone.

The formula and its numbers are read from the work order, the joints are commanded by them at other temperatures, and
the arm must reach what was wanted. An arm that is only warmed up does not.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.verdict.contributions import contributions
from armscope.verdict.work_order import work_order

from ..diagnosis.numpy_arms import UR5E, reached, said

GROWS_PER_K, TURNS_PER_K = 2.2e-5, 5e-5
LENGTHS = np.array([[a, 0, d, 0] for a, _, d in UR5E])
UNITS = {"millionths per K": 1e-6, "µrad per K": 1e-6, "mrad per K": 1e-3}
Errors = Callable[[float], Array]
"""(6, 4) errors of the rows' a, alpha, d and about y at a temperature."""


def grown(*rows: int) -> Errors:
    """Rows that grow, all else as stated."""
    which = np.isin(np.arange(1, 7), rows)[:, None]
    return lambda temperature: GROWS_PER_K * (temperature - 20) * LENGTHS * which


def bowed(temperature: float) -> Array:
    """Link 2 turned about its y."""
    errors = np.zeros((6, 4))
    errors[1, 3] = TURNS_PER_K * (temperature - 20)
    return errors


def tools(errors: Errors, angles: Array, temperature: Array, zero: float = 0.0) -> Array:
    """(N, 3) tool points, m, row by row at its temperature; joint 3's zero moves with it, too."""
    turned = angles + zero * np.outer(temperature - 20, np.arange(6) == 2)
    rows = zip(turned, temperature, strict=True)
    return np.vstack([reached(UR5E, errors(float(t)), row[None]) for row, t in rows])


def number(text: str, name: str) -> float:
    """A number as the work order prints it, SI units."""
    found = re.search(rf"{name} = ([−\d.]+) ({'|'.join(UNITS)})", text)
    assert found, text
    return float(found[1].replace("−", "-")) * UNITS[found[2]]


def formula(text: str, name: str) -> Callable[..., Array]:
    """What a text says that something equals, to be calculated."""
    found = re.search(rf"{name} = ([^;.:]+?\(temperature - 20 C\)\)?)", text)
    assert found, text
    code = found[1].replace(" x ", " * ").replace("20 C", "20").replace("stated length", "stated")
    return lambda **names: eval(code, {"__builtins__": {}}, names)


def by_model(wanted: Array, angles: Array, model: Callable[[Array], Array]) -> Array:
    """Commands for which a controller's model stands at the wanted points: Newton's method, smallest steps."""
    for _ in range(4):
        missed = wanted - model(angles)
        steps = 1e-6 * np.eye(6)
        J = np.stack([(model(angles + step) - model(angles)) / 1e-6 for step in steps], axis=2)
        angles = angles + np.einsum("nmk,nk->nm", np.linalg.pinv(J, rcond=1e-3), missed)
    return angles


def commands(what: str, text: str, angles: Array, temperature: Array) -> Array:
    """The joints' angles under the cure as it is worded."""
    if what == "zero":
        drift = number(text, "drift")
        changed = angles.copy()
        changed[:, 2] = formula(text, "commanded")(wanted=angles[:, 2], drift=drift, temperature=temperature)
        return changed
    if what == "bow":
        turn = formula(text, "turn")

        def errors(at: float) -> Array:
            tilted = np.zeros((6, 4))
            tilted[1, 1] = turn(tilt_x=number(text, "tilt_x"), temperature=at)
            tilted[1, 3] = turn(tilt_x=number(text, "tilt_y"), temperature=at)
            return tilted
    else:
        longer, which = formula(text, "length"), np.arange(1, 7) == 2 if what == "link" else np.full(6, True)
        coefficient = number(text, "coefficient")

        def errors(at: float) -> Array:
            scaled = longer(stated=LENGTHS, coefficient=coefficient, temperature=at) - LENGTHS
            return scaled * which[:, None]

    wanted = tools(lambda at: np.zeros((6, 4)), angles, temperature)
    return by_model(wanted, angles, lambda some: tools(errors, some, temperature))


@pytest.mark.parametrize("what", ["link", "links", "bow", "zero"])
def test_a_thermal_cure_as_worded_takes_the_error_away_and_warming_the_arm_up_does_not(what: str) -> None:
    errors: Errors = {"link": grown(2), "links": grown(*range(1, 7)), "bow": bowed}.get(what, grown())
    zero = TURNS_PER_K if what == "zero" else 0.0
    rng = np.random.default_rng(5)
    temperature = rng.uniform(20, 36, 150)

    def shifted(points: Array, rows: Array) -> None:
        angles = np.random.default_rng(11).uniform(-2, 2, (len(rows), 6))
        stated = tools(lambda at: np.zeros((6, 4)), angles, temperature)
        points += tools(errors, angles, temperature, zero) - stated

    verdict = said(UR5E, lambda true, rows: None, 11, shifted, temperature=temperature)
    cause = next(each for each in verdict.causes if each.family == "thermal")
    order = work_order(verdict, contributions(verdict))
    task = next(each for each in order.tasks if each.family == "thermal")
    text = f"{task.instruction} {task.cure}"
    for told in (text, cause.cure):
        assert "20 C" in told
        assert "Warm" not in told
        assert "only with a calibration at that temperature" in told
    angles, day = rng.uniform(-2, 2, (60, 6)), rng.uniform(20, 36, 60)
    wanted = tools(lambda at: np.zeros((6, 4)), angles, day)
    before = rms(tools(errors, angles, day, zero) - wanted)
    after = rms(tools(errors, commands(what, text, angles, day), day, zero) - wanted)
    warmed_up = rms(tools(errors, angles, np.full(60, 36.0), zero) - wanted)
    assert after < 0.15 * before < 0.15 * warmed_up
