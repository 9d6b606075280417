"""The library: every effect that can be missing, armscope's own and those of installed packages.

A package brings effects of its own by an entry point of the group ``armscope.effects`` (docs/add-an-effect.md).
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator
from importlib.metadata import EntryPoint, entry_points

from armscope.core.inputs import InputError
from armscope.physics import (
    compliance_change,
    drift,
    elastic,
    freeform,
    geometric,
    instrument,
    loose_target,
    payload,
    payload_change,
    thermal,
    tilting,
    transmission,
    zero_shift,
)
from armscope.physics.drivers import KINDS
from armscope.physics.effect import Effect, Placed
from armscope.physics.learned_sizes import with_learned_sizes
from armscope.physics.packages import held_to_contract
from armscope.recordings import Recordings
from armscope.robot import Arm

GROUP = "armscope.effects"

EFFECTS: tuple[Effect, ...] = (
    *geometric.EFFECTS,
    *transmission.EFFECTS,
    *elastic.EFFECTS,
    *compliance_change.EFFECTS,
    *tilting.EFFECTS,
    *thermal.EFFECTS,
    *drift.EFFECTS,
    *zero_shift.EFFECTS,
    *instrument.EFFECTS,
    *loose_target.EFFECTS,
    *payload.EFFECTS,
    *payload_change.EFFECTS,
    *freeform.EFFECTS,
)
"""armscope's own."""


@functools.cache
def effects() -> tuple[Effect, ...]:
    """armscope's own effects, then those of installed packages, whose drivers are known from then on.

    Raises:
        InputError: a package's entry point can't be loaded, is no effect, takes a name that is taken, or breaks the
            contract (`armscope.physics.packages`).
    """
    known = list(EFFECTS)
    for point in sorted(entry_points(group=GROUP), key=lambda point: (point.name, point.value)):
        for effect in (held_to_contract(each, _package(point)) for each in _loaded(point)):
            taken = [name for name in (effect.name,) if name in {each.name for each in known}]
            taken += [kind for kind in effect.drivers if kind in KINDS]
            if taken:
                raise _refused(
                    point, taken[0], "names of effects and drivers must be new", "Rename it in that package."
                )
            KINDS.update(effect.drivers)
            known.append(effect)
    return tuple(known)


def _loaded(point: EntryPoint) -> Iterator[Effect]:
    try:
        loaded = point.load()
    except Exception as error:  # whatever a module does wrong as it is imported
        raise _refused(point, f"{type(error).__name__}: {error}", "it must be importable") from error
    for effect in loaded if isinstance(loaded, Iterable) else (loaded,):
        if not isinstance(effect, Effect):
            raise _refused(point, type(effect).__name__, "it must be an Effect, or several")
        yield effect


def _refused(point: EntryPoint, found: str, rule: str, cure: str = "Mend or uninstall that package.") -> InputError:
    return InputError(_package(point), f"entry point {GROUP}: {point.name} = {point.value}", found, rule, cure)


def _package(point: EntryPoint) -> str:
    return point.dist.name if point.dist else "an installed package"


def effect_named(name: str) -> Effect | None:
    """The definition of an effect by its name; None where nothing of that name is installed."""
    return next((effect for effect in effects() if effect.name == name), None)


def library(arm: Arm, recordings: Recordings) -> list[Placed]:
    """Every effect at every location of an arm where the recordings can show it, without those found by scanning."""
    placed = [placed for effect in effects() for placed in effect.place(arm, recordings)]
    return with_learned_sizes(placed, arm.type, [effect.name for effect in effects()])
