"""A link that bows, or a joint that turns, with another joint's angle is told there; laws of their own are not."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.physics.model import predict
from armscope.physics.unexplained_turn import ELSEWHERE
from armscope.recordings import Recordings
from armscope.verdict.diagnosis import Diagnosis

from ..numpy_arms import NOISE_M, ROWS, UR5E, bowed, said, still, tolerances

SIZE = 6e-4
Moved = Callable[[Array, Array], None]


def led(verdict: Diagnosis) -> list[tuple[str, str]]:
    """What is said to turn with another joint's angle, and with whose."""
    return [(e.location, e.driver) for e in verdict.effects if e.driver.startswith(ELSEWHERE)]


@pytest.mark.parametrize(("rows", "link", "joint"), [(UR5E, 2, 1), (UR5E, 3, 1)])
def test_a_link_that_bows_with_a_joint_before_it_is_told_with_its_size(
    rows: list[tuple[float, float, float]], link: int, joint: int
) -> None:
    verdict = said(rows, still, seed=link, bow=(link, joint, SIZE))
    assert led(verdict) == [(f"link {link}", f"{ELSEWHERE} joint {joint}")]
    (found,) = (e for e in verdict.effects if e.driver.startswith(ELSEWHERE))
    amplitude = next(p for p in found.parameters if p.name == "amplitude")
    assert abs(amplitude.value - SIZE) < 3 * amplitude.stderr < SIZE
    assert found.effect == "unknown"
    assert "Find what pulls" in found.cure
    assert verdict.noise_mm < 1.1 * 1e3 * NOISE_M, "nothing of the bow is left"


def test_the_model_foretells_what_the_link_does_at_poses_that_were_not_measured() -> None:
    """By the arm's own kinematics, written by hand: what commands by the model leave of it."""
    verdict = said(UR5E, still, seed=2, bow=(2, 1, SIZE))
    rng = np.random.default_rng(2)
    rng.uniform(-2, 2, (ROWS, len(UR5E)))
    errors = tolerances(UR5E, rng)
    angles = np.random.default_rng(77).uniform(-1.8, 1.8, (300, len(UR5E)))
    table = Recordings(angles, np.zeros((300, 3)), np.full(300, "1"), np.full(300, ""), np.arange(300).astype(str))
    true = bowed(UR5E, errors, angles, (2, 1, SIZE))
    missed = np.sqrt(np.mean((predict(verdict.model, table) - true) ** 2))
    straight = np.sqrt(np.mean((bowed(UR5E, errors, angles, None) - true) ** 2))
    assert missed < min(NOISE_M, straight / 3), (missed, straight)


def follows(joint: int, other: int) -> Moved:
    def moved(angles: Array, row: Array) -> None:
        angles[:, joint - 1] += SIZE * np.sin(angles[:, other - 1] + 0.5)

    return moved


def test_a_joint_that_turns_with_a_joint_before_it_is_told() -> None:
    assert led(said(UR5E, follows(4, 1), seed=5)) == [("joint 4", f"{ELSEWHERE} joint 1")]


def eccentric(angles: Array, row: Array) -> None:
    angles[:, 2] += SIZE * np.sin(angles[:, 2] + 0.5)


def sagging(angles: Array, row: Array) -> None:
    """Joints 2 and 3 give way under the weight of a forearm, of which the nominal arm knows no mass."""
    forearm = np.cos(angles[:, 1] + angles[:, 2])
    angles[:, 1] -= SIZE * (np.cos(angles[:, 1]) + 0.6 * forearm)
    angles[:, 2] -= SIZE * forearm


@pytest.mark.parametrize("moved", [still, eccentric, sagging])
def test_what_laws_of_their_own_explain_is_not_told_so(moved: Moved) -> None:
    assert led(said(UR5E, moved, seed=8)) == []
