"""Benchmarks are run by hand, so what they reach into must be there: a part of a diagnosis is timed inside it."""

import importlib
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.diagnosis import measure, told
from benchmarks.price_of_search import noncentrality, smallest_p_values
from scipy.stats import norm

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "one-effect"


@pytest.mark.long
def test_the_atlas_is_timed_inside_the_diagnosis():
    found = measure(EXAMPLE, 0)
    (whole,), (atlas,) = found["cpu"], found["atlas"]
    assert 0 < atlas < whole
    assert "60 rows" in told("one-effect", found)


def test_the_price_of_search_is_that_of_so_many_independent_tests():
    """Twenty candidates of one column each, at right angles: the smallest of twenty uniform p-values."""
    frames, candidates = np.arange(3), [SimpleNamespace(columns=np.array([3 + k])) for k in range(20)]
    gram = np.eye(23)
    gram[:3, 3:] = gram[3:, :3] = 0.1  # what the frames take of every column alike
    gram[3:, 3:] += 3 * 0.1**2
    problem = SimpleNamespace(
        equations=SimpleNamespace(G=gram), space=SimpleNamespace(frames=frames, candidates=candidates)
    )
    rng = np.random.default_rng(2)
    smallest = np.concatenate([smallest_p_values(problem, rng) for _ in range(10)])
    expected = 1 - (1 - np.array([0.01, 0.05, 0.5])) ** (1 / 20)
    assert np.quantile(smallest, [0.01, 0.05, 0.5]) == pytest.approx(expected, rel=0.15)  # 400 draws at the lowest
    assert np.sqrt(noncentrality(expected[0], 1) / noncentrality(0.01, 1)) == pytest.approx(
        (norm.isf(expected[0] / 2) + norm.isf(0.1)) / (norm.isf(0.005) + norm.isf(0.1)), rel=1e-3
    )


BESIDE = sorted(
    str(path.relative_to(ROOT)) for folder in ("benchmarks", "tools") for path in (ROOT / folder).glob("*.py")
)


@pytest.mark.parametrize("script", BESIDE)
def test_what_stands_beside_the_package_finds_what_it_takes_from_it(script: str) -> None:
    """A name that moved, or went because nothing in the package called it, broke a benchmark and the installation."""
    importlib.import_module(script.removesuffix(".py").replace("/", "."))


def test_the_installation_finds_what_it_calls() -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    called = re.findall(r'python -c "from ([\w.]+) import (\w+); \w+\.(\w+)\(\)"', makefile)
    assert called
    for package, module, function in called:
        assert callable(getattr(importlib.import_module(f"{package}.{module}"), function))
