"""What remains where not all is explained, in words: beside the noise, and what is asked of a stated noise."""

from __future__ import annotations

from armscope.verdict.schema import NOISE_EXCEEDED, Unexplained, Verdict
from armscope.verdict.wording import millimetres

ABOVE_NOISE = "residual above "  # How what is left is described where all that is known of it is what noise it exceeds


def still_open(verdict: Verdict) -> str:
    """What remains where not all is explained, beside what noise alone would leave; a clause."""
    left, noise = verdict.residual_after_mm, verdict.noise_mm
    named = any(effect.scatters for effect in verdict.effects)
    remain = f"{millimetres(left)} remain{', the scatter included' if named else ''}"
    above = above_what(verdict.unexplained)
    if above:
        patterned = any(notice.kind == "model error" for notice in verdict.notices)
        follow = "with a pattern that is not yet explained" if patterned else "but follow nothing that was recorded"
        return f"{remain}, {above}, {follow}"
    if not noise < left:
        structured = any(notice.kind == "model error" for notice in verdict.notices)
        without_a_name = any(effect.nameless for effect in verdict.effects)
        if without_a_name and not structured:
            return f"the {millimetres(left)} that remain are noise"
        return f"{remain}, no more than noise in size, yet with a pattern that is not yet explained"
    at_most = " at most" if "residuals" in verdict.noise_source else ""
    return f"{remain}, where noise alone would leave {millimetres(noise)}{at_most}: something is not yet explained"


def above_what(left: Unexplained) -> str:
    """ "above the stated noise": what the rest exceeds, where it has neither place nor driver; "" otherwise."""
    what, _, _ = left.description.partition(", that follows")
    placeless = left.present and left.location is None and left.driver is None
    return what.removeprefix("residual ") if placeless and left.description.startswith(ABOVE_NOISE) else ""


def asked_of_noise(verdict: Verdict) -> str:
    """What is asked of a stated uncertainty that the rest exceeds without following anything; "" of any other."""
    return next((notice.text.partition(": ")[2] for notice in verdict.notices if notice.kind == NOISE_EXCEEDED), "")
