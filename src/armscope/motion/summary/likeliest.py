"""The name of masses that comes next where none is sure enough to be told as one."""

from __future__ import annotations

import math

from armscope.core.numerals import size_of
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary.judgement import title
from armscope.motion.summary.unnamed_masses import likeliest_name


def likeliest_in_words(selected: SelectedCauses) -> str:
    """What a reader may look at first where masses are off without a name: what weighs more, and how likely that is.

    Args:
        selected: the selection.

    Returns:
        A sentence with a space behind it; nothing where no name is likelier than none.
    """
    if (likeliest := likeliest_name(selected)) is None:
        return ""
    found, number, nats = likeliest
    layout = found.rows.layout
    placed, values = layout.placed[number], found.coefficients[layout.columns[number]]
    told = zip(placed.parameters, values, strict=True)
    sizes = ", ".join(f"{name.replace('_', ' ')} {size_of(value, unit, sign=True)}" for (name, unit), value in told)
    odds = f"{math.exp(nats):.0f} to 1" if nats > 1 else "hardly likelier than none"
    return f"The likeliest name, too unsure to be told as one ({odds}): {title(placed)}, {sizes}. "
