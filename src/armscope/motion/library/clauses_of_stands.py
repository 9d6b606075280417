"""What a headline says of a stand that rings."""

from __future__ import annotations

import numpy as np

from armscope.core.words import rounded, shown_unit
from armscope.motion.library.clauses import Numbers, rms_of
from armscope.motion.library.rocking import ABOUT
from armscope.motion.verdict import FoundCause


def rocking_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A base that rocks: its frequency, and how far it gives way about the axis where it does most."""
    one, both, other = (numbers[name].value for name in ABOUT)
    most = float(np.max(np.linalg.eigvalsh([[one, both], [both, other]])))
    factor, unit = shown_unit(numbers[ABOUT[0]].unit, abs(most))
    soft = f"its stand gives way by {rounded(factor * most)} {unit}" if most > 0 else rms_of(cause)
    return f"the base rocks and rings at {numbers['frequency'].value:.3g} Hz: {soft}"
