"""Truths and answers as plain data, for scoring without simulating or diagnosing anything."""

from __future__ import annotations

import pandas as pd

from armscope.proof.answers import Answer, NamedEffect
from armscope.proof.scoring import World
from armscope.proof.truth import Concealed, Truth

READINGS = pd.DataFrame({"x_mm": [0.0, 1.0], "y_mm": [2.0, 3.0], "z_mm": [4.0, 5.0]})


def concealed(
    effect, location, alternatives=(), strength=5.0, minor=False, parameters=None, comparable=True, driver=None
):
    return Concealed(
        effect=effect,
        location=location,
        driver=driver or "joint angle",
        minor=minor,
        strength=strength,
        parameters=parameters or {},
        comparable=comparable,
        noncentrality=float("nan") if minor else 100.0 * strength**2,
        columns=0 if minor else 1,
        frame_numbers=0 if minor else 9,
        alternatives=tuple(alternatives),
        shape="local_bump" if effect == "unknown" else "",
    )


def claim(effect, location, minor=False, alternatives=(), parameters=None, rms=0.1):
    return NamedEffect(
        effect=effect,
        location=location,
        driver="angle of joint 2",
        minor=minor,
        named_as="effect",
        rms_mm=rms,
        evidence_nats=50.0,
        parameters=parameters or {},
        alternatives=tuple(alternatives),
    )


def world(
    effects=(), claims=(), category="single", answer="explained", failed="", fresh=True, name="world-000", off=0.0
):
    truth = Truth(
        world=name,
        category=category,
        arm="six-axis",
        fresh=fresh,
        rows=100,
        sigma_mm=0.02,
        noise_rms_mm=0.02,
        noise="gaussian",
        masses="right",
        left_out=(),
        outside=any(effect.effect == "unknown" for effect in effects),
        true_rms_mm=0.5,
        effects=tuple(effects),
        test=READINGS,
    )
    given = Answer(
        world=name,
        claims=tuple(claims),
        mismatch=bool(claims),
        answer="failed" if failed else answer,
        noise_mm=0.02,
        predicted=None if failed else READINGS + off,
        failed=failed,
    )
    return World(truth, given, None, 2, 1.0)
