"""Truths and answers of moving worlds, written by hand."""

import numpy as np
import pandas as pd

from armscope.proof.motion.answers import MotionAnswer, _claims
from armscope.proof.motion.scoring import MotionWorld
from armscope.proof.motion.truth import MotionTruth, _effect

LEFT = np.array([0.5, 0.1])
ROWS = 400
TORQUE = np.random.default_rng(0).normal(size=(ROWS, 2)) * [20, 5]
NOISE = np.random.default_rng(1).normal(size=(ROWS, 2)) * LEFT


def effect(name="torque_offset", location="joint 2", alternatives=(), shape="", **numbers):
    return {
        "effect": name, "location": location, "driver": "constant", "shape": shape, "strength": 5.0,
        "parameters": [{"name": key, "unit": "N m", "value": value} for key, value in numbers.items()],
        "alternatives": [{"effect": e, "location": place} for e, place in alternatives],
    }  # fmt: skip


def said(name="torque_offset", location="joint 2", alternatives=(), **numbers):
    return {
        "effect": name, "location": location, "minor": False, "evidence_nats": 40.0, "driver": "constant",
        "parameters": [{"name": k, "unit": "N m", "value": v, "stderr": s} for k, (v, s) in numbers.items()],
        "alternatives": [{"effect": e, "location": place} for e, place in alternatives],
    }  # fmt: skip


def table(torque):
    return pd.DataFrame({f"tau{j + 1}_nm": torque[:, j] for j in range(2)})


def world(effects=(), answers=(), category="single", unknown_at=None, off=0.0, **changes):
    truth = MotionTruth(
        world=changes.get("name", "motion-000"), category=category, arm="two-axis", fresh=changes.get("fresh", False),
        rows=1000, stated=changes.get("stated", False), outside=any(each["effect"] == "unknown" for each in effects),
        effects=tuple(_effect(each) for each in effects),
        background={f"joint {j}": {"coulomb": 5.0, "viscous": 4.0, "inertia": 1.0} for j in (1, 2)},
        left_nm=LEFT, test=table(TORQUE + NOISE),
    )  # fmt: skip
    if changes.get("failed"):
        return MotionWorld(truth, MotionAnswer(truth.world, failed="InputError: no"))
    verdict = {"effects": list(answers), "unexplained": {"present": unknown_at is not None, "location": unknown_at}}
    answer = MotionAnswer(
        truth.world, claims=tuple(_claims(verdict)), mismatch=bool(answers), answer="explained",
        background=changes.get("background", ()), predicted=table(TORQUE + off * LEFT),
    )  # fmt: skip
    return MotionWorld(truth, answer)
