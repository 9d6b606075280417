"""Errors of loads follow the model around which they are linearised, and keep the shares that were fitted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from armscope.diagnosis.errors_of_loads import on_loads
from armscope.fitting.registration import fit_frames
from armscope.physics.effect import Part
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.loads import STATED_MASSES, mass_errors
from armscope.recordings import read_recordings
from armscope.robot import load_arm

EXAMPLE = Path(__file__).parents[2] / "examples/five-effects"


def test_shares_of_masses_stay_while_what_they_act_through_is_written_anew() -> None:
    arm = load_arm(EXAMPLE / "robot.yaml")
    table = read_recordings(EXAMPLE / "recordings.csv", arm.n_motors)
    drive = next(p for p in JOINT_COMPLIANCE.place(arm, table) if not p.variant)
    was = [Part(p, np.array([0.1])) for p in mass_errors(arm, table, [Part(drive, np.array([1e-6]))])]
    assert was
    model = replace(
        fit_frames(arm, table, tool_per_run=False), parts=(Part(drive, np.array([3e-6])),), background=tuple(was)
    )
    now, payload, masses = on_loads(model, table)
    assert [part.placed.key for part in now.background] == [part.placed.key for part in was]
    assert all(part.placed.effect is STATED_MASSES and part.values[0] == 0.1 for part in now.background)
    factors = [
        [product.factor for term in part.placed.terms for product in term.products] for part in (*now.background, *was)
    ]
    half = len(was)
    for new, old in zip(factors[:half], factors[half:], strict=True):
        np.testing.assert_allclose(new, 3 * np.array(old))
    assert {each.location for each in payload} <= {"payload"}
    assert [each.key for each in masses] == [part.placed.key for part in was]


def test_errors_of_loads_go_with_what_they_act_through() -> None:
    arm = load_arm(EXAMPLE / "robot.yaml")
    table = read_recordings(EXAMPLE / "recordings.csv", arm.n_motors)
    drive = next(p for p in JOINT_COMPLIANCE.place(arm, table) if not p.variant)
    was = [Part(p, np.array([0.1])) for p in mass_errors(arm, table, [Part(drive, np.array([1e-6]))])]
    now, payload, masses = on_loads(replace(fit_frames(arm, table, tool_per_run=False), background=tuple(was)), table)
    assert (now.background, payload, masses) == ((), [], [])
