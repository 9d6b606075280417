"""What is changed at a parallelogram's bars, with directions."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.core.words import enumerated
from armscope.physics.linkage_words import BARS, OF_WHAT
from armscope.verdict.effects import INTERVAL, Parameter
from armscope.verdict.entries import length

ALL_OF_THEM = "both before anything is measured: one without the other can make it worse"
NOT_SURE = "no bar is surely off (each interval holds zero), so change none before it was measured"
PPM = 1e6


def bars_set_right(parameters: Sequence[Parameter]) -> str:
    """How each bar that is off is changed; one whose interval holds zero is left as it is. ``parameters``: of the
    parallelogram: the errors of its bars, lengths or shares of the rocker's."""
    bars = sorted((p for p in parameters if p.name in BARS), key=lambda p: BARS.index(p.name))
    if not bars:
        return "–"
    off = [p for p in bars if abs(p.value) > INTERVAL * p.stderr]
    if not off:
        return NOT_SURE
    changes = [f"make the {p.name} {'shorter' if p.value > 0 else 'longer'} by {_by_how_much(p)}" for p in off]
    kept = [f"leave the {p.name} as it is (its error may be none)" for p in bars if p not in off]
    return "; ".join([enumerated(changes), *([ALL_OF_THEM] if len(off) > 1 else []), *kept])


def _by_how_much(bar: Parameter) -> str:
    if bar.unit == "mm":
        return length(abs(bar.value), bar.stderr).removeprefix("+")
    half = f" (± {PPM * INTERVAL * bar.stderr:.0f})" if bar.stderr > 0 else ""
    return f"{PPM * abs(bar.value):.0f} ppm{half} {OF_WHAT}"
