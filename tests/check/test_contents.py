"""Neighbours are those that a tree finds, which is another implementation, however they are spread."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from armscope.check import contents
from armscope.check.contents import close_pairs

RNG = np.random.default_rng(0)
SPREADS = {
    "anywhere": RNG.uniform(-2, 2, (400, 4)),
    "visited again": np.repeat(RNG.uniform(-2, 2, (100, 4)), 3, axis=0) + RNG.normal(0, 1e-3, (300, 4)),
    "on a grid": np.stack(np.meshgrid(*[np.arange(4) * 0.01] * 4), axis=-1).reshape(-1, 4),
    "one": np.zeros((1, 4)),
}


@pytest.mark.parametrize("points", SPREADS.values(), ids=SPREADS)
@pytest.mark.parametrize("most", [0, 50, 10_000])
def test_neighbours_are_those_that_a_tree_finds(points, most, monkeypatch):
    monkeypatch.setattr(contents, "TABLE", replace(contents.TABLE, candidates=most))
    for reach in (3e-3, 0.01, 0.5):
        expected = {tuple(sorted(pair)) for pair in cKDTree(points).query_pairs(reach)}
        assert {tuple(sorted(pair)) for pair in close_pairs(points, reach).tolist()} == expected
