"""Backgrounds must foretell motion that took no part, too."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.summary import foretelling
from armscope.motion.summary.foretelling import with_backgrounds_that_foretell
from tests.motion.moving import moved, robot


@pytest.fixture(scope="module")
def selected() -> SelectedCauses:
    found = diagnose_motion(robot(), moved(robot(), 3, seconds=10.0), MotionSettings(cutoff=10.0)).selected
    assert found.best.background[1], "friction changes sides at times of its own to begin with"
    return found


def harming(selected: SelectedCauses, share: float) -> Array:
    """Nats of the four choices in two blocks; without reversals so many of the noise's power less."""
    nats = np.zeros((4, len(selected.blocks)))
    nats[2:] -= share * selected.problem.n / (2 * len(selected.blocks))
    return nats


@pytest.mark.long
def test_a_background_that_does_harm_elsewhere_goes(selected: SelectedCauses, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foretelling, "misfits", lambda at, asked: harming(selected, 0.5))
    found, without = with_backgrounds_that_foretell(selected)
    assert without == {"reversals"}
    assert not np.isin(selected.space.families[1].columns, found.best.columns).any()


def test_one_that_does_hardly_any_stays(selected: SelectedCauses, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foretelling, "misfits", lambda at, asked: harming(selected, 0.05))
    assert with_backgrounds_that_foretell(selected) == (selected, frozenset())


def test_where_the_library_has_all_that_there_is_nothing_goes(selected: SelectedCauses) -> None:
    assert with_backgrounds_that_foretell(selected)[1] == frozenset()
