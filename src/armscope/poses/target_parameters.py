"""What poses shall show: the parameters of chosen effects, and of the two frames that every recording leaves free."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError, nearest
from armscope.core.location import Location
from armscope.core.types import Array, Indices
from armscope.design.independence import independent_columns
from armscope.physics.drift import six_terms
from armscope.physics.effect import AXES, ONE, Part, Placed, Term
from armscope.physics.frames import BASE_FRAME, TOOL_FRAME
from armscope.physics.geometric import background
from armscope.physics.registry import effects as all_effects
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.poses.constants import CHOOSING
from armscope.recordings import Recordings
from armscope.robot import Arm

GEOMETRY = "geometry"  # The default set of effects: constant errors of all D-H rows and all motors' zeros


@dataclass(frozen=True, eq=False)
class TargetParameters:
    """Parameters that poses can tell apart."""

    arm: Arm
    placed: tuple[Placed, ...]  # frames first, then the effects
    terms: tuple[tuple[int, Term], ...]  # (effect number in ``placed``, term) of each parameter kept, p of them
    sizes: Array  # (p,) SI size of each that moves the tool by `CHOOSING.size_m`
    hidden: tuple[str, ...]  # names of parameters that the others imitate, or that move nothing

    @property
    def names(self) -> tuple[str, ...]:
        """Of the parameters: "link 2 a", "joint 3 offset"."""
        return tuple(_name(self.placed[number], term) for number, term in self.terms)

    @cached_property
    def is_frame(self) -> NDArray[np.bool_]:
        """(p,) which parameters belong to base and tool frame."""
        return np.array([self.placed[number].family == "frame" for number, _ in self.terms])

    def jacobian(self, table: Recordings) -> Array:
        """(N, 3, p) displacement of the tool, m, by each parameter's `size`."""
        posture = Scene(self.arm, table).posture()
        return np.stack(
            [posture.column(term) * size for (_, term), size in zip(self.terms, self.sizes, strict=True)], 2
        )

    def parts(self, values: Array) -> list[Part]:
        """The effects with values (p,) in units of the sizes; parameters that are not kept are zero."""
        by_effect = [np.zeros(len(each.terms)) for each in self.placed]
        for value, size, (number, term) in zip(values, self.sizes, self.terms, strict=True):
            by_effect[number][self.placed[number].terms.index(term)] = value * size
        return [Part(each, si) for each, si in zip(self.placed, by_effect, strict=True)]

    def tool(self, table: Recordings, values: Array) -> Array:
        """(N, 3) the tool with all effects in place, exactly, m."""
        return Scene(self.arm, table).posture(self.parts(values)).tool


def target_parameters(arm: Arm, table: Recordings, effects: Sequence[str] = (GEOMETRY,)) -> TargetParameters:
    """The parameters of some effects, wherever they can stand, that the poses of a table tell apart.

    Args:
        arm: the arm.
        table: candidate poses with the context that effects follow.
        effects: names of the vocabulary, or `GEOMETRY`.

    Returns:
        The parameters with their natural sizes, and the names of those that the poses don't tell apart.

    Raises:
        InputError: an unknown name, or an effect that poses alone cannot show.
    """
    frames = [
        Placed(BASE_FRAME, "base", six_terms("base", ONE), (1.0,) * 6, "constant"),
        Placed(TOOL_FRAME, "tool", six_terms("tool", ONE, axes=AXES[:3]), (1.0,) * 3, "constant"),
    ]
    placed = (*frames, *_placed(arm, table, effects))
    posture = Scene(arm, table).posture()
    terms = [(number, term) for number, each in enumerate(placed) for term in each.terms]
    columns = np.stack([posture.column(term).reshape(-1) for _, term in terms], axis=1)
    rms = np.sqrt(np.mean(columns**2, axis=0) * 3)
    moves = rms > CHOOSING.unmoved_m
    sizes = np.where(moves, CHOOSING.size_m / np.where(moves, rms, 1.0), 1.0)
    tiers = np.array([_tier(placed[number]) for number, _ in terms])
    kept = _told_apart(columns * sizes, tiers) & moves
    hidden = tuple(_name(placed[number], term) for (number, term), keep in zip(terms, kept, strict=True) if not keep)
    chosen = tuple(each for each, keep in zip(terms, kept, strict=True) if keep)
    return TargetParameters(arm, placed, chosen, sizes[kept], hidden)


def _placed(arm: Arm, table: Recordings, effects: Sequence[str]) -> list[Placed]:
    known = {effect.name: effect for effect in all_effects()}
    found, everywhere = list[Placed](), library(arm, table)
    for name in dict.fromkeys(effects):
        if name == GEOMETRY:
            found += background(arm)
            continue
        if name not in known:
            raise InputError("--effects", "", name, "no effect of this name", nearest(name, {*known, GEOMETRY}))
        here = [each for each in everywhere if each.name == name and not each.refinement]
        first = {each.location: each for each in reversed(here)}  # one form of it per location
        if not here:
            needs = ", ".join(known[name].needs)
            needs = f"it follows {needs}" if needs else "nothing here drives it, or it is found by scanning only"
            rule = f"poses alone cannot show it on {arm.name}: {needs}"
            raise InputError(
                "--effects", "", name, rule, "Leave it out, or give the context it follows (--payload-kg)."
            )
        found += list(first.values())[::-1]
    return found


def _tier(placed: Placed) -> int:
    """Order of preference where parameters imitate each other: frames, then zeros of motors, which a user can set."""
    if placed.family == "frame":
        return 0
    return 1 if placed.family == "geometric" and Location.of(placed.location).kind == "joint" else 2


def _told_apart(columns: Array, tiers: Indices) -> NDArray[np.bool_]:
    """Columns of which enough is left beyond those of lower tiers, whatever their size."""
    triangular = np.linalg.qr(columns, mode="r")
    unit = triangular / np.maximum(np.linalg.norm(triangular, axis=0), 1e-300)
    return independent_columns(unit, tiers, CHOOSING.independent)


def _name(placed: Placed, term: Term) -> str:
    return f"{placed.location} {term.name}" if placed.family in ("frame", "geometric") else f"{placed} {term.name}"
