"""What gives way and looks alike shares in a background what one of them did: together they may stand out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import naming
from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.model_space import EffectSpace, build_model_space
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.design_matrix import point_columns
from armscope.fitting.registration import fit_frames
from armscope.inference.evidence import evaluate
from armscope.inference.normal_equations import total
from armscope.inference.problem import Problem, build_problem
from armscope.inference.search import Search
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import FAMILIES, STRUCTURE, backgrounds
from armscope.physics.frames import free_frames
from armscope.physics.registry import library

from ..backgrounds import sizes
from .planted import planted

ROWS, NOISE_MM, USUAL_MM = 200, 0.03, 0.02
LINK = ("link_bending", "link 1")


@pytest.fixture(scope="module")
def setting() -> tuple[Problem, EffectSpace, np.ndarray]:
    """An arm's library at random poses, and its columns, scaled to 1 mm at the tool."""
    arm, table = planted("six-axis", {}, ROWS, NOISE_MM, seed=5)
    model = fit_frames(arm, table)
    space = build_model_space(free_frames(table, False), list(backgrounds(arm, table).values()), library(arm, table))
    weights = RowWeights.of_positions(np.ones(ROWS))
    gram = total(normal_equations_by_block(space.layout, model, table, weights, np.arange(ROWS) % 5))
    problem = build_problem(space, gram, 0.97 * NOISE_MM)
    return problem, space, point_columns(model.posture(model.scene(table)), space.layout.terms) / problem.scale


def names(setting: tuple[Problem, EffectSpace, np.ndarray], times: float) -> set[tuple[str, str]]:
    """Where base and all links give way, the first link so many times as much as usual."""
    problem, space, X = setting
    rng = np.random.default_rng(1)
    structure = FAMILIES.index(STRUCTURE)
    amounts = {c: rng.uniform(0.5, 1.5) for c in space.families[structure].columns}
    first = next(c for c in space.candidates if c.key == LINK)
    amounts[first.columns[0]] *= times
    y = USUAL_MM * X[:, list(amounts)] @ np.array(list(amounts.values())) + rng.normal(0, NOISE_MM, len(X))
    read = replace(problem, equations=replace(problem.equations, b=X.T @ y, yy=float(y @ y)))
    background = list(sizes(2))
    background[structure] = space.families[structure].sizes - 1
    found = evaluate(read, (), tuple(background), NOISE_MM)
    return {space.candidates[c.candidate].key for c in naming.named(Search.on(read), space, found).chosen}


def test_what_one_of_several_alike_did_is_named_although_each_looks_usual(setting, monkeypatch):
    assert names(setting, 7.5) == {LINK}
    monkeypatch.setattr(naming, "NAMING", replace(NAMING, alike=1.0))
    assert names(setting, 7.5) == set()


def test_where_all_give_way_alike_none_is_named(setting):
    assert names(setting, 1.0) == set()
