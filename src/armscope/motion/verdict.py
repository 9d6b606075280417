"""What the diagnosis of a motion says: plain data, and verdict.json.

Names, answers, parameters and alternatives are those of the verdict on positions (`armscope.verdict.schema`); numbers
are torque, N m (N of a sliding joint), and errors relative to the torque.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from armscope.core.files import read_json, write_json
from armscope.core.types import Array, Number
from armscope.verdict.effects import UNKNOWN, Alternative, Parameter
from armscope.verdict.schema import Answer, Notice

Format = Literal["armscope motion verdict 1"]
FORMAT: Format = "armscope motion verdict 1"


@dataclass(frozen=True, eq=False)
class FoundCause:
    """A cause that the evidence asks for.

    Attributes:
        effect: its name; "unknown" where no known law explains it.
        location: where it is.
        family: what kind of physics it is.
        driver: what it follows.
        title: the name in words.
        minor: worth little of the mismatch.
        parameters: with standard errors. Those of masses come on top of what is stated, in the frame of the joint that
            carries the link, as in corrected.urdf (of standard D-H rows: before d, a and alpha): mx, my and mz are mass
            times the place of the centre of mass, kg m; not com_mm of robot.yaml, which lies in the row's frame.
        rms: of its torque at the joint where it is largest.
        unit: of that: N m, or N of a sliding joint.
        joint: at which it is largest.
        share: of the squared torque that friction and rotors leave: how much goes when this is cured as it was found,
            averaged over the orders in which all can be cured; below zero it hides part of what others do.
        evidence_nats: what is lost by leaving it out.
        alternatives: what could stand in its place, nearest first.
        carries_over: what other paths say of it; empty where that was not tested.
        consistent: whether they agree on it; None where that was not tested.
        physics: what happens, in one sentence.
        confirm: how to confirm it on the arm.
        cure: how to take it out.
        doubt: why it is to be taken with care; empty where nothing speaks against it.
    """

    effect: str
    location: str
    family: str
    driver: str
    title: str
    minor: bool
    parameters: tuple[Parameter, ...]
    rms: Number
    unit: str
    joint: str
    share: Number
    evidence_nats: Number
    alternatives: tuple[Alternative, ...] = ()
    carries_over: str = ""
    consistent: bool | None = None
    physics: str = ""
    confirm: str = ""
    cure: str = ""
    doubt: str = ""

    @property
    def nameless(self) -> bool:
        """Whether no known law explains it: it is known by what it follows alone."""
        return self.family == UNKNOWN


@dataclass(frozen=True, eq=False)
class LinkSide:
    """A joint whose link was recorded beside its motor: how they lie, and why.

    Attributes:
        joint: its name.
        offset: of the link's zero from the motor's.
        rms: of link less motor, beyond that.
        left: of what the causes leave of it on motion that took no part.
        unit: of both: rad, or m of a sliding joint.
        causes: why, largest share first; their shares are of the link's place beside its motor, beyond the zero.
    """

    joint: str
    offset: Parameter
    rms: Number
    left: Number
    unit: str
    causes: tuple[FoundCause, ...]


@dataclass(frozen=True)
class JointBackground:
    """What every joint has: friction and rotor inertia, as fitted where robot.yaml doesn't state them.

    Attributes:
        joint: its name.
        parameters: coulomb, viscous, inertia, and an offset where the evidence asks for one, with standard errors; of a
            joint that stands still none.
        noise: what the model leaves, RMS while it moves.
        unit: of that: N m, or N of a sliding joint.
        independent_rows: of how many independent rows its torque tells.
    """

    joint: str
    parameters: tuple[Parameter, ...]
    noise: Number
    unit: str
    independent_rows: int


@dataclass(frozen=True)
class Step:
    """The error with one cause more: RMS residual over RMS torque.

    Attributes:
        label: what is in the model from this step on.
        fitted: on the fitted rows.
        held_out: on held-out rows.
    """

    label: str
    fitted: Number
    held_out: Number


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

    stated: Number
    background: Number
    model: Number
    by_joint: tuple[Number, ...]
    what: str
    by_run: dict[str, Number] = field(default_factory=dict)


@dataclass(frozen=True)
class UnexplainedTorque:
    """Structure for which the library has no cause: a free curve, or what lasts and repeats beyond all of them.

    Attributes:
        present: whether there is any.
        location: where.
        driver: what it follows.
        description: in words.
    """

    present: bool
    location: str | None = None
    driver: str | None = None
    description: str = ""


@dataclass(frozen=True, eq=False, kw_only=True)
class MotionVerdict:
    """What verdict.json of a motion holds.

    Attributes:
        format: the file's kind and version.
        answer: in two words.
        headline: the answer in one sentence.
        mismatch: whether the model misses something; None where the motion cannot tell.
        effects: the causes, largest share first; those with `minor` true are apart from the story.
        unexplained: what no cause of the library explains.
        background: friction and rotor of every joint.
        masses_share: of a link's mass, mass x length, mass x length^2, within which masses that have no name are held
            near the stated ones; 0 where they are as stated.
        held_out: errors on motion that took no part.
        fitted: errors on the fitted rows.
        waterfall: how the error falls as causes come in, one by one.
        identifiable: how many inertial parameters there are, how many combinations of them the motion tells, and the
            condition number of these.
        preparation: what was done to the samples, in words.
        notices: what the verdict must not hide.
        rows: of torque and model that were fitted.
        samples: that were recorded.
        runs: which runs they are of.
        settings: what was asked for.
        links: joints whose links were recorded beside their motors.
    """

    format: Format = FORMAT
    answer: Answer
    headline: str
    mismatch: bool | None
    effects: tuple[FoundCause, ...]
    unexplained: UnexplainedTorque
    background: tuple[JointBackground, ...]
    masses_share: Number
    held_out: HeldOutMotion
    fitted: Step
    waterfall: tuple[Step, ...]
    identifiable: dict[str, Number]
    preparation: str
    notices: tuple[Notice, ...]
    rows: int
    samples: int
    runs: tuple[str, ...]
    settings: dict[str, Any] = field(default_factory=dict)
    links: tuple[LinkSide, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """The content of verdict.json."""
        from armscope.motion.contract import to_json

        return to_json(self)

    @staticmethod
    def from_json(content: Any, source: object = "verdict.json") -> MotionVerdict:
        """A verdict from the content of verdict.json: all that `to_json` writes.

        Args:
            content: as JSON gives it.
            source: the file, for an error.

        Raises:
            InputError: it is none, or of another version.
        """
        from armscope.motion.contract import from_json

        return from_json(content, source)


def read_motion_verdict(path: Path | str) -> MotionVerdict:
    """The verdict of a verdict.json of a motion.

    Raises:
        InputError: it is none, or of another version.
    """
    return MotionVerdict.from_json(read_json(path, "verdict.json of a diagnosis of a motion"), path)


def write_motion_verdict(verdict: MotionVerdict, folder: Path | str) -> None:
    """Write verdict.json into a folder."""
    write_json(Path(folder) / "verdict.json", verdict.to_json())


def relative(residuals: Array, torque: Array) -> float:
    """||residuals|| / ||torque||, over all joints together."""
    return float(np.linalg.norm(residuals) / max(float(np.linalg.norm(torque)), 1e-300))
