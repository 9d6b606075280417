"""What the diagnosis of a motion says: plain data, and verdict.json.

Names, answers, parameters and alternatives are those of the verdict on positions (`armscope.verdict.schema`); numbers
are torque, N m (N of a sliding joint), and errors relative to the torque.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from armscope.core.files import read_json, write_json
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.verdict.effects import UNKNOWN, Alternative, Parameter
from armscope.verdict.schema import Answer, Notice

FORMAT = "armscope motion verdict 1"


@dataclass(frozen=True, eq=False)
class FoundCause:
    """A cause that the evidence asks for.

    Attributes:
        effect, location, family, driver: what and where, and what it follows.
        title: the name in words.
        minor: worth little of the mismatch.
        parameters: with standard errors.
        rms: of its torque at the joint where it is largest, `unit` (N m or N) at `joint`.
        share: of what friction and rotors leave, averaged over the orders in which causes come in.
        evidence_nats: what is lost by leaving it out.
        alternatives: what could stand in its place, nearest first.
        carries_over: what other paths say of it; `consistent`: whether they agree on it (None: not tested).
        physics, confirm, cure: one sentence each.
        curve: for a free curve and friction laws: driver's values, torque and its standard error.
    """

    effect: str
    location: str
    family: str
    driver: str
    title: str
    minor: bool
    parameters: tuple[Parameter, ...]
    rms: float
    unit: str
    joint: str
    share: float
    evidence_nats: float
    alternatives: tuple[Alternative, ...] = ()
    carries_over: str = ""
    consistent: bool | None = None
    physics: str = ""
    confirm: str = ""
    cure: str = ""

    @property
    def nameless(self) -> bool:
        """Whether no known law explains it: it is known by what it follows alone."""
        return self.family == UNKNOWN


@dataclass(frozen=True)
class JointBackground:
    """What every joint has: friction and rotor inertia, as fitted where robot.yaml doesn't state them.

    Attributes:
        joint: its name.
        parameters: coulomb, viscous, inertia, and an offset where the evidence asks for one, with standard errors; of a
            joint that stands still none.
        noise: what the model leaves, RMS while it moves; `unit`: N m or N.
        independent_rows: of how many independent rows its torque tells.
    """

    joint: str
    parameters: tuple[Parameter, ...]
    noise: float
    unit: str
    independent_rows: int


@dataclass(frozen=True)
class Step:
    """The error with one cause more: RMS residual over RMS torque, on fitted rows and on held-out rows."""

    label: str
    fitted: float
    held_out: float


@dataclass(frozen=True)
class HeldOutMotion:
    """Errors on motion that took no part, relative to its torque (0.05 is 5 %), and RMS by joint with the model.

    Of joints while they move: a standing one's friction may be anything within its band, and no model says what.

    Attributes:
        stated: of the arm as stated, nothing fitted.
        background: with friction and rotor inertia of every joint fitted.
        model: with masses held near the stated ones, and the causes.
        by_joint: RMS of what the model leaves, N m or N.
        what: which motion was held out.
        by_run: the model's error on each run that was held out, those too that the others leave out.
    """

    stated: float
    background: float
    model: float
    by_joint: tuple[float, ...]
    what: str
    by_run: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class UnexplainedTorque:
    """Structure for which the library has no cause: where, and what it follows."""

    present: bool
    location: str | None = None
    driver: str | None = None
    description: str = ""


@dataclass(frozen=True, eq=False)
class MotionVerdict:
    """What verdict.json of a motion holds."""

    answer: Answer
    headline: str
    mismatch: bool | None
    effects: tuple[FoundCause, ...]
    unexplained: UnexplainedTorque
    background: tuple[JointBackground, ...]
    masses_share: float
    held_out: HeldOutMotion
    fitted: Step
    waterfall: tuple[Step, ...]
    identifiable: dict[str, float]
    preparation: str
    notices: tuple[Notice, ...]
    rows: int
    samples: int
    runs: tuple[str, ...]
    seconds: float = 0.0
    settings: dict[str, Any] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """The content of verdict.json."""
        content = asdict(self)
        for effect, told in zip(content["effects"], self.effects, strict=True):
            effect["parameters"] = [_with_interval(each) for each in told.parameters]
        for joint, of in zip(content["background"], self.background, strict=True):
            joint["parameters"] = [_with_interval(each) for each in of.parameters]
        return {"format": FORMAT, **content}


def _with_interval(parameter: Parameter) -> dict[str, Any]:
    return {**asdict(parameter), "interval_95": list(parameter.interval)}


def read_motion_verdict(path: Path | str) -> dict[str, Any]:
    """The content of verdict.json of a motion.

    Raises:
        InputError: it is none, or of another version.
    """
    content = read_json(path, "verdict.json of a diagnosis of a motion")
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        found = content.get("format", "no key format") if isinstance(content, dict) else "no mapping"
        raise InputError(path, "format", found, f'a verdict on a motion says "format": "{FORMAT}"')
    return content


def write_motion_verdict(verdict: MotionVerdict, folder: Path | str) -> None:
    """Write verdict.json into a folder."""
    write_json(Path(folder) / "verdict.json", verdict.to_json())


def relative(residuals: Array, torque: Array) -> float:
    """||residuals|| / ||torque||, over all joints together."""
    return float(np.linalg.norm(residuals) / max(float(np.linalg.norm(torque)), 1e-300))
