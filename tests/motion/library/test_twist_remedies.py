"""Cures of links that lie beside their motors, executed as printed: on another motion link and motor agree."""

import re
from collections.abc import Callable

import numpy as np
import pandas as pd
import pinocchio as pin
import pytest
from scipy.ndimage import gaussian_filter1d

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.recordings.motions import as_motions
from tests.motion.cured import told
from tests.motion.moving import robot
from tests.motion.two_inertias import RIGID, play, recorded, said_of, spring

INSIDE = (1.5, 14.5)
UNITS = {"rad": 1.0, "mrad": 1e-3, "µrad": 1e-6}
Cured = Callable[[pd.DataFrame], tuple[Array, Array]]
"""Where link and motor of a motion are once the cure was followed, rad."""


def passed_on(table: pd.DataFrame) -> Array:
    """Torque that the drive passes on to its link, N m: by Newton-Euler of what the link carries."""
    model, found = robot().model, []
    data = model.createData()
    for _, run in table.groupby("run", sort=False):
        time = run.time_s.to_numpy()
        q = gaussian_filter1d(run[["q1_link_rad", "q2_rad", "q3_rad"]].to_numpy(), 2.0, axis=0)
        dq = np.gradient(q, time, axis=0)
        motion = zip(q, dq, np.gradient(dq, time, axis=0), strict=True)
        found += [pin.rnea(model, data, *row)[0] for row in motion]
    return np.array(found)


def lying_behind(table: pd.DataFrame, by: Array) -> tuple[Array, Array]:
    return table.q1_link_rad.to_numpy(), table.q1_rad.to_numpy() - by


def spring_between(cure: str) -> Cured:
    (stiffness,) = told(cure, "link: ")
    assert cure.endswith("N m/rad.")
    return lambda table: lying_behind(table, passed_on(table) / stiffness)


def behind_its_motor(cure: str) -> Cured:
    (size,) = told(cure, "passed on: by ")
    half = size * UNITS[re.findall(r"by [\d.]+ (?:± [\d.]+ )?(\S*rad)", cure)[0]]
    assert "against the torque passed on" in cure
    return lambda table: lying_behind(table, half * np.sign(passed_on(table)))


def less_a_wave(cure: str) -> Cured:
    terms = re.findall(r"([+−]) ?([\d.]+) (?:± [\d.]+ )?(\S*rad) × (sin|cos)\((?:(\d+) × )?angle\)", cure)
    assert len(terms) == 2
    assert cure.startswith("Take the wave from the link's position")

    def corrected(table: pd.DataFrame) -> tuple[Array, Array]:
        link = table.q1_link_rad.to_numpy().copy()
        for sign, size, unit, wave, count in terms:
            turned = getattr(np, wave)(int(count or 1) * table.q1_rad.to_numpy())
            link -= (1 if sign == "+" else -1) * float(size) * UNITS[unit] * turned
        return link, table.q1_rad.to_numpy()

    return corrected


def off_its_centre(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(q1_link_rad=table.q1_link_rad + 8e-4 * np.sin(2 * table.q1_rad + 0.7))


def as_it_is(table: pd.DataFrame) -> pd.DataFrame:
    return table


CASES = {
    "joint_elasticity": (spring(12000.0), as_it_is, spring_between),
    "joint_play": (play(1e-3), as_it_is, behind_its_motor),
    "encoder_wave": (RIGID, off_its_centre, less_a_wave),
}


def found(behind: str, planted: Callable[[pd.DataFrame], pd.DataFrame]) -> MotionDiagnosis:
    if planted is as_it_is:
        return said_of(behind, 1)
    return diagnose_motion(robot(), as_motions(planted(recorded(behind, 1)), "motions.csv", 3))


@pytest.mark.long
@pytest.mark.parametrize("kind", [*CASES])
def test_who_does_what_the_card_says_has_the_link_where_its_motor_is(kind: str) -> None:
    behind, planted, read = CASES[kind]
    (side,) = found(behind, planted).verdict.links
    (cause,) = [each for each in side.causes if not each.minor]
    assert cause.effect == kind
    other = planted(recorded(behind, 1, seed=5, runs=1, noise=0.0))
    link, motor = read(cause.cure)(other)
    inside = (other.time_s > INSIDE[0]) & (other.time_s < INSIDE[1])  # differences of the ends are one-sided
    before, after = (np.median(np.abs(each[inside])) for each in (other.q1_link_rad - other.q1_rad, link - motor))
    assert after < 0.05 * before  # half of the rows: while a link crosses its play, nothing says where it is
