"""How large a cause is in each of several recordings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.comparison.constants import SHARED
from armscope.comparison.dispersion import Possible
from armscope.comparison.penalised import HeldColumns
from armscope.comparison.shared_model import SharedModel
from armscope.core.types import Array


def own_values(
    model: SharedModel, number: int, beside: Sequence[Possible], count: int, prior_mm: float = SHARED.prior_mm
) -> tuple[Array, Array, float]:
    """An effect with a value of its own in every recording.

    Args:
        model: what recordings share.
        number: the effect's, of q terms.
        beside: changes of other effects.
        count: of the recordings.
        prior_mm: how large other effects that are shared are at the tool.

    Returns:
        Values (count q), SI units, their covariance, and how many numbers are free.
    """
    at = model.at(number)
    others = model.scale > 0
    others[at] = False
    base = model.base(beside, others, model.own.other_than(model.effects[:, at]), prior_mm)
    own = np.hstack([model.columns_of(number, (k,)) for k in range(count)])
    # what one recording alone does not tell stays at the prior
    scale = np.tile(model.scale[at], count)
    scale = np.where(scale > 0, scale, 1.0)
    held = np.concatenate([base.penalty, model.noise / (SHARED.widened * scale) ** 2])
    whole = HeldColumns(np.hstack([base.columns, own]), held, base.drawn)
    inverse = np.linalg.inv(whole.gram + np.diag(held))
    values = (inverse @ (whole.columns.T @ model.residual))[-own.shape[1] :]
    variance, free = model.left(whole)
    return values, np.asarray(model.dispersion * variance * inverse[-own.shape[1] :, -own.shape[1] :]), free
