"""The scan for a stand: no line of the damping that is tried first lies unseen between two frequencies."""

from __future__ import annotations

import numpy as np

from armscope.motion.library.rocking_constants import ROCKING


def test_between_two_frequencies_a_line_has_more_than_half_of_its_power() -> None:
    aside = np.exp(ROCKING.step / 2)
    share = (2 * ROCKING.damping) ** 2 / ((1 - aside**2) ** 2 + (2 * ROCKING.damping * aside) ** 2)
    assert share > 0.5
