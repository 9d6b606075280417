"""The names of masses that come next where none is sure enough to be told as one."""

from __future__ import annotations

from armscope.core.words import enumerated, size_of
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary.constants import NAMING
from armscope.motion.summary.judgement import title
from armscope.motion.summary.names_of_masses import NameOfMasses, likely_names
from armscope.verdict.effects import INDISTINGUISHABLE_NATS
from armscope.verdict.wording import odds_in_words


def likeliest_in_words(selected: SelectedCauses) -> str:
    """What a reader may look at first where masses are off without a name: what weighs more, and how likely that is.

    Args:
        selected: the selection.

    Returns:
        A sentence with a space behind it; nothing where masses without a name are likelier than any.
    """
    names = likely_names(selected)
    if not names:
        return ""
    told, why = [_in_words(each) for each in names], _not_told(names[0].nats)
    if len(told) == 1:
        return f"The likeliest name, {why}: {told[0]}. "
    return f"The likeliest names, of which these rows tell none from the next, {why}: {enumerated(told, 'or')}. "


def _in_words(name: NameOfMasses) -> str:
    """A name with its numbers, where these are few enough to be read in a sentence."""
    layout = name.selected.rows.layout
    placed, values = layout.placed[name.number], name.selected.coefficients[layout.columns[name.number]]
    if len(values) > NAMING.numbers_in_a_sentence:
        return title(placed)
    told = zip(placed.parameters, values, strict=True)
    sizes = ", ".join(f"{each.replace('_', ' ')} {size_of(value, unit, sign=True)}" for (each, unit), value in told)
    return f"{title(placed)}, {sizes}"


def _not_told(nats: float) -> str:
    """Why a name is not told, by how much likelier it is than that its own link is off without one.

    From where two readings are told apart it is no longer that: then the selection, which weighs all links and motion
    that took no part, does without it.
    """
    if nats >= INDISTINGUISHABLE_NATS:
        odds = f"{odds_in_words(nats)} at its own link"
        return f"not told as one because all links and all motion together do without it ({odds})"
    odds = odds_in_words(nats) if nats > 1 else "hardly likelier than none" if nats > 0 else "no likelier than none"
    return f"too unsure to be told as one ({odds})"
