"""The first sentence of a verdict."""

from __future__ import annotations

from armscope.verdict.schema import Verdict

UNPLACED_SHARE = 0.3
"""A background that is worth more than this is not small: its members stand in for each other."""


def headline(verdict: Verdict) -> str:
    """The first sentence of the report."""
    if verdict.answer == "nothing missing":
        return f"Nothing is missing: the residual of {verdict.residual_after_mm:.3g} mm is noise."
    if verdict.answer == "cannot tell" and not verdict.effects:
        if verdict.unexplained.description:
            return f"It cannot be told what is missing: {verdict.unexplained.description}."
        return "There is more than noise, but nothing in the table explains it: it cannot be told what is missing."
    story = [effect for effect in verdict.effects if not effect.minor][:3]
    parts = [f"{e.title} ({e.rms_at_tool_mm:.2g} mm, {100 * e.share:.0f} %)" for e in story]
    for family in verdict.background_families:
        if family.present:
            size = f"({family.rms_at_tool_mm:.2g} mm, {100 * family.share:.0f} %)"
            if family.share < UNPLACED_SHARE:
                parts.append(f"small {family.family} errors everywhere {size}")
            else:
                parts.append(f"{family.family} errors whose places cannot be told apart {size}")
    rest = f"; {verdict.residual_before_mm:.3g} mm become {verdict.residual_after_mm:.3g} mm"
    return ("; ".join(parts) or "Minor effects only") + rest + "."
