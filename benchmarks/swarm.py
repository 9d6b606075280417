"""How fast the swarms are: all models x axes x 100 seeds x 100 particles x 200 iterations, against other libraries.

One process, one thread, one processor; warm-up with compilation first; then rounds in which everybody runs, in an order
that alternates; CPU time; the ratio within each round; its median over the rounds with the smallest and the largest. A
library counts only on the models where its final fitness equals ours (its excess over least squares within one
percentage point). Slow libraries run a stated share of the seeds, and their time is scaled.

    python -m benchmarks.swarm [--rounds 5] [--seeds 100]

Needs armscope and whatever of requirements-benchmark.txt is installed; a missing library is reported as missing.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from benchmarks.swarm_peers import ITERATIONS, PARTICLES, PEERS, Fit, Runner

from armscope.errormodels.basis import make_basis
from armscope.errormodels.features import PAPER_MODELS
from armscope.errormodels.swarm_fit import FitProblem, fit_swarms
from armscope.swarm.streams import WeightStream, spawn_generators

KERNEL, NUMPY, RANDOM = "armscope kernel", "armscope NumPy", "random numbers alone (NumPy)"
ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "NUMBA_NUM_THREADS": "1",
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1",
    "JAX_PLATFORMS": "cpu",
}
THIS = [sys.executable, "-m", "benchmarks.swarm"]
EQUAL_WITHIN = 1.0  # percentage points of excess over least squares
PEAK_MB = 500


@dataclass
class Contender:
    """Somebody who runs all models, and what it took: seconds per model and round, and final excess per model."""

    name: str
    run: Callable[[int, int], np.ndarray]  # model, number of seeds -> excess over least squares in %, or nothing
    share: float = 1.0
    seconds: list[list[float]] = field(default_factory=list)
    excess: list[list[float]] = field(default_factory=list)

    def one_round(self, models: int, seeds: int) -> None:
        """Run everything once."""
        used = max(1, round(seeds * self.share))
        times, excesses = [], []
        for model in range(models):
            start = time.process_time()
            excess = self.run(model, used)
            times.append((time.process_time() - start) * seeds / used)
            excesses.append(float(np.mean(excess)) if len(excess) else np.nan)
        self.seconds.append(times)
        self.excess.append(excesses)

    def per_model(self) -> np.ndarray:
        """Seconds for the whole batch, rounds x models."""
        return np.array(self.seconds)


def identification_rows(rows: int = 85) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Joint angles (rad), positions (mm) and errors (mm) of a made-up six-axis arm; all joints move."""
    generator = np.random.default_rng(2006)
    reach = np.array([1.2, 0.7, 0.8, 1.0, 1.0, 2.0])
    angles = generator.uniform(-reach, reach, (rows, 6))
    forearm = 1000 + 600 * np.cos(angles[:, 1])
    positions = np.stack(
        [forearm * np.cos(angles[:, 0]), forearm * np.sin(angles[:, 0]), 800 + 900 * np.sin(angles[:, 2])], axis=1
    )
    geometry = generator.normal(scale=2.0, size=(3, 3)) * 1e-3
    errors = positions @ geometry.T + 2 * np.sin(angles[:, [1, 2, 4]]) + generator.normal(size=(rows, 3))
    return angles, positions, errors


def problems() -> list[FitProblem]:
    """One per model of the paper: 4 and 7 terms in positions, 7, 13, 25 and 25 in joint angles."""
    angles, positions, errors = identification_rows()
    return [FitProblem(spec, angles if spec.space == "angular" else positions, errors) for spec in PAPER_MODELS]


def fits_of(problem: FitProblem, seeds: int) -> list[Fit]:
    """What the libraries are given: every axis and seed of one model, in the QR basis."""
    features = problem.spec.features(problem.inputs)
    basis = make_basis("qr", features.matrix(problem.inputs), features.term_names)
    errors = np.asarray(problem.errors_mm)
    targets, rests = basis.targets(errors)
    widths = basis.half_widths(errors)[:, 0]
    return [
        Fit(targets[axis], float(rests[axis]), float(widths[axis]), seed, float(np.sqrt(rests[axis])))
        for seed in range(seeds)
        for axis in range(3)
    ]


def ours(engine: str, batch: list[FitProblem]) -> Callable[[int, int], np.ndarray]:
    """armscope from rows to fitted models, everything included."""

    def run(model: int, seeds: int) -> np.ndarray:
        (fitted,) = fit_swarms([batch[model]], range(seeds), basis="qr", engine=engine)
        return fitted.excess_percent.ravel()

    return run


def random_numbers(batch: list[FitProblem]) -> Callable[[int, int], np.ndarray]:
    """The random numbers that these swarms need, drawn by NumPy as its engine does, and nothing else."""
    dimensions = [problem.spec.features(problem.inputs).coefficients_per_axis for problem in batch]

    def run(model: int, seeds: int) -> np.ndarray:
        for generators in np.array_split(np.array(spawn_generators(model, 3 * seeds)), max(1, seeds // 5)):
            stream = WeightStream(generators, (PARTICLES, dimensions[model]), ITERATIONS)
            for _ in range(ITERATIONS):
                stream.draw()
        return np.empty(0)

    return run


def theirs(runner: Runner, batch: list[FitProblem]) -> Callable[[int, int], np.ndarray]:
    """A library on the same fits."""

    def run(model: int, seeds: int) -> np.ndarray:
        fits = fits_of(batch[model], seeds)
        return 100 * (np.asarray(runner(fits), dtype=float) / np.array([fit.optimum for fit in fits]) - 1)

    return run


def contenders(batch: list[FitProblem]) -> tuple[list[Contender], list[str]]:
    """Everybody that can run here, and the names of those that can't."""
    found = [
        Contender(KERNEL, ours("numba", batch)),
        Contender(NUMPY, ours("numpy", batch)),
        Contender(RANDOM, random_numbers(batch)),
    ]
    missing = []
    for name, load, share in PEERS:
        try:
            found.append(Contender(name, theirs(load(), batch), share))
        except ImportError as error:
            missing.append(f"{name} ({error})")
    return found, missing


def ratios(slow: Contender, fast: Contender, models: Sequence[int]) -> np.ndarray:
    """How many times longer ``slow`` takes, per round, on these models."""
    return slow.per_model()[:, models].sum(axis=1) / fast.per_model()[:, models].sum(axis=1)


def equal_models(peer: Contender, reference: Contender) -> list[int]:
    """The models on which both end at the same fitness."""
    gaps = np.abs(np.mean(peer.excess, axis=0) - np.mean(reference.excess, axis=0))
    return [int(model) for model in np.flatnonzero(gaps <= EQUAL_WITHIN)]


def spread(values: np.ndarray) -> str:
    """Median with the smallest and the largest."""
    return f"{np.median(values):7.2f}  [{values.min():.2f}, {values.max():.2f}]"


def peak_memory(engine: str, seeds: int) -> tuple[float, float]:
    """Peak memory in MB of a process that runs our whole batch, and what the imports alone take."""
    command = [*THIS, "--memory-of", engine, "--seeds", str(seeds)]
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return float(out[0]), float(out[1])


def report_memory(engine: str, seeds: int) -> None:
    """What `peak_memory` asks of the process it starts."""
    before = _peak_so_far()
    fit_swarms(problems(), range(seeds), basis="qr", engine=engine)
    print(_peak_so_far(), before)


def _peak_so_far() -> float:
    """Peak resident memory of this process in MB (getrusage would count the parent's before the start, too)."""
    (line,) = (line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) / 1024


def print_times(everybody: list[Contender], seeds: int) -> None:
    """CPU seconds and excess over least squares, model by model."""
    names = [spec.name.replace("-degree polynomial", "-deg. pol.") for spec in PAPER_MODELS]
    print(f"\nCPU seconds for {seeds} seeds x 3 axes (median of rounds), and mean excess over least squares in %")
    print(f"{'':30}{'run':>6}" + "".join(f"{name:>20}" for name in names) + f"{'all':>10}")
    for each in everybody:
        times, excess = np.median(each.per_model(), axis=0), np.mean(each.excess, axis=0)
        cells = [
            f"{t:9.3f} ({e:7.2g}%)" if np.isfinite(e) else f"{t:9.3f}{'':10}"
            for t, e in zip(times, excess, strict=True)
        ]
        print(f"{each.name:30}{each.share:6.0%}" + "".join(f"{cell:>20}" for cell in cells) + f"{times.sum():10.2f}")


def print_ratios(everybody: list[Contender]) -> dict[tuple[str, str], float]:
    """How many times faster ours are on models with equal final fitness; the medians by (ours, theirs)."""
    by_name = {each.name: each for each in everybody}
    medians = {}
    for own in (KERNEL, NUMPY):
        print(f"\nTimes faster: {own}. Ratio per round, median [smallest, largest], at equal final fitness")
        for each in everybody:
            if each.name in (KERNEL, NUMPY, RANDOM):
                continue
            equal = equal_models(each, by_name[own])
            if not equal:
                print(f"  {each.name:30} reaches our fitness on no model")
                continue
            values = ratios(each, by_name[own], equal)
            medians[own, each.name] = float(np.median(values))
            kept = "all models" if len(equal) == len(PAPER_MODELS) else ", ".join(PAPER_MODELS[k].name for k in equal)
            print(f"  {each.name:30}{spread(values)}   ({kept})")
        everything = list(range(len(PAPER_MODELS)))
        print(f"  its time / {RANDOM}: {spread(ratios(by_name[own], by_name[RANDOM], everything))}")
    return medians


def main() -> None:
    """Run the benchmark and print times, ratios and targets."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--memory-of", choices=["numba", "numpy"], help=argparse.SUPPRESS)
    options = parser.parse_args()
    if any(os.environ.get(name) != value for name, value in ONE_THREAD.items()):
        os.environ.update(ONE_THREAD)  # libraries read these while they are imported: start again
        os.execv(sys.executable, [*THIS, *sys.argv[1:]])
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    warnings.simplefilter("ignore")
    if options.memory_of:
        report_memory(options.memory_of, options.seeds)
        return
    everybody, missing = contenders(problems())
    models = len(PAPER_MODELS)
    print(
        f"{models} models x 3 axes x {options.seeds} seeds x {PARTICLES} particles x {ITERATIONS} iterations",
        flush=True,
    )
    for each in everybody:
        start = time.perf_counter()
        for model in range(models if "evosax" in each.name else 1):  # it compiles for each size, the others once
            each.run(model, options.seeds if "evosax" in each.name else 1)
        print(f"  warm-up of {each.name}: {time.perf_counter() - start:.1f} s", flush=True)
    for number in range(options.rounds):
        for each in everybody if number % 2 == 0 else everybody[::-1]:
            each.one_round(models, options.seeds)
        print(f"  round {number + 1} of {options.rounds} done", flush=True)
    print_times(everybody, options.seeds)
    medians = print_ratios(everybody)
    print("\nPeak memory of the whole batch")
    peaks = {engine: peak_memory(engine, options.seeds) for engine in ("numba", "numpy")}
    for engine, (peak, imports) in peaks.items():
        print(f"  {engine}: {peak:.0f} MB, of which {imports:.0f} MB are there before it starts")
    for each_missing in missing:
        print(f"missing: {each_missing}")
    print_targets(medians, max(peak for peak, _ in peaks.values()))


def print_targets(medians: dict[tuple[str, str], float], peak: float) -> None:
    """Which targets are met."""
    print("\nTargets")
    print(f"  {'met   ' if peak < PEAK_MB else 'MISSED'} peak memory {peak:.0f} MB < {PEAK_MB} MB")
    targets = [
        (KERNEL, "pyswarms", 20.0),
        (KERNEL, "evosax", 4.0),
        (KERNEL, "evosax, r per dimension", 4.0),
        (NUMPY, "pyswarms", 5.0),
    ]
    for own, peer, least in targets:
        if (own, peer) not in medians:
            print(f"  not measured: {own} at least {least:g} x {peer}")
            continue
        met = medians[own, peer] >= least
        print(f"  {'met   ' if met else 'MISSED'} {own} {medians[own, peer]:.1f} x {peer}, at least {least:g} wanted")


if __name__ == "__main__":
    main()
