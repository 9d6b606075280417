"""Gravity that points another way than robot.yaml states: joints would then give way against their load, or beside.

Loads are linear in gravity, so what joints do that give way to it along three axes tells of every other direction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from armscope.calibration.geometry import Posed, State
from armscope.calibration.model import set_up
from armscope.check.constants import WRONG_GRAVITY
from armscope.check.plain_errors import drive_columns
from armscope.check.suspicion import GRAVITY, Suspicion
from armscope.core.sampling import spread_over_a_sphere
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def gravity_mistake(arm: Arm, recordings: Recordings, state: State) -> list[Suspicion]:
    """Whether joints give way to another gravity than robot.yaml states, base, tool, geometry and drives being free.

    Args:
        arm: with link masses, else nothing is tried.
        recordings: some rows.
        state: base and tool as fitted to these rows.

    Returns:
        One hint, or none: controllers that make up for too much give the same picture as gravity turned around.
    """
    table = replace(recordings, torque=None, orientation=None)
    rows = set_up(arm, table)
    if rows.loads is None or not np.any(rows.loads):
        return []
    giving = _Giving.of(arm, table, state)
    if giving.free <= arm.n_motors:
        return []
    stated, around = giving.explained(arm.gravity), giving.explained(-arm.gravity)
    nats = giving.nats(1.0, 1 - around)
    clear = max(WRONG_GRAVITY.clear_nats, giving.nats(1.0, 1 - stated) / WRONG_GRAVITY.little)
    is_around = around > WRONG_GRAVITY.clear_share and nats > clear
    leaning = giving.likeliest_way(arm.gravity)
    left = 1 - giving.explained(leaning)
    if not giving.is_clear(1 - max(stated, around if is_around else 0.0), left):
        return [_told(-arm.gravity, AROUND, stated, around)] if is_around else []
    cosine = np.dot(leaning, arm.gravity) / np.linalg.norm(arm.gravity) ** 2
    lean = f"to gravity that leans by {np.degrees(np.arccos(np.clip(cosine, -1, 1))):.3g} degrees from what is stated"
    return [_told(leaning, lean, stated, 1 - left)]


AROUND = "against gravity"


@dataclass(frozen=True, eq=False)
class _Giving:
    """Joints that give way to gravity along each axis of the base, beyond geometry, drives and the target."""

    alike: Array  # (3, m, 3, m) products of what they do
    beyond: Array  # the same of what is left of it beyond geometry, drives and the target
    towards: Array  # (3, m) products of that with what geometry and drives leave of the points
    square: float  # of what they leave, m^2
    free: int  # how many numbers of it are free

    @staticmethod
    def of(arm: Arm, table: Recordings, state: State) -> _Giving:
        """Of rows of an arm with link masses."""
        rows = set_up(arm, table)
        posed, free = rows.posed(state), rows.free("compliance")
        fixed = rows.jacobian(state, posed, free)[:, : -arm.n_motors]
        drives = drive_columns(arm, posed, table.motor_angles)
        geometry = np.hstack([fixed, drives, _target_columns(arm, posed)])
        spanned, size, _ = np.linalg.svd(geometry, full_matrices=False)
        spanned = spanned[:, size > WRONG_GRAVITY.left_of_column**2 * size[0]]
        left = posed.left.ravel() - spanned @ (spanned.T @ posed.left.ravel())
        along = [set_up(replace(arm, gravity=axis), table) for axis in np.eye(3)]
        giving = np.hstack([each.jacobian(state, posed, free)[:, -arm.n_motors :] for each in along])
        beyond = giving - spanned @ (spanned.T @ giving)
        by_axis = (3, arm.n_motors, 3, arm.n_motors)
        alike, beyond_alike = (each.T @ each for each in (giving, beyond))
        towards = (beyond.T @ left).reshape(by_axis[:2])
        square = max(float(left @ left), np.finfo(float).tiny)
        return _Giving(
            alike.reshape(by_axis), beyond_alike.reshape(by_axis), towards, square, len(left) - spanned.shape[1]
        )

    def explained(self, gravity: Array) -> float:
        """Share of the squares that joints explain which give way to a gravity."""
        alike, beyond = (np.einsum("i,ijkl,k->jl", gravity, each, gravity) for each in (self.alike, self.beyond))
        clear = beyond.diagonal() > WRONG_GRAVITY.left_of_column**2 * alike.diagonal()
        return _squares_explained(beyond[np.ix_(clear, clear)], (gravity @ self.towards)[clear]) / self.square

    def nats(self, before: float, after: float) -> float:
        """How much likelier rows are of which a smaller share is left."""
        return 0.5 * self.free * float(np.log(before / max(after, np.finfo(float).tiny)))

    def is_clear(self, before: float, after: float) -> bool:
        """Whether another direction leaves so much less that somebody should look."""
        return after <= WRONG_GRAVITY.leaning * before and self.nats(before, after) >= WRONG_GRAVITY.clear_nats

    def likeliest_way(self, gravity: Array) -> Array:
        """Gravity of the same size along which joints that give way explain most; an axis of the base if that does."""
        size = float(np.linalg.norm(gravity))
        step = np.pi / np.sqrt(WRONG_GRAVITY.ways)
        best = max([gravity, *(size * way for way in spread_over_a_sphere(WRONG_GRAVITY.ways))], key=self.explained)
        while step > WRONG_GRAVITY.nearest_rad:
            across = np.linalg.svd(best[None])[2][1:]
            turns = np.linspace(0, 2 * np.pi, WRONG_GRAVITY.sides, endpoint=False)
            beside = [best + size * np.tan(step) * (np.cos(a) * across[0] + np.sin(a) * across[1]) for a in turns]
            nearer = max([best, *(size * way / np.linalg.norm(way) for way in beside)], key=self.explained)
            best, step = nearer, step / 2 if nearer is best else step
        left = 1 - self.explained(best)
        along = [size * sign * axis for axis in np.eye(3) for sign in (1, -1)]
        as_well = [way for way in along if self.nats(1 - self.explained(way), left) < INDISTINGUISHABLE_NATS]
        return max([best, *as_well], key=lambda way: (np.count_nonzero(way) == 1, self.explained(way)))


def _told(best: Array, way: str, stated: float, explained: float) -> Suspicion:
    """What joints give way to instead, and by how much that explains more."""
    wanted = ", ".join(f"{each + 0.0:.3g}" for each in best)
    statement = (
        f"joints seem to give way {way}: with gravity_m_s2 {'turned around' if way == AROUND else f'[{wanted}]'}, "
        f"joints that give way explain {100 * explained:.0f} % of the squared error that geometry and drives leave, "
        f"as it is {100 * stated:.0f} %"
    )
    cure = (
        "gravity_m_s2 points the way things fall, in the base frame: [0, 0, -9.81] for an arm that stands upright, "
        "[0, 0, 9.81] for one that hangs."
    )
    told = " Is it mounted on a wall, or on a slope? `armscope diagnose --estimate-gravity` tells how it leans."
    mounted = "" if way == AROUND else told
    return Suspicion("hint", statement, f"{cure}{mounted}", GRAVITY)


def _target_columns(arm: Arm, posed: Posed) -> Array:
    """(3 N, 9) what a target does on the tool that leans with its own weight, as a loose nest or a soft holder lets it.

    Gravity moves it as if the last joints gave way, and by chance as if they pushed.
    """
    turns = posed.frames.tool_rotation
    weight = np.einsum("nji,j->ni", turns, arm.gravity / np.linalg.norm(arm.gravity))
    return np.asarray(np.einsum("nir,nc->nirc", turns, weight).reshape(-1, 9))


def _squares_explained(alike: Array, towards: Array) -> float:
    """What columns with these products explain by values that are not negative; the most negative go by turns."""
    while len(towards):
        values = np.linalg.lstsq(alike, towards)[0]
        if values.min() >= 0:
            return float(values @ towards)
        kept = np.arange(len(values)) != int(np.argmin(values * np.sqrt(alike.diagonal())))
        alike, towards = alike[np.ix_(kept, kept)], towards[kept]
    return 0.0
