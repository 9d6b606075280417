"""What a model file of a motion may ask of an arm: causes, links and laws that there are, numbers that they take."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.motion.library.catalogue import CAUSES
from armscope.motion.library.causes import Moment, PlacedCause
from armscope.motion.library.laws import LAWS, Law
from armscope.motion.library.twist_catalogue import TWISTS
from armscope.motion.model.constants import MODEL_FILE
from armscope.motion.model.file_contents import CauseFile, LawFile
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.samples.preparation import Signals
from armscope.robot.bodies import Bodies
from armscope.robot.dynamics import PARAMETERS, MovingArm


class CauseReader:
    """Causes of a model file as causes of an arm.

    Args:
        arm: the arm.
        source: the file, for messages.
    """

    def __init__(self, arm: MovingArm, source: object) -> None:
        self.arm, self.source = arm, source
        self._known = {cause.name: cause for cause in (*CAUSES, *TWISTS)}

    def causes(self, contents: Sequence[CauseFile], key: str = "causes") -> tuple[FittedCause, ...]:
        """Causes as the file lists them.

        Args:
            contents: of the file.
            key: where they stand in it.

        Returns:
            The causes.

        Raises:
            InputError: a cause, a link or a law that this arm can't have; its place is named.
        """
        return tuple(self._cause(content, f"{key}[{number}]") for number, content in enumerate(contents))

    def _cause(self, file: CauseFile, place: str) -> FittedCause:
        if file.effect not in self._known:
            cure = nearest(file.effect, self._known)
            raise InputError(self.source, f"{place}.effect", file.effect, "no cause of that name", cure)
        law = None if file.law is None else self._law(file.law, len(file.parameters), f"{place}.law")
        placed = PlacedCause(
            self._known[file.effect],
            file.location,
            file.driver,
            tuple((each.name, each.unit) for each in file.parameters),
            law.joints if law else tuple(range(self.arm.n_motors)),
            law,
            inertial=self._inertial(file, place) if file.inertial else None,
            runs=file.runs,
            variant=file.variant,
            is_curve=bool(law and law.kind.startswith("curve")),
            scanned=tuple((each.name, each.unit, each.value) for each in file.scanned),
        )
        errors = [np.nan if each.stderr is None else each.stderr for each in file.parameters]
        return FittedCause(placed, np.array([each.value for each in file.parameters]), np.diag(np.square(errors)))

    def _inertial(self, file: CauseFile, place: str) -> Array:
        inertial = np.zeros((len(self.arm.inertial), len(file.parameters)))
        for number, entry in enumerate(file.inertial):
            if entry.link > self.arm.n_links or entry.parameter > len(file.parameters):
                rule = f"the arm has {self.arm.n_links} links, the cause {len(file.parameters)} parameters"
                found = f"link {entry.link}, parameter {entry.parameter}"
                raise InputError(self.source, f"{place}.inertial[{number}]", found, rule)
            row = len(PARAMETERS) * (entry.link - 1) + PARAMETERS.index(entry.what)
            inertial[row, entry.parameter - 1] = entry.per_unit
        return inertial

    def _law(self, file: LawFile, width: int, place: str) -> Law:
        if file.kind not in LAWS:
            raise InputError(self.source, f"{place}.kind", file.kind, "no law of that name", nearest(file.kind, LAWS))
        if not file.joints or max(file.joints) > self.arm.n_motors or len(set(file.joints)) < len(file.joints):
            rule = f"its joints are among the {self.arm.n_motors} of the arm, each once"
            raise InputError(self.source, f"{place}.joints", list(file.joints), rule)
        numbers = file.numbers
        if file.kind.startswith("curve") and not (
            len(numbers) == 3 and numbers[0] < numbers[1] and numbers[2] == width >= MODEL_FILE.least_knots
        ):
            rule = f"a curve takes its limits and its number of parameters, {MODEL_FILE.least_knots} or more"
            raise InputError(self.source, f"{place}.numbers", list(numbers), rule)
        law = Law(file.kind, tuple(j - 1 for j in file.joints), numbers)
        columns = self._tried(law, place)
        if columns.shape[1:] != (len(law.joints), width):
            rule = f"{law.kind!r} has {columns.shape[2]} parameters at {columns.shape[1]} joints"
            raise InputError(self.source, place, f"{width} parameters at {len(law.joints)} joints", rule)
        return law

    def _tried(self, law: Law, place: str) -> Array:
        """Its columns at a few samples: numbers that it can't take are refused here and not in a prediction."""
        few = np.linspace(-1, 1, 8)[:, None] * np.ones(self.arm.n_motors)
        signals = Signals("", 0, few[:, 0], few, few, few, few, None, few, np.arange(8))
        try:
            with np.errstate(divide="raise", invalid="raise", over="ignore"):
                bodies = Bodies(self.arm, self.arm.inertial, None)
                return law(Moment(signals, few, few, 1.0, bodies))
        except (TypeError, ValueError, ArithmeticError, IndexError) as error:
            found = f"joints {[j + 1 for j in law.joints]}, numbers {list(law.numbers)}"
            raise InputError(self.source, place, found, f"{law.kind!r} takes others ({error})") from error
