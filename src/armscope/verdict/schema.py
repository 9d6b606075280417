"""What a diagnosis says: plain data.

A `Verdict` is what verdict.json holds, both ways (`armscope.verdict.contract` has the file's names); what only lives in
memory is beside it in a `Diagnosis` (`armscope.verdict.diagnosis`). Units stand in the names (mm, rad, nats).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from armscope.core.types import Number
from armscope.verdict.effects import Cause, FoundEffect

Answer = Literal["nothing missing", "explained", "partly explained", "cannot tell"]
ANOTHER_MODEL = "another model"  # The kind of a notice that an arm of the library fits clearly better
TOOL_AS_STATED = "tool as stated"
"""The kind of a notice that a tool point is as stated, since poses do not tell it from the base."""
TOOL_EXCHANGED = "tool exchanged"  # The kind of a notice that the tool lies elsewhere from run to run
ROWS_LEFT_OUT = "rows left out"  # The kind of a notice that many rows fit none of what was found
NOISE_EXCEEDED = "noise exceeded"
"""The kind of a notice that what remains is above the stated noise and follows nothing: that may be too small."""
NO_BAD_SHOTS = "rows that are no bad shots"
"""The same where they are too many to be bad shots: what is promised is then promised with them."""

MISLABELLED = "targets"  # The kind of a notice that rows fit another target than the one whose name they carry


@dataclass(frozen=True)
class Unexplained:
    """Structure beyond the noise for which no effect was found.

    Attributes:
        present: whether there is any.
        location: where; None where it has no place.
        driver: what it follows; None where it follows nothing in the table.
        rms_mm: per axis, at the tool.
        description: in words.
    """

    present: bool
    location: str | None = None
    driver: str | None = None
    rms_mm: Number = 0.0
    description: str = ""


@dataclass(frozen=True)
class Background:
    """Small errors of one family that were allowed for everywhere in the arm and are not named one by one.

    A verdict has one for all families together and one per family.

    Attributes:
        family: what kind of physics they are; "all" for all together.
        present: whether the evidence asks for them.
        size: share of the tolerance (1 mm, 1 mrad) for the geometric family, mm at the tool for the others; NaN for all
            together.
        rms_at_tool_mm: per axis, beyond what the free frames absorb.
        share: of the residual variance after the free frames that goes when they are cured as found, averaged over the
            orders in which all can be cured.
        worst: the joint or link whose part moves the tool clearly more than any other's; "" where none does.
    """

    family: str
    present: bool
    size: Number
    rms_at_tool_mm: Number
    share: Number
    worst: str = ""


@dataclass(frozen=True)
class WaterfallStep:
    """RMS per axis with one effect more than in the step before.

    Attributes:
        label: what is in the model from this step on.
        fitted_mm: on the fitted rows.
        held_out_mm: on held-out rows.
        spread_mm: standard deviation of the held-out RMS from fold to fold; NaN with a single fold.
        minor: the effect is apart from the story.
    """

    label: str
    fitted_mm: Number
    held_out_mm: Number
    spread_mm: Number = float("nan")
    minor: bool = False


@dataclass(frozen=True)
class HeldOut:
    """Cross-validation of the whole procedure; RMS per axis on rows that took no part, mm. NaN: it was not possible.

    Attributes:
        before: with the frames only, without the rows that look like bad shots.
        after: with the model, without those rows.
        folds: into how many parts the rows were divided.
        grouped_by: what was held out together.
        before_all_rows: with the frames only, on all rows.
        after_all_rows: with the model, on all rows.
        spread: standard deviation of ``after`` from fold to fold.
        turn_before: of orientations, mrad, with the frames only.
        turn_after: of orientations, mrad, with the model.
    """

    before: float
    after: float
    folds: int = 0
    grouped_by: str = ""
    before_all_rows: float = float("nan")
    after_all_rows: float = float("nan")
    spread: float = float("nan")
    turn_before: float = float("nan")
    turn_after: float = float("nan")


@dataclass(frozen=True)
class Orientations:
    """What the measured orientations say; RMS per axis, mrad.

    Attributes:
        rows: that hold one.
        noise_mrad: what the fitted model leaves of them.
        lever_mm: by which a turn counts beside a shift of the point: the ratio of their noises.
        before_mrad: after the free frames alone.
        instrument_mrad: what they err by, smoothly with the tool's attitude: as they were read, not as the arm stood.
    """

    rows: int
    noise_mrad: float
    lever_mm: float
    before_mrad: float
    instrument_mrad: float = 0.0


@dataclass(frozen=True)
class SuspectRow:
    """A row that looks like a bad shot: it was weighted down, not dropped.

    Attributes:
        id: as the table has it.
        run: in which it was recorded.
        residual_mm: what the model leaves of it, length.
        weight: with which it counted, 0 ... 1.
        reads_as: the other target of the table that its point fits within the noise; "" for none.
    """

    id: str
    run: str
    residual_mm: Number
    weight: Number
    reads_as: str = ""


@dataclass(frozen=True)
class Notice:
    """A plain statement that limits the verdict.

    Attributes:
        kind: what it is about.
        text: in a sentence or two.
    """

    kind: str
    text: str


@dataclass(frozen=True, eq=False)
class Verdict:
    """What verdict.json holds.

    Attributes:
        answer: in two words.
        headline: the answer in one sentence.
        mismatch: whether the model misses something; None where the recordings cannot tell.
        noise_mm: of the measurements, per axis, 1 sigma.
        noise_source: where that number comes from.
        residual_before_mm, residual_after_mm: RMS per axis on the fitted rows, frames only and with the model.
        causes: what is wrong, in a few causes, largest share first.
        effects: in order of ``share``, the measure of importance; those with ``minor`` true are apart from the story.
        background: small errors everywhere, of all families together.
        background_families: the same family by family.
        unexplained: what no effect of the library explains.
        held_out: errors on rows that took no part.
        waterfall: how the error falls as effects come in, one by one.
        suspects: rows that look like bad shots.
        notices: what the verdict must not hide.
        rows: how many were used.
        runs: which runs they are of.
        orientations: what measured orientations say; None where none were measured.
        settings: what was asked for.
    """

    answer: Answer
    headline: str
    mismatch: bool | None
    noise_mm: float
    noise_source: str
    residual_before_mm: float
    residual_after_mm: float
    effects: tuple[FoundEffect, ...]
    background: Background
    background_families: tuple[Background, ...]
    unexplained: Unexplained
    held_out: HeldOut
    waterfall: tuple[WaterfallStep, ...]
    suspects: tuple[SuspectRow, ...]
    notices: tuple[Notice, ...]
    rows: int
    runs: tuple[str, ...]
    orientations: Orientations | None = None
    causes: tuple[Cause, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """The content of verdict.json: the contract's names, and further ones."""
        from armscope.verdict.contract import to_json

        return to_json(self)

    @staticmethod
    def from_json(content: Any, source: object = "verdict.json") -> Verdict:
        """A verdict from the content of verdict.json: all that `to_json` writes, no curves, no sentences of effects.

        Args:
            content: as JSON gives it.
            source: the file, for an error.

        Raises:
            InputError: it is none, or of another version.
        """
        from armscope.verdict.contract import from_json

        return from_json(content, source)
