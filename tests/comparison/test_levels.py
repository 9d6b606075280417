"""How large a cause is in each recording: its change is known, and how large it is to what is else possible."""

import numpy as np

from armscope.comparison.levels import own_values
from tests.comparison.test_at_the_tool import of_zero
from tests.comparison.test_changes import session


def test_how_large_it_is_is_known_the_better_the_less_others_may_be():
    """A zero of 1 mrad that came: its change is known to a tenth, its size only beside what else there may be."""
    model, zero = of_zero({"a": session(1), "b": session(2, offsets={3: 1e-3})}, 3)
    since = np.array([-1.0, 1.0])
    errors = []
    for prior in (3.0, 0.3):
        values, covariance, _ = own_values(model, zero.number, (), 2, prior)
        assert abs(since @ values - 1e-3) < 3 * np.sqrt(since @ covariance @ since) < 2e-4
        errors.append(np.sqrt(covariance[0, 0]))
    assert errors[1] < 0.5 * errors[0]
