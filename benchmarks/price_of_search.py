"""How small an effect can be and still be found by somebody who knows all but where to look.

The oracle of the proof knows which effect to test, and where. Nobody who holds a table does: every other place and
effect of the library can look like the true one by chance. Here that chance is simulated on faint worlds of the proof:
readings of nothing but noise, of known size, against the whole library; the smallest p-value of all candidates that one
table in a hundred shows by chance is what a searcher must ask of a single one to raise as few false alarms.

    python -m benchmarks.price_of_search [--worlds 12] [--seed 2006]
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.linalg import lstsq
from scipy.optimize import brentq
from scipy.stats import chi2, ncx2

from armscope.core.types import Array
from armscope.diagnosis import pipeline
from armscope.diagnosis.pipeline import Settings, diagnose
from armscope.diagnosis.state import DiagnosisState
from armscope.inference.problem import Problem
from armscope.proof.definitions import FALSE_ALARMS_OF_ORACLE, RELIABLE
from armscope.recordings import read_recordings
from armscope.robot import load_arm
from armscope.world.catalogue import catalogue
from armscope.world.folder import build

ROBOTS = Path(__file__).parents[1] / "config" / "robots"
DRAWS = 4000
FALSE_ALARMS = (FALSE_ALARMS_OF_ORACLE, 0.05)
COLUMNS = (1, 2, 3, 6)
"""Numbers of an effect; most of the library's have one to three."""
OF_ITS_OWN = 1e-5
"""Share of a column's square that free frames must leave for it to be more than rounding."""


def library_of(world: Path) -> Problem:
    """The sums over a world's rows under which the library's effects compete."""
    arm = load_arm(world / "robot.yaml")
    recordings = read_recordings(world / "recordings.csv", arm.n_motors)

    class Found(Exception):
        """Ends the diagnosis once its columns stand."""

    def caught(state: DiagnosisState, *_: object) -> None:
        raise Found(state.problem)

    judge, pipeline.judge = pipeline.judge, caught  # type: ignore[assignment]
    try:
        diagnose(arm, recordings, Settings(resamples=0, cross_validation=False))
    except Found as found:
        return found.args[0]
    finally:
        pipeline.judge = judge
    raise RuntimeError(f"{world.name} can't be diagnosed")


def smallest_p_values(problem: Problem, rng: np.random.Generator) -> Array:
    """(DRAWS,) the smallest p-value over all candidates on readings that are noise of known size and nothing else."""
    gram, frames = problem.equations.G, np.asarray(problem.space.frames)
    rest = np.setdiff1d(np.arange(len(gram)), frames)
    along = lstsq(gram[np.ix_(frames, frames)], gram[np.ix_(frames, rest)])[0]
    left = gram[np.ix_(rest, rest)] - gram[np.ix_(rest, frames)] @ along
    alive = np.diag(left) > OF_ITS_OWN * np.diag(gram)[rest]
    left, rest = left[np.ix_(alive, alive)], rest[alive]
    values, vectors = np.linalg.eigh(left)
    noise = vectors * np.sqrt(np.maximum(values, 0.0)) @ rng.standard_normal((len(rest), DRAWS))
    smallest = np.ones(DRAWS)
    for candidate in problem.space.candidates:
        own = np.flatnonzero(np.isin(rest, candidate.columns))
        if not len(own):
            continue
        sizes, axes = np.linalg.eigh(left[np.ix_(own, own)])
        kept = sizes > OF_ITS_OWN * sizes.max()
        explained = np.sum((axes[:, kept].T @ noise[own]) ** 2 / sizes[kept, None], axis=0)
        smallest = np.minimum(smallest, chi2.sf(explained, kept.sum()))
    return smallest


def noncentrality(level: float, columns: int) -> float:
    """At which a test of so many numbers at this level finds an effect in the share `RELIABLE` of tables."""
    critical = chi2.isf(level, columns)
    return float(brentq(lambda value: ncx2.sf(critical, columns, value) - RELIABLE, 1e-3, 1e3))


def prices(worlds: int, seed: int) -> Iterator[dict[str, object]]:
    """Of each world, the searcher's threshold in multiples of the oracle's, by false alarms and numbers fitted."""
    faint = [spec for spec in catalogue(seed, "full") if spec.category == "faint" and spec.fresh]
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as home:
        for spec in faint[:: max(1, len(faint) // worlds)][:worlds]:
            problem = library_of(build(spec, Path(home), ROBOTS) / "visible")
            smallest = smallest_p_values(problem, rng)
            for alarms in FALSE_ALARMS:
                level = float(np.quantile(smallest, alarms))
                for columns in COLUMNS:
                    oracle = noncentrality(FALSE_ALARMS_OF_ORACLE, columns)
                    yield {
                        "world": spec.id,
                        "false alarms": alarms,
                        "numbers": columns,
                        "level": level,
                        "times the oracle's": float(np.sqrt(noncentrality(level, columns) / oracle)),
                    }


def main() -> None:
    """Print the median, lowest and highest of the worlds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--worlds", type=int, default=12)
    parser.add_argument("--seed", type=int, default=2006)
    chosen = parser.parse_args()
    table = pd.DataFrame(prices(chosen.worlds, chosen.seed))
    groups = table.groupby(["false alarms", "numbers"])["times the oracle's"]
    print(groups.agg(["median", "min", "max"]).round(2).to_string())


if __name__ == "__main__":
    main()
