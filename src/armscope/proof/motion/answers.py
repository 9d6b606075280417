"""What the diagnosis answered about a moving world: verdict.json and the predicted torques of the test path."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from armscope.core.files import read_table
from armscope.motion.verdict import MotionVerdict, read_motion_verdict
from armscope.proof.answers import FAILURE, NamedEffect, Numbers, numbers_of
from armscope.proof.definitions import Name
from armscope.verdict.effects import UNKNOWN

VERDICT, PREDICTED = "verdict.json", "test_predicted.csv"
NOT_PREDICTED = "not_predicted.txt"
"""Why there is a verdict but no prediction: names count then, the held-out error is infinite."""
KEPT = (VERDICT, "model.yaml", PREDICTED)


@dataclass(frozen=True, eq=False)
class MotionAnswer:
    """A verdict on a motion; ``failed`` holds the reason where there is none."""

    world: str
    claims: tuple[NamedEffect, ...] = ()  # its causes, one per name, and what it calls unknown
    # mismatch, answer: as in verdict.json
    mismatch: bool | None = None
    answer: str = "failed"
    # ordinary friction and rotors by joint: (value, standard error, unit) by name
    background: tuple[tuple[str, Numbers], ...] = ()
    # of links' encoders beside their motors': (value, standard error, unit) by joint
    zeros: Numbers = field(default_factory=dict)
    predicted: pd.DataFrame | None = None  # torques of the test path; None: there are none, ``not_predicted`` says why
    failed: str = ""
    not_predicted: str = ""


def read_answer(folder: Path) -> MotionAnswer:
    """The answer in a world's folder of the diagnosing job."""
    if (folder / FAILURE).is_file():
        return MotionAnswer(folder.name, failed=(folder / FAILURE).read_text(encoding="utf-8").strip())
    why = folder / NOT_PREDICTED
    verdict = read_motion_verdict(folder / VERDICT)
    return MotionAnswer(
        world=folder.name,
        claims=claims_of(verdict),
        mismatch=verdict.mismatch,
        answer=verdict.answer,
        background=tuple((joint.joint, numbers_of(joint.parameters)) for joint in verdict.background),
        zeros={each.joint: (each.offset.value, each.offset.stderr, each.offset.unit) for each in verdict.links},
        predicted=None if why.is_file() else read_table(folder / PREDICTED),
        not_predicted=why.read_text(encoding="utf-8").strip() if why.is_file() else "",
    )


def claims_of(verdict: MotionVerdict) -> tuple[NamedEffect, ...]:
    """One per name, of torques and links, minor only if all of that name are; structure without a cause: `unknown`."""
    by_name: dict[Name, NamedEffect] = {}
    causes = (*verdict.effects, *(cause for link in verdict.links for cause in link.causes))
    for cause in sorted(causes, key=lambda cause: cause.minor):
        by_name.setdefault((cause.effect, cause.location), NamedEffect.of(cause))
    left = verdict.unexplained
    if left.present and left.location:
        unknown = NamedEffect(
            UNKNOWN, left.location, left.driver or "", False, "effect", float("nan"), float("nan"), {}, ()
        )
        by_name.setdefault(unknown.name, unknown)
    return tuple(by_name.values())
