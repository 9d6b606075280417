"""Truths and answers of moving worlds, written by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.motion.verdict import FoundCause, LinkSide, UnexplainedTorque, read_motion_verdict
from armscope.proof.motion.answers import MotionAnswer, claims_of
from armscope.proof.motion.scoring import MotionWorld
from armscope.proof.motion.truth import MotionTruth, _effect
from armscope.verdict.effects import Alternative, Parameter

WRITTEN = Path(__file__).parents[2] / "fuzz" / "corpus" / "motion-verdict" / "moving-arm.json"

LEFT = np.array([0.5, 0.1])
ROWS = 400
TORQUE = np.random.default_rng(0).normal(size=(ROWS, 2)) * [20, 5]
MOVES = (np.arange(ROWS) >= ROWS // 10).astype(int)
"""Whether joint 1 moves; joint 2 always does."""
NOISE = np.random.default_rng(1).normal(size=(ROWS, 2)) * LEFT


def effect(name="torque_offset", location="joint 2", alternatives=(), shape="", **numbers):
    return {
        "effect": name, "location": location, "driver": "constant", "shape": shape, "strength": 5.0,
        "parameters": [{"name": key, "unit": "N m", "value": value} for key, value in numbers.items()],
        "alternatives": [{"effect": e, "location": place} for e, place in alternatives],
    }  # fmt: skip


def said(name="torque_offset", location="joint 2", alternatives=(), **numbers):
    return FoundCause(
        effect=name, location=location, family="drive", driver="constant", title=name, minor=False,
        parameters=tuple(Parameter(k, "N m", v, s) for k, (v, s) in numbers.items()), rms=1.0, unit="N m",
        joint="joint 2", share=0.5, evidence_nats=40.0,
        alternatives=tuple(Alternative(e, place, "drive", 1.0, "constant", 1.0) for e, place in alternatives),
    )  # fmt: skip


def verdict_of(causes, unknown_at=None, **changes):
    """A verdict that some program wrote, with these causes."""
    left = UnexplainedTorque(unknown_at is not None, unknown_at)
    return replace(read_motion_verdict(WRITTEN), effects=tuple(causes), unexplained=left, **changes)


def link_side(causes):
    """A link that lies beside its motor for these causes."""
    return LinkSide("joint 1", Parameter("offset", "rad", 0.0, 1e-5), 1e-3, 1e-4, "rad", tuple(causes))


def table(torque):
    return pd.DataFrame({f"tau{j + 1}_nm": torque[:, j] for j in range(2)})


def world(effects=(), answers=(), category="single", unknown_at=None, off=0.0, **changes):
    truth = MotionTruth(
        world=changes.get("name", "motion-000"), category=category, arm="two-axis", fresh=changes.get("fresh", False),
        rows=1000, stated=changes.get("stated", False), outside=any(each["effect"] == "unknown" for each in effects),
        effects=tuple(_effect(each) for each in effects),
        rough=tuple(replace(_effect(each), minor=True) for each in changes.get("rough", ())),
        also_allowed=tuple(changes.get("also_allowed", ())),
        background={f"joint {j}": {"coulomb": 5.0, "viscous": 4.0, "inertia": 1.0} for j in (1, 2)},
        zeros=np.array(changes.get("zeros", ())),
        left_nm=LEFT, left_moving_nm=LEFT, test=table(TORQUE + NOISE).assign(moves1=MOVES, moves2=1),
    )  # fmt: skip
    if changes.get("failed"):
        return MotionWorld(truth, MotionAnswer(truth.world, failed="InputError: no"))
    answer = MotionAnswer(
        truth.world, claims=claims_of(verdict_of(answers, unknown_at)), mismatch=bool(answers), answer="explained",
        background=changes.get("background", ()), zeros=changes.get("told_zeros", {}),
        predicted=table(TORQUE + off * LEFT),
    )  # fmt: skip
    return MotionWorld(truth, answer)
