"""What a neighbour of a large hypothesis costs: beside the one whose factor is known, and by factors of its own.

Both are timed in turns, in one process, on one thread, after a first turn that is not counted; CPU time per neighbour
as medians with their range, and the ratio. The hypothesis has every background of an arm; its neighbours have one
effect more, one less, or a smaller background.

    python -m benchmarks.evidence [--rounds 5]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from benchmarks.diagnosis import world

ARM, ROWS, EFFECTS, NEIGHBOURS = "six-axis", 600, 6, 20


def neighbours(folder: Path) -> tuple[object, object, list[tuple[object, object]]]:
    """A problem, a large hypothesis on it, and (effects, background) of some of its neighbours."""
    from armscope.diagnosis.model_space import build_model_space
    from armscope.fitting.block_sums import normal_equations_by_block
    from armscope.fitting.linearisation import residuals
    from armscope.fitting.registration import fit_frames
    from armscope.inference.edits import replaced
    from armscope.inference.evidence import evaluate
    from armscope.inference.problem import SelectedEffect, build_problem
    from armscope.measurement.row_weights import RowWeights
    from armscope.physics.backgrounds import backgrounds
    from armscope.physics.frames import free_frames
    from armscope.physics.registry import library
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm

    arm = load_arm(folder / "robot.yaml")
    table = read_recordings(folder / "recordings.csv", arm.n_motors)
    space = build_model_space(free_frames(table, False), list(backgrounds(arm, table).values()), library(arm, table))
    model = fit_frames(arm, table)
    weights = RowWeights.of_positions(np.ones(len(residuals(model, table).points_mm)))
    (sums,) = normal_equations_by_block(space.layout, model, table, weights, np.zeros(len(table), dtype=np.intp))
    problem = build_problem(space, sums, 0.0)
    everywhere = tuple(family.sizes - 1 if len(family.columns) else 0 for family in space.families)
    curves = [n for n, candidate in enumerate(space.candidates) if candidate.is_curve and candidate.competes]
    chosen = tuple(SelectedEffect(n, 3) for n in curves[:EFFECTS])
    large = evaluate(problem, chosen, everywhere, 0.05)
    more = [((*chosen, SelectedEffect(n, 2)), everywhere) for n in range(NEIGHBOURS) if n not in curves]
    less = [(tuple(c for c in chosen if c is not each), everywhere) for each in chosen]
    other = [(chosen, replaced(everywhere, n, size - 1)) for n, size in enumerate(everywhere) if size]
    return problem, large, [*more, *less, *other]


def told(name: str, taken: Sequence[float]) -> str:
    """One line of the table."""
    return f"{name:28s} {1e3 * np.median(taken):7.2f} ms CPU ({1e3 * min(taken):.2f}-{1e3 * max(taken):.2f})"


def main() -> None:
    """Time both ways in turns, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    from armscope.inference.evidence import evaluate

    with tempfile.TemporaryDirectory() as name:
        problem, large, asked = neighbours(world(ARM, ROWS, Path(name)))
    _ = large.inverse  # that of a hypothesis whose neighbours are looked at is known
    taken: dict[bool, list[float]] = {True: [], False: []}
    for turn in range(rounds + 1):
        for beside in (True, False):
            start = time.process_time()
            for chosen, background in asked:
                evaluate(problem, chosen, background, large.noise, large if beside else None)
            if turn:
                taken[beside].append((time.process_time() - start) / len(asked))
    print(f"{len(large.columns)} columns, {len(asked)} neighbours")
    print(told("beside the known one", taken[True]))
    print(told("by factors of their own", taken[False]))
    print(f"ratio {np.median(np.array(taken[False]) / np.array(taken[True])):.1f}")


if __name__ == "__main__":
    main()
