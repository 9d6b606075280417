"""How long the choice of 85 of 5,000 poses takes: the exchange alone, and with candidates, Jacobian and collisions.

CPU seconds on one thread, medians with their range after a first run that is not counted. Aim: the exchange within 2 s.

    python -m benchmarks.poses [--rounds 5]
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from pathlib import Path

os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

import numpy as np

from armscope.design.exchange import d_optimal
from armscope.design.indices import all_indices
from armscope.poses.choose import choose
from armscope.poses.obstacles import Surroundings
from armscope.robot import load_arm

ROBOTS = Path(__file__).parents[1] / "config" / "robots"
ARMS = ("sk120", "six-axis", "seven-axis")
POSES, CANDIDATES, STARTS = 85, 5000, 3
AIM_S = 2.0
AROUND = Surroundings(floor=0.0, tracker=np.array([4.0, 0.0, 1.5]))


def timed(work: Callable[[], object], rounds: int) -> np.ndarray:
    """CPU seconds of some rounds after one that is not counted."""
    times = []
    for number in range(rounds + 1):
        start = time.process_time()
        work()
        if number:
            times.append(time.process_time() - start)
    return np.array(times)


def told(times: np.ndarray) -> str:
    """Median with range."""
    return f"{np.median(times):5.2f} s ({times.min():.2f}-{times.max():.2f})"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    for name in ARMS:
        arm = load_arm(ROBOTS / f"{name}.yaml")
        choice = choose(arm, POSES, AROUND, n_candidates=CANDIDATES)
        whole = timed(lambda arm=arm: choose(arm, POSES, AROUND, n_candidates=CANDIDATES, starts=STARTS), rounds)
        jacobian = choice.jacobian
        exchange = timed(lambda j=jacobian: d_optimal(j, POSES, np.random.default_rng(0), STARTS), rounds)
        draws = np.random.default_rng(1)
        random = [all_indices(jacobian[draws.choice(CANDIDATES, POSES, replace=False)])["O1"] for _ in range(50)]
        met = "met" if np.median(exchange) <= AIM_S else "NOT MET"
        print(
            f"{name:12s} {POSES} of {CANDIDATES}, {jacobian.shape[2]} parameters, {STARTS} starts: exchange "
            f"{told(exchange)}, aim {AIM_S:g} s {met}; with candidates and Jacobian {told(whole)}; "
            f"O1 {choice.indices['O1'] / np.median(random):.2f} x random",
            flush=True,
        )


if __name__ == "__main__":
    main()
