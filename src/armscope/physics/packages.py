"""Effects of installed packages, held to the contract: what is wrong with one is said with its name.

An effect is asked about as it is registered (family, templates), and whenever it is placed or its drivers are
evaluated: only then are its parameters known, and the rows.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from string import Formatter
from typing import TypeVar, get_args

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.physics.clause import Told
from armscope.physics.cure import INSTRUCTION_WORDS
from armscope.physics.effect import Effect, Family, Placed
from armscope.physics.loaded_arm import LoadedArm
from armscope.physics.terms import DriverKind
from armscope.recordings import Recordings
from armscope.robot import Arm

Given = TypeVar("Given")

IN_CLAUSES = tuple(Told("", "", "", {}).words())
"""What a clause may name beside the effect's own numbers."""
OF_WAVES = ("amplitude", "phase", "direction")
"""What a verdict tells in place of the values of a wave's terms."""
MEND = "Mend it in that package."
ARMSCOPE = str(Path(__file__).parents[1])


def held_to_contract(effect: Effect, package: str) -> Effect:
    """An effect whose mistakes are told with its name, from now on.

    Args:
        effect: as a package gives it.
        package: its name.

    Returns:
        The same effect; placing it and evaluating its drivers ask about what comes out.

    Raises:
        InputError: a family that there is not, or an instruction that names what there is not.
    """
    source = f"{package}: effect {effect.name!r}"
    if effect.family not in get_args(Family):
        known = get_args(Family)
        raise InputError(
            source, "family", effect.family, f"a family is one of {', '.join(known)}", _close(effect, known)
        )
    _require(source, "cure.instruction", effect.cure.instruction, INSTRUCTION_WORDS)

    def place(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
        for placed in _run(source, "place", lambda: list(effect.place(arm, recordings))):
            if placed.parametrisation != "curve":  # of which a verdict tells how far it reaches
                terms = OF_WAVES if placed.parametrisation == "sine" else [term.name for term in placed.terms]
                own = (*terms, *(name for name, _, _ in placed.scanned), *IN_CLAUSES)
                for clause in effect.clauses:
                    _require(source, "clauses", clause if isinstance(clause, str) else "", own)
            yield placed

    drivers = {name: _asked(kind, source, name) for name, kind in effect.drivers.items()}
    return replace(effect, place=place, drivers=drivers)


def _close(effect: Effect, known: tuple[str, ...]) -> str:
    found = nearest(effect.family, known)
    return found if found.startswith("Did") else MEND


def _require(source: str, place: str, template: str, known: tuple[str, ...]) -> None:
    """Refuse a template that names something else than what is known of the effect."""
    try:
        names = [name for _, name, _, _ in Formatter().parse(template) if name is not None]
    except ValueError as error:
        raise InputError(source, place, template, f"a template: {error}", MEND) from error
    for name in names:
        if name not in known:
            raise InputError(source, place, f"{{{name}}}", "nothing of this name is told of it", nearest(name, known))


def _asked(kind: DriverKind, source: str, name: str) -> DriverKind:
    """A driver whose values are one finite number per row."""

    def values(scene: LoadedArm, *arguments: object) -> Array:
        place = f"driver {name!r}"
        found = np.asarray(_run(source, place, lambda: kind.values(scene, *arguments)))
        wanted = f"one finite number per row, shape ({len(scene)},)"
        if found.shape != (len(scene),):
            raise InputError(source, place, f"shape {found.shape}", wanted, MEND)
        if not np.issubdtype(found.dtype, np.number) or not np.isfinite(found).all():
            wrong = (
                f"NaN or infinity in {(~np.isfinite(found)).sum()} rows" if found.dtype.kind in "fc" else "no numbers"
            )
            raise InputError(source, place, wrong, wanted, "Give 0 where it is not defined or was not recorded.")
        return np.asarray(found, dtype=np.float64)

    return replace(kind, values=values)


def _run(source: str, place: str, call: Callable[[], Given]) -> Given:
    """What a package's function gives; where it fails, where and why."""
    try:
        return call()
    except InputError:
        raise
    except Exception as error:  # whatever a package does wrong when it is called
        frames = traceback.extract_tb(error.__traceback__)
        # where its own call is wrong, it never came as far as the package
        at = ([each for each in frames if not each.filename.startswith(ARMSCOPE)] or frames)[-1]
        where = f"{place}, {at.filename}, line {at.lineno}"
        raise InputError(
            source, where, f"{type(error).__name__}: {error}", "it must run without an error", MEND
        ) from error
