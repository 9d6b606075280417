"""Where a drive or a channel ends is told from torque that is merely dense at its ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.check import CUT_OFF, check_motions
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.samples.rail_constants import RAIL
from armscope.motion.samples.rails import rails
from armscope.recordings.motions import Motions
from tests.motion.moving import moved, robot
from tests.seeds import seeds


def clipped(seed: int, share: float, noise: float = 0.0, both: bool = True) -> tuple[Motions, float]:
    """Motion whose second torque goes no farther than a quantile of its size, with noise on top of that; and that."""
    good = moved(robot(), seed, seconds=15.0)
    effort, most = good.effort.copy(), float(np.quantile(np.abs(good.effort[:, 1]), 1 - share))
    effort[:, 1] = np.clip(effort[:, 1], -most, most if both else np.inf)
    effort[:, 1] += noise * np.random.default_rng(seed).normal(size=len(effort))
    return replace(good, effort=effort), most


@pytest.mark.parametrize("seed", seeds(1, 3))
@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_a_rail_is_found_with_its_value_also_where_noise_lies_on_it(seed: int, noise: float) -> None:
    motions, most = clipped(seed, 0.3, noise, both=False)
    found = rails(motions, robot())
    assert found.values[1] == pytest.approx((-most,), abs=0.5 * noise + 1e-9)
    assert found.noisy == (False, noise > 0, False)
    assert not found.at[:, [0, 2]].any()
    on = moved(robot(), seed, seconds=15.0).effort[:, 1] <= -most
    assert np.mean(found.at[on, 1]) > 0.95


def test_what_a_filter_rings_beyond_a_rail_lies_on_it() -> None:
    """Samples beyond a limit, one at each arrival, hid that it is one, and the channel was called not read."""
    motions, most = clipped(2, 0.3)
    arrived = np.flatnonzero(np.diff((motions.effort[:, 1] == -most).astype(int)) == 1) + 1
    effort = motions.effort.copy()
    effort[arrived, 1] -= 0.5 * RAIL.rings * np.ptp(effort[:, 1])
    found = rails(replace(motions, effort=effort))
    assert -most in found.values[1]
    assert found.at[arrived, 1].all()
    kinds = {notice.kind for notice in check_motions(robot(), replace(motions, effort=effort))}
    assert CUT_OFF in kinds
    assert "not read" not in kinds


@pytest.mark.parametrize("seed", seeds(1, 4))
def test_a_joint_of_dry_friction_alone_has_no_rail(seed: int) -> None:
    """Its torque is dense at both ends, and nothing asks for more."""
    motions, dq = moved(robot(), seed), np.gradient(moved(robot(), seed).q[:, 2])
    effort = motions.effort.copy()
    effort[:, 2] = 5 * np.sign(dq) + 0.1 * np.random.default_rng(seed).normal(size=len(effort))
    assert not rails(replace(motions, effort=effort), robot()).at.any()


@pytest.mark.parametrize("seed", seeds(1, 4))
def test_motion_that_turns_back_has_no_rail(seed: int) -> None:
    assert not rails(moved(robot(), seed), robot()).at.any()


@pytest.mark.long
@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_what_lies_on_a_rail_names_nothing(noise: float) -> None:
    verdict = diagnose_motion(robot(), clipped(3, 0.2, noise)[0], MotionSettings(cutoff=10.0)).verdict
    assert (verdict.answer, verdict.effects) == ("nothing missing", ())
    assert verdict.headline.startswith("Beside samples that are cut off, nothing is missing")
    assert "tau2_nm stays at" in verdict.headline
