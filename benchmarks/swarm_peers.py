"""The same swarm in other libraries: constriction as inertia 0.7298 and c1 = c2 = 1.4962, global best, no early stop.

Each library is given the same search box and the same vectorised objective on the triangular factor as armscope's own
engines (in the QR basis, |z - b|^2 + rest), and what its documentation offers for speed. A loader imports its library,
so that one that is missing is reported as missing.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from armscope.swarm.update import PRESETS

INERTIA, COGNITIVE, SOCIAL = PRESETS["constriction"].coefficients(0, 200)
PARTICLES, ITERATIONS = 100, 200


@dataclass(frozen=True)
class Fit:
    """One swarm to run: D coordinates in the QR basis, its random seed, and the least-squares RMS as its yardstick."""

    target: np.ndarray
    rest: float
    half_width: float
    seed: int
    optimum: float

    def fitness(self, positions: np.ndarray) -> np.ndarray:
        """The RMS residual of each row of ``positions``."""
        gaps = positions - self.target
        return np.sqrt(np.einsum("pd,pd->p", gaps, gaps) + self.rest)

    @property
    def dimensions(self) -> int:
        """D."""
        return len(self.target)


Runner = Callable[[Sequence[Fit]], np.ndarray]  # fits of one model -> their final fitness


def one_by_one(run: Callable[[Fit], float]) -> Runner:
    """A runner for a library that knows one swarm at a time."""
    return lambda fits: np.array([run(fit) for fit in fits])


def pyswarms() -> Runner:
    """GlobalBestPSO, without bounds: its handling of them costs a third more."""
    import pyswarms

    logging.getLogger("pyswarms").setLevel(logging.CRITICAL)

    def run(fit: Fit) -> float:
        np.random.seed(fit.seed)  # noqa: NPY002 - the library draws from numpy's global generator
        start = np.random.uniform(-fit.half_width, fit.half_width, (PARTICLES, fit.dimensions))  # noqa: NPY002
        options = {"w": INERTIA, "c1": COGNITIVE, "c2": SOCIAL}
        swarm = pyswarms.single.GlobalBestPSO(PARTICLES, fit.dimensions, options, init_pos=start)
        return swarm.optimize(fit.fitness, ITERATIONS, verbose=False)[0]

    return one_by_one(run)


def scikit_opt() -> Runner:
    """sko.PSO with a vectorised objective; it keeps particles in the box."""
    from sko.PSO import PSO
    from sko.tools import set_run_mode

    def run(fit: Fit) -> float:
        np.random.seed(fit.seed)  # noqa: NPY002 - the library draws from numpy's global generator

        def objective(positions: np.ndarray) -> np.ndarray:
            return fit.fitness(positions)

        set_run_mode(objective, "vectorization")
        box = np.full(fit.dimensions, fit.half_width)
        swarm = PSO(objective, fit.dimensions, PARTICLES, ITERATIONS, -box, box, INERTIA, COGNITIVE, SOCIAL)
        swarm.run()
        return float(np.ravel(swarm.gbest_y)[0])

    return one_by_one(run)


def mealpy() -> Runner:
    """OriginalPSO; it evaluates one particle at a time and draws anew what leaves the box."""
    from mealpy import FloatVar
    from mealpy.swarm_based.PSO import OriginalPSO

    def run(fit: Fit) -> float:
        box = np.full(fit.dimensions, fit.half_width)
        problem = {
            "bounds": FloatVar(lb=-box, ub=box),
            "minmax": "min",
            "obj_func": lambda position: float(fit.fitness(position[None])[0]),
            "log_to": None,
        }
        swarm = OriginalPSO(epoch=ITERATIONS, pop_size=PARTICLES, c1=COGNITIVE, c2=SOCIAL, w=INERTIA)
        return float(swarm.solve(problem, seed=fit.seed).target.fitness)

    return one_by_one(run)


def pymoo() -> Runner:
    """PSO with fixed weights and a vectorised problem."""
    from pymoo.algorithms.soo.nonconvex.pso import PSO
    from pymoo.core.problem import Problem
    from pymoo.optimize import minimize

    class LeastSquaresProblem(Problem):
        def __init__(self, fit: Fit) -> None:
            super().__init__(n_var=fit.dimensions, n_obj=1, xl=-fit.half_width, xu=fit.half_width)
            self.fit = fit

        def _evaluate(self, positions: np.ndarray, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
            out["F"] = self.fit.fitness(positions)

    def run(fit: Fit) -> float:
        swarm = PSO(PARTICLES, w=INERTIA, c1=COGNITIVE, c2=SOCIAL, adaptive=False, pertube_best=False)
        return float(minimize(LeastSquaresProblem(fit), swarm, ("n_gen", ITERATIONS + 1), seed=fit.seed).F[0])

    return one_by_one(run)


def evosax() -> Runner:
    """PSO as it comes: one r1 and one r2 for all dimensions of a particle."""
    from evosax.algorithms import PSO

    return _evosax_runner(PSO)


def evosax_per_dimension() -> Runner:
    """PSO with the paper's formula: r1 and r2 for each dimension, as in all others here."""
    import jax
    import jax.numpy as jnp
    from evosax.algorithms import PSO

    class PerDimensionPSO(PSO):
        def _ask(self, key: Any, state: Any, params: Any) -> tuple[Any, Any]:
            best = state.population_best[jnp.argmin(state.fitness_best)]
            r1, r2 = jax.random.uniform(key, (2, *state.population.shape))
            velocity = (
                params.inertia_coeff * state.velocity
                + params.cognitive_coeff * r1 * (state.population_best - state.population)
                + params.social_coeff * r2 * (best - state.population)
            )
            return state.population + velocity, state.replace(velocity=velocity)

    return _evosax_runner(PerDimensionPSO)


def _evosax_runner(algorithm: Any, together: int = 32) -> Runner:
    """All iterations in one compiled scan, 32 swarms side by side (best of 1, 8, 32 and 300), single precision."""
    import jax
    import jax.numpy as jnp

    compiled: dict[int, Any] = {}

    def compile_for(dimensions: int) -> Any:
        swarm = algorithm(PARTICLES, jnp.zeros(dimensions))
        params = swarm.default_params.replace(inertia_coeff=INERTIA, cognitive_coeff=COGNITIVE, social_coeff=SOCIAL)

        def one(fit: tuple[Any, Any, Any, Any]) -> Any:
            key, target, rest, half_width = fit

            def fitness(positions: Any) -> Any:
                return jnp.sqrt(jnp.sum((positions - target) ** 2, axis=-1) + rest)

            start_key, init_key, key = jax.random.split(key, 3)
            start = jax.random.uniform(start_key, (PARTICLES, dimensions), minval=-half_width, maxval=half_width)
            state = swarm.init(init_key, start, fitness(start), params)

            def step(state: Any, key: Any) -> tuple[Any, None]:
                ask_key, tell_key = jax.random.split(key)
                positions, state = swarm.ask(ask_key, state, params)
                return swarm.tell(tell_key, positions, fitness(positions), state, params)[0], None

            state, _ = jax.lax.scan(step, state, jax.random.split(key, ITERATIONS))
            return jnp.min(state.fitness_best)

        return jax.jit(lambda *fits: jax.lax.map(one, fits, batch_size=together))

    def run(fits: Sequence[Fit]) -> np.ndarray:
        dimensions = fits[0].dimensions
        if dimensions not in compiled:
            compiled[dimensions] = compile_for(dimensions)
        keys = jax.vmap(jax.random.key)(jnp.array([fit.seed * 1000 + k for k, fit in enumerate(fits)]))
        rest, half_width = (jnp.array([getattr(fit, name) for fit in fits]) for name in ("rest", "half_width"))
        return np.asarray(compiled[dimensions](keys, jnp.array([fit.target for fit in fits]), rest, half_width))

    return run


# name, loader, share of the seeds that is run (its time is scaled up)
PEERS: tuple[tuple[str, Callable[[], Runner], float], ...] = (
    ("pyswarms", pyswarms, 0.1),
    ("evosax", evosax, 1.0),
    ("evosax, r per dimension", evosax_per_dimension, 1.0),
    ("scikit-opt", scikit_opt, 0.1),
    ("mealpy", mealpy, 0.01),
    ("pymoo", pymoo, 0.01),
)
