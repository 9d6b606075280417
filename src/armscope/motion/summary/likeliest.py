"""The name of masses that comes next where none is sure enough to be told as one."""

from __future__ import annotations

from armscope.core.numerals import size_of
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary.judgement import title
from armscope.motion.summary.unnamed_masses import likeliest_name
from armscope.verdict.counting import odds_in_words
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


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
    return f"The likeliest name, {_not_told(nats)}: {title(placed)}, {sizes}. "


def _not_told(nats: float) -> str:
    """Why a name is not told, by how much likelier it is than that its own link is off without one.

    From where two readings are told apart it is no longer that: then the selection, which weighs all links and motion
    that took no part, does without it.
    """
    if nats >= INDISTINGUISHABLE_NATS:
        odds = f"{odds_in_words(nats)} at its own link"
        return f"not told as one because all links and all motion together do without it ({odds})"
    odds = odds_in_words(nats) if nats > 1 else "hardly likelier than none"
    return f"too unsure to be told as one ({odds})"
