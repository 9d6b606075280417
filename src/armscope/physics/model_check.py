"""What a model file may ask of an arm: effects, frames and drivers that there are, with arguments that they take."""

from __future__ import annotations

import inspect
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.physics import drivers
from armscope.physics.effect import AXES, Direction, Driver, Effect, Part, Placed, Product, Term
from armscope.physics.frames import BASE_FRAME, TOOL_FRAME
from armscope.physics.geometric import BACKGROUND, PARALLELOGRAM_GEOMETRY, is_parallelogram
from armscope.physics.loads import STATED_MASSES
from armscope.physics.model_contents import PartFile
from armscope.physics.orientation_error import ORIENTATION_ERROR
from armscope.physics.registry import effects
from armscope.physics.wander import BASE_WANDER, LINK_WANDER
from armscope.robot import Arm

ALLOWED_FOR = (STATED_MASSES, BASE_WANDER, LINK_WANDER, ORIENTATION_ERROR)
DEEPEST_DRIVER = 4
"""Levels of drivers of drivers."""
LARGEST_ARGUMENT = 1e12
"""Of a driver: seconds since 1970 are the largest numbers that stand there."""
RUNS = ("runs", "later")
"""What arguments are called that are any number of runs."""


class Reader:
    """Parts of a model file as parts of a model of an arm.

    Args:
        arm: the arm.
        source: the file, for messages.
    """

    def __init__(self, arm: Arm, source: object) -> None:
        self.arm, self.source = arm, source
        self._definitions: dict[str, Effect] = {
            effect.name: effect for effect in (BASE_FRAME, TOOL_FRAME, BACKGROUND, *ALLOWED_FOR, *effects())
        }

    def parts(self, contents: Sequence[PartFile], place: str) -> tuple[Part, ...]:
        """Parts as the file lists them under a key.

        Raises:
            InputError: an effect, a location or a driver that this arm can't have; its place is named.
        """
        return tuple(self._part(content, f"{place}[{number}]") for number, content in enumerate(contents))

    def _part(self, content: PartFile, place: str) -> Part:
        if content.effect not in self._definitions:
            cure = nearest(content.effect, self._definitions)
            raise InputError(self.source, f"{place}.effect", content.effect, "no effect of that name", cure)
        if content.effect == PARALLELOGRAM_GEOMETRY.name:
            self._check_linkage(content, place)
        terms = tuple(
            Term(
                term.name,
                term.unit,
                term.si,
                tuple(
                    self._product(product, f"{place}.terms[{number}].products[{which}]")
                    for which, product in enumerate(term.products)
                ),
            )
            for number, term in enumerate(content.terms)
        )
        placed = Placed(
            self._definitions[content.effect],
            content.location,
            terms,
            (1.0,) * len(terms),
            content.driver,
            tuple((each.name, each.unit, each.value) for each in content.scanned),
            variant=content.variant,
            parametrisation=content.reading,
        )
        return Part(placed, np.array([term.value for term in content.terms]))

    def _check_linkage(self, content: PartFile, place: str) -> None:
        lengths = self.arm.description.parallelogram
        if lengths is None and not is_parallelogram(self.arm):
            raise InputError(self.source, place, content.effect, "this arm has no `parallelogram`")
        errors = {term.name: term.value for term in content.terms}
        if set(errors) != {"rod", "rocker"}:
            raise InputError(self.source, f"{place}.terms", sorted(errors), "its terms are rocker and rod")
        # of bars that are not stated errors are shares
        shortest, unit = (1.0, "") if lengths is None else (1e-3 * min(lengths.rod_mm, lengths.rocker_mm), " m")
        for name, value in errors.items():
            if abs(value) > shortest / 2:
                raise InputError(
                    self.source, f"{place}.terms", f"{name} {value:g}{unit}", "a bar's error is less than half"
                )

    def _product(self, content: Sequence[Any], place: str) -> Product:
        if len(content) < 4:
            raise InputError(self.source, place, list(content), "[location, axis, factor, driver, ...]")
        location, axis, factor, *driver = content
        direction = Direction(self._location(location, axis, place), axis)
        return Product(direction, self._driver(driver, place), self._finite(factor, place))

    def _location(self, location: Any, axis: Any, place: str) -> str:
        axes = {"instrument": ("scale", "height", *AXES[3:]), "motor": ("turn",), "payload": ("mass",)}
        kind = self._frame(location, ("base", "tool", "instrument", "payload", "joint", "link", "motor"), place)
        if axis not in axes.get(kind, AXES):
            raise InputError(self.source, place, axis, f"at {location} the axis is one of {axes.get(kind, AXES)}")
        return str(location)

    def _frame(self, location: Any, kinds: Sequence[str], place: str) -> str:
        """The kind of a location; it is there."""
        counts = {"joint": self.arm.n_joints, "link": self.arm.n_joints, "motor": self.arm.n_motors}
        kind, _, number = str(location).partition(" ")
        known = not number if kind not in counts else number.isascii() and number.isdecimal() and number[0] != "0"
        if kind not in kinds or not known or (kind in counts and not 1 <= int(number[:4]) <= counts[kind]):
            rule = f"a location is {', '.join(kinds)}, with a number up to {self.arm.n_joints} where there are several"
            raise InputError(self.source, place, location, rule)
        return kind

    def _driver(self, content: Any, place: str, depth: int = 0) -> Driver:
        if not isinstance(content, list | tuple) or not content or depth >= DEEPEST_DRIVER:
            raise InputError(self.source, place, content, "a driver is its kind and its arguments")
        kind, *arguments = content
        if not isinstance(kind, str) or kind not in drivers.KINDS:
            cure = nearest(str(kind), drivers.KINDS)
            raise InputError(self.source, place, kind, "no driver of that kind", cure)
        if kind in ("rod", "rocker") and self.arm.description.parallelogram is None:
            raise InputError(self.source, place, kind, "this arm has no `parallelogram`")
        if kind in ("rod share", "rocker share") and not is_parallelogram(self.arm):
            raise InputError(self.source, place, kind, "no two motors of this arm turn its elbow against each other")
        names = self._names(kind, len(arguments), place)
        taken = (self._argument(kind, name, each, place, depth) for name, each in zip(names, arguments, strict=True))
        return Driver(kind, tuple(taken))

    def _names(self, kind: str, count: int, place: str) -> list[str]:
        """What the arguments of a driver are called, by the function that evaluates it."""
        parameters = list(inspect.signature(drivers.KINDS[kind].values).parameters.values())[1:]
        names = [each.name for each in parameters if each.kind is not inspect.Parameter.VAR_POSITIONAL]
        required = sum(each.default is inspect.Parameter.empty for each in parameters if each.name in names)
        counts = {len(names), required}
        if len(names) < len(parameters):
            last = parameters[-1].name
            if last in (*RUNS, "links") and count >= required:
                return [*names, *[last] * (count - len(names))]
            # as many more as it may be: the ends of a range, or weights of mass moments
            more = 2 if last == "ends" else 4 * self.arm.n_joints
            counts = {required, required + 2} if more == 2 else {required + more}
            names += [last] * more
        if count not in counts:
            rule = (
                f"{kind!r} takes {' or '.join(map(str, sorted(counts)))} arguments: {', '.join(dict.fromkeys(names))}"
            )
            raise InputError(self.source, place, f"{count} arguments", rule)
        return names[:count]

    def _argument(self, kind: str, name: str, value: Any, place: str, depth: int) -> object:
        """An argument of a driver by what it is called."""
        if name in _drivers_among(kind):
            return self._driver(value, place, depth + 1)
        if name in ("run", "target", *RUNS):
            if isinstance(value, str):
                return value
            raise InputError(self.source, place, value, f"a {'run' if name in RUNS else name} is a name")
        if name == "location":
            self._frame(value, ("base", "joint"), place)
            return value
        if name in ("j", "link", "links", "axis", "row", "column"):
            motors = self.arm.n_joints if kind.startswith("chain") else self.arm.n_motors
            most = {
                "j": motors,
                **dict.fromkeys(("link", "links"), self.arm.n_joints),
                "axis": 5 if kind == "bend" else 2,
            }
            most |= dict.fromkeys(("row", "column"), 5 if kind == "attitude twice" else 3)
            least = 0 if name == "axis" else 1
            if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most[name]:
                raise InputError(self.source, place, value, f"{name} is a whole number from {least} to {most[name]}")
            return value
        number = self._finite(value, place)
        if name in ("width", "knee") and number <= 0:
            raise InputError(self.source, place, value, f"a {name} is positive")
        return value

    def _finite(self, value: Any, place: str) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise InputError(self.source, place, value, "this must be a finite number")
        if abs(value) > LARGEST_ARGUMENT:
            raise InputError(self.source, place, value, f"no number here is beyond {LARGEST_ARGUMENT:g}")
        return float(value)


def _drivers_among(kind: str) -> set[str]:
    """Which arguments of a driver are drivers themselves, by the function that evaluates it."""
    parameters = inspect.signature(drivers.KINDS[kind].values).parameters.values()
    return {each.name for each in parameters if each.annotation in (Driver, Driver.__name__)}
