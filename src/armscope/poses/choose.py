"""The choice: candidates, what they show, the poses that show it best, in an order with short ways."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.design.exchange import optimal
from armscope.design.indices import SOURCES, all_indices
from armscope.poses.candidates import Candidates, candidates, grid, subset
from armscope.poses.constants import CHOOSING
from armscope.poses.obstacles import Surroundings
from armscope.poses.target_parameters import GEOMETRY, TargetParameters, target_parameters
from armscope.recordings import Recordings
from armscope.robot import Arm


@dataclass(frozen=True, eq=False)
class Choice:
    """Poses chosen from candidates."""

    effects: tuple[str, ...]  # what is to be shown, as asked for
    index: str  # what was made large, "O1" to "O5"
    rows: Indices  # (n,) of the candidates, in the order to measure
    candidates: Candidates  # what they were chosen from
    targets: TargetParameters
    jacobian: Array  # (N, 3, p) of all candidates
    around: Surroundings  # floor, tracker, radius of the links

    @property
    def table(self) -> Recordings:
        """The chosen poses, in the order to measure, each come to from the side of the pose before it."""
        table = subset(self.candidates.table, self.rows)
        moves = np.diff(table.motor_angles, axis=0, prepend=table.motor_angles[:1])
        return replace(table, approach=np.sign(moves))

    @property
    def indices(self) -> dict[str, float]:
        """O1 to O5 of the choice."""
        return all_indices(self.targets.jacobian(self.table))


# so many parameters: each is a choice of its own that a user makes by name, and nearly all have a default
def choose(
    arm: Arm,
    count: int,
    around: Surroundings | None = None,
    effects: Sequence[str] = (GEOMETRY,),
    index: str = "O1",
    n_candidates: int = CHOOSING.candidates,
    payload_kg: float = 0.0,
    seed: int = 0,
    starts: int = CHOOSING.starts,
) -> Choice:
    """The ``count`` possible poses that show some effects best, by an observability index (O1 is D-optimality).

    Args:
        arm: the nominal arm.
        count: how many poses.
        around: what refuses a pose; None: only the joint limits and the arm's own body.
        effects: names of the vocabulary, or `shown.GEOMETRY`.
        index: O1 ... O5, see `armscope.design.indices`.
        n_candidates: possible poses to choose from.
        payload_kg: carried in every other candidate.
        seed: of candidates and starts.
        starts: local optima to compare.

    Returns:
        The chosen rows in an order that makes the way short, the candidates, and the parameters that they show.

    Raises:
        InputError: too few possible poses, too few poses for the parameters, or effects that poses cannot show.
    """
    around = around or Surroundings()
    pool = candidates(arm, n_candidates, around, seed, payload_kg)
    targets = target_parameters(arm, pool.table, effects)
    if targets.is_frame.all():
        rule = "poses of this arm show nothing of them beside base and tool"
        raise InputError("--effects", "", ", ".join(effects), rule, "Choose other effects.")
    jacobian = targets.jacobian(pool.table)
    try:
        rows = optimal(index, jacobian, count, np.random.default_rng(seed), starts)
    except ValueError as error:
        raise InputError("--poses", "", count, str(error)) from error
    return Choice(tuple(effects), index, short_way(pool.table.motor_angles, rows), pool, targets, jacobian, around)


def by_other_criteria(choice: Choice, seed: int = 0, starts: int = CHOOSING.starts) -> dict[str, Recordings]:
    """As many of the same candidates chosen by each of the other indices: name of the index -> poses.

    Args:
        choice: whose candidates are taken.
        seed: of the starts.
        starts: local optima to compare.

    Returns:
        Rows by the name of the index.
    """
    table = choice.candidates.table
    rows = {
        index: optimal(index, choice.jacobian, len(choice.rows), np.random.default_rng(seed), starts)
        for index in SOURCES
        if index != choice.index
    }
    return {index: subset(table, chosen) for index, chosen in rows.items()}


def random_choice(choice: Choice, rng: np.random.Generator) -> Recordings:
    """As many of the candidates, drawn at random."""
    rows = rng.choice(len(choice.candidates), len(choice.rows), replace=False)
    return subset(choice.candidates.table, rows)


def grid_choice(choice: Choice, rng: np.random.Generator, payload_kg: float = 0.0) -> Recordings:
    """As many possible poses of a grid.

    Args:
        choice: whose arm, surroundings and count are taken.
        rng: draws the poses from the grid.
        payload_kg: carried in every other row, on average.

    Returns:
        The rows, without positions.

    Raises:
        InputError: as `candidates.grid`.
    """
    return grid(choice.targets.arm, len(choice.rows), choice.around, rng, payload_kg)


def short_way(motor_angles: Array, rows: Indices) -> Indices:
    """The rows in an order with short ways: nearest neighbours, then 2-opt (Croes 1958).

    A way counts as the largest turn of any motor, as all move at once.
    """
    poses = motor_angles[rows]
    ways = np.abs(poses[:, None] - poses[None]).max(axis=2)
    order, left = [0], set(range(1, len(rows)))
    while left:
        here = order[-1]
        order.append(min(left, key=lambda each: (ways[here, each], each)))
        left.remove(order[-1])
    tour = np.array(order)
    for _ in range(CHOOSING.exchanges * len(rows)):
        before, after = tour[:-1], tour[1:]
        saved = (ways[before, after][:, None] + ways[before, after][None]) - (
            ways[before[:, None], before[None]] + ways[after[:, None], after[None]]
        )
        i, j = np.unravel_index(int(np.argmax(np.triu(saved, 1))), saved.shape)
        if saved[i, j] < CHOOSING.shorter_rad:
            break
        tour[i + 1 : j + 1] = tour[i + 1 : j + 1][::-1].copy()
    return np.asarray(rows[tour])
