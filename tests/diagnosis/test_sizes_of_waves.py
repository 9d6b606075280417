"""Waves of gears get sizes of their own where held-out rows gain by it, and only there."""

from __future__ import annotations

import numpy as np

from armscope.diagnosis.model_space import EffectSpace, build_model_space
from armscope.diagnosis.sizes_of_waves import freedom_of_waves, with_sizes_of_rows
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.registration import fit_frames
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, build_problem
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import FAMILIES, TRANSMISSION, gear_waves
from armscope.physics.effect import Placed
from armscope.physics.frames import free_frames

from .planted import planted

ROWS, NOISE = 160, 0.02
FEW = {("gear_eccentricity", "joint 1"): [2e-4, 1e-4], ("gear_eccentricity", "joint 2"): [-1e-4, 2e-4]}
Posed = tuple[Problem, EffectSpace, list[NormalEquations], Hypothesis, list[Placed]]


def posed(effects: dict[tuple[str, str], list[float]], size: int) -> Posed:
    """A six-axis arm with a few waves at most, all gears' twenty waves allowed for."""
    arm, table = planted("six-axis", effects, ROWS, NOISE, seed=2)
    waves = gear_waves(table, 20)
    families = [waves if family == TRANSMISSION else [] for family in FAMILIES]
    space = build_model_space(free_frames(table, False), families, [])
    weights = RowWeights.of_positions(np.ones(ROWS))
    blocks = normal_equations_by_block(space.layout, fit_frames(arm, table), table, weights, np.arange(ROWS) % 20)
    problem = build_problem(space, total(blocks), NOISE / 2)
    background = tuple(size if family == TRANSMISSION else 0 for family in FAMILIES)
    return problem, space, blocks, evaluate(problem, (), background, NOISE), waves


def test_two_waves_of_a_hundred_and_twenty_are_larger_and_the_others_smaller():
    problem, space, blocks, hypothesis, waves = posed(FEW, 3)
    freedom = freedom_of_waves(problem, space, hypothesis, blocks, waves)
    assert freedom is not None
    learned = with_sizes_of_rows(problem, space, hypothesis, waves, freedom)
    larger = {
        (new.location, new.scanned[0][2]): new.prior_scale[0] / old.prior_scale[0]
        for new, old in zip(learned, waves, strict=True)
    }
    planted_waves = sorted(larger, key=lambda wave: -larger[wave])[:2]
    assert {place for place, _ in planted_waves} == {"joint 1", "joint 2"}
    usual = float(np.median(list(larger.values())))
    assert usual < 0.8
    assert min(larger[wave] for wave in planted_waves) > 2 * usual


def test_waves_stay_as_stated_where_there_are_none():
    problem, space, blocks, hypothesis, waves = posed(FEW, 0)
    assert freedom_of_waves(problem, space, hypothesis, blocks, waves) is None


def test_waves_stay_as_stated_where_no_rows_can_be_held_out():
    problem, space, blocks, hypothesis, waves = posed(FEW, 3)
    assert freedom_of_waves(problem, space, hypothesis, [total(blocks)], waves) is None
