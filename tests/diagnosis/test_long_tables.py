"""A long table is fitted by its sums and one pass: the verdict is the one that passes over all rows lead to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose, pipeline, selection, selection_loop
from armscope.fitting import model_fit, refit, summed_rows
from armscope.fitting.constants import STEPS
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.diagnosis import Diagnosis

from .planted import joined, planted

QUICK = Settings(resamples=0, cross_validation=False)
WANTED = {
    ("joint_compliance", "joint 2"): [2e-6],
    ("joint_offset", "joint 3"): [8e-4],
    ("link_geometry", "link 2"): [2e-3, 1e-3, 4e-4],
}


def recordings() -> tuple[Arm, Recordings]:
    """Two runs, the second one short; some bad shots."""
    arm, first = planted("six-axis", WANTED, 600, 0.03, seed=21)
    _, second = planted("six-axis", WANTED, 60, 0.03, seed=23)
    table = joined(first, second)
    moved = table.positions.copy()
    moved[::40] += 6e-4
    return arm, replace(table, positions=moved)


@pytest.fixture(scope="module")
def verdicts() -> tuple[Diagnosis, Diagnosis, int]:
    """By passes over all rows, by their sums, and how many fits were by sums."""
    arm, table = recordings()
    fits = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(selection, "LOOP", replace(selection.LOOP, sample_rows=150))
        exact = diagnose(arm, table, QUICK)
        short = replace(STEPS, quickly_passed=300, kept_rows=400, telling_rows=150)
        for module in (pipeline, selection_loop, summed_rows):
            patch.setattr(module, "STEPS", short)
        patch.setattr(refit, "SummedFit", lambda *given: fits.append(given) or summed_rows.SummedFit(*given))
        return exact, diagnose(arm, table, QUICK), len(fits)


@pytest.mark.long
def test_the_verdict_is_that_of_passes_over_all_rows(verdicts: tuple[Diagnosis, Diagnosis, int]) -> None:
    exact, of_sums, fits = verdicts
    assert fits
    assert_alike(exact, of_sums)


@pytest.mark.long
def test_the_verdict_on_a_table_that_is_passed_over_once_the_names_are_known_is_the_same(
    verdicts: tuple[Diagnosis, Diagnosis, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    exact, _, _ = verdicts
    arm, table = recordings()
    monkeypatch.setattr(selection, "LOOP", replace(selection.LOOP, sample_rows=150))
    for module in (selection_loop, refit, model_fit):
        monkeypatch.setattr(module, "STEPS", replace(STEPS, quickly_passed=300))
    assert_alike(exact, diagnose(arm, table, QUICK))


def assert_alike(exact: Diagnosis, of_sums: Diagnosis) -> None:
    """The same names; values by a tenth of a standard error."""
    names = [{(each.effect, each.location) for each in verdict.effects} for verdict in (exact, of_sums)]
    assert names[0] == names[1]
    assert ("joint_compliance", "joint 2") in names[0]
    for one, other in zip(exact.effects, of_sums.effects, strict=True):
        for told, again in zip(one.parameters, other.parameters, strict=True):
            assert again.value == pytest.approx(told.value, abs=0.1 * told.stderr)
            assert again.stderr == pytest.approx(told.stderr, rel=0.05)
        assert other.share == pytest.approx(one.share, abs=0.01)


@pytest.mark.long
def test_residuals_are_of_all_rows(verdicts: tuple[Diagnosis, Diagnosis, int]) -> None:
    exact, of_sums, _ = verdicts
    assert of_sums.residual_after_mm == pytest.approx(exact.residual_after_mm, rel=0.01)
    assert len(of_sums.residuals.after) == 660
    assert np.abs(np.array(of_sums.residuals.after) - np.array(exact.residuals.after)).max() < 0.02
