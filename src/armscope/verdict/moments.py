"""When a jump was: several of one kind differ in nothing else."""

from __future__ import annotations

from armscope.physics.drift import OF_RUNS
from armscope.physics.registry import effect_named
from armscope.verdict.effects import FoundEffect


def since(effect: FoundEffect) -> str:
    """From when on a jump holds, or between which runs it was, to be put behind its name; "" of what is no jump."""
    known = effect_named(effect.effect)
    if known is None or not known.jumps:
        return ""
    for start, before in OF_RUNS.items():
        if effect.driver.startswith(start):
            return f"{before}{effect.driver}"
    moment = next((p for p in effect.parameters if p.name in ("row", "time")), None)
    if moment is None:
        return ""
    run = effect.driver.partition(", run ")[2]
    at = f"row {moment.value:g}" if moment.name == "row" else f"{moment.value:g} s"
    return f", from {at} of run {run}" if run else f", from {at}"
